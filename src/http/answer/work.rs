//! What is to be evaluated for one answer: a scene over directions, or over the curves of a sweep.

use crate::http::problem::Problem;
use crate::reflectance::diagram::Sweep;
use crate::reflectance::directions::Directions;
use crate::reflectance::evaluate::{Output, Prepared, Quantity, expected_cost};
use crate::reflectance::scene::Scene;
use std::ops::Range;
use std::sync::Arc;

/// Nanoseconds of one vectorised exponential, the unit of [`expected_cost`].
const EXPONENTIAL: f64 = 3.5;
/// Nanoseconds of one number in an answer, written as text.
const NUMBER: f64 = 30.0;
/// Nanoseconds of a piece of work for the pool: a change of threads costs a fortieth of it.
const PIECE: f64 = 1e6;
/// Rows of a piece: not so few that the changes of threads show, nor so many that text and columns take memory.
const LEAST_ROWS: usize = 128;
const MOST_ROWS: usize = 16 << 10;

/// What is asked for.
#[derive(Clone, Debug)]
pub(crate) struct Work {
    pub(crate) scene: Arc<Scene>,
    pub(crate) quantity: Quantity,
    pub(crate) output: Output,
    pub(crate) over: Over,
}

/// Where.
#[derive(Clone, Debug)]
pub(crate) enum Over {
    Directions(Arc<Directions>),
    Sweep(Arc<Sweep>),
}

/// One curve made ready; directions without a sweep are one curve.
#[derive(Clone, Debug)]
pub(super) struct Curve {
    /// The fixed angle of a sweep.
    pub(super) at_deg: Option<f64>,
    pub(super) directions: Arc<Directions>,
    pub(super) prepared: Arc<Prepared>,
}

impl Work {
    pub(super) fn rows(&self) -> usize {
        match &self.over {
            Over::Directions(directions) => directions.count(),
            Over::Sweep(sweep) => sweep.rows(),
        }
    }

    pub(super) fn curves(&self) -> usize {
        match &self.over {
            Over::Directions(_) => 1,
            Over::Sweep(sweep) => sweep.at().len(),
        }
    }

    /// The directions of a curve, `index` below [`Self::curves`].
    pub(super) fn directions(&self, index: usize) -> Result<Arc<Directions>, Problem> {
        match &self.over {
            Over::Directions(directions) => Ok(Arc::clone(directions)),
            Over::Sweep(sweep) => sweep.directions(sweep.at()[index]).map(Arc::new).map_err(|error| {
                tracing::error!(%error, "a checked sweep left its range");
                Problem::internal()
            }),
        }
    }

    /// Finds what a curve requires.
    pub(super) fn prepare(&self, index: usize) -> Result<Curve, Problem> {
        let directions = self.directions(index)?;
        let prepared = Prepared::new(&self.scene, &directions, self.quantity, self.output);
        let at_deg = match &self.over {
            Over::Directions(_) => None,
            Over::Sweep(sweep) => Some(sweep.at()[index]),
        };
        Ok(Curve { at_deg, directions, prepared: Arc::new(prepared) })
    }

    /// Nanoseconds of one row, before what it requires is known: good to a factor of two.
    pub(super) fn nanoseconds_a_row(&self) -> f64 {
        let numbers = if self.output.log10 { 8.0 } else { 4.0 };
        EXPONENTIAL * expected_cost(&self.scene, self.output) + NUMBER * numbers
    }

    /// The ranges of so many rows that are about a millisecond of work each.
    pub(super) fn pieces(&self, rows: usize) -> impl Iterator<Item = Range<usize>> + Send + use<> {
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped at once")]
        let piece = ((PIECE / self.nanoseconds_a_row()) as usize).clamp(LEAST_ROWS, MOST_ROWS);
        (0..rows).step_by(piece).map(move |first| first..rows.min(first + piece))
    }
}
