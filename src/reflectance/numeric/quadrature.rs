//! Tanh-sinh quadrature: integrals of smooth functions to a few ε, also where a derivative is infinite at an end.
//!
//! H. Takahasi and M. Mori, *Double exponential formulas for numerical integration*, Publ. RIMS 9 (1974) 721. The
//! substitution x = tanh(π/2 sinh t) turns the interval into the real line and makes the integrand fall off
//! doubly exponentially, where the trapezoidal rule converges as fast as its step allows.

use crate::reflectance::numeric::EPSILON;
use core::f64::consts::FRAC_PI_2;

/// An integral and the estimate of its absolute error.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Integral {
    /// The value.
    pub value: f64,
    /// |value − exact|: the last change by halving the step, and the rounding of the sum.
    pub error: f64,
}

impl Integral {
    /// Nothing, exactly.
    pub const ZERO: Self = Self { value: 0.0, error: 0.0 };

    /// Of neighbouring intervals together.
    #[must_use]
    pub fn plus(self, other: Self) -> Self {
        Self { value: self.value + other.value, error: self.error + other.error }
    }
}

/// Beyond this t the weights are below 1e-20 of the largest.
const LAST: f64 = 3.4;
/// The step begins at 1/2 and is halved at most this often: 3481 points.
const HALVINGS: u32 = 8;

/// The finest relative tolerance: below it rounding of `f` may keep the value from settling.
pub const FINEST: f64 = 8.0 * EPSILON;

/// ∫ `f` from `a` to `b` as well as f64 can, [`integrate_to`] the [`FINEST`] tolerance.
pub fn integrate(a: f64, b: f64, f: impl FnMut(f64) -> f64) -> Integral {
    integrate_to(FINEST, a, b, f)
}

/// ∫ `f` from `a` to `b`, both finite, 0 if a ≥ b; `f` must be finite inside. The ends themselves may be met by rounding.
///
/// Halves its step until the value changes by less than `tolerance` of ∫|f|; what is left then is in the error, also where
/// the halvings did not suffice (an unresolved peak or kink inside: split the interval there).
pub fn integrate_to(tolerance: f64, a: f64, b: f64, mut f: impl FnMut(f64) -> f64) -> Integral {
    let half = 0.5 * (b - a);
    if half <= 0.0 {
        return Integral::ZERO;
    }
    let mut step = 0.5;
    let mut sum = Sum::default();
    let mut size = 0.0;
    let (mut previous, mut last_change) = (f64::NAN, f64::NAN);
    let mut halving = 0;
    loop {
        // The first round takes every node of the step, each later one those between.
        let (mut t, stride) = if halving == 0 { (0.0, step) } else { (step, 2.0 * step) };
        while t < LAST {
            let (distance, weight) = node(t);
            let from_end = half * distance;
            let left = weight * f(a + from_end);
            sum.add(left);
            size += left.abs();
            if t > 0.0 {
                let right = weight * f(b - from_end);
                sum.add(right);
                size += right.abs();
            }
            t += stride;
        }
        let value = half * step * sum.total();
        let change = (value - previous).abs();
        let size = half * step * size;
        let rounding = 4.0 * EPSILON * size;
        if halving > 2 && change <= tolerance * size {
            return Integral { value, error: change + rounding };
        }
        if halving == HALVINGS {
            // Not settled: changes no longer bound what is left. A kink's contribution swings by as much as it shrinks.
            return Integral { value, error: 8.0 * (change + last_change) + rounding };
        }
        (previous, last_change) = (value, change);
        step *= 0.5;
        halving += 1;
    }
}

/// Distance of tanh(π/2 sinh t) from the nearer end of [−1, 1], and its derivative, t ≥ 0.
fn node(t: f64) -> (f64, f64) {
    let u = FRAC_PI_2 * libm::sinh(t);
    let decay = libm::exp(-2.0 * u);
    let below = 1.0 + decay;
    (2.0 * decay / below, FRAC_PI_2 * libm::cosh(t) * 4.0 * decay / (below * below))
}

/// A sum with its rounding error carried along (Neumaier).
#[derive(Default)]
struct Sum {
    high: f64,
    low: f64,
}

impl Sum {
    fn add(&mut self, term: f64) {
        let high = self.high + term;
        self.low +=
            if self.high.abs() >= term.abs() { (self.high - high) + term } else { (term - high) + self.high };
        self.high = high;
    }

    fn total(&self) -> f64 {
        self.high + self.low
    }
}

#[cfg(test)]
mod tests {
    use super::integrate;
    use crate::reflectance::numeric::EPSILON;
    use core::f64::consts::PI;

    fn check(got: super::Integral, exact: f64) {
        // One rounding of the reference on top of the stated error, which is itself to be a few ε.
        let slack = got.error + EPSILON * exact.abs();
        assert!((got.value - exact).abs() <= slack, "{got:?} {exact}");
        assert!(got.error <= 16.0 * EPSILON * exact.abs(), "{got:?} {exact}");
    }

    #[test]
    fn smooth_functions() {
        check(integrate(0.0, PI, libm::sin), 2.0);
        check(integrate(-1.0, 2.0, |x| x * x), 3.0);
        check(integrate(0.0, 1.0, |x| 4.0 / (1.0 + x * x)), PI);
        // erf(6) is 1 to 2e-17.
        check(integrate(0.0, 6.0, |x| libm::exp(-x * x)), PI.sqrt() / 2.0);
    }

    #[test]
    fn infinite_derivatives_at_an_end() {
        check(integrate(0.0, 1.0, f64::sqrt), 2.0 / 3.0);
        check(integrate(-1.0, 1.0, |x| (1.0 - x * x).max(0.0).sqrt()), PI / 2.0);
    }

    #[test]
    fn an_empty_interval_has_no_integral() {
        assert_eq!(integrate(1.0, 1.0, |_| 1.0).value, 0.0);
    }

    #[test]
    fn an_unresolved_kink_shows_in_the_error() {
        let exact = 0.5 * (0.3 * 0.3 + 0.7 * 0.7);
        let got = integrate(0.0, 1.0, |x| (x - 0.3).abs());
        assert!((got.value - exact).abs() <= got.error, "{got:?}");
        assert!(got.error > 1e-9, "{got:?}");
    }
}
