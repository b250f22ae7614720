//! The specular lobe of (47) in many directions at once, for directions in which it is an ordinary number: the
//! rest is left to [`RelativeRoughness::lobe`](super::RelativeRoughness::lobe).

use super::{G_UNITS, PREFACTOR_UNITS, RelativeRoughness, X_UNITS};
use crate::reflectance::fresnel::lanes::ReflectanceLanes;
use crate::reflectance::fresnel_average::table::Reflectivity;
use crate::reflectance::geometry::lanes::Geometries;
use crate::reflectance::numeric::EPSILON;
use crate::reflectance::numeric::dispatch::{InstructionSet, vectorized};
use crate::reflectance::numeric::elementary::{binary_exponent, scale};
use crate::reflectance::numeric::lobe_series::lanes::{self, Batch, Choice, LANES, Lanes};
use crate::reflectance::numeric::lobe_series::{LobeSeries, Method, ROUNDING_UNITS};
use crate::reflectance::shadowing::ShadowingFunction;
use crate::reflectance::shadowing::lanes::{Cosines, over_cosines};
use core::f64::consts::PI;

/// What the directions of a block have in common.
#[derive(Clone, Copy)]
pub(in crate::reflectance) struct Common<'a> {
    pub(in crate::reflectance) roughness: RelativeRoughness,
    pub(in crate::reflectance) reflectivity: Reflectivity<'a>,
    /// What multiplies the lobe: the irradiance for a radiance, 1 for a BRDF.
    pub(in crate::reflectance) strength: f64,
    pub(in crate::reflectance) shadowing: ShadowingFunction,
    pub(in crate::reflectance) cosines: Cosines,
}

/// How far the vector path got with a direction.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::reflectance) enum State {
    /// Value and bound are there.
    Plain,
    /// Too small for f64, its truncation within the tier's: the value is 0.
    Dark,
    /// Not done: a limit, an overflow, a subnormal number, or a point outside the batch's domain.
    Left,
}

/// The lobe in the directions of a block.
pub(in crate::reflectance) struct LobeLanes {
    /// g of (34).
    pub(in crate::reflectance) g: Lanes,
    x: Lanes,
    series: Batch,
    reflectance: ReflectanceLanes,
    over_cosines: Lanes,
    pub(in crate::reflectance) value: Lanes,
    /// Bound of the relative error.
    pub(in crate::reflectance) bound: Lanes,
    /// The part of it that no method can do without.
    pub(in crate::reflectance) rounding: Lanes,
    state: Lanes,
}

impl LobeLanes {
    pub(in crate::reflectance) const fn new() -> Self {
        let zero = [0.0; LANES];
        Self {
            g: zero,
            x: zero,
            series: Batch::new(),
            reflectance: ReflectanceLanes::new(),
            over_cosines: zero,
            value: zero,
            bound: zero,
            rounding: zero,
            state: zero,
        }
    }

    /// S in each direction.
    pub(in crate::reflectance) fn expand(
        &mut self,
        set: InstructionSet,
        choice: Choice<'_>,
        roughness: RelativeRoughness,
        geometries: &Geometries,
        count: usize,
    ) {
        arguments(set, roughness, geometries, &mut self.g[..count], &mut self.x[..count]);
        lanes::evaluate(set, choice, &self.g[..count], &self.x[..count], &mut self.series);
    }

    /// S in one direction, unless the point is outside the batch's domain.
    pub(in crate::reflectance) fn series(&self, lane: usize) -> Option<LobeSeries> {
        self.series.get(lane)
    }

    /// What made S in a direction.
    pub(in crate::reflectance) fn method(&self, lane: usize) -> Method {
        self.series.method[lane]
    }

    /// Value and bound of the lobe in each direction, from S.
    pub(in crate::reflectance) fn combine(
        &mut self,
        set: InstructionSet,
        common: Common<'_>,
        geometries: &Geometries,
        count: usize,
    ) {
        self.reflectance.fill(set, common.reflectivity, geometries, count);
        over_cosines(set, common.shadowing, common.cosines, geometries, count, &mut self.over_cosines);
        combined(set, common, geometries, count, self);
    }

    pub(in crate::reflectance) fn state(&self, lane: usize) -> State {
        if self.series.method[lane] == Method::Auto || self.state[lane] < 0.0 {
            State::Left
        } else if self.state[lane] == 0.0 {
            State::Dark
        } else {
            State::Plain
        }
    }
}

vectorized! {
    fn arguments = g_and_x,
        (roughness: RelativeRoughness, geometries: &Geometries, g: &mut [f64], x: &mut [f64])
}

#[inline(always)]
fn g_and_x(roughness: RelativeRoughness, geometries: &Geometries, g: &mut [f64], x: &mut [f64]) {
    for (g, &cos_sum) in g.iter_mut().zip(&geometries.cos_sum) {
        *g = roughness.g_of(cos_sum);
    }
    for (x, &horizontal) in x.iter_mut().zip(&geometries.horizontal) {
        *x = roughness.x_of(horizontal);
    }
}

vectorized! {
    fn combined = value_and_bound, (common: Common<'_>, geometries: &Geometries, count: usize, lobe: &mut LobeLanes)
}

#[inline(always)]
fn value_and_bound(common: Common<'_>, geometries: &Geometries, count: usize, lobe: &mut LobeLanes) {
    let prefactor = ROUNDING_UNITS + PREFACTOR_UNITS + common.shadowing.units();
    for lane in 0..count.min(LANES) {
        let (cos_sum, horizontal) = (geometries.cos_sum[lane], geometries.horizontal[lane]);
        let length_squared = cos_sum * cos_sum + horizontal * horizontal;
        let patch = common.roughness.correlation_length * (length_squared / cos_sum);
        let strength = common.strength * lobe.reflectance.value[lane];
        let factor = patch * patch * (0.25 * PI) * lobe.over_cosines[lane] * strength;
        let (significand, exponent) = (factor * lobe.series.significand[lane], lobe.series.exponent[lane]);
        let (condition_g, condition_x) = (lobe.series.condition_g[lane], lobe.series.condition_x[lane]);
        let rounding = EPSILON
            * (prefactor
                + (ROUNDING_UNITS + G_UNITS) * condition_g
                + (ROUNDING_UNITS + X_UNITS) * condition_x)
            + lobe.reflectance.distance[lane];
        // |ln(value/exact)|; e^d − 1 < d + d² for d < 1.
        let distance = lobe.series.truncation[lane] * (1.0 + lobe.series.truncation[lane]) + rounding;
        let value = scale(significand, exponent);
        let size = binary_exponent(significand) + exponent;
        // Nothing was lost on the way to numbers that are normal.
        let ordinary = (1e-140..1e140).contains(&patch)
            && (1e-290..1e290).contains(&factor)
            && (1e-290..1e290).contains(&significand)
            && distance < 0.5
            && size < 1023.0;
        // Half the smallest subnormal number is 2^−1075.
        let dark = size < -1080.0;
        let plain = size > -1021.0;
        lobe.value[lane] = if dark { 0.0 } else { value };
        lobe.bound[lane] = if dark { 1.0 } else { distance + distance * distance };
        lobe.rounding[lane] = rounding;
        let of_size = if plain { 1.0 } else { -1.0 };
        let of_size = if dark { 0.0 } else { of_size };
        lobe.state[lane] = if ordinary { of_size } else { -1.0 };
    }
}
