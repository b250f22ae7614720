//! The exponential series of the specular lobe,
//!
//! S(g, x) = e^{-g} Σ_{m≥1} g^m/(m! m) e^{-x/m},
//!
//! g = (2π σ_h/λ (cos θ_i + cos θ_r))² of (34) and x = v_xy² T²/4. Everything else in (47) is
//! elementary, so the trade of speed for accuracy is a question about S alone: one file a method.
//!
//! Domain: finite g ≥ 0 and x ≥ 0, from subnormal to 1e250. Every method returns [`LobeSeries`]:
//! the value with an exponent that cannot underflow, a relative error bound that holds, and what
//! an error of g or x does to it.

mod saddle;
mod series;
mod single_term;
mod uniform;

use super::EPSILON;
use super::scaled::Scaled;

/// How the series is evaluated.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Method {
    /// The cheapest whose bound keeps the tolerance.
    Auto,
    /// Summed to convergence around the largest term.
    Series,
    /// The first 100 terms, as the authors did (section 4.1.5).
    Paper,
    /// Saddle-point expansion to order 4, uniform in g and x.
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
    /// S, or what the named approximation makes of it. Infinite where the approximation diverges.
    pub value: Scaled,
    /// Bound of |value − S|/S for the g and x given, rounding included.
    pub relative_error: f64,
    /// |∂ ln S/∂ ln g|
    pub condition_g: f64,
    /// |∂ ln S/∂ ln x|
    pub condition_x: f64,
    /// The method that made the value; never [`Method::Auto`].
    pub method: Method,
}

impl LobeSeries {
    /// The series without a surface to scatter: g = 0.
    const ZERO: Self = Self {
        value: Scaled::ZERO,
        relative_error: 0.0,
        condition_g: 1.0,
        condition_x: 0.0,
        method: Method::Series,
    };
}

/// Rounding error of a converged value in units of ε(1 + condition): four times the worst seen on
/// the oracle's points (docs/accuracy.md).
const ROUNDING_UNITS: f64 = 48.0;

/// The relative rounding error to allow for a value of this condition.
fn rounding(condition_g: f64, condition_x: f64) -> f64 {
    ROUNDING_UNITS * EPSILON * (1.0 + condition_g + condition_x)
}

/// How far an approximation lies from S, given a converged value of it; infinite past f64's range.
fn excess(approximation: Scaled, converged: &LobeSeries) -> f64 {
    let ratio = (approximation / converged.value).to_f64();
    (ratio - 1.0).abs() + (1.0 + ratio) * converged.relative_error
}

/// S(g, x) by `method`; `tolerance` matters to [`Method::Auto`] only.
///
/// A named method is used as asked, wherever it leads: its bound then says how far off it is.
pub fn evaluate(method: Method, g: f64, x: f64, tolerance: f64) -> LobeSeries {
    if g == 0.0 {
        return match method {
            Method::Rough => single_term::rough(g, x),
            named => LobeSeries { method: reported(named), ..LobeSeries::ZERO },
        };
    }
    match method {
        Method::Auto => cheapest(g, x, tolerance),
        Method::Series => series::converged(g, x),
        Method::Paper => series::first_hundred(g, x),
        Method::Uniform => uniform::order_four(g, x, &saddle::Saddle::of(g, x)),
        Method::Smooth => single_term::smooth(g, x),
        Method::Rough => single_term::rough(g, x),
    }
}

const fn reported(method: Method) -> Method {
    match method {
        Method::Auto => Method::Series,
        named => named,
    }
}

/// The cheapest method whose bound keeps `tolerance`: one term, the saddle point, or the sum.
fn cheapest(g: f64, x: f64, tolerance: f64) -> LobeSeries {
    if single_term::smooth_truncation(g, x) <= tolerance {
        let smooth = single_term::smooth(g, x);
        if smooth.relative_error <= tolerance {
            return smooth;
        }
    }
    let saddle = saddle::Saddle::of(g, x);
    if uniform::serves(&saddle) && uniform::truncation(&saddle) <= tolerance {
        let uniform = uniform::order_four(g, x, &saddle);
        if uniform.relative_error <= tolerance {
            return uniform;
        }
    }
    series::converged_at(g, x, &saddle)
}
