//! From a scene and directions to answers: one pass, columns of f64, no allocation per direction.

use super::block::Block;
use super::cost;
use super::directions::{Directions, Extents};
use super::findings::{Diagnostic, Omitted, Warning};
use super::fresnel_average::table::SlopeAverages;
use super::kernel::Kernel;
use super::numeric::lobe_series::lanes::LANES;
use super::receiver::Receiver;
use super::requirement::Requirement;
use super::scene::{Component, Scene};
use super::strain;
use core::ops::Range;
use rayon::iter::{IntoParallelIterator as _, ParallelIterator as _};

#[cfg(test)]
mod tests;

pub use super::columns::ComponentColumn;
pub use super::kernel::{EvaluatedBy, Quantity};
pub use super::stretch::{Parts, Stretch, Tally};

/// What to add to the answer.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct Output {
    /// Decimal logarithms of total and components, right also where the value underflows.
    pub log10: bool,
    /// Method and g of each direction.
    pub per_direction: bool,
}

/// The answer to N directions.
#[derive(Clone, Debug, PartialEq)]
pub struct Evaluation {
    /// The sum of the evaluated components.
    pub total: Vec<f64>,
    /// Its decimal logarithm, if asked for.
    pub log10_total: Option<Vec<f64>>,
    /// The evaluated components, in the model's order.
    pub components: Vec<ComponentColumn>,
    /// |total − exact|/exact is not larger, for the numbers as given.
    pub relative_error_bound: Vec<f64>,
    /// How many directions each method evaluated; methods that evaluated none are left out.
    pub methods: Vec<(EvaluatedBy, usize)>,
    /// The method of each direction, if asked for.
    pub method: Option<Vec<EvaluatedBy>>,
    /// g of (34) for each direction, if asked for; NaN where the scene has no heights or wavelength.
    pub roughness_g: Option<Vec<f64>>,
    /// Components that were not evaluated, and why.
    pub omitted: Vec<Omitted>,
    /// What the caller should know of the whole answer.
    pub warnings: Vec<Warning>,
    /// Why a value of a direction is not a number, in order of directions.
    pub diagnostics: Vec<Diagnostic>,
}

/// Directions that one thread evaluates at a time: some tens of microseconds of work at least.
const PART: usize = 8 * LANES;

/// A scene made ready for some directions: what they require is known, and any stretch of them can be evaluated by
/// itself, on any thread and in any order, to the same numbers.
#[derive(Debug)]
pub struct Prepared {
    scene: Scene,
    /// Where viewers are not points.
    receiver: Option<Receiver>,
    quantity: Quantity,
    output: Output,
    share: f64,
    averages: SlopeAverages,
    omitted: Vec<Omitted>,
    extents: Extents,
    asked: Scene,
}

impl Prepared {
    /// Finds what is required of a scene in these directions; `is_over` is asked before each mean over slopes whether to
    /// stop, and what is missing then is worked out where it is needed.
    pub fn new(
        scene: &Scene,
        directions: &Directions,
        quantity: Quantity,
        output: Output,
        is_over: impl Fn() -> bool,
    ) -> Self {
        let requirement = Requirement::of(scene, directions);
        Self::required(scene, directions, quantity, output, requirement, is_over)
    }

    /// With what is required known.
    pub(super) fn required(
        scene: &Scene,
        directions: &Directions,
        quantity: Quantity,
        output: Output,
        requirement: Requirement,
        is_over: impl Fn() -> bool,
    ) -> Self {
        let Requirement { evaluated, omitted, share, extents } = requirement;
        let needed = scene.with_only(&evaluated);
        let receiver = Receiver::of(&needed, share);
        let averages = SlopeAverages::of(&needed, directions, is_over);
        Self {
            scene: needed,
            receiver,
            quantity,
            output,
            share,
            averages,
            omitted,
            extents,
            asked: scene.clone(),
        }
    }

    /// What is asked for.
    pub fn quantity(&self) -> Quantity {
        self.quantity
    }

    /// What is added to the answer.
    pub fn output(&self) -> Output {
        self.output
    }

    /// The components that are evaluated, in the model's order.
    pub fn components(&self) -> &[Component] {
        self.scene.evaluated()
    }

    /// Components that are not evaluated, and why.
    pub fn omitted(&self) -> &[Omitted] {
        &self.omitted
    }

