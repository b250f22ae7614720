//! F′ of (63) in many directions at once, where it is known well.

use super::{Energy, Medium, RefractiveIndex};
use crate::reflectance::degrees::SinCos;
use crate::reflectance::fresnel_average::FresnelAverage;
use crate::reflectance::fresnel_average::table::Reflectivity;
use crate::reflectance::geometry::Geometry;
use crate::reflectance::geometry::lanes::Geometries;
use crate::reflectance::numeric::dispatch::{InstructionSet, vectorized};
use crate::reflectance::numeric::lobe_series::lanes::{LANES, Lanes};

/// Relative errors from here on are left to the one who works with absolute ones: next to Brewster's angle, and where
/// there is next to no surface.
const LARGEST_ERROR: f64 = 0.1;

/// F′ of each direction.
pub(in crate::reflectance) struct ReflectanceLanes {
    pub(in crate::reflectance) value: Lanes,
    /// |ln(value/exact)| is not larger; infinite where little is known.
    pub(in crate::reflectance) distance: Lanes,
}

impl ReflectanceLanes {
    /// The perfect conductor's, everywhere.
    pub(in crate::reflectance) const fn new() -> Self {
        Self { value: [1.0; LANES], distance: [0.0; LANES] }
    }

    /// The same numbers as [`Reflectivity::energy`] gives one by one.
    pub(in crate::reflectance) fn fill(
        &mut self,
        set: InstructionSet,
        reflectivity: Reflectivity<'_>,
        geometries: &Geometries,
        count: usize,
    ) {
        filled(set, reflectivity, geometries, count, self);
    }
}

vectorized! {
    fn filled = value_and_distance, (
        reflectivity: Reflectivity<'_>,
        geometries: &Geometries,
        count: usize,
        lanes: &mut ReflectanceLanes,
    )
}

#[inline(always)]
fn value_and_distance(
    reflectivity: Reflectivity<'_>,
    geometries: &Geometries,
    count: usize,
    lanes: &mut ReflectanceLanes,
) {
    let Medium::Index(index) = reflectivity.medium else {
        *lanes = ReflectanceLanes::new();
        return;
    };
    let at = |incidence: SinCos| RefractiveIndex::energies(index, incidence).mixed(reflectivity.polarization);
    // The match stands outside of the loops.
    match reflectivity.average {
        FresnelAverage::HalfVector => {
            fill(geometries, count, lanes, |geometry| at(geometry.local_incidence()));
        }
        FresnelAverage::MeanPlane => {
            let source = |geometry: &Geometry| SinCos { sin: geometry.sin_i, cos: geometry.cos_i };
            fill(geometries, count, lanes, |geometry| at(source(geometry)));
        }
        FresnelAverage::SlopeAverage => {
            fill(geometries, count, lanes, |geometry| reflectivity.energy(geometry));
        }
    }
}

#[inline(always)]
fn fill(
    geometries: &Geometries,
    count: usize,
    lanes: &mut ReflectanceLanes,
    energy: impl Fn(&Geometry) -> Energy,
) {
    for lane in 0..count.min(LANES) {
        let Energy { value, error } = energy(&geometries.get(lane));
        let ratio = error / value;
        // The exact one is value (1 ± r), and −ln(1 − r) ≤ r/(1 − r) ≤ r (1 + 2r) for r ≤ 1/2.
        let distance = ratio * (1.0 + 2.0 * ratio);
        lanes.value[lane] = value;
        lanes.distance[lane] = if ratio < LARGEST_ERROR { distance } else { f64::INFINITY };
    }
}

#[cfg(test)]
mod tests {
    use super::{LANES, ReflectanceLanes};
    use crate::reflectance::fresnel::{Medium, Polarization, RefractiveIndex};
    use crate::reflectance::fresnel_average::FresnelAverage;
    use crate::reflectance::fresnel_average::table::{Reflectivity, SlopeAverages};
    use crate::reflectance::geometry::Geometry;
    use crate::reflectance::geometry::lanes::{DirectionLanes, Geometries, fill};
    use crate::reflectance::numeric::dispatch::InstructionSet;
    use crate::reflectance::quantity::{Azimuth, IndexK, IndexN, Quantity, SourceZenith, ViewerZenith};

    #[test]
    fn lanes_give_the_numbers_of_single_directions() {
        let mut directions = DirectionLanes::new();
        directions.count = LANES;
        for lane in 0..LANES {
            directions.theta_i.degrees[lane] = 90.0 - 0.7 * lane as f64;
            directions.theta_r.degrees[lane] = 1.4 * (lane as f64 - 64.0);
            directions.phi_r.degrees[lane] = 2.8 * lane as f64;
        }
        let mut geometries = Geometries::new();
        fill(InstructionSet::widest(), &directions, false, &mut geometries);
        let mut lanes = ReflectanceLanes::new();
        let mut known = 0;
        for (n, k) in
            [(1.5, 0.0), (0.66, 0.0), (0.96, 6.69), (1.0, 0.0), (1.0, 1e-300), (1e-9, 1e9), (2.0, 1e-3)]
        {
            let index = RefractiveIndex { n: IndexN::new(n).unwrap(), k: IndexK::new(k).unwrap() };
            let polarizations =
                [Polarization::unpolarized(), Polarization::parallel(), Polarization::perpendicular()];
            let readings = [FresnelAverage::HalfVector, FresnelAverage::MeanPlane];
            for (polarization, average) in polarizations.into_iter().flat_map(|p| readings.map(|a| (p, a))) {
                let none = SlopeAverages::default();
                let reading = Reflectivity::new(Medium::Index(index), polarization, average, &none);
                for set in InstructionSet::available() {
                    lanes.fill(set, reading, &geometries, LANES);
                    for lane in 0..LANES {
                        let geometry = Geometry::new(
                            SourceZenith::new(directions.theta_i.degrees[lane]).unwrap(),
                            ViewerZenith::new(directions.theta_r.degrees[lane]).unwrap(),
                            Azimuth::new(directions.phi_r.degrees[lane]).unwrap(),
                        );
                        let one = reading.energy(&geometry);
                        assert_eq!(lanes.value[lane].to_bits(), one.value.to_bits(), "{n} {k} {lane}");
                        let (ratio, distance) = (one.error / one.value, lanes.distance[lane]);
                        assert_eq!(distance.is_finite(), ratio < super::LARGEST_ERROR, "{n} {k} {lane}");
                        assert!(!distance.is_finite() || distance >= -(-ratio).ln_1p(), "{ratio} {distance}");
                        known += usize::from(distance < 1e-12);
                    }
                }
            }
        }
        assert!(known > 10 * LANES, "{known}");
    }
}
