//! Mean scattered power ⟨E₂E₂*⟩ (33), and by method its smooth and rough forms (38), (39): what a
//! rectangular patch sends to a point far away, before (46) makes a radiance of it.

use super::beckmann_spizzichino::{Patch, RelativeRoughness};
use super::estimate::Estimate;
use super::geometry::Geometry;
use super::numeric::EPSILON;
use super::numeric::lobe_series::Method;
use super::numeric::scaled::Scaled;

/// The field at one point, every length over the wavelength.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ScatteredPower {
    /// Of the surface.
    pub roughness: RelativeRoughness,
    /// X and Y; its area is A = 4XY, its footprint is not used.
    pub patch: Patch,
    /// E₀ of the incident wave; the power has the unit of its square.
    pub amplitude: f64,
    /// R₀/λ, distance of the point.
    pub distance: f64,
}

/// Rounding of the factors before spike and lobe, in ε.
const FACTOR_UNITS: f64 = 24.0;

impl ScatteredPower {
    /// (E₀ A cos θ_i/(λ R₀))² e^{-g} ρ_o²: the first term of (33) and (38).
    pub fn spike(&self, geometry: &Geometry) -> Estimate {
        let field = self.field() * self.area() * geometry.cos_i;
        self.roughness
            .coherent(geometry, &self.patch)
            .scaled_by(field.squared())
            .widened(FACTOR_UNITS * EPSILON)
    }

    /// The second term of (33); (38)'s with [`Method::Smooth`], (39) with [`Method::Rough`].
    pub fn lobe(&self, geometry: &Geometry, method: Method) -> Estimate {
        let (lobe, _) = self.roughness.lobe(geometry, 1.0, method);
        lobe.scaled_by(self.field().squared() * self.area()).widened(FACTOR_UNITS * EPSILON)
    }

    /// E₀ λ/R₀
    fn field(&self) -> Scaled {
        Scaled::new(self.amplitude) / Scaled::new(self.distance)
    }

    /// 4XY/λ²
    fn area(&self) -> Scaled {
        Scaled::new(4.0 * self.patch.half_x) * self.patch.half_y
    }
}
