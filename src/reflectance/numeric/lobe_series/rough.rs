//! The saddle's leading behaviour at u → 0, for rough surfaces.

use super::between::Enclosure;
use super::{LobeSeries, Method, rounding};
use crate::reflectance::estimate::Estimate;
use crate::reflectance::numeric::scaled::Scaled;

/// Up to this error the closed bound is used: it is then within a tenth of itself.
const CLOSED_UP_TO: f64 = 0.1;

/// e^{-x/g}/g: (39), (49).
pub(super) fn rough(g: f64, x: f64) -> LobeSeries {
    let y = x / g;
    let value = Scaled::exp(-y) / Scaled::new(g);
    let own = rounding(1.0, y);
    let bound = bound(g, x);
    if bound > CLOSED_UP_TO {
        return Enclosure::of(g, x).judge(value, own, Method::Rough);
    }
    // S lies between value/(1 + bound) and value/(1 − bound). The conditions of the value are |y − 1|
    // and y, and the correction adds little.
    let estimate = Estimate {
        value,
        error: value * (bound / (1.0 - bound)) + value.spread(own),
        least: (value * (1.0 / (1.0 + bound))).lowered(own),
    };
    LobeSeries { estimate, condition_g: 1.0 + y, condition_x: 1.0 + y, method: Method::Rough }
}

/// What (49) neglects beside (1 − 2y + y²/2)/g, in 1/g². For g → ∞ it is
/// ±(1 − 5y + 5y²/2 + y³/6 − y⁴/8), with the sign of the first bracket: at most 5/6 + 4√2/3 = 2.72, at
/// y = 2 + √2. For finite g it is less, as measured over g from 0.01 to 10⁴.
const SECOND: f64 = 3.0;

/// Bound of |e^{-x/g}/g − S|/S, for every g > 0 and x ≥ 0; no rounding included.
#[inline(always)]
pub(super) fn bound(g: f64, x: f64) -> f64 {
    let y = x / g;
    let first = 1.0 + y * (0.5 * y - 2.0);
    (first.abs() + SECOND / g) / g
}

/// The limit of e^{-x/g}/g for g → 0, where S itself is 0.
pub(super) fn rough_without_roughness(x: f64) -> LobeSeries {
    let estimate = if x > 0.0 { Estimate::ZERO } else { Estimate::INFINITE };
    LobeSeries { estimate, ..LobeSeries::zero(Method::Rough) }
}
