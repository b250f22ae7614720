//! The columns of a curve: which there are, and their numbers in the same order.

use crate::reflectance::columns::ComponentColumn;
use crate::reflectance::evaluate::{EvaluatedBy, Output, Parts, Quantity, Tally};
use crate::reflectance::findings::Diagnostic;
use crate::reflectance::linear_image::LinearEvaluation;
use crate::reflectance::scene::Component;

/// Name and unit of every column of numbers of a curve with these components.
pub(super) fn headings(
    components: &[Component],
    quantity: Quantity,
    output: Output,
) -> Vec<(&'static str, &'static str)> {
    let mut headings = vec![("total", quantity.unit())];
    headings.extend(components.iter().map(|component| (component.name(), quantity.unit())));
    if output.log10 {
        headings.push(("log10_total", ""));
        headings.extend(components.iter().map(|component| (component.log10_name(), "")));
    }
    headings.push(("relative_error_bound", ""));
    if output.per_direction {
        headings.push(("roughness_g", ""));
    }
    headings
}

/// A stretch by columns.
pub(super) struct Stretch {
    /// In the order of [`headings`].
    pub(super) numbers: Vec<Vec<f64>>,
    /// What evaluated each direction, if asked for.
    pub(super) method: Option<Vec<EvaluatedBy>>,
    /// Whether each direction of a linear model meets the spike exactly.
    pub(super) delta_on: Option<Vec<bool>>,
    pub(super) diagnostics: Vec<Diagnostic>,
    pub(super) tally: Tally,
}

impl Stretch {
    /// Whether a column is the total to the bit, as that of a component is which is alone: it is not written twice.
    pub(super) fn is_total(&self, column: usize) -> bool {
        let [total, other] = [&self.numbers[0], &self.numbers[column]];
        total.len() == other.len() && total.iter().zip(other).all(|(a, b)| a.to_bits() == b.to_bits())
    }
}

/// Totals and components, then their logarithms.
fn numbers(
    total: Vec<f64>,
    log10_total: Option<Vec<f64>>,
    components: Vec<ComponentColumn>,
) -> Vec<Vec<f64>> {
    let mut numbers = vec![total];
    let mut logarithms: Vec<_> = log10_total.into_iter().collect();
    for column in components {
        numbers.push(column.values);
        logarithms.extend(column.log10);
    }
    numbers.append(&mut logarithms);
    numbers
}

impl From<Parts> for Stretch {
    fn from(parts: Parts) -> Self {
        let mut numbers = numbers(parts.total, parts.log10_total, parts.components);
        numbers.push(parts.relative_error_bound);
        numbers.extend(parts.roughness_g);
        let (method, diagnostics, tally) = (parts.method, parts.diagnostics, parts.tally);
        Self { numbers, method, delta_on: None, diagnostics, tally }
    }
}

impl From<LinearEvaluation> for Stretch {
    fn from(evaluation: LinearEvaluation) -> Self {
        let tally = Tally::of(EvaluatedBy::ClosedForm, evaluation.total.len());
        let mut numbers = numbers(evaluation.total, evaluation.log10_total, evaluation.components);
        numbers.push(evaluation.relative_error_bound);
        let (delta_on, diagnostics) = (Some(evaluation.delta_on), evaluation.diagnostics);
        Self { numbers, method: None, delta_on, diagnostics, tally }
    }
}
