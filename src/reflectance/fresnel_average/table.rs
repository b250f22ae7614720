//! ⟨FF*⟩ of a lobe, made ready for the directions of a request.

use super::{FINEST, FresnelAverage, half_vector, mean_plane, slope_average};
use crate::reflectance::degrees::SinCos;
use crate::reflectance::directions::Directions;
use crate::reflectance::fresnel::{Energy, Medium, Polarization};
use crate::reflectance::geometry::Geometry;
use crate::reflectance::quantity::{AveragedRatio, Quantity as _};
use crate::reflectance::scene::Scene;
use core::cmp::Ordering;

/// What part of the tolerance of an answer its slope averages may take.
const SHARE_OF_TOLERANCE: f64 = 1.0 / 64.0;

/// The means over the slopes for the sources of a request: they depend on nothing else of a direction.
#[derive(Clone, Debug, Default)]
pub(in crate::reflectance) struct SlopeAverages {
    /// In ascending order of the sources.
    means: Vec<(SinCos, Energy)>,
}

impl SlopeAverages {
    /// Of a scene in these directions; nothing where it does not ask for them, and no more once it is over.
    pub(in crate::reflectance) fn of(
        scene: &Scene,
        directions: &Directions,
        is_over: impl Fn() -> bool,
    ) -> Self {
        if !scene.averages_slopes() {
            return Self::default();
        }
        let mut sources: Vec<SinCos> =
            directions.sources().map(|source| SinCos::of_degrees(source.get())).collect();
        sources.sort_unstable_by(ascending);
        sources.dedup();
        let none = Self::default();
        let reflectivity = Reflectivity::of(scene, &none);
        let wanted = sources.into_iter().take_while(|_| !is_over());
        Self { means: wanted.map(|source| (source, reflectivity.averaged(source))).collect() }
    }

    fn at(&self, source: SinCos) -> Option<Energy> {
        let place = self.means.binary_search_by(|(other, _)| ascending(other, &source)).ok()?;
        Some(self.means[place].1)
    }
}

fn ascending(one: &SinCos, other: &SinCos) -> Ordering {
    // Towards grazing cosines, towards the normal sines tell zeniths apart.
    one.sin.total_cmp(&other.sin).then(other.cos.total_cmp(&one.cos))
}

/// ⟨FF*⟩ of (41) and F′ of (71) in the reading that a scene asks for.
#[derive(Clone, Copy, Debug)]
pub(in crate::reflectance) struct Reflectivity<'a> {
    pub(in crate::reflectance) medium: Medium,
    pub(in crate::reflectance) polarization: Polarization,
    pub(in crate::reflectance) average: FresnelAverage,
    /// σ_h/T and the tolerance, for a mean over the slopes.
    slopes: Option<(AveragedRatio, f64)>,
    averages: &'a SlopeAverages,
}

impl<'a> Reflectivity<'a> {
    /// Of a scene, with means that may have been worked out before.
    pub(in crate::reflectance) fn of(scene: &Scene, averages: &'a SlopeAverages) -> Self {
        let p = scene.parameters();
        let average = scene.fresnel_average();
        let reading = Self::new(p.surface.medium, p.illumination.polarization, average, averages);
        let slope = if average == FresnelAverage::SlopeAverage { scene.slope() } else { None };
        let ratio = slope.and_then(|slope| AveragedRatio::new(0.5 * slope.get()).ok());
        let tolerance = SHARE_OF_TOLERANCE * p.accuracy.relative_tolerance.get();
        Self { slopes: ratio.map(|ratio| (ratio, tolerance)), ..reading }
    }

    /// Of a surface whose slope is not known.
    pub(in crate::reflectance) const fn new(
        medium: Medium,
        polarization: Polarization,
        average: FresnelAverage,
        averages: &'a SlopeAverages,
    ) -> Self {
        Self { medium, polarization, average, slopes: None, averages }
    }

    /// In one direction.
    pub(in crate::reflectance) fn energy(&self, geometry: &Geometry) -> Energy {
        match self.average {
            FresnelAverage::HalfVector => half_vector(&self.medium, self.polarization, geometry),
            FresnelAverage::MeanPlane => mean_plane(&self.medium, self.polarization, geometry),
            FresnelAverage::SlopeAverage => {
                let source = SinCos { sin: geometry.sin_i, cos: geometry.cos_i };
                self.averages.at(source).unwrap_or_else(|| self.averaged(source))
            }
        }
    }

    /// The mean over the slopes under one source.
    fn averaged(&self, source: SinCos) -> Energy {
        self.slopes.map_or(Energy::UNKNOWN, |(ratio, tolerance)| {
            let tolerance = tolerance.max(FINEST);
            slope_average(&self.medium, self.polarization, source, ratio, tolerance).reflectance
        })
    }
}
