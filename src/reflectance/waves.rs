//! Plane waves: amplitudes, the energy they carry, and the field that a smooth plane scatters.
//!
//! SI units for the medium's constants (F/m, H/m) and for fields (V/m); any one unit for lengths.

use super::fresnel::Complex;
use core::f64::consts::{PI, TAU};

/// k = 2π/λ of (11), radians per unit of λ. Relative error below 2 ε.
pub fn wavenumber(wavelength: f64) -> f64 {
    TAU / wavelength
}

/// The medium that a wave travels in, without absorption.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lossless {
    /// ε of (12), above 0.
    pub permittivity: f64,
    /// μ of (12), above 0.
    pub permeability: f64,
}

impl Lossless {
    /// √(ε/μ) of (12), siemens: what the report calls the wave impedance is the admittance (errata E2). Relative error
    /// below 3 ε.
    pub fn admittance(&self) -> f64 {
        (self.permittivity / self.permeability).sqrt()
    }

    /// √(μ/ε), ohms; 376.73 in vacuum. Relative error below 3 ε.
    pub fn impedance(&self) -> f64 {
        (self.permeability / self.permittivity).sqrt()
    }

    /// H_o of (12), A/m, from the electric amplitude E_o.
    pub fn magnetic_amplitude(&self, electric_amplitude: f64) -> f64 {
        self.admittance() * electric_amplitude
    }

    /// S_a of (15), W m⁻²: ½ √(ε/μ) |E|², with the roots the right way round (errata E3, E4). The irradiance of the wave
    /// on a plane normal to it.
    pub fn energy_flow(&self, electric_amplitude: f64) -> f64 {
        0.5 * self.admittance() * (electric_amplitude * electric_amplitude)
    }

    /// (15) as printed, ½ √(μ/ε) |E|²: μ/ε times the right value, 141 926 in vacuum.
    pub fn energy_flow_as_printed(&self, electric_amplitude: f64) -> f64 {
        0.5 * self.impedance() * (electric_amplitude * electric_amplitude)
    }

    /// I_s of (50), W m⁻²: S_a cos θ_i, negative for a source behind the surface.
    pub fn surface_irradiance(&self, electric_amplitude: f64, cos_i: f64) -> f64 {
        self.energy_flow(electric_amplitude) * cos_i
    }

    /// (50) as printed, with the roots of [`Self::energy_flow_as_printed`].
    pub fn surface_irradiance_as_printed(&self, electric_amplitude: f64, cos_i: f64) -> f64 {
        self.energy_flow_as_printed(electric_amplitude) * cos_i
    }
}

/// A smooth, perfectly conducting rectangle in the mean plane and its far point in the mirror direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SmoothPlate {
    /// X of (30): half the length along x.
    pub half_x: f64,
    /// Y of (30): half the length along y.
    pub half_y: f64,
    /// λ
    pub wavelength: f64,
    /// R_o: distance of the observer.
    pub distance: f64,
}

impl SmoothPlate {
    /// |E_2ss| of (32), E_o A cos θ_i/(λ R_o) with A = 4XY, in the unit of E_o; negative for a source behind the surface,
    /// as printed. Relative error below 8 ε.
    pub fn specular_amplitude(&self, electric_amplitude: f64, cos_i: f64) -> f64 {
        let area = 4.0 * self.half_x * self.half_y;
        electric_amplitude * (area / self.distance) * cos_i / self.wavelength
    }

    /// E_2ss of (31), which is (30) integrated: i e^{ikR_o} times (32). The phase is k R_o reduced by whole waves; it is
    /// known no better than R_o/λ is to one wave.
    pub fn specular_field(&self, electric_amplitude: f64, cos_i: f64) -> Complex {
        let amplitude = self.specular_amplitude(electric_amplitude, cos_i);
        let waves = libm::fmod(self.distance, self.wavelength) / self.wavelength;
        let (sin, cos) = libm::sincos(2.0 * PI * waves);
        Complex { re: -amplitude * sin, im: amplitude * cos }
    }
}

#[cfg(test)]
mod tests {
    use super::{Lossless, SmoothPlate, wavenumber};
    use crate::reflectance::numeric::EPSILON;

    const VACUUM: Lossless = Lossless { permittivity: 8.8541878128e-12, permeability: 1.25663706212e-6 };

    #[test]
    fn vacuum() {
        // Errata E4: 376.73 ohms, and the print is its square too large.
        assert!((VACUUM.impedance() - 376.730_313_67).abs() < 1e-8);
        assert!((VACUUM.impedance() * VACUUM.admittance() - 1.0).abs() < 8.0 * EPSILON);
        let ratio = VACUUM.energy_flow_as_printed(3.0) / VACUUM.energy_flow(3.0);
        assert!((ratio - 141_926.0).abs() < 1.0, "{ratio}");
    }

    #[test]
    fn the_flow_is_half_the_product_of_the_amplitudes() {
        let (e, h) = (27.0, VACUUM.magnetic_amplitude(27.0));
        assert!((VACUUM.energy_flow(e) / (0.5 * e * h) - 1.0).abs() < 8.0 * EPSILON);
        assert_eq!(VACUUM.surface_irradiance(e, 0.5), 0.5 * VACUUM.energy_flow(e));
        assert_eq!(VACUUM.surface_irradiance_as_printed(e, 0.5), 0.5 * VACUUM.energy_flow_as_printed(e));
    }

    #[test]
    fn the_specular_field_turns_by_a_quarter_wave_more_than_the_path() {
        let plate = SmoothPlate { half_x: 5.0, half_y: 2.0, wavelength: 0.5, distance: 1000.125 };
        // A = 40; R_o is 2000 waves and a quarter: i e^{iπ/2} = −1.
        let amplitude = plate.specular_amplitude(3.0, 0.5);
        assert!((amplitude - 3.0 * 40.0 * 0.5 / (0.5 * 1000.125)).abs() < 8.0 * EPSILON * amplitude);
        let field = plate.specular_field(3.0, 0.5);
        assert!((field.re + amplitude).abs() < 8.0 * EPSILON && field.im.abs() < 8.0 * EPSILON, "{field:?}");
        assert!((wavenumber(0.5) - 4.0 * core::f64::consts::PI).abs() < 1e-14);
    }
}
