//! Where the terms of the series are largest.

/// The saddle of the summand, m ↦ g^m/(m! m) e^{-g-x/m} with Stirling's leading factor:
/// ln(m/g) = x/m², that is m = μ = g e^u with 2u e^{2u} = 2x/g² (Lambert's W).
#[derive(Clone, Copy, Debug)]
pub(super) struct Saddle {
    /// u = W₀(2x/g²)/2 = ln(μ/g), relative error below 8 ε.
    pub(super) u: f64,
    /// μ = g e^u, where the largest term is.
    pub(super) mu: f64,
    /// w = 1 + 2u; the variance of the terms is μ/w.
    pub(super) w: f64,
}

impl Saddle {
    /// Of g > 0, x ≥ 0.
    pub(super) fn of(g: f64, x: f64) -> Self {
        let u = 0.5 * lambert_w(g, x);
        // For u so large that e^u overflows, g is so small that μ does not.
        let mu = if u < 600.0 { g * libm::exp(u) } else { (x / u).sqrt() };
        Self { u, mu, w: 1.0 + 2.0 * u }
    }

    /// Variance of the terms.
    pub(super) fn variance(&self) -> f64 {
        self.mu / self.w
    }
}

/// W₀(2x/g²), also where the quotient is beyond f64's range.
fn lambert_w(g: f64, x: f64) -> f64 {
    if x == 0.0 {
        return 0.0;
    }
    let z = 2.0 * (x / g) / g;
    if z < 1e-8 {
        // W = z − z² + …, the next term below 1e-16 of the first.
        return z * (1.0 - z);
    }
    let ln_z =
        if z < 1e300 { libm::log(z) } else { core::f64::consts::LN_2 + libm::log(x) - 2.0 * libm::log(g) };
    let mut w = if ln_z > 2.0 { ln_z - libm::log(ln_z) } else { libm::log1p(z) * 0.7 };
    // Newton's step for w + ln w = ln z. It squares the error; the start is within 30 %.
    for _ in 0..8 {
        let next = w * (1.0 + ln_z - libm::log(w)) / (1.0 + w);
        let done = (next - w).abs() <= 1e-9 * next;
        w = next;
        if done {
            break;
        }
    }
    w
}

#[cfg(test)]
mod tests {
    use super::{Saddle, lambert_w};

    #[test]
    fn w_solves_its_equation() {
        for exponent in -300..300 {
            let x = 10f64.powi(exponent);
            for g in [1e-300, 1e-9, 0.3, 1.0, 50.0, 1e10] {
                let w = lambert_w(g, x);
                // A subnormal has too few digits to be asked for them; μ = g either way.
                if w < f64::MIN_POSITIVE {
                    continue;
                }
                let ln_z = 2f64.ln() + x.ln() - 2.0 * g.ln();
                let residual = (w + w.ln() - ln_z).abs();
                assert!(residual <= 1e-15 * (4.0 + ln_z.abs() + w), "g {g} x {x}: {residual}");
            }
        }
    }

    #[test]
    fn the_saddle_is_stationary() {
        for (g, x) in [(1e-300, 1e14), (3.0, 1000.0), (1e6, 1e6), (1e-3, 5.0)] {
            let Saddle { mu, .. } = Saddle::of(g, x);
            let slope = (mu.ln() - g.ln()) - x / mu / mu;
            assert!(slope.abs() <= 1e-13 * (1.0 + x / mu / mu), "g {g} x {x}: {slope}");
        }
    }
}
