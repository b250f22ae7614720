//! ⟨FF*⟩ of (41): the energy reflectance by which a rough surface of finite conductivity falls short of a perfect conductor.
//!
//! The report leaves open over what F is averaged (errata E25). Three readings agree as σ_h/T → 0 towards the mirror direction:
//! the mean plane ([`mean_plane`]), the facets that mirror the source to the viewer ([`half_vector`], which Torrance-Sparrow's
//! F′ is), and all facets that the source reaches ([`slope_average`]).

mod slopes;
pub(super) mod table;

use super::degrees::SinCos;
use super::fresnel::{Energy, Medium, Polarization};
use super::geometry::Geometry;

pub use slopes::{FINEST, SlopeAverage, slope_average};

/// Over what F of a lobe is averaged.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum FresnelAverage {
    /// The facets that mirror the source to the viewer, at θ′ of (59).
    HalfVector,
    /// The mean plane, at θ_i.
    MeanPlane,
    /// All facets that face the source.
    SlopeAverage,
}

impl FresnelAverage {
    /// Every reading.
    pub const ALL: [Self; 3] = [Self::HalfVector, Self::MeanPlane, Self::SlopeAverage];

    /// The name in requests.
    pub const fn name(self) -> &'static str {
        match self {
            Self::HalfVector => "half_vector",
            Self::MeanPlane => "mean_plane",
            Self::SlopeAverage => "slope_average",
        }
    }
}

/// F′ of (63) at θ_i.
pub fn mean_plane(medium: &Medium, polarization: Polarization, geometry: &Geometry) -> Energy {
    medium.reflectance(SinCos { sin: geometry.sin_i, cos: geometry.cos_i }, polarization)
}

/// F′ of (63) at θ′ of (59).
pub fn half_vector(medium: &Medium, polarization: Polarization, geometry: &Geometry) -> Energy {
    medium.reflectance(geometry.local_incidence(), polarization)
}
