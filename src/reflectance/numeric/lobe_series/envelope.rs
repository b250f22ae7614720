//! Bounds of ln S that cost a saddle and a few logarithms: enough to tell whether a lobe can matter.
//!
//! Above: −x/m is concave in m, so its tangent at any point μ lies above it. At the saddle
//! g e^{x/μ²} = μ and the tangent sums in closed form:
//!
//! S(g, x) ≤ e^{μ − g − 2x/μ} S(μ, 0).
//!
//! Below: the mean of an exponential is at least the exponential of the mean (Jensen), over the terms of S(μ, 0); or
//! one term alone, whichever is more.

use super::saddle::Saddle;
use core::f64::consts::TAU;

/// Rounding allowed for, relative to the largest terms of the exponent: what the saddle, known to 8 ε, and the
/// logarithms can do is a few hundred times less.
const SLACK: f64 = 1e-13;

/// ln S from below and from above, for g > 0 and x ≥ 0. Measured: the two differ by less than
/// 4 + 1.1 ln(2 + μ) + w/4μ on the whole plane, and by less than 1 for g > 100 and u < 0.1.
pub fn envelope(g: f64, x: f64) -> (f64, f64) {
    let saddle = Saddle::of(g, x);
    let Saddle { u, mu, w } = saddle;
    let psi = if u < 0.5 { g * (libm::expm1(u) - 2.0 * u * libm::exp(u)) } else { (mu - g) - 2.0 * x / mu };
    let slack = SLACK * (1.0 + psi.abs() + x / mu * w);
    // 1/m ≤ 1/(m + 1) + 3/((m + 1)(m + 2)) for m ≥ 1, and the first term alone for small μ.
    let without_x = if mu < 1.0 { mu } else { 1.0 / mu + 3.0 / mu / mu };
    let upper = psi + libm::log(without_x) + slack;
    let term = one_term(g, x, mu.floor().max(1.0)).max(one_term(g, x, mu.floor() + 1.0));
    (jensen(g, x, &saddle, psi - slack).max(term), upper)
}

/// μ/w: the variance of the terms about the saddle, for g > 0 and x ≥ 0.
pub fn variance(g: f64, x: f64) -> f64 {
    Saddle::of(g, x).variance()
}

/// Jensen's inequality over the terms of S(μ, 0): with ln(μ/g) = x/μ², the exponent is
/// μ − g + ln S(μ, 0) − x E\[m\]/μ² − x E\[1/m\].
fn jensen(g: f64, x: f64, saddle: &Saddle, psi: f64) -> f64 {
    let Saddle { u, mu, .. } = *saddle;
    if mu < 16.0 || g == 0.0 {
        return f64::NEG_INFINITY;
    }
    // 1 − (1 + μ) e^{−μ} is above 1 − 2e-6 from here on: 1/m ≥ 1/(m + 1).
    let without_x = 1.0 - (1.0 + mu) * libm::exp(-mu);
    // E[m] ≤ μ/(1 − e^{−μ}): the weight 1/m favours small m. What it is above μ:
    let mean = mu * libm::exp(-mu) / (1.0 - libm::exp(-mu));
    // 1/m² ≤ 1/(m+1)(m+2) + 3/(m+1)…(m+3) + 85/(m+1)…(m+4), so E[1/m] − 1/μ is at most this over μ:
    let inverse = ((3.0 + 85.0 / mu) / mu + (1.0 - without_x)) / without_x;
    psi + libm::log(without_x / mu) - u * mean - x / mu * inverse
}

/// ln of term m ≥ 1, a whole number; ln m! from above by Stirling's series.
fn one_term(g: f64, x: f64, m: f64) -> f64 {
    let (ln_m, ln_g) = (libm::log(m), libm::log(g));
    let slack = SLACK * (1.0 + g + x / m + m * (1.0 + ln_m + ln_g.abs()));
    if m == 1.0 {
        return ln_g - g - x - slack;
    }
    (m - g) - m * (ln_m - ln_g) - x / m - ln_m - 0.5 * libm::log(TAU * m) - 1.0 / (12.0 * m) - slack
}

#[cfg(test)]
mod tests {
    use super::envelope;
    use crate::reflectance::numeric::lobe_series::saddle::Saddle;
    use crate::reflectance::numeric::lobe_series::series;

    #[test]
    fn the_series_lies_between() {
        let mut state = 7u64;
        let mut uniform = || {
            state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            (state >> 11) as f64 / 9007199254740992.0
        };
        for round in 0..60_000 {
            let g =
                10f64.powf(if round % 3 == 0 { 600.0 * uniform() - 300.0 } else { 16.0 * uniform() - 8.0 });
            // u from 1e-8 to 300, or x on its own.
            let x = match round % 4 {
                0 => 10f64.powf(16.0 * uniform() - 8.0),
                1 => 0.0,
                _ => g * g * 10f64.powf(12.0 * uniform() - 8.0),
            };
            if !(x.is_finite() && x < 1e200 && g < 1e100) {
                continue;
            }
            let saddle = Saddle::of(g, x);
            let exact = series::converged(g, x, &saddle).estimate;
            let (lower, upper) = envelope(g, x);
            let (least, most) = (exact.least.ln(), (exact.value + exact.error).ln());
            assert!(lower <= most && upper >= least, "g {g} x {x}: {lower} {least} {upper}");
            // Not idle either, as far as the exponent itself is known.
            let known = 4e-13 * (g + x / saddle.mu * saddle.w + saddle.mu * (2.0 + saddle.u));
            let most_apart = 4.0 + 1.1 * (2.0 + saddle.mu).ln() + 0.25 * saddle.w / saddle.mu + known;
            assert!(upper - lower <= most_apart, "g {g} x {x}: {lower} {upper} {most_apart}");
            if g > 100.0 && saddle.u < 0.1 && g < 1e9 {
                assert!(upper - lower < 1.0 + known, "g {g} x {x}: {lower} {upper}");
            }
        }
    }
}
