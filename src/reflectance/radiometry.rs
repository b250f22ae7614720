//! Radiance, irradiance, BRDF and solid angles, (1)-(3) and (52)-(56), and what a camera makes of them, (42)-(46) and
//! (51).
//!
//! Lengths in one unit, areas in its square; flux in W, irradiance in W m⁻², radiance in W m⁻² sr⁻¹, if lengths are in
//! metres. Relative errors below 8 ε unless stated.

use super::numeric::scaled::Scaled;
use core::f64::consts::FRAC_PI_4;

/// I_s of (1) and (56): flux per area of the surface.
pub fn irradiance(flux: f64, area: f64) -> f64 {
    flux / area
}

/// L_r of (2) and (42): flux per solid angle and foreshortened area.
pub fn radiance(flux: f64, area: f64, cos_r: f64, solid_angle: f64) -> f64 {
    flux / (area * cos_r * solid_angle)
}

/// f_r of (3), per steradian: radiance per irradiance of the surface; infinite at grazing incidence unless the radiance is 0.
pub fn brdf(radiance: f64, irradiance: f64) -> f64 {
    radiance / irradiance
}

/// The solid angle, steradian, of a small area whose normal is turned by an angle of this cosine from the line to the
/// observer: dω_i of (53) (cosine 1), dω_s of (54), dω_r of (44).
pub fn solid_angle(area: f64, cos: f64, distance: f64) -> f64 {
    area / distance * (cos / distance)
}

/// d²Φ_i of (52): what a source of this radiance and area sends into a solid angle along its normal.
pub fn emitted_flux(radiance: f64, area: f64, solid_angle: f64) -> f64 {
    radiance * area * solid_angle
}

/// d²Φ_i of (55): what a surface of this area receives from a solid angle of this radiance.
pub fn received_flux(radiance: f64, solid_angle: f64, area: f64, cos_i: f64) -> f64 {
    radiance * solid_angle * area * cos_i
}

/// The camera of figure 10.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    /// dA_im: area of a pixel.
    pub pixel_area: f64,
    /// z: distance of the surface from the lens along the optical axis.
    pub distance: f64,
    /// f: distance of the image from the lens.
    pub focal_length: f64,
    /// d: diameter of the lens.
    pub aperture: f64,
    /// cos γ, γ between the optical axis and the ray to the surface element.
    pub cos_off_axis: f64,
}

impl Camera {
    /// (z/f)² dA_im cos γ of (43) and (47): the area a pixel sees of a surface that faces it.
    pub fn footprint(&self) -> Scaled {
        Scaled::new(self.distance / self.focal_length).squared() * self.pixel_area * self.cos_off_axis
    }

    /// dA_s of (43): the area of the surface that a pixel sees; infinite at grazing view.
    pub fn surface_area(&self, cos_r: f64) -> Scaled {
        self.footprint() / Scaled::new(cos_r)
    }

    /// Half the side of a square of that area: X and Y of (35) for a pixel, √A/2 (errata E18).
    pub fn half_side(&self, cos_r: f64) -> f64 {
        0.5 * (self.distance / self.focal_length)
            * self.pixel_area.sqrt()
            * (self.cos_off_axis / cos_r).sqrt()
    }

    /// dω_r of (44), steradian: the lens, π d²/4, seen from the surface at R_o = z/cos γ.
    pub fn lens_solid_angle(&self) -> f64 {
        let ratio = self.aperture / self.distance;
        FRAC_PI_4 * ratio * ratio * self.cos_off_axis.powi(3)
    }

    /// d²Φ_r of (45): the flux through the lens from a flow S_a at R_o.
    pub fn lens_flux(&self, energy_flow: f64) -> f64 {
        energy_flow * FRAC_PI_4 * self.aperture * self.aperture * self.cos_off_axis
    }

    /// L_r of (46): radiance from the flow S_a of the scattered field at distance R_o = z/cos γ (errata E26).
    pub fn radiance_of_flow(&self, energy_flow: f64) -> Scaled {
        // S_a R_o²/(A cos θ_r), and A cos θ_r is the footprint.
        let range = self.distance / self.cos_off_axis;
        Scaled::new(energy_flow) * Scaled::new(range).squared() / self.footprint()
    }

    /// I_im/L_r of (51), steradian: π/4 (d/f)² cos⁴ γ.
    pub fn image_irradiance_factor(&self) -> f64 {
        let ratio = self.aperture / self.focal_length;
        FRAC_PI_4 * ratio * ratio * self.cos_off_axis.powi(4)
    }
}

#[cfg(test)]
mod tests {
    use super::{Camera, brdf, emitted_flux, irradiance, radiance, received_flux, solid_angle};
    use crate::reflectance::numeric::EPSILON;

    const CAMERA: Camera =
        Camera { pixel_area: 1e-10, distance: 2.0, focal_length: 0.05, aperture: 0.02, cos_off_axis: 0.8 };

    #[track_caller]
    fn same(a: f64, b: f64) {
        // Two routes of at most eight roundings each.
        assert!((a / b - 1.0).abs() < 16.0 * EPSILON, "{a} {b}");
    }

    #[test]
    fn source_and_surface_agree_on_the_flux_between_them() {
        // (52) with (53), (54) is (55).
        let (source, surface, distance, cos_i) = (3e-4, 2e-6, 5.0, 0.6);
        let sent = emitted_flux(7.0, source, solid_angle(surface, cos_i, distance));
        let got = received_flux(7.0, solid_angle(source, 1.0, distance), surface, cos_i);
        same(sent, got);
        same(brdf(radiance(sent, surface, 0.5, 0.1), irradiance(sent, surface)), 1.0 / (0.5 * 0.1));
    }

    #[test]
    fn radiance_of_the_scattered_field_is_flux_over_area_and_angle() {
        // (46) is (42) with (43)-(45), at any view.
        for cos_r in [1.0, 0.3] {
            let by_flux = radiance(
                CAMERA.lens_flux(0.7),
                CAMERA.surface_area(cos_r).to_f64(),
                cos_r,
                CAMERA.lens_solid_angle(),
            );
            same(by_flux, CAMERA.radiance_of_flow(0.7).to_f64());
        }
    }

    #[test]
    fn a_pixel_gathers_the_radiance_through_the_lens() {
        // (51): flux through the lens from the surface seen, over the pixel's area.
        let (cos_r, radiance) = (0.4, 11.0);
        let flux = radiance * CAMERA.surface_area(cos_r).to_f64() * cos_r * CAMERA.lens_solid_angle();
        same(flux / CAMERA.pixel_area, radiance * CAMERA.image_irradiance_factor());
    }

    #[test]
    fn the_square_has_the_area_it_is_made_from() {
        let half = CAMERA.half_side(0.4);
        same(4.0 * half * half, CAMERA.surface_area(0.4).to_f64());
        assert_eq!(CAMERA.half_side(0.0), f64::INFINITY);
    }
}
