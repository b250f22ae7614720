//! The geometries of many directions at once: structures of arrays, filled by loops that become vector
//! instructions. What is constant along a sweep is worked out once.

use super::{Geometry, Sines};
use crate::reflectance::degrees::SinCos;
use crate::reflectance::numeric::dispatch::vectorized;
use crate::reflectance::numeric::lobe_series::lanes::{LANES, Lanes};

const ZERO: Lanes = [0.0; LANES];

/// One of the three angles of up to [`LANES`] directions, degrees.
pub(in crate::reflectance) struct AngleLanes {
    /// The first holds for all if they are one.
    pub(in crate::reflectance) degrees: Lanes,
    pub(in crate::reflectance) is_one: bool,
}

/// Directions in the order of the request.
pub(in crate::reflectance) struct DirectionLanes {
    pub(in crate::reflectance) count: usize,
    pub(in crate::reflectance) theta_i: AngleLanes,
    pub(in crate::reflectance) theta_r: AngleLanes,
    pub(in crate::reflectance) phi_r: AngleLanes,
}

impl DirectionLanes {
    /// Room for a block.
    pub(in crate::reflectance) const fn new() -> Self {
        const NONE: AngleLanes = AngleLanes { degrees: ZERO, is_one: false };
        Self { count: 0, theta_i: NONE, theta_r: NONE, phi_r: NONE }
    }

    /// Forgets the angles of other directions.
    pub(in crate::reflectance) fn clear(&mut self) {
        for angle in [&mut self.theta_i, &mut self.theta_r, &mut self.phi_r] {
            angle.is_one = false;
        }
    }
}

/// Sine and cosine of one angle a direction.
struct SinCosLanes {
    sin: Lanes,
    cos: Lanes,
}

impl SinCosLanes {
    const fn new() -> Self {
        Self { sin: ZERO, cos: ZERO }
    }

    /// Of `angle` of each direction; of the first one's if they `is_one`.
    #[inline(always)]
    fn fill(&mut self, count: usize, is_one: bool, angle: impl Fn(usize) -> f64) {
        if is_one {
            let SinCos { sin, cos } = SinCos::of_degrees(angle(0));
            self.sin[..count].fill(sin);
            self.cos[..count].fill(cos);
        } else {
            for lane in 0..count {
                let SinCos { sin, cos } = SinCos::of_degrees(angle(lane));
                self.sin[lane] = sin;
                self.cos[lane] = cos;
            }
        }
    }

    #[inline(always)]
    fn at(&self, lane: usize) -> SinCos {
        SinCos { sin: self.sin[lane], cos: self.cos[lane] }
    }
}

/// [`Geometry`], one array a field.
pub(in crate::reflectance) struct Geometries {
    pub(in crate::reflectance) cos_i: Lanes,
    pub(in crate::reflectance) cos_r: Lanes,
    pub(in crate::reflectance) cos_sum: Lanes,
    pub(in crate::reflectance) horizontal: Lanes,
    sin_i: Lanes,
    sin_r: Lanes,
    half_difference: SinCosLanes,
    half_azimuth: SinCosLanes,
    cos_azimuth: Lanes,
    sin_difference: Lanes,
}

vectorized! {
    /// The geometries of `directions`, the same numbers as [`Geometry::new`] gives one by one; cos φ_r, which only a
    /// spike reads, is NaN unless asked for.
    pub(in crate::reflectance) fn fill = all,
        (directions: &DirectionLanes, with_cos_azimuth: bool, geometries: &mut Geometries)
}

#[inline(always)]
fn all(directions: &DirectionLanes, with_cos_azimuth: bool, geometries: &mut Geometries) {
    let DirectionLanes { count, theta_i, theta_r, phi_r } = directions;
    let count = (*count).min(LANES);
    let (i, r, phi) = (&theta_i.degrees, &theta_r.degrees, &phi_r.degrees);
    let (mut source, mut viewer) = (SinCosLanes::new(), SinCosLanes::new());
    let (mut half_azimuth, mut azimuth) = (SinCosLanes::new(), SinCosLanes::new());
    let mut half_difference = SinCosLanes::new();
    source.fill(count, theta_i.is_one, |lane| i[lane]);
    viewer.fill(count, theta_r.is_one, |lane| r[lane].abs());
    half_difference.fill(count, theta_i.is_one && theta_r.is_one, |lane| (i[lane] - r[lane].abs()) / 2.0);
    half_azimuth.fill(count, phi_r.is_one, |lane| phi[lane] / 2.0);
    if with_cos_azimuth {
        azimuth.fill(count, phi_r.is_one, |lane| phi[lane]);
    } else {
        azimuth.cos = [f64::NAN; LANES];
    }
    for lane in 0..count {
        let sines = Sines {
            source: source.at(lane),
            viewer: viewer.at(lane),
            half_difference: half_difference.at(lane),
            half_azimuth: half_azimuth.at(lane),
            azimuth: azimuth.at(lane),
            behind: r[lane] < 0.0,
        };
        geometries.set(lane, &Geometry::of_sines(&sines));
    }
}

impl Geometries {
    /// Room for a block.
    pub(in crate::reflectance) const fn new() -> Self {
        Self {
            cos_i: ZERO,
            cos_r: ZERO,
            cos_sum: ZERO,
            horizontal: ZERO,
            sin_i: ZERO,
            sin_r: ZERO,
            half_difference: SinCosLanes::new(),
            half_azimuth: SinCosLanes::new(),
            cos_azimuth: ZERO,
            sin_difference: ZERO,
        }
    }

    #[inline(always)]
    fn set(&mut self, lane: usize, geometry: &Geometry) {
        self.cos_i[lane] = geometry.cos_i;
        self.cos_r[lane] = geometry.cos_r;
        self.cos_sum[lane] = geometry.cos_sum;
        self.horizontal[lane] = geometry.horizontal;
        self.sin_i[lane] = geometry.sin_i;
        self.sin_r[lane] = geometry.sin_r;
        self.half_difference.sin[lane] = geometry.half_difference.sin;
        self.half_difference.cos[lane] = geometry.half_difference.cos;
        self.half_azimuth.sin[lane] = geometry.half_azimuth.sin;
        self.half_azimuth.cos[lane] = geometry.half_azimuth.cos;
        self.cos_azimuth[lane] = geometry.cos_azimuth;
        self.sin_difference[lane] = geometry.sin_difference;
    }

    /// One of them.
    #[inline(always)]
    pub(in crate::reflectance) fn get(&self, lane: usize) -> Geometry {
        Geometry {
            cos_i: self.cos_i[lane],
            sin_i: self.sin_i[lane],
            cos_r: self.cos_r[lane],
            sin_r: self.sin_r[lane],
            half_difference: self.half_difference.at(lane),
            half_azimuth: self.half_azimuth.at(lane),
            cos_azimuth: self.cos_azimuth[lane],
            cos_sum: self.cos_sum[lane],
            sin_difference: self.sin_difference[lane],
            horizontal: self.horizontal[lane],
        }
    }
}
