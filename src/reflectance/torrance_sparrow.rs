//! The facet lobe of Torrance and Sparrow, (58)-(71). Its companion, the diffuse lobe of (72), is [`super::lambertian`].

pub(super) mod lanes;

use super::estimate::Estimate;
use super::fresnel::{Energy, Medium, Polarization};
use super::geometry::Geometry;
use super::numeric::EPSILON;
use super::numeric::quadrature;
use super::numeric::scaled::Scaled;
use super::shadowing::ShadowingFunction;
use core::f64::consts::{FRAC_PI_2, PI};

/// (70) and (71) for every direction: c·a_f, σ_α and what the facets are made of.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FacetLobe {
    /// σ_α of (58) in radians, above 0.
    pub sigma_alpha: f64,
    /// c·a_f of (71) per steradian, relative error up to 8 ε.
    pub specular_scale: f64,
    /// F′ of (63) is taken from it at θ′.
    pub medium: Medium,
    /// h and v of (63).
    pub polarization: Polarization,
    /// G of (65), Smith's, or none.
    pub shadowing: ShadowingFunction,
}

impl FacetLobe {
    /// κ_spec of (71) per steradian, with the error that comes from F′.
    pub fn kappa_spec(&self, geometry: &Geometry) -> Energy {
        let reflectance = self.medium.reflectance(geometry.local_incidence(), self.polarization);
        let scale = 0.25 * self.specular_scale * self.shadowing.factor(geometry);
        Energy { value: scale * reflectance.value, error: scale * reflectance.error }
    }

    /// exp(−α²/2σ_α²) of (75). Its logarithm has a relative error below 28 ε.
    pub fn gaussian(&self, geometry: &Geometry) -> Scaled {
        gaussian(geometry, self.sigma_alpha)
    }

    /// c·a_f/4 · exp(−α²/2σ_α²) · `over_cosines`: (70) over the irradiance, without F′.
    ///
    /// `over_cosines` is G/cos θ_r for a radiance, G/(cos θ_i cos θ_r) for a BRDF; where it is infinite or NaN, so is
    /// the lobe. Error: 14 ε (α/σ_α)² for the exponential, whose angle is known to 6 ε and width to 5 ε, and 48 ε
    /// for the factors, more if G is Smith's.
    pub fn lobe(&self, geometry: &Geometry, over_cosines: f64) -> Estimate {
        // A lobe without strength has no radiance at grazing either.
        if self.specular_scale == 0.0 {
            return Estimate::ZERO;
        }
        if over_cosines.is_nan() {
            return Estimate::UNDEFINED;
        }
        if over_cosines.is_infinite() {
            return Estimate::INFINITE;
        }
        if over_cosines == 0.0 {
            return Estimate::ZERO;
        }
        if geometry.length() == 0.0 {
            // Both directions grazing and opposite: α depends on the path.
            return Estimate::UNDEFINED;
        }
        let ratio = geometry.alpha() / self.sigma_alpha;
        let square = ratio * ratio;
        let value = Scaled::exp(-0.5 * square) * (0.25 * over_cosines) * self.specular_scale;
        Estimate::within(value, EPSILON * (14.0 * square + 48.0 + self.shadowing.units()))
    }

    /// Radiance (70) under a beam of this irradiance on a plane normal to it (L_i dω_i), W m⁻² sr⁻¹.
    ///
    /// Infinite at cos θ_r = 0 without shadowing, NaN where G has no limit.
    pub fn radiance(&self, geometry: &Geometry, irradiance: f64) -> Estimate {
        let reflectance = self.medium.reflectance(geometry.local_incidence(), self.polarization);
        self.lobe(geometry, self.shadowing.factor_over_cos_r(geometry))
            .times(reflectance.into())
            .scaled_by(Scaled::new(irradiance))
    }
}

/// exp(−α²/2`sigma_alpha`²), α by the half vector.
pub fn gaussian(geometry: &Geometry, sigma_alpha: f64) -> Scaled {
    let ratio = geometry.alpha() / sigma_alpha;
    Scaled::exp(-0.5 * ratio * ratio)
}

/// Below this σ_α in radians, e^{−π²/8σ²} is below 1e-18: facets steeper than 90° make no difference.
const NARROW: f64 = 0.17;

