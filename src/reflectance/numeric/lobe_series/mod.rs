//! The exponential series of the specular lobe,
//!
//! S(g, x) = e^{-g} Σ_{m≥1} g^m/(m! m) e^{-x/m},
//!
//! g = (2π σ_h/λ (cos θ_i + cos θ_r))² of (34) and x = v_xy² T²/4. Everything else in (47) is
//! elementary, so the trade of speed for accuracy is a question about S alone: one file a method.
//!
//! Domain: finite g ≥ 0 and x ≥ 0, from subnormal to 1e250. Every method returns [`LobeSeries`]:
//! the value with an exponent that cannot underflow, an error bound that holds, and what an error of
//! g or x does to it.

mod between;
mod by_saddle;
mod direct;
pub mod lanes;
pub mod patches;
mod rough;
mod saddle;
mod series;
mod single_term;
#[cfg(test)]
mod tests;
mod uniform;

use super::EPSILON;
use super::dispatch::InstructionSet;
use super::scaled::Scaled;
use crate::reflectance::estimate::Estimate;
pub use between::between;
use lanes::{Batch, Choice};
use patches::Tier;
use saddle::Saddle;

/// How the series is evaluated.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Method {
    /// The cheapest that keeps the truncation asked for.
    Auto,
    /// Summed to convergence around the largest term.
    Series,
    /// The first 100 terms, as the authors did (section 4.1.5).
    Paper,
    /// Saddle-point form, uniform in g and x; its correction by polynomial patches, beyond them to the
    /// order that serves best.
    Uniform,
    /// The first term alone: (38), (48) with the exponential restored (errata E21).
    Smooth,
    /// e^{-x/g}/g: (39), (49).
    Rough,
}

impl Method {
    /// Every method that a caller may name.
    pub const ALL: [Self; 6] =
        [Self::Auto, Self::Series, Self::Paper, Self::Uniform, Self::Smooth, Self::Rough];

    /// The name in requests and answers.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Auto => "auto",
            Self::Series => "series",
            Self::Paper => "paper",
            Self::Uniform => "uniform",
            Self::Smooth => "smooth",
            Self::Rough => "rough",
        }
    }
}

/// A value of S.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LobeSeries {
    /// S, or what the named approximation makes of it, with the bound of its error for the g and x
    /// given, rounding included. Infinite where the approximation diverges.
    pub estimate: Estimate,
    /// |∂ ln S/∂ ln g|
    pub condition_g: f64,
    /// |∂ ln S/∂ ln x|
    pub condition_x: f64,
    /// The method that made the value; never [`Method::Auto`].
    pub method: Method,
}

impl LobeSeries {
    /// A value that is S up to truncation and rounding.
    fn converged(value: Scaled, truncation: f64, condition_g: f64, condition_x: f64, method: Method) -> Self {
        let log_error = truncation + rounding(condition_g, condition_x);
        Self { estimate: Estimate::within(value, log_error), condition_g, condition_x, method }
    }

    /// The series without roughness: g = 0.
    fn zero(method: Method) -> Self {
        Self { estimate: Estimate::ZERO, condition_g: 1.0, condition_x: 0.0, method }
    }
}

/// Rounding error of a converged value in units of ε(1 + condition): four times the worst seen on
/// the oracle's points (docs/accuracy.md).
pub(in crate::reflectance) const ROUNDING_UNITS: f64 = 48.0;

/// The relative rounding error to allow for a value of this condition.
fn rounding(condition_g: f64, condition_x: f64) -> f64 {
    ROUNDING_UNITS * EPSILON * (1.0 + condition_g + condition_x)
}

/// Truncation that disappears in the rounding.
const NEGLIGIBLE_TRUNCATION: f64 = 4.0 * EPSILON;

/// S(g, x) by `method`, at its best; by [`Method::Auto`] as well as the sum.
///
/// A named method is used as asked, wherever it leads: its bound then says how far off it is.
pub fn evaluate(method: Method, g: f64, x: f64) -> LobeSeries {
    if g == 0.0 {
        return match method {
            Method::Rough => rough::rough_without_roughness(x),
            Method::Auto => LobeSeries::zero(Method::Series),
            named => LobeSeries::zero(named),
        };
    }
    match method {
        Method::Auto => evaluate_within(&patches::FULL, g, x),
        Method::Series => series::converged(g, x, &Saddle::of(g, x)),
        Method::Paper => series::first_hundred(g, x),
        Method::Uniform => alone(Choice::uniform(), g, x).unwrap_or_else(|| uniform::at_its_best(g, x)),
        Method::Smooth => single_term::smooth(g, x),
        Method::Rough => rough::rough(g, x),
    }
}

/// S(g, x) by the cheapest method whose truncation is `tier`'s at most.
pub fn evaluate_within(tier: &Tier, g: f64, x: f64) -> LobeSeries {
    if g == 0.0 {
        return LobeSeries::zero(Method::Series);
    }
    alone(Choice::auto(tier), g, x).unwrap_or_else(|| beyond_the_batch(g, x))
}

/// A batch of one point; none where it is left to the methods for one point.
fn alone(choice: Choice<'_>, g: f64, x: f64) -> Option<LobeSeries> {
    let mut batch = Batch::new();
    lanes::evaluate(InstructionSet::widest(), choice, &[g], &[x], &mut batch);
    batch.get(0)
}

/// As good as the sum where g or x is beyond the batch's domain: one term, the saddle point, or the sum itself.
fn beyond_the_batch(g: f64, x: f64) -> LobeSeries {
    if single_term::second_to_first(g, x) <= NEGLIGIBLE_TRUNCATION {
        return single_term::smooth(g, x);
    }
    let saddle = Saddle::of(g, x);
    if uniform::serves(&saddle) && uniform::truncation(&saddle) <= NEGLIGIBLE_TRUNCATION {
        uniform::order_four(g, x, &saddle)
    } else {
        series::converged(g, x, &saddle)
    }
}

/// μ/w: the variance of the terms about the saddle, for g > 0 and x ≥ 0.
pub fn variance(g: f64, x: f64) -> f64 {
    Saddle::of(g, x).variance()
}
