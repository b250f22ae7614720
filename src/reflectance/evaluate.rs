//! From a scene and directions to answers: one pass, columns of f64, no allocation per direction.

use super::block::Block;
use super::columns::Columns;
use super::directions::Directions;
use super::findings::{Concern, Diagnostic, DiagnosticCode, Omitted, Warning, WarningCode};
use super::kernel::{Kernel, Reflection};
use super::numeric::lobe_series::Method;
use super::numeric::lobe_series::lanes::LANES;
use super::requirement::Requirement;
use super::scene::{Component, Scene};
use super::strain;
use rayon::iter::{IntoParallelIterator as _, ParallelIterator as _};

#[cfg(test)]
mod tests;

pub use super::columns::ComponentColumn;
pub use super::kernel::{EvaluatedBy, Quantity};

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

/// Evaluates a scene in every direction; many directions on all threads of rayon's current pool.
///
/// A direction's answer does not depend on the others.
pub fn evaluate(scene: &Scene, directions: &Directions, quantity: Quantity, output: Output) -> Evaluation {
    evaluate_required(scene, directions, quantity, output, Requirement::of(scene, directions))
}

/// Evaluates what is required of a scene.
pub(super) fn evaluate_required(
    scene: &Scene,
    directions: &Directions,
    quantity: Quantity,
    output: Output,
    requirement: Requirement,
) -> Evaluation {
    let Requirement { evaluated, omitted, share, extents } = requirement;
    let needed = scene.with_only(&evaluated);
    let kernel = Kernel::new(&needed, quantity, share);
    let count = directions.count();
    let warnings = strain::warnings(scene, &needed, directions, &extents, &omitted);
    let mut whole = Answer::new(&needed, count, output, share);
    let threads = if count > PART { rayon::current_num_threads() } else { 1 };
    if threads == 1 {
        Block::new().evaluate(&kernel, directions, 0..count, &mut whole);
        return whole.finish(omitted, warnings);
    }
    let part = |block: &mut Block, first: usize| {
        let end = count.min(first + PART);
        let mut answer = Answer::new(&needed, end - first, output, share);
        block.evaluate(&kernel, directions, first..end, &mut answer);
        answer
    };
    // A few parts a thread at a time, so that what is not yet in its place stays small.
    let at_once = 8 * PART * threads;
    for first in (0..count).step_by(at_once) {
        let starts: Vec<usize> = (first..count.min(first + at_once)).step_by(PART).collect();
        let parts: Vec<Answer> = starts.into_par_iter().map_init(Block::new, part).collect();
        for part in parts {
            whole.append(part);
        }
    }
    whole.finish(omitted, warnings)
}

/// The answer while it is being made.
pub(super) struct Answer<'a> {
    scene: &'a Scene,
    columns: Columns,
    method: Option<Vec<EvaluatedBy>>,
    roughness_g: Option<Vec<f64>>,
    counts: [usize; EvaluatedBy::ALL.len()],
    out_of_range: Concern,
    underflow: Concern,
    tolerance: Concern,
}

impl<'a> Answer<'a> {
    fn new(scene: &'a Scene, count: usize, output: Output, omitted_share: f64) -> Self {
        Self {
            scene,
            columns: Columns { omitted_share, ..Columns::new(scene.evaluated(), count, output.log10) },
            method: output.per_direction.then(|| Vec::with_capacity(count)),
            roughness_g: output.per_direction.then(|| Vec::with_capacity(count)),
            counts: [0; EvaluatedBy::ALL.len()],
            out_of_range: Concern::default(),
            underflow: Concern::default(),
            tolerance: Concern::default(),
        }
    }

    /// Whether g is asked for.
    pub(super) fn needs_g(&self) -> bool {
        self.roughness_g.is_some()
    }

    pub(super) fn push_g(&mut self, index: usize, g: Option<f64>) {
        if let Some(column) = &mut self.roughness_g {
            column.push(g.unwrap_or(f64::NAN));
            if g.is_none() {
                self.columns.diagnostics.push(Diagnostic { index, code: DiagnosticCode::NoRoughness });
            }
        }
    }

