//! G over the cosines in many directions at once.

use super::Shadowing;
use crate::reflectance::geometry::Geometry;
use crate::reflectance::geometry::lanes::Geometries;
use crate::reflectance::numeric::dispatch::vectorized;
use crate::reflectance::numeric::lobe_series::lanes::{LANES, Lanes};

/// What G is divided by.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::reflectance) enum Cosines {
    /// cos θ_r, for a radiance.
    OfView,
    /// cos θ_i cos θ_r, for a BRDF.
    OfBoth,
}

vectorized! {
    /// The same numbers as [`Shadowing::factor_over_cos_r`] or [`Shadowing::factor_over_cosines`] give one by one.
    pub(in crate::reflectance) fn over_cosines = each, (
        shadowing: Shadowing,
        cosines: Cosines,
        geometries: &Geometries,
        count: usize,
        over: &mut Lanes,
    )
}

#[inline(always)]
fn each(shadowing: Shadowing, cosines: Cosines, geometries: &Geometries, count: usize, over: &mut Lanes) {
    // The match stands outside of the loops: each of them is one branch-free expression.
    match (shadowing, cosines) {
        (Shadowing::None, Cosines::OfView) => {
            fill(over, count, geometries, |geometry| Shadowing::None.factor_over_cos_r(geometry));
        }
        (Shadowing::None, Cosines::OfBoth) => {
            fill(over, count, geometries, |geometry| Shadowing::None.factor_over_cosines(geometry));
        }
        (Shadowing::VGroove, Cosines::OfView) => {
            fill(over, count, geometries, |geometry| Shadowing::VGroove.factor_over_cos_r(geometry));
        }
        (Shadowing::VGroove, Cosines::OfBoth) => {
            fill(over, count, geometries, |geometry| Shadowing::VGroove.factor_over_cosines(geometry));
        }
    }
}

#[inline(always)]
fn fill(over: &mut Lanes, count: usize, geometries: &Geometries, factor: impl Fn(&Geometry) -> f64) {
    for lane in 0..count.min(LANES) {
        over[lane] = factor(&geometries.get(lane));
    }
}