    /// What the caller should know whatever the values are, of the directions that it was made ready for.
    pub fn warnings(&self, directions: &Directions) -> Vec<Warning> {
        strain::warnings(&self.asked, &self.scene, directions, &self.extents, &self.omitted)
    }

    /// Evaluates a range of the directions that it was made ready for; `is_over` is asked every few tens of microseconds
    /// whether to stop, and what is missing then is missing at the end.
    pub fn stretch(
        &self,
        directions: &Directions,
        range: Range<usize>,
        is_over: impl Fn() -> bool,
    ) -> Stretch {
        let kernel = self.kernel();
        let mut answer = self.room(range.start, range.len());
        for first in range.clone().step_by(PART) {
            if is_over() {
                break;
            }
            self.part(&kernel, directions, first..range.end.min(first + PART), &mut answer, &is_over);
        }
        answer
    }

    fn kernel(&self) -> Kernel<'_> {
        match &self.receiver {
            Some(receiver) => Kernel::new(receiver.scene(), self.quantity, 0.0, &self.averages),
            None => Kernel::new(&self.scene, self.quantity, self.share, &self.averages),
        }
    }

    /// Adds some directions to an answer.
    fn part(
        &self,
        kernel: &Kernel<'_>,
        directions: &Directions,
        range: Range<usize>,
        answer: &mut Stretch,
        is_over: impl Fn() -> bool,
    ) {
        match &self.receiver {
            Some(receiver) => receiver.evaluate(kernel, directions, range, answer, is_over),
            None => Block::lent(|block| block.evaluate(kernel, directions, range, answer)),
        }
    }

    fn room(&self, first: usize, count: usize) -> Stretch {
        Stretch::new(&self.scene, first, count, self.output, self.share)
    }

    /// Evaluates all directions; many on all threads of rayon's current pool.
    fn whole(self, directions: &Directions) -> Evaluation {
        let count = directions.count();
        let threads = if count > PART { rayon::current_num_threads() } else { 1 };
        if threads == 1 {
            let whole = self.stretch(directions, 0..count, || false);
            return self.finish(whole, directions);
        }
        let mut whole = self.room(0, count);
        let kernel = self.kernel();
        let part = |first: usize| {
            let end = count.min(first + PART);
            let mut answer = self.room(first, end - first);
            self.part(&kernel, directions, first..end, &mut answer, || false);
            answer
        };
        // A few parts a thread at a time, so that what is not yet in its place stays small.
        let at_once = 8 * PART * threads;
        for first in (0..count).step_by(at_once) {
            let starts: Vec<usize> = (first..count.min(first + at_once)).step_by(PART).collect();
            let parts: Vec<Stretch> = starts.into_par_iter().map(part).collect();
            for part in parts {
                whole.append(part);
            }
        }
        self.finish(whole, directions)
    }

    fn finish(self, whole: Stretch, directions: &Directions) -> Evaluation {
        let parts = whole.into_parts();
        let mut warnings = self.warnings(directions);
        let methods = parts.tally.methods();
        warnings.extend(parts.tally.warnings());
        Evaluation {
            total: parts.total,
            log10_total: parts.log10_total,
            components: parts.components,
            relative_error_bound: parts.relative_error_bound,
            methods,
            method: parts.method,
            roughness_g: parts.roughness_g,
            omitted: self.omitted,
            warnings,
            diagnostics: parts.diagnostics,
        }
    }
}

/// What a direction costs before it is known what it requires, in vectorised exponentials of some 3 ns: good to a factor of
/// two.
pub fn expected_cost(scene: &Scene, output: Output) -> f64 {
    cost::expected(scene, output.log10)
}

/// What the averages of F over the slopes cost before any direction, for so many zeniths of the source, in the same unit.
pub const fn average_cost(sources: usize) -> f64 {
    cost::SLOPE_AVERAGE * sources as f64
}

/// Evaluates a scene in every direction; many directions on all threads of rayon's current pool.
///
/// A direction's answer does not depend on the others.
pub fn evaluate(scene: &Scene, directions: &Directions, quantity: Quantity, output: Output) -> Evaluation {
    Prepared::new(scene, directions, quantity, output, || false).whole(directions)
}

/// Evaluates what is required of a scene.
pub(super) fn evaluate_required(
    scene: &Scene,
    directions: &Directions,
    quantity: Quantity,
    output: Output,
    requirement: Requirement,
) -> Evaluation {
    Prepared::required(scene, directions, quantity, output, requirement, || false).whole(directions)
}
