//! Directions in blocks: geometry and lobe series of a block are worked out in vector lanes, the rest direction by
//! direction; or all of it, where the answer is nothing but the lobe of (47).

use super::beckmann_spizzichino::lanes::{Common, LobeLanes, State};
use super::directions::Directions;
use super::evaluate::{Answer, EvaluatedBy};
use super::geometry::lanes::{DirectionLanes, Geometries, fill};
use super::kernel::Kernel;
use super::numeric::dispatch::InstructionSet;
use super::numeric::lobe_series::lanes::LANES;
use core::ops::Range;

/// Room for one block of directions.
pub(super) struct Block {
    set: InstructionSet,
    directions: DirectionLanes,
    geometries: Geometries,
    lobe: LobeLanes,
}

impl Block {
    pub(super) fn new() -> Self {
        Self::with(InstructionSet::widest())
    }

    /// What is computed does not depend on `set`.
    pub(super) fn with(set: InstructionSet) -> Self {
        Self { set, directions: DirectionLanes::new(), geometries: Geometries::new(), lobe: LobeLanes::new() }
    }

    /// Adds the directions of `range` to `answer`.
    pub(super) fn evaluate(
        &mut self,
        kernel: &Kernel<'_>,
        directions: &Directions,
        range: Range<usize>,
        answer: &mut Answer<'_>,
    ) {
        for first in range.clone().step_by(LANES) {
            let count = (range.end - first).min(LANES);
            directions.block(first, count, &mut self.directions);
            fill(self.set, &self.directions, kernel.has_spike(), &mut self.geometries);
            if let Some((roughness, choice)) = kernel.series() {
                self.lobe.expand(self.set, choice, roughness, &self.geometries, count);
            }
            match kernel.lobe_alone().filter(|_| !answer.has_logarithms()) {
                Some(common) => self.lobe_alone(kernel, common, first, count, answer),
                None => (0..count).for_each(|lane| self.direction(kernel, first, lane, answer)),
            }
            if answer.needs_g() {
                for lane in 0..count {
                    answer.push_g(first + lane, kernel.g(&self.geometries.get(lane)));
                }
            }
        }
    }

    /// Runs of directions in which the lobe is an ordinary number, and one by one those in between.
    fn lobe_alone(
        &mut self,
        kernel: &Kernel<'_>,
        common: Common,
        first: usize,
        count: usize,
        answer: &mut Answer<'_>,
    ) {
        self.lobe.combine(self.set, common, &self.geometries, count);
        let mut lane = 0;
        while lane < count {
            let done = (lane..count).take_while(|&lane| self.is_done(kernel, lane)).count();
            let run = lane..lane + done;
            let by = |place| EvaluatedBy::Lobe(self.lobe.method(lane + place));
            answer.extend(first + lane, &self.lobe.value[run.clone()], &self.lobe.bound[run], by);
            lane += done;
            if lane < count {
                self.direction(kernel, first, lane, answer);
                lane += 1;
            }
        }
    }

    /// Whether nothing better than what is there is to be had.
    fn is_done(&self, kernel: &Kernel<'_>, lane: usize) -> bool {
        match self.lobe.state(lane) {
            State::Dark => true,
            State::Plain => kernel.is_enough(self.lobe.bound[lane], self.lobe.rounding[lane]),
            State::Left => false,
        }
    }

    fn direction(&self, kernel: &Kernel<'_>, first: usize, lane: usize, answer: &mut Answer<'_>) {
        let series = kernel.series().and_then(|_| self.lobe.series(lane));
        let reflection = kernel.reflect(&self.geometries.get(lane), series, answer.has_logarithms());
        answer.push(first + lane, &reflection);
    }
}
