//! The report's two closed forms: one term for smooth surfaces, the saddle's leading behaviour
//! for rough ones.

use super::{LobeSeries, Method, cheapest, excess, rounding};
use crate::reflectance::numeric::scaled::Scaled;

/// e^{-g} g e^{-x}: the first term of the series, (38), (48) with the exponential restored.
///
/// All terms are positive and their ratios fall (they are log-concave), so with r = (g/4) e^{x/2}
/// the ratio of the second to the first, the terms left out are at most r of S.
pub(super) fn smooth(g: f64, x: f64) -> LobeSeries {
    let (condition_g, condition_x) = ((1.0 - g).abs(), x);
    LobeSeries {
        value: Scaled::exp(-(g + x)) * g,
        relative_error: smooth_truncation(g, x) + rounding(condition_g + g, condition_x),
        condition_g,
        condition_x,
        method: Method::Smooth,
    }
}

/// Bound of (S − first term)/S, at most 1.
pub(super) fn smooth_truncation(g: f64, x: f64) -> f64 {
    let ratio = 0.25 * g * libm::exp(0.5 * x);
    ratio.min(1.0)
}

/// e^{-x/g}/g: (39), (49). Its error is measured against the best value of S, since no switch on
/// g alone is safe (errata E23).
pub(super) fn rough(g: f64, x: f64) -> LobeSeries {
    if g == 0.0 {
        // e^{-x/g}/g → 0 for x > 0; for x = 0 it grows without bound. S itself is 0.
        let value = if x > 0.0 { Scaled::ZERO } else { Scaled::INFINITY };
        let relative_error = if x > 0.0 { 0.0 } else { f64::INFINITY };
        return LobeSeries {
            value,
            relative_error,
            condition_g: 0.0,
            condition_x: 0.0,
            method: Method::Rough,
        };
    }
    let y = x / g;
    let value = Scaled::exp(-y) / Scaled::new(g);
    let best = cheapest(g, x, 1e-12);
    let relative_error = excess(value, &best) + rounding(1.0, y) * (value / best.value).to_f64();
    LobeSeries { value, relative_error, condition_g: (y - 1.0).abs(), condition_x: y, method: Method::Rough }
}