/// c·a_f such that the facets' projections add up to the mean plane (errata E31), per steradian:
/// 1/∫ exp(−α²/2σ²) cos α dω = 1/(π ∫₀^{π/2} exp(−α²/2σ²) sin 2α dα), σ in radians above 0.
///
/// Tends to 1/(2πσ²) for small σ and to 1/π for large ones. Relative error below 8 ε and twice that of σ.
pub fn normalized_scale(sigma_alpha: f64) -> f64 {
    if sigma_alpha < NARROW {
        // ∫₀^∞ exp(−α²/2σ²) sin 2α dα = √2 σ D(√2 σ) with Dawson's D(z) = Σ (−2z²)^n z/(2n + 1)!!.
        let z = -4.0 * sigma_alpha * sigma_alpha;
        // |z| < 0.12: the first term left out, z^9/19!!, is below 1e-17.
        let sum = (1..9).rev().fold(1.0, |sum, n| 1.0 + sum * z / f64::from(2 * n + 1));
        return 0.5 / (PI * sum) / sigma_alpha / sigma_alpha;
    }
    // In units of σ. What lies beyond 9.5 is below e^{−45} of the whole.
    let end = (FRAC_PI_2 / sigma_alpha).min(9.5);
    let integral = quadrature::integrate(0.0, end, |t| {
        libm::exp(-0.5 * t * t) * (libm::sin(2.0 * sigma_alpha * t) / sigma_alpha)
    });
    1.0 / (PI * integral.value) / sigma_alpha / sigma_alpha
}

#[cfg(test)]
mod tests {
    use super::{FacetLobe, NARROW, normalized_scale};
    use crate::reflectance::fresnel::{Medium, Polarization};
    use crate::reflectance::geometry::Geometry;
    use crate::reflectance::numeric::EPSILON;
    use crate::reflectance::quantity::{Azimuth, Quantity, SourceZenith, ViewerZenith};
    use crate::reflectance::shadowing::ShadowingFunction;
    use core::f64::consts::PI;

    fn geometry(theta_i: f64, theta_r: f64) -> Geometry {
        Geometry::new(
            SourceZenith::new(theta_i).unwrap(),
            ViewerZenith::new(theta_r).unwrap(),
            Azimuth::new(0.0).unwrap(),
        )
    }

    fn lobe(sigma_alpha: f64, shadowing: ShadowingFunction) -> FacetLobe {
        FacetLobe {
            sigma_alpha,
            specular_scale: 4.0,
            medium: Medium::PerfectConductor,
            polarization: Polarization::unpolarized(),
            shadowing,
        }
    }

    #[test]
    fn the_scale_has_its_limits() {
        // The next term of the integral is smaller by the order of σ².
        for sigma in [1e-120, 1e-14, 1e-9] {
            let scale = normalized_scale(sigma) * sigma * sigma;
            assert!((scale * 2.0 * PI - 1.0).abs() < 16.0 * EPSILON, "{sigma} {scale}");
        }
        // Series and quadrature meet.
        let (below, above) = (normalized_scale(NARROW.next_down()), normalized_scale(NARROW));
        assert!((above / below - 1.0).abs() < 16.0 * EPSILON, "{below} {above}");
        // exp(−α²/2σ²) ≥ 1 − π²/8σ².
        let wide = normalized_scale(1e9);
        assert!((wide * PI - 1.0).abs() < 16.0 * EPSILON, "{wide}");
        // Errata E31: 1.07 and 1.42 times 1/(2πσ²) at 13 and 30 degrees.
        for (degrees, printed) in [(13.0f64, 1.07), (30.0, 1.42)] {
            let sigma = degrees.to_radians();
            let ratio = normalized_scale(sigma) * 2.0 * PI * sigma * sigma;
            assert!((ratio - printed).abs() < 0.005, "{degrees} {ratio}");
        }
    }

    #[test]
    fn grazing_view_is_finite_with_grooves_and_infinite_without() {
        // Errata E38: σ_α = 13°, θ_i = 60°: L(90°) = 1.918 L(specular).
        let rough = lobe(13f64.to_radians(), ShadowingFunction::VGroove);
        let ratio = rough.radiance(&geometry(60.0, 90.0), 1.0).value
            / rough.radiance(&geometry(60.0, 60.0), 1.0).value;
        assert!((ratio.to_f64() - 1.918).abs() < 0.0005, "{ratio:?}");
        let bare = lobe(13f64.to_radians(), ShadowingFunction::None);
        assert_eq!(bare.radiance(&geometry(60.0, 90.0), 1.0).value.to_f64(), f64::INFINITY);
        assert!(rough.radiance(&geometry(90.0, 90.0), 1.0).value.to_f64().is_nan());
    }

    #[test]
    fn the_logarithm_survives_where_the_value_does_not() {
        // α = 30° and σ = 1e-4°: exponent −(3e5)²/2, and 1/cos 60° = 2.
        let radiance =
            lobe(1e-4f64.to_radians(), ShadowingFunction::None).radiance(&geometry(0.0, 60.0), 1.0);
        assert_eq!(radiance.value.to_f64(), 0.0);
        let ln = radiance.value.ln();
        let exact = -4.5e10 + 2f64.ln();
        // The exponent's own bound, 14 ε (α/σ)², and the roundings of the test.
        assert!((ln - exact).abs() <= 16.0 * EPSILON * 9e10, "{ln}");
        assert!(radiance.relative_error() < 1e-3);
    }

    #[test]
    fn a_lobe_without_strength_is_dark() {
        let mut dark = lobe(0.1, ShadowingFunction::None);
        dark.specular_scale = 0.0;
        assert!(dark.radiance(&geometry(60.0, 90.0), 1.0).value.is_zero());
    }
}
