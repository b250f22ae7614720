//! Directions: how many a request asked for, and what evaluated them.

use crate::reflectance::evaluate::{EvaluatedBy, Tally};
use metrics::Counter;
use std::fmt;
use std::sync::Arc;

/// How many directions were asked for: an extension of the answer.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Asked(pub(crate) usize);

/// Counts what is evaluated. By default it counts for nobody.
#[derive(Clone, Default)]
pub(crate) struct Meter(Option<Arc<[Counter; EvaluatedBy::ALL.len()]>>);

impl fmt::Debug for Meter {
    fn fmt(&self, formatter: &mut fmt::Formatter) -> fmt::Result {
        formatter.write_str("Meter")
    }
}

impl Meter {
    /// For a counter of each way of evaluation.
    pub(super) fn new(counters: [Counter; EvaluatedBy::ALL.len()]) -> Self {
        Self(Some(Arc::new(counters)))
    }

    /// Adds what was evaluated.
    pub(crate) fn add(&self, tally: &Tally) {
        let Some(counters) = &self.0 else { return };
        for (by, directions) in tally.methods() {
            for (counter, _) in counters.iter().zip(EvaluatedBy::ALL).filter(|(_, one)| *one == by) {
                counter.increment(directions as u64);
            }
        }
    }
}
