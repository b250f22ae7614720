//! Directions in blocks: geometry and lobe series of a block are worked out in vector lanes, the rest direction by
//! direction; or all of it, where [`InLanes`] says so.

use super::beckmann_spizzichino::lanes::{LobeLanes, State};
use super::directions::Directions;
use super::evaluate::{EvaluatedBy, Stretch};
use super::geometry::lanes::{DirectionLanes, Geometries, fill};
use super::kernel::{InLanes, Kernel};
use super::numeric::dispatch::InstructionSet;
use super::numeric::lobe_series::lanes::LANES;
use super::scene::Component;
use super::torrance_sparrow::lanes::FacetLanes;
use core::cell::RefCell;
use core::ops::Range;

/// Room for one block of directions.
pub(super) struct Block {
    set: InstructionSet,
    directions: DirectionLanes,
    geometries: Geometries,
    lobe: LobeLanes,
    facets: FacetLanes,
}

impl Block {
    /// Lends the calling thread's own: clearing a new one takes longer than evaluating one direction.
    pub(super) fn lent<T>(work: impl FnOnce(&mut Self) -> T) -> T {
        thread_local! {
            static BLOCK: RefCell<Box<Block>> = RefCell::new(Box::new(Block::with(InstructionSet::widest())));
        }
        BLOCK.with_borrow_mut(|block| work(block))
    }

    /// What is computed does not depend on `set`.
    pub(super) fn with(set: InstructionSet) -> Self {
        Self {
            set,
            directions: DirectionLanes::new(),
            geometries: Geometries::new(),
            lobe: LobeLanes::new(),
            facets: FacetLanes::new(),
        }
    }

    /// Adds the directions of `range` to `answer`.
    pub(super) fn evaluate(
        &mut self,
        kernel: &Kernel<'_>,
        directions: &Directions,
        range: Range<usize>,
        answer: &mut Stretch,
    ) {
        self.directions.clear();
        for first in range.clone().step_by(LANES) {
            let count = (range.end - first).min(LANES);
            directions.block(first, count, &mut self.directions);
            fill(self.set, &self.directions, kernel.has_spike(), &mut self.geometries);
            if let Some((roughness, choice)) = kernel.series() {
                self.lobe.expand(self.set, choice, roughness, &self.geometries, count);
            }
            match kernel.in_lanes().filter(|_| !answer.has_logarithms()) {
                Some(InLanes::HeightLobe(common)) => {
                    self.lobe.combine(self.set, common, &self.geometries, count);
                    self.runs(kernel, first, count, answer, Self::has_lobe, Self::push_lobes);
                }
                Some(InLanes::Facets(common)) => {
                    self.facets.combine(self.set, common, &self.geometries, count);
                    self.runs(kernel, first, count, answer, Self::has_facets, Self::push_facets);
                }
                None => (0..count).for_each(|lane| self.direction(kernel, first, lane, answer)),
            }
            if answer.needs_g() {
                for lane in 0..count {
                    answer.push_g(first + lane, kernel.g(&self.geometries.get(lane)));
                }
            }
        }
    }

    /// Runs of directions in which nothing better than what is there is to be had, and one by one those in between.
    fn runs(
        &self,
        kernel: &Kernel<'_>,
        first: usize,
        count: usize,
        answer: &mut Stretch,
        is_done: impl Fn(&Self, &Kernel<'_>, usize) -> bool,
        push: impl Fn(&Self, usize, Range<usize>, &mut Stretch),
    ) {
        let mut lane = 0;
        while lane < count {
            let done = (lane..count).take_while(|&lane| is_done(self, kernel, lane)).count();
            push(self, first + lane, lane..lane + done, answer);
            lane += done;
            if lane < count {
                self.direction(kernel, first, lane, answer);
                lane += 1;
            }
        }
    }

    fn has_lobe(&self, kernel: &Kernel<'_>, lane: usize) -> bool {
        match self.lobe.state(lane) {
            State::Dark => true,
            State::Plain => kernel.is_enough(self.lobe.bound[lane], self.lobe.rounding[lane]),
            State::Left => false,
        }
    }

    fn push_lobes(&self, first: usize, run: Range<usize>, answer: &mut Stretch) {
        let lane = run.start;
        let by = |place| EvaluatedBy::Lobe(self.lobe.method(lane + place));
        let values = &self.lobe.value[run.clone()];
        answer.extend(first, values, &self.lobe.bound[run], |_| values, by);
    }

    fn has_facets(&self, kernel: &Kernel<'_>, lane: usize) -> bool {
        self.facets.is_dark(lane) || kernel.keeps(self.facets.bound[lane])
    }

    fn push_facets(&self, first: usize, run: Range<usize>, answer: &mut Stretch) {
        let of = |component| match component {
            Component::DiffuseLobe => &self.facets.diffuse[run.clone()],
            Component::SpecularLobe | Component::SpecularSpike => &self.facets.lobe[run.clone()],
        };
        let (totals, bounds) = (&self.facets.total[run.clone()], &self.facets.bound[run.clone()]);
        answer.extend(first, totals, bounds, of, |_| EvaluatedBy::ClosedForm);
    }

    fn direction(&self, kernel: &Kernel<'_>, first: usize, lane: usize, answer: &mut Stretch) {
        let series = kernel.series().and_then(|_| self.lobe.series(lane));
        let reflection = kernel.reflect(&self.geometries.get(lane), series, answer.has_logarithms());
        answer.push(first + lane, &reflection);
    }
}
