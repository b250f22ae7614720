//! The columns of a curve: which there are, and their numbers in the same order.

use crate::reflectance::evaluate::{EvaluatedBy, Tally};
use crate::reflectance::evaluate::{Output, Parts, Quantity};
use crate::reflectance::findings::Diagnostic;
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
    pub(super) method: Option<Vec<EvaluatedBy>>,
    pub(super) diagnostics: Vec<Diagnostic>,
    pub(super) tally: Tally,
}

impl From<Parts> for Stretch {
    fn from(parts: Parts) -> Self {
        let mut numbers = vec![parts.total];
        let mut logarithms: Vec<_> = parts.log10_total.into_iter().collect();
        for column in parts.components {
            numbers.push(column.values);
            logarithms.extend(column.log10);
        }
        numbers.append(&mut logarithms);
        numbers.push(parts.relative_error_bound);
        numbers.extend(parts.roughness_g);
        Self { numbers, method: parts.method, diagnostics: parts.diagnostics, tally: parts.tally }
    }
}
