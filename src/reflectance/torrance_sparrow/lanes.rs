//! Diffuse lobe and facet lobe of (72) in many directions at once, for directions in which their sum is an ordinary
//! number: the rest is left to [`FacetLobe::lobe`](super::FacetLobe::lobe).

use crate::reflectance::fresnel::lanes::ReflectanceLanes;
use crate::reflectance::fresnel_average::table::Reflectivity;
use crate::reflectance::geometry::lanes::Geometries;
use crate::reflectance::numeric::EPSILON;
use crate::reflectance::numeric::dispatch::{InstructionSet, vectorized};
use crate::reflectance::numeric::elementary::{angle, binary_exponent, exp, scale};
use crate::reflectance::numeric::lobe_series::lanes::{LANES, Lanes};
use crate::reflectance::shadowing::ShadowingFunction;
use crate::reflectance::shadowing::lanes::{Cosines, over_cosines};
use crate::reflectance::unified::{lobe_share, mirror_g};

/// What the directions of a block have in common.
#[derive(Clone, Copy, Debug)]
pub(in crate::reflectance) struct Common<'a> {
    /// κ_diff, times the irradiance for a radiance; 0 without a diffuse lobe.
    pub(in crate::reflectance) diffuse: f64,
    pub(in crate::reflectance) facets: Option<Facets<'a>>,
    /// A radiance has the cosine of one, a BRDF of both.
    pub(in crate::reflectance) cosines: Cosines,
}

/// The facet lobe (70).
#[derive(Clone, Copy, Debug)]
pub(in crate::reflectance) struct Facets<'a> {
    /// σ_α in radians.
    pub(in crate::reflectance) sigma_alpha: f64,
    /// c·a_f/4, times the irradiance for a radiance; a normal number.
    pub(in crate::reflectance) strength: f64,
    pub(in crate::reflectance) reflectivity: Reflectivity<'a>,
    pub(in crate::reflectance) shadowing: ShadowingFunction,
    /// σ_h/λ of a surface whose spike has e^{−g} of the energy and the lobe the rest.
    pub(in crate::reflectance) height: Option<f64>,
}

/// Rounding of (57), in ε.
const DIFFUSE_UNITS: f64 = 8.0;
/// Of (70): what a single direction's lobe is allowed, and what [`exp`] and [`angle`] have more.
const FACTOR_UNITS: f64 = 56.0;
const SQUARE_UNITS: f64 = 24.0;
/// Of 1 − e^{−g}.
const SHARE_UNITS: f64 = 28.0;
/// (α/σ_α)² from which on the lobe is 0 in f64, whatever its factors.
const DARK: f64 = 1e6;
/// More than what a value below 2^−1021 misses the exact one by.
const LOST: f64 = 1e-307;

/// Sum and parts in the directions of a block.
pub(in crate::reflectance) struct FacetLanes {
    reflectance: ReflectanceLanes,
    over_cosines: Lanes,
    pub(in crate::reflectance) diffuse: Lanes,
    pub(in crate::reflectance) lobe: Lanes,
    /// |ln(lobe/exact)| is not larger; infinite where the direction is left.
    distance: Lanes,
    pub(in crate::reflectance) total: Lanes,
    /// Bound of its relative error; infinite where the direction is left.
    pub(in crate::reflectance) bound: Lanes,
}

impl FacetLanes {
    pub(in crate::reflectance) const fn new() -> Self {
        let zero = [0.0; LANES];
        Self {
            reflectance: ReflectanceLanes::new(),
            over_cosines: zero,
            diffuse: zero,
            lobe: zero,
            distance: zero,
            total: zero,
            bound: zero,
        }
    }

    /// Whether the total underflows to 0.
    pub(in crate::reflectance) fn is_dark(&self, lane: usize) -> bool {
        self.total[lane] == 0.0 && self.bound[lane] == 1.0
    }

