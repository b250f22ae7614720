//! Laplace's method on the summand, with Stirling's series and the sum replaced by the integral:
//!
//! S ≈ e^ψ/(μ √w) (1 + c₁/μ + c₂/μ² + c₃/μ³ + c₄/μ⁴),  ψ = g (expm1 u − 2u e^u),
//!
//! uniformly in x; at x = 0 it is 1/g + 1/g² + 2/g³ + 6/g⁴ + 24/g⁵, and (49) is its u → 0 limit.

use super::saddle::Saddle;
use super::{LobeSeries, Method, rounding};
use crate::reflectance::numeric::scaled::Scaled;

/// Bound of |c₅| and the tail it stands for, over all w ≥ 1 and μ ≥ 10: c₅(1) = 5! is its largest
/// value; the factor covers what follows it. Measured against the sum: `tests.rs` beside this file.
const REMAINDER: f64 = 4.0 * 120.0;

/// c₁ … c₄ as polynomials in t = 1/w, lowest power first.
const C1: [f64; 4] = [-1.0, 0.0, 3.0, 10.0];
const C2: [f64; 7] = [1.0, -24.0, -30.0, -92.0, -399.0, -420.0, 1540.0];
const C3: [f64; 10] =
    [139.0, 540.0, 405.0, -930.0, 12825.0, 129816.0, 278355.0, -810810.0, -2702700.0, 3403400.0];
const C4: [f64; 13] = [
    -571.0,
    40032.0,
    47604.0,
    66040.0,
    166590.0,
    -1148184.0,
    -15800532.0,
    -50131224.0,
    101975445.0,
    813412600.0,
    116396280.0,
    -3879876000.0,
    2974571600.0,
];

fn horner(coefficients: &[f64], t: f64) -> f64 {
    coefficients.iter().rev().fold(0.0, |sum, c| sum * t + c)
}

/// Bound of the relative truncation error: the asymptotic remainder and the sum's difference from
/// its integral. Above 1 it only says that the expansion does not serve.
pub(super) fn truncation(saddle: &Saddle) -> f64 {
    let fifth = saddle.mu * saddle.mu * saddle.mu * saddle.mu * saddle.mu;
    let aliasing = 4.0 * libm::exp(-2.0 * core::f64::consts::PI.powi(2) * saddle.variance());
    REMAINDER / fifth + aliasing
}

/// Whether [`truncation`] is a bound here: below, the expansion is off by more than it can say.
pub(super) fn serves(saddle: &Saddle) -> bool {
    saddle.mu >= 16.0 && saddle.variance() >= 2.0
}

/// c₁ … c₄.
fn coefficients(saddle: &Saddle) -> [f64; 4] {
    let t = 1.0 / saddle.w;
    [horner(&C1, t) / 12.0, horner(&C2, t) / 288.0, horner(&C3, t) / 51840.0, horner(&C4, t) / 2488320.0]
}

/// 1 + c₁/μ + … + c₄/μ⁴.
fn correction(saddle: &Saddle) -> f64 {
    let [c1, c2, c3, c4] = coefficients(saddle);
    let r = 1.0 / saddle.mu;
    1.0 + r * (c1 + r * (c2 + r * (c3 + r * c4)))
}

/// The same for any μ.
fn scaled_correction(saddle: &Saddle) -> Scaled {
    let r = Scaled::ONE / Scaled::new(saddle.mu);
    let sum = coefficients(saddle).into_iter().rev().fold(Scaled::ZERO, |sum, c| (sum + Scaled::new(c)) * r);
    Scaled::ONE + sum
}

/// S by the expansion to order 4, where it [`serves`].
pub(super) fn order_four(g: f64, x: f64, saddle: &Saddle) -> LobeSeries {
    let value = leading_term(g, x, saddle) * correction(saddle);
    let (condition_g, condition_x) = conditions(g, x, saddle);
    LobeSeries::converged(value, truncation(saddle), condition_g, condition_x, Method::Uniform)
}

/// What the expansion makes of a point where it does not serve, measured against `s`.
pub(super) fn beyond(g: f64, x: f64, saddle: &Saddle, s: &LobeSeries) -> LobeSeries {
    // 1/μ⁴ may leave f64's range.
    let value = leading_term(g, x, saddle) * scaled_correction(saddle);
    // Far outside, 1 + c₁/μ + … may be negative: the report's quantities are not.
    let value = if value.is_negative() { Scaled::ZERO } else { value };
    let (condition_g, condition_x) = conditions(g, x, saddle);
    LobeSeries::compared(value, rounding(condition_g, condition_x), s, Method::Uniform)
}

/// |∂ ln S/∂ ln g| and |∂ ln S/∂ ln x| of the leading term: with ∂u/∂ ln g = −2u/w and
/// ∂u/∂ ln x = u/w, the exponent adds μ − g and −x/μ, the rest what follows.
fn conditions(g: f64, x: f64, &Saddle { u, mu, w }: &Saddle) -> (f64, f64) {
    // μ − g cancels for small u; g expm1(u) does not, but overflows where g is tiny.
    let shift = if u < 1.0 { g * libm::expm1(u) } else { mu - g };
    ((shift - 1.0 / w + 2.0 * u / (w * w)).abs(), x / mu + u / w + u / (w * w))
}

/// e^ψ/(μ √w).
fn leading_term(g: f64, x: f64, saddle: &Saddle) -> Scaled {
    let Saddle { u, mu, w } = *saddle;
    // For small u in a form that does not cancel. For large u stationary in μ: with 2x/μ in place of
    // μ ln(μ/g) + x/μ, the rounding of μ would come back w times as large.
    let psi = if u < 0.5 {
        g * (libm::expm1(u) - 2.0 * u * libm::exp(u))
    } else {
        // Beyond u = 600 the quotient may overflow.
        let ln_ratio = if u < 600.0 { libm::log(mu / g) } else { libm::log(mu) - libm::log(g) };
        (mu - g) - mu * ln_ratio - x / mu
    };
    Scaled::exp(psi) / (Scaled::new(mu) * w.sqrt())
}
