//! The diffuse lobe (57): radiance the same in every direction.

use super::numeric::scaled::Scaled;
use super::quantity::{Fraction, Irradiance};
use core::f64::consts::FRAC_1_PI;

/// κ_diff = ρ/π of (57), per steradian: ρ is the share of the light that a white plane would
/// send back, since the integral of cos θ_r over the hemisphere is π (errata E30).
pub fn kappa_diff(albedo: Fraction) -> Scaled {
    Scaled::new(albedo.get()) * FRAC_1_PI
}

/// Radiance (57), W m⁻² sr⁻¹: κ_diff · irradiance · max(0, cos θ_i); a source behind the
/// surface gives none. Relative error below 4 ε and that of the cosine.
pub fn radiance(albedo: Fraction, irradiance: Irradiance, cos_i: f64) -> Scaled {
    kappa_diff(albedo) * irradiance.get() * cos_i.max(0.0)
}

#[cfg(test)]
mod tests {
    use super::{kappa_diff, radiance};
    use crate::reflectance::quantity::{Fraction, Irradiance, Quantity};

    #[test]
    fn a_white_surface_sends_everything_back() {
        let (white, beam) = (Fraction::new(1.0).unwrap(), Irradiance::new(3.0).unwrap());
        let exitance = core::f64::consts::PI * radiance(white, beam, 0.5).to_f64();
        // Four roundings.
        assert!((exitance - 1.5).abs() <= 1.5 * 2.0 * f64::EPSILON, "{exitance}");
        assert!(kappa_diff(Fraction::new(0.0).unwrap()).is_zero());
    }

    #[test]
    fn a_source_behind_the_surface_gives_no_light() {
        let (white, beam) = (Fraction::new(1.0).unwrap(), Irradiance::new(3.0).unwrap());
        assert!(radiance(white, beam, -0.5).is_zero());
        assert!(radiance(white, beam, 0.0).is_zero());
    }
}
