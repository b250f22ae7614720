//! The answer in consecutive directions, while it is being made and after.

use super::columns::{Columns, ComponentColumn};
use super::evaluate::Output;
use super::findings::{Concern, Diagnostic, DiagnosticCode, Warning, WarningCode};
use super::kernel::{EvaluatedBy, Reflection};
use super::numeric::lobe_series::Method;
use super::scene::{Component, Scene};

/// The answer in some consecutive directions: their numbers, and what is to be said of them.
pub struct Stretch {
    first: usize,
    tolerance: f64,
    is_named: bool,
    pub(super) columns: Columns,
    method: Option<Vec<EvaluatedBy>>,
    roughness_g: Option<Vec<f64>>,
    tally: Tally,
}

/// What is counted over all directions.
#[derive(Debug, Default)]
pub struct Tally {
    counts: [usize; EvaluatedBy::ALL.len()],
    out_of_range: Concern,
    underflow: Concern,
    tolerance: Concern,
}

impl Stretch {
    /// Room for so many directions from `first` on.
    pub(super) fn new(scene: &Scene, first: usize, count: usize, output: Output, omitted_share: f64) -> Self {
        let accuracy = &scene.parameters().accuracy;
        Self {
            first,
            tolerance: accuracy.relative_tolerance.get(),
            is_named: accuracy.method != Method::Auto,
            columns: Columns { omitted_share, ..Columns::new(scene.evaluated(), count, output.log10) },
            method: output.per_direction.then(|| Vec::with_capacity(count)),
            roughness_g: output.per_direction.then(|| Vec::with_capacity(count)),
            tally: Tally::default(),
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
        if total.relative_error_bound > self.tolerance && total.exact.is_finite() {
            self.tally.tolerance.add(index, total.relative_error_bound);
        }
        if total.value.abs() < f64::MIN_POSITIVE && !total.exact.is_zero() {
            self.tally.underflow.add(index, 0.0);
        }
        // Before it is rounded to f64: a value that underflows may be right, and one that overflows has a method, too.
        let error = reflection.total.relative_error();
        if self.is_approximation(reflection.evaluated_by) && error > 1.0 && total.exact.is_finite() {
            self.tally.out_of_range.add(index, error);
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
        let tolerance = self.tolerance;
        let share = self.columns.omitted_share;
        let mut needs_a_word = false;
        for (&value, &bound) in values.iter().zip(bounds) {
            needs_a_word |= (bound + share > tolerance) | (value == 0.0);
        }
        if needs_a_word {
            for (place, (&value, &bound)) in values.iter().zip(bounds).enumerate() {
                let bound = bound + share;
                if bound > tolerance {
                    self.tally.tolerance.add(first + place, bound);
                }
                if value == 0.0 {
                    self.tally.underflow.add(first + place, 0.0);
                }
            }
        }
        (0..values.len()).for_each(|place| self.count(by(place)));
    }

    /// Whether a form was asked for that is right in some range only.
    fn is_approximation(&self, by: EvaluatedBy) -> bool {
        self.is_named
            && match by {
                EvaluatedBy::Lobe(Method::Paper | Method::Uniform | Method::Smooth | Method::Rough) => true,
                EvaluatedBy::Lobe(Method::Auto | Method::Series)
                | EvaluatedBy::ClosedForm
                | EvaluatedBy::ConeQuadrature => false,
            }
    }

    /// The logarithms are asked for.
    pub(super) fn has_logarithms(&self) -> bool {
        self.columns.log10_total.is_some()
    }

    /// Adds the directions that follow these.
    pub(super) fn append(&mut self, next: Self) {
        self.columns.append(next.columns);
        if let (Some(column), Some(mut next)) = (&mut self.method, next.method) {
            column.append(&mut next);
        }
        if let (Some(column), Some(mut next)) = (&mut self.roughness_g, next.roughness_g) {
            column.append(&mut next);
        }
        self.tally.append(&next.tally);
    }

    fn count(&mut self, by: EvaluatedBy) {
        self.tally.counts[by.index()] += 1;
        if let Some(method) = &mut self.method {
            method.push(by);
        }
    }

    /// Its parts; `before` directions stand before those that it was evaluated of.
    pub fn into_parts_after(mut self, before: usize) -> Parts {
        for diagnostic in &mut self.columns.diagnostics {
            diagnostic.index += before;
        }
        for concern in [&mut self.tally.out_of_range, &mut self.tally.underflow, &mut self.tally.tolerance] {
            concern.shift(before);
        }
        self.first += before;
        self.into_parts()
    }

    /// Its parts.
    pub fn into_parts(self) -> Parts {
        let Columns { total, log10_total, components, relative_error_bound, diagnostics, .. } = self.columns;
        Parts {
            first: self.first,
            total,
            log10_total,
            components,
            relative_error_bound,
            method: self.method,
            roughness_g: self.roughness_g,
            diagnostics,
            tally: self.tally,
        }
    }
}

/// A [`Stretch`] taken apart.
pub struct Parts {
    /// The first of its directions, among all.
    pub first: usize,
    /// The sum of the evaluated components.
    pub total: Vec<f64>,
    /// Its decimal logarithm, if asked for.
    pub log10_total: Option<Vec<f64>>,
    /// The evaluated components, in the model's order.
    pub components: Vec<ComponentColumn>,
    /// |total − exact|/exact is not larger, for the numbers as given.
    pub relative_error_bound: Vec<f64>,
    /// The method of each direction, if asked for.
    pub method: Option<Vec<EvaluatedBy>>,
    /// g of (34) for each direction, if asked for.
    pub roughness_g: Option<Vec<f64>>,
    /// Why values are not numbers, in order of directions; indices count among all.
    pub diagnostics: Vec<Diagnostic>,
    /// What is counted.
    pub tally: Tally,
}

impl Tally {
    /// So many directions evaluated in one way, of which there is nothing to be said.
    pub fn of(by: EvaluatedBy, directions: usize) -> Self {
        let mut tally = Self::default();
        tally.counts[by.index()] = directions;
        tally
    }

    /// Adds what was counted in the directions that follow.
    pub fn append(&mut self, next: &Self) {
        for (count, next) in self.counts.iter_mut().zip(next.counts) {
            *count += next;
        }
        self.out_of_range.append(&next.out_of_range);
        self.underflow.append(&next.underflow);
        self.tolerance.append(&next.tolerance);
    }

    /// How many directions each method evaluated; methods that evaluated none are left out.
    pub fn methods(&self) -> Vec<(EvaluatedBy, usize)> {
        EvaluatedBy::ALL.into_iter().zip(self.counts).filter(|(_, count)| *count > 0).collect()
    }

    /// What the caller should know of the values.
    pub fn warnings(self) -> Vec<Warning> {
        let known = |largest: f64| largest.is_finite().then_some(largest);
        let (out_of_range, tolerance) = (known(self.out_of_range.largest), known(self.tolerance.largest));
        let of_values = [
            self.out_of_range.warning(WarningCode::MethodOutOfRange, out_of_range),
            self.tolerance.warning(WarningCode::ToleranceNotMet, tolerance),
            self.underflow.warning(WarningCode::Underflow, None),
        ];
        of_values.into_iter().flatten().collect()
    }
}
