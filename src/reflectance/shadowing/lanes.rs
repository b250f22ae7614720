//! G over the cosines in many directions at once.

use super::ShadowingFunction;
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
    /// The same numbers as [`ShadowingFunction::factor_over_cos_r`] or [`ShadowingFunction::factor_over_cosines`] give one by one.
    pub(in crate::reflectance) fn over_cosines = each, (
        shadowing: ShadowingFunction,
        cosines: Cosines,
        geometries: &Geometries,
        count: usize,
        over: &mut Lanes,
    )
}

#[inline(always)]
fn each(
    shadowing: ShadowingFunction,
    cosines: Cosines,
    geometries: &Geometries,
    count: usize,
    over: &mut Lanes,
) {
    use ShadowingFunction::{None, Smith, VGroove};
    // The match stands outside of the loops: each of them is one branch-free expression.
    match (shadowing, cosines) {
        (None, Cosines::OfView) => {
            fill(over, count, geometries, |geometry| None.factor_over_cos_r(geometry));
        }
        (None, Cosines::OfBoth) => {
            fill(over, count, geometries, |geometry| None.factor_over_cosines(geometry));
        }
        (VGroove, Cosines::OfView) => {
            fill(over, count, geometries, |geometry| VGroove.factor_over_cos_r(geometry));
        }
        (VGroove, Cosines::OfBoth) => {
            fill(over, count, geometries, |geometry| VGroove.factor_over_cosines(geometry));
        }
        (Smith(smith), Cosines::OfView) => {
            fill(over, count, geometries, |geometry| Smith(smith).factor_over_cos_r(geometry));
        }
        (Smith(smith), Cosines::OfBoth) => {
            fill(over, count, geometries, |geometry| {
                let over = Smith(smith).factor_over_cosines(geometry);
                // Grazing source and view are left to the one who looks at single directions.
                if geometry.cos_sum > 0.0 { over } else { f64::NAN }
            });
        }
    }
}

#[inline(always)]
fn fill(over: &mut Lanes, count: usize, geometries: &Geometries, factor: impl Fn(&Geometry) -> f64) {
    for lane in 0..count.min(LANES) {
        over[lane] = factor(&geometries.get(lane));
    }
}