    pub(super) fn push(&mut self, index: usize, reflection: &Reflection) {
        let total = self.columns.push(index, &reflection.components, reflection.total);
        if total.relative_error_bound > self.scene.parameters().accuracy.relative_tolerance.get()
            && total.exact.is_finite()
        {
            self.tolerance.add(index, total.relative_error_bound);
        }
        if total.value.abs() < f64::MIN_POSITIVE && !total.exact.is_zero() {
            self.underflow.add(index, 0.0);
        }
        // Before it is rounded to f64: a value that underflows may be right, and one that overflows has a method, too.
        let error = reflection.total.relative_error();
        if self.is_approximation(reflection.evaluated_by) && error > 1.0 && total.exact.is_finite() {
            self.out_of_range.add(index, error);
        }
        self.count(reflection.evaluated_by);
    }

    /// Directions none of whose numbers needs a word but totals that are 0 because they underflow; `of` gives each
    /// component's values.
    pub(super) fn extend<'b>(
        &mut self,
        first: usize,
        values: &[f64],
        bounds: &[f64],
        of: impl Fn(Component) -> &'b [f64],
        by: impl Fn(usize) -> EvaluatedBy,
    ) {
        self.columns.extend(values, bounds, of);
        let tolerance = self.scene.parameters().accuracy.relative_tolerance.get();
        let share = self.columns.omitted_share;
        let mut needs_a_word = false;
        for (&value, &bound) in values.iter().zip(bounds) {
            needs_a_word |= (bound + share > tolerance) | (value == 0.0);
        }
        if needs_a_word {
            for (place, (&value, &bound)) in values.iter().zip(bounds).enumerate() {
                let bound = bound + share;
                if bound > tolerance {
                    self.tolerance.add(first + place, bound);
                }
                if value == 0.0 {
                    self.underflow.add(first + place, 0.0);
                }
            }
        }
        (0..values.len()).for_each(|place| self.count(by(place)));
    }

    /// Whether a form was asked for that is right in some range only.
    fn is_approximation(&self, by: EvaluatedBy) -> bool {
        let is_named = self.scene.parameters().accuracy.method != Method::Auto;
        is_named
            && match by {
                EvaluatedBy::Lobe(Method::Paper | Method::Uniform | Method::Smooth | Method::Rough) => true,
                EvaluatedBy::Lobe(Method::Auto | Method::Series) | EvaluatedBy::ClosedForm => false,
            }
    }

    /// The logarithms are asked for.
    pub(super) fn has_logarithms(&self) -> bool {
        self.columns.log10_total.is_some()
    }

    /// The directions that follow these.
    fn append(&mut self, next: Self) {
        self.columns.append(next.columns);
        if let (Some(column), Some(mut next)) = (&mut self.method, next.method) {
            column.append(&mut next);
        }
        if let (Some(column), Some(mut next)) = (&mut self.roughness_g, next.roughness_g) {
            column.append(&mut next);
        }
        for (count, next) in self.counts.iter_mut().zip(next.counts) {
            *count += next;
        }
        self.out_of_range.append(&next.out_of_range);
        self.underflow.append(&next.underflow);
        self.tolerance.append(&next.tolerance);
    }

    fn count(&mut self, by: EvaluatedBy) {
        self.counts[by.index()] += 1;
        if let Some(method) = &mut self.method {
            method.push(by);
        }
    }

    fn finish(self, omitted: Vec<Omitted>, mut warnings: Vec<Warning>) -> Evaluation {
        let methods = EvaluatedBy::ALL.into_iter().zip(self.counts).filter(|(_, count)| *count > 0).collect();
        let known = |largest: f64| largest.is_finite().then_some(largest);
        let (out_of_range, tolerance) = (known(self.out_of_range.largest), known(self.tolerance.largest));
        let of_values = [
            self.out_of_range.warning(WarningCode::MethodOutOfRange, out_of_range),
            self.tolerance.warning(WarningCode::ToleranceNotMet, tolerance),
            self.underflow.warning(WarningCode::Underflow, None),
        ];
        warnings.extend(of_values.into_iter().flatten());
        let Columns { total, log10_total, components, relative_error_bound, diagnostics, .. } = self.columns;
        Evaluation {
            total,
            log10_total,
            components,
            relative_error_bound,
            methods,
            method: self.method,
            roughness_g: self.roughness_g,
            omitted,
            warnings,
            diagnostics,
        }
    }
}
