//! What S lies between, at the cost of one saddle and a few terms: it bounds a component before it is
//! computed, and a named method where its own bound says nothing.

use super::saddle::Saddle;
use super::{LobeSeries, Method, rounding, series, uniform};
use crate::reflectance::estimate::Estimate;
use crate::reflectance::numeric::EPSILON;
use crate::reflectance::numeric::scaled::Scaled;

/// low ≤ S ≤ high, rounding included, with the conditions of S to a few per cent.
#[derive(Clone, Copy, Debug)]
pub(super) struct Enclosure {
    pub(super) low: Scaled,
    pub(super) high: Scaled,
    pub(super) condition_g: f64,
    pub(super) condition_x: f64,
}

/// From this μ and this variance on the expansion knows S within 5 %; elsewhere no more than about
/// fifteen terms are above a 64th of the largest.
const EXPANDED_FROM_MU: f64 = 6.0;
const EXPANDED_FROM_VARIANCE: f64 = 0.5;

impl Enclosure {
    /// Of g > 0, x ≥ 0.
    pub(super) fn of(g: f64, x: f64) -> Self {
        Self::at(g, x, &Saddle::of(g, x))
    }

    /// The same where the saddle is known.
    pub(super) fn at(g: f64, x: f64, saddle: &Saddle) -> Self {
        if saddle.mu >= EXPANDED_FROM_MU && saddle.variance() >= EXPANDED_FROM_VARIANCE {
            uniform::enclose(g, x, saddle)
        } else {
            series::enclose(g, x, saddle)
        }
    }

    /// The two ends before rounding, which the conditions tell.
    pub(super) fn rounded(low: Scaled, high: Scaled, condition_g: f64, condition_x: f64) -> Self {
        let log_error = rounding(condition_g, condition_x);
        let high = high + high.spread(log_error);
        Self { low: low.lowered(log_error), high, condition_g, condition_x }
    }

    /// A value that need not be near S, its own rounding e^{±`log_error`}: how far off it may be.
    pub(super) fn judge(&self, value: Scaled, log_error: f64, method: Method) -> LobeSeries {
        let farthest = value.distance(self.low).larger(value.distance(self.high));
        let error = farthest * (1.0 + 4.0 * EPSILON) + value.spread(log_error);
        LobeSeries {
            estimate: Estimate { value, error, least: self.low },
            condition_g: self.condition_g,
            condition_x: self.condition_x,
            method,
        }
    }
}

/// Bounds of S from both sides, within 10 % of each other but for the rounding of the exponents,
/// which grows with them.
pub fn between(g: f64, x: f64) -> (Scaled, Scaled) {
    if g == 0.0 {
        return (Scaled::ZERO, Scaled::ZERO);
    }
    let Enclosure { low, high, .. } = Enclosure::of(g, x);
    (low, high)
}
