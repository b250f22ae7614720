//! The linear models of image irradiance: (74) for a fixed source and (80) for a fixed view, from given strengths.
//!
//! Both are written in the angles themselves. Their spike is a product of two one-dimensional functions of θ_i − θ_r and φ_r
//! that is 1 (or a delta) where both vanish; at normal incidence, where the azimuth means nothing, it still asks for φ_r = 0.

use super::beckmann_spizzichino::Patch;
use super::degrees;
use super::estimate::Estimate;
use super::geometry::Geometry;
use super::numeric::{EPSILON, scaled::Scaled};
use super::quantity::{Azimuth, SourceZenith, ViewerZenith};
use core::f64::consts::{FRAC_PI_2, TAU};

/// C_dl, C_sl, C_ss of (74) or K_dl, K_sl, K_ss of (80), each ≥ 0, in the unit of the answer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Strengths {
    /// C_dl or K_dl
    pub diffuse_lobe: f64,
    /// C_sl or K_sl
    pub specular_lobe: f64,
    /// C_ss or K_ss
    pub specular_spike: f64,
}

/// How the spike is drawn, section 5.1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Spike {
    /// δ(θ_i − θ_r) δ(φ_r) as printed. Its integral over solid angle is the strength times sin θ_r, not the strength
    /// (errata E43), so the answer says only whether it is on and leaves it out of the sum.
    Delta,
    /// ρ_o² of (35): sinc²(v_x X) sinc²(v_y Y).
    Sinc2(Patch),
    /// exp(−((θ_i − θ_r)² + φ_r²)/2σ_s²), σ_s > 0 in radians.
    Gaussian {
        /// σ_s
        width: f64,
    },
}

impl Spike {
    /// σ_s of the Gaussian with the curvature of ρ_o² at its peak, √(3/2)/(k X |cos θ|) radians, as a function of θ_r at
    /// φ_r = 0 (errata E44): sinc²(a) = 1 − a²/3 + …, a = k X cos θ (θ_i − θ_r). Relative error below 8 ε.
    pub fn width_by_curvature(half_x_in_wavelengths: f64, cos: f64) -> f64 {
        1.5f64.sqrt() / (TAU * half_x_in_wavelengths * cos.abs())
    }

    /// σ_s of the Gaussian with the energy of ρ_o², √(π/2)/(k X |cos θ|) radians: ∫ sinc² a da = π = √(2π) σ_a.
    pub fn width_by_energy(half_x_in_wavelengths: f64, cos: f64) -> f64 {
        FRAC_PI_2.sqrt() / (TAU * half_x_in_wavelengths * cos.abs())
    }
}

/// θ_i − θ_r and φ_r in radians: how far the viewer is from the mirror direction, angle by angle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Offset {
    zenith: f64,
    azimuth: f64,
}

impl Offset {
    /// From degrees; the azimuth is brought between −180° and 180°, exactly.
    pub fn new(theta_i: SourceZenith, theta_r: ViewerZenith, phi_r: Azimuth) -> Self {
        // A negative zenith is the same one half a turn away; the nearer half turn keeps the range.
        let turned = libm::remainder(phi_r.get(), 360.0);
        let azimuth = if theta_r.get() < 0.0 { turned - libm::copysign(180.0, turned) } else { turned };
        Self {
            zenith: degrees::to_radians(theta_i.get() - theta_r.get().abs()),
            azimuth: degrees::to_radians(azimuth),
        }
    }

    /// From radians, the azimuth between −π and π.
    pub fn from_radians(theta_i: f64, theta_r: f64, phi_r: f64) -> Self {
        Self { zenith: theta_i - theta_r, azimuth: phi_r }
    }

    /// Whether both deltas of (74) and (80) are on.
    pub fn is_zero(self) -> bool {
        self.zenith == 0.0 && self.azimuth == 0.0
    }

    /// exp(−(zenith² + azimuth²)/2σ_s²); both offsets are known to 3 ε.
    fn gaussian(self, width: f64) -> Estimate {
        let (zenith, azimuth) = (self.zenith / width, self.azimuth / width);
        let exponent = 0.5 * (zenith * zenith + azimuth * azimuth);
        Estimate::within(Scaled::exp(-exponent), EPSILON * (14.0 * exponent + 4.0))
    }
}