    /// Values and bounds in each direction.
    pub(in crate::reflectance) fn combine(
        &mut self,
        set: InstructionSet,
        common: Common<'_>,
        geometries: &Geometries,
        count: usize,
    ) {
        if let Some(facets) = common.facets {
            self.reflectance.fill(set, facets.reflectivity, geometries, count);
            over_cosines(set, facets.shadowing, common.cosines, geometries, count, &mut self.over_cosines);
            if let Some(height) = facets.height {
                shares(set, height, geometries, count, &mut self.over_cosines);
            }
            lobes(set, facets, geometries, count, self);
        } else {
            self.lobe.fill(0.0);
            self.distance.fill(0.0);
        }
        sums(set, common, geometries, count, self);
    }
}

vectorized! {
    fn shares = times_share, (height: f64, geometries: &Geometries, count: usize, over: &mut Lanes)
}

#[inline(always)]
fn times_share(height: f64, geometries: &Geometries, count: usize, over: &mut Lanes) {
    for lane in 0..count.min(LANES) {
        let share = lobe_share(mirror_g(height, 1.0, geometries.cos_i[lane]));
        // One that is hardly normal leaves the direction.
        over[lane] *= if share > 1e-290 { share } else { 0.0 };
    }
}

vectorized! {
    fn lobes = lobe_and_distance, (facets: Facets<'_>, geometries: &Geometries, count: usize, lanes: &mut FacetLanes)
}

#[inline(always)]
fn lobe_and_distance(facets: Facets<'_>, geometries: &Geometries, count: usize, lanes: &mut FacetLanes) {
    let share = if facets.height.is_some() { SHARE_UNITS } else { 0.0 };
    let factor_units = FACTOR_UNITS + share + facets.shadowing.units();
    for lane in 0..count.min(LANES) {
        let ratio = angle(geometries.cos_sum[lane], geometries.horizontal[lane]) / facets.sigma_alpha;
        let square = (ratio * ratio).min(DARK);
        let gaussian = exp(-0.5 * square);
        let factor = lanes.over_cosines[lane] * facets.strength * lanes.reflectance.value[lane];
        let significand = factor * gaussian.significand;
        let size = binary_exponent(significand) + gaussian.exponent;
        let distance = EPSILON * (SQUARE_UNITS * square + factor_units) + lanes.reflectance.distance[lane];
        // Nothing was lost on the way to numbers that are normal.
        let ordinary = (1e-290..1e290).contains(&factor) && distance < 0.5 && size < 1023.0;
        lanes.lobe[lane] = scale(significand, gaussian.exponent);
        lanes.distance[lane] = if ordinary { distance } else { f64::INFINITY };
    }
}

vectorized! {
    fn sums = total_and_bound, (common: Common<'_>, geometries: &Geometries, count: usize, lanes: &mut FacetLanes)
}

#[inline(always)]
fn total_and_bound(common: Common<'_>, geometries: &Geometries, count: usize, lanes: &mut FacetLanes) {
    let with_cosine = common.cosines == Cosines::OfView;
    for lane in 0..count.min(LANES) {
        let cos_i = if with_cosine { geometries.cos_i[lane] } else { 1.0 };
        let diffuse = common.diffuse * cos_i;
        let (lobe, distance) = (lanes.lobe[lane], lanes.distance[lane]);
        let total = diffuse + lobe;
        // |v − v e^{±d}| < v (d + d²) and v e^{−d} > v (1 − d) for d < 1.
        let is_normal = lobe > LOST;
        let lobe_error = lobe * (distance + distance * distance) + if is_normal { 0.0 } else { LOST };
        let lobe_least = if is_normal { lobe * (1.0 - distance) } else { 0.0 };
        let error = diffuse * ((DIFFUSE_UNITS + 1.0) * EPSILON) + lobe_error + total * EPSILON;
        let least = diffuse * (1.0 - DIFFUSE_UNITS * EPSILON) + lobe_least;
        // Nine roundings made this quotient.
        let bound = error / least * (1.0 + 16.0 * EPSILON);
        let ordinary = (1e-290..1e300).contains(&total) && distance < 0.5;
        // Half the smallest subnormal number is 2^−1075, and what is 0 here is far below it or was left.
        let dark = common.diffuse == 0.0 && lobe == 0.0 && distance < 0.5;
        lanes.diffuse[lane] = diffuse;
        lanes.total[lane] = total;
        lanes.bound[lane] = if ordinary { bound } else { f64::INFINITY };
        lanes.bound[lane] = if dark { 1.0 } else { lanes.bound[lane] };
    }
}
