//! The report's two closed forms: one term for smooth surfaces, the saddle's leading behaviour
//! for rough ones.

use super::{LobeSeries, Method, cheapest, rounding, series};
use crate::reflectance::estimate::Estimate;
use crate::reflectance::numeric::lobe_series::saddle::Saddle;
use crate::reflectance::numeric::scaled::Scaled;

/// e^{-g} g e^{-x}: the first term of the series, (38), (48) with the exponential restored.
///
/// All terms are positive and their ratios fall (they are log-concave), so with r the ratio of the
/// second to the first what is left out is below r/(1 − r) of the first. Where r says too little
/// the error is measured against the sum.
pub(super) fn smooth(g: f64, x: f64) -> LobeSeries {
    let first = Scaled::exp(-(g + x)) * g;
    let ratio = second_to_first(g, x);
    if ratio <= 0.25 {
        // The mean of m lies between 1 and 2, that of 1/m between 1/2 and 1.
        LobeSeries::converged(first, ratio / (1.0 - ratio), 2.0 + g, x, Method::Smooth)
    } else {
        let s = series::converged(g, x, &Saddle::of(g, x));
        LobeSeries::compared(first, rounding(g, x), &s, Method::Smooth)
    }
}

/// r = (g/4) e^{x/2}.
pub(super) fn second_to_first(g: f64, x: f64) -> f64 {
    0.25 * g * libm::exp(0.5 * x)
}

/// e^{-x/g}/g: (39), (49). Its error is measured against S, since no switch on g alone is safe
/// (errata E23).
pub(super) fn rough(g: f64, x: f64) -> LobeSeries {
    let y = x / g;
    let value = Scaled::exp(-y) / Scaled::new(g);
    LobeSeries::compared(value, rounding(1.0, y), &cheapest(g, x), Method::Rough)
}

/// The limit of e^{-x/g}/g for g → 0, where S itself is 0.
pub(super) fn rough_without_roughness(x: f64) -> LobeSeries {
    let estimate = if x > 0.0 { Estimate::ZERO } else { Estimate::INFINITE };
    LobeSeries { estimate, ..LobeSeries::zero(Method::Rough) }
}

/// temporary
#[inline(always)]
pub(super) fn rough_truncation(g: f64, x: f64) -> f64 {
    let y = x / g;
    8.0 * (1.0 + y) * (1.0 + y) / g
}