/// The three terms of (74) or (80).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ImageIrradiance {
    /// First term.
    pub diffuse_lobe: Estimate,
    /// Second term.
    pub specular_lobe: Estimate,
    /// Third term; 0 for a delta.
    pub specular_spike: Estimate,
    /// Whether the viewer meets the spike exactly. With [`Spike::Delta`] the strength then adds as a delta.
    pub delta_on: bool,
}

impl ImageIrradiance {
    /// The sum; without the delta, if the spike is one.
    pub fn total(&self) -> Estimate {
        self.diffuse_lobe.plus(self.specular_lobe).plus(self.specular_spike)
    }
}

/// What both models depend on besides direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LinearModel {
    /// The three strengths.
    pub strengths: Strengths,
    /// σ_α in radians, above 0.
    pub sigma_alpha: f64,
    /// The spike's shape.
    pub spike: Spike,
}

impl LinearModel {
    /// (74): C_dl + C_sl/cos θ_r · exp(−α²/2σ_α²) + C_ss · spike. Infinite at grazing view unless C_sl is 0.
    pub fn fixed_source(&self, geometry: &Geometry, offset: Offset) -> ImageIrradiance {
        let lobe = if self.strengths.specular_lobe == 0.0 {
            Estimate::ZERO
        } else if geometry.cos_r == 0.0 {
            Estimate::INFINITE
        } else {
            self.lobe(geometry).scaled_by(Scaled::ONE / Scaled::new(geometry.cos_r))
        };
        self.with(geometry, offset, exactly(self.strengths.diffuse_lobe), lobe)
    }

    /// (80): K_dl max(0, cos θ_i) + K_sl exp(−α²/2σ_α²) + K_ss · spike (errata E43).
    pub fn fixed_view(&self, geometry: &Geometry, offset: Offset) -> ImageIrradiance {
        let diffuse = Scaled::new(self.strengths.diffuse_lobe) * geometry.cos_i.max(0.0);
        self.with(geometry, offset, Estimate::within(diffuse, 4.0 * EPSILON), self.lobe(geometry))
    }

    /// The exponential with its strength. α is known to 6 ε, σ_α to 5 ε.
    fn lobe(&self, geometry: &Geometry) -> Estimate {
        let ratio = geometry.alpha() / self.sigma_alpha;
        let square = ratio * ratio;
        let value = Scaled::exp(-0.5 * square) * self.strengths.specular_lobe;
        Estimate::within(value, EPSILON * (14.0 * square + 8.0))
    }

    fn with(
        &self,
        geometry: &Geometry,
        offset: Offset,
        diffuse_lobe: Estimate,
        specular_lobe: Estimate,
    ) -> ImageIrradiance {
        let shape = match self.spike {
            Spike::Delta => Estimate::ZERO,
            Spike::Sinc2(patch) => patch.rho_squared(geometry),
            Spike::Gaussian { width } => offset.gaussian(width),
        };
        let specular_spike = shape.scaled_by(Scaled::new(self.strengths.specular_spike));
        ImageIrradiance { diffuse_lobe, specular_lobe, specular_spike, delta_on: offset.is_zero() }
    }
}

fn exactly(value: f64) -> Estimate {
    Estimate { value: Scaled::new(value), error: Scaled::ZERO, least: Scaled::new(value) }
}

#[cfg(test)]
mod tests {
    use super::{LinearModel, Offset, Spike, Strengths};
    use crate::reflectance::beckmann_spizzichino::Patch;
    use crate::reflectance::geometry::Geometry;
    use crate::reflectance::numeric::scaled::Scaled;
    use crate::reflectance::numeric::{EPSILON, quadrature::integrate};
    use crate::reflectance::quantity::{Azimuth, Quantity, SourceZenith, ViewerZenith};

    const STRENGTHS: Strengths = Strengths { diffuse_lobe: 2.0, specular_lobe: 3.0, specular_spike: 5.0 };

