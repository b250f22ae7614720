//! The first term alone, for smooth surfaces.

use super::between::Enclosure;
use super::{LobeSeries, Method, rounding};
use crate::reflectance::estimate::Estimate;
use crate::reflectance::numeric::scaled::Scaled;

/// Up to this ratio of the second term to the first the closed bound is used.
const CLOSED_UP_TO: f64 = 0.5;

/// e^{-g} g e^{-x}: the first term of the series, (38), (48) with the exponential restored.
pub(super) fn smooth(g: f64, x: f64) -> LobeSeries {
    let value = Scaled::exp(-(g + x)) * g;
    let ratio = second_to_first(g, x);
    if ratio > CLOSED_UP_TO {
        return Enclosure::of(g, x).judge(value, rounding(g, x), Method::Smooth);
    }
    // The mean of m lies between 1 and 2, that of 1/m between 1/2 and 1.
    let (condition_g, condition_x) = (2.0 + g, x);
    let own = rounding(condition_g, condition_x);
    let estimate = Estimate {
        value,
        error: value * rest_to_first(ratio) + value.spread(own),
        least: (value * (1.0 + ratio)).lowered(own),
    };
    LobeSeries { estimate, condition_g, condition_x, method: Method::Smooth }
}

/// r = (g/4) e^{x/2}, the second term over the first.
pub(super) fn second_to_first(g: f64, x: f64) -> f64 {
    // A subnormal g would lose the quarter.
    g * (0.25 * libm::exp(0.5 * x))
}

/// Bound of all further terms over the first; none, infinity, from r = 1 on.
///
/// The ratios of neighbours fall (the terms are log-concave), so the rest is below r/(1 − r₂), and
/// r₂ = (2g/9) e^{x/6} ≤ 8r/9.
#[inline(always)]
pub(super) fn rest_to_first(ratio: f64) -> f64 {
    if ratio < 1.0 { ratio / (1.0 - 8.0 / 9.0 * ratio) } else { f64::INFINITY }
}