    fn model(spike: Spike) -> LinearModel {
        LinearModel { strengths: STRENGTHS, sigma_alpha: 0.2, spike }
    }

    fn at(theta_i: f64, theta_r: f64, phi_r: f64) -> (Geometry, Offset) {
        let (i, r, phi) = (
            SourceZenith::new(theta_i).unwrap(),
            ViewerZenith::new(theta_r).unwrap(),
            Azimuth::new(phi_r).unwrap(),
        );
        (Geometry::new(i, r, phi), Offset::new(i, r, phi))
    }

    #[test]
    fn the_mirror_direction_has_all_three() {
        let (geometry, offset) = at(60.0, 60.0, 0.0);
        for spike in [
            Spike::Sinc2(Patch { footprint: Scaled::ONE, half_x: 100.0, half_y: 100.0 }),
            Spike::Gaussian { width: 1e-3 },
        ] {
            let source = model(spike).fixed_source(&geometry, offset);
            // 2 + 3/cos 60° + 5, and 2 cos 60° + 3 + 5, to the roundings of the cosine and the sums.
            assert!((source.total().value.to_f64() - 13.0).abs() < 13.0 * 8.0 * EPSILON);
            let view = model(spike).fixed_view(&geometry, offset);
            assert!((view.total().value.to_f64() - 9.0).abs() < 9.0 * 8.0 * EPSILON);
        }
    }

    #[test]
    fn a_delta_is_on_or_off_and_not_in_the_sum() {
        let (geometry, offset) = at(60.0, 60.0, 0.0);
        let on = model(Spike::Delta).fixed_source(&geometry, offset);
        assert!(on.delta_on && on.specular_spike.value.is_zero());
        assert!((on.total().value.to_f64() - 8.0).abs() < 8.0 * 8.0 * EPSILON);
        for (theta_r, phi_r, expected) in [
            (60.0, 360.0, true),
            (-60.0, 180.0, true),
            (-60.0, -180.0, true),
            (60.0, 1e-9, false),
            (59.9, 0.0, false),
        ] {
            assert_eq!(at(60.0, theta_r, phi_r).1.is_zero(), expected, "{theta_r} {phi_r}");
        }
    }

    #[test]
    fn grazing_view_and_a_source_behind() {
        let (geometry, offset) = at(60.0, 90.0, 0.0);
        let spike = Spike::Gaussian { width: 0.1 };
        assert_eq!(model(spike).fixed_source(&geometry, offset).total().value.to_f64(), f64::INFINITY);
        let mut dull = model(spike);
        dull.strengths.specular_lobe = 0.0;
        assert!(dull.fixed_source(&geometry, offset).total().value.is_finite());
        let behind = Geometry::from_radians(2.0, 0.3, 0.0);
        let offset = Offset::from_radians(2.0, 0.3, 0.0);
        assert!(model(spike).fixed_view(&behind, offset).diffuse_lobe.value.is_zero());
    }

    #[test]
    fn the_two_widths_match_curvature_and_energy() {
        let (half_x, cos) = (50.0, 0.8);
        let phase = core::f64::consts::TAU * half_x * cos;
        // Curvature: 1 − sinc²(h) against 1 − exp(−h²/2σ²) at a small h; they differ in the next order, h² relative.
        let width = Spike::width_by_curvature(half_x, cos) * phase;
        let h = 1e-3;
        let sinc = libm::sin(h) / h;
        let ratio = (1.0 - sinc * sinc) / -libm::expm1(-h * h / (2.0 * width * width));
        assert!((ratio - 1.0).abs() < 1e-6, "{ratio}");
        // Energy: ∫ sinc² = π; a Gaussian's is √(2π) σ.
        let width = Spike::width_by_energy(half_x, cos) * phase;
        let gaussian = integrate(-12.0, 12.0, |a| libm::exp(-a * a / (2.0 * width * width))).value;
        assert!((gaussian / core::f64::consts::PI - 1.0).abs() < 32.0 * EPSILON, "{gaussian}");
    }
}
