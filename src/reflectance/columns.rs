//! Columns of answers: components and their sum, direction by direction, each non-number explained.

use super::estimate::Estimate;
use super::findings::{Diagnostic, DiagnosticCode};
use super::numeric::scaled::Scaled;
use super::scene::Component;

/// One component's values.
#[derive(Clone, Debug, PartialEq)]
pub struct ComponentColumn {
    /// Which.
    pub component: Component,
    /// One a direction. Infinities and NaNs are each explained by a diagnostic.
    pub values: Vec<f64>,
    /// Their decimal logarithms, if asked for.
    pub log10: Option<Vec<f64>>,
}

/// The columns while they are being filled.
pub(super) struct Columns {
    pub(super) total: Vec<f64>,
    pub(super) log10_total: Option<Vec<f64>>,
    pub(super) components: Vec<ComponentColumn>,
    pub(super) relative_error_bound: Vec<f64>,
    pub(super) diagnostics: Vec<Diagnostic>,
    /// What the components left out may add to each total, relative; part of its bound.
    pub(super) omitted_share: f64,
}

/// The total of one direction.
pub(super) struct Total {
    /// Before it was rounded to f64.
    pub(super) exact: Scaled,
    /// As answered.
    pub(super) value: f64,
    /// Bound of its relative error.
    pub(super) relative_error_bound: f64,
}

impl Columns {
    /// Room for `count` directions.
    pub(super) fn new(components: &[Component], count: usize, log10: bool) -> Self {
        let column = || Vec::with_capacity(count);
        Self {
            total: column(),
            log10_total: log10.then(column),
            components: components
                .iter()
                .map(|&component| ComponentColumn { component, values: column(), log10: log10.then(column) })
                .collect(),
            relative_error_bound: column(),
            diagnostics: Vec::new(),
            omitted_share: 0.0,
        }
    }

    /// Adds directions in which all is an ordinary number or 0; `of` gives each component's values.
    pub(super) fn extend<'a>(&mut self, values: &[f64], bounds: &[f64], of: impl Fn(Component) -> &'a [f64]) {
        self.total.extend_from_slice(values);
        self.relative_error_bound.extend(bounds.iter().map(|bound| bound + self.omitted_share));
        for column in &mut self.components {
            column.values.extend_from_slice(of(column.component));
        }
    }

    /// Adds the directions that follow these.
    pub(super) fn append(&mut self, mut next: Self) {
        self.total.append(&mut next.total);
        self.relative_error_bound.append(&mut next.relative_error_bound);
        self.diagnostics.append(&mut next.diagnostics);
        if let (Some(column), Some(mut next)) = (&mut self.log10_total, next.log10_total) {
            column.append(&mut next);
        }
        for (column, mut next) in self.components.iter_mut().zip(next.components) {
            column.values.append(&mut next.values);
            if let (Some(column), Some(mut next)) = (&mut column.log10, next.log10) {
                column.append(&mut next);
            }
        }
    }

    /// Adds a direction; `estimates` by [`Component::index`], and their sum.
    pub(super) fn push(&mut self, index: usize, estimates: &[Option<Estimate>; 3], total: Estimate) -> Total {
        let first_diagnostic = self.diagnostics.len();
        let diagnostics = &mut self.diagnostics;
        for column in &mut self.components {
            // Every evaluated component has a value: the scene was checked for what it needs.
            let Some(estimate) = estimates[column.component.index()] else { continue };
            column.values.push(finite(estimate.value, index, first_diagnostic, diagnostics));
            if let Some(log10) = &mut column.log10 {
                log10.push(logarithm(estimate, index, first_diagnostic, diagnostics));
            }
        }
        let value = finite(total.value, index, first_diagnostic, diagnostics);
        if let Some(log10) = &mut self.log10_total {
            log10.push(logarithm(total, index, first_diagnostic, diagnostics));
        }
        let bound = if value == 0.0 {
            // All is lost, or there is nothing: no other error of a 0 is possible.
            if total == Estimate::ZERO { 0.0 } else { 1.0 }
        } else {
            total.relative_error() + rounding_below_normal(total, value) + self.omitted_share
        };
        if !bound.is_finite() && total.value.is_finite() {
            note(index, DiagnosticCode::NoErrorBound, first_diagnostic, diagnostics);
        }
        self.total.push(value);
        self.relative_error_bound.push(bound);
        Total { exact: total.value, value, relative_error_bound: bound }
    }
}

/// What rounding to a subnormal adds to the relative error, which is relative to the exact value.
fn rounding_below_normal(total: Estimate, value: f64) -> f64 {
    if value.abs() >= f64::MIN_POSITIVE || !total.value.is_finite() {
        0.0
    } else {
        (Scaled::new(2f64.powi(-1074)) * 0.5 / total.least).to_f64()
    }
}

/// The f64 of a value, with a diagnostic where it has none.
fn finite(value: Scaled, index: usize, first: usize, diagnostics: &mut Vec<Diagnostic>) -> f64 {
    let number = value.to_f64();
    if !number.is_finite() {
        let code = if value.is_nan() {
            DiagnosticCode::UndefinedLimit
        } else if value.is_finite() {
            DiagnosticCode::Overflow
        } else {
            DiagnosticCode::GrazingDivergence
        };
        note(index, code, first, diagnostics);
    }
    number
}

/// The logarithm of a value, with a diagnostic where it has none.
fn logarithm(estimate: Estimate, index: usize, first: usize, diagnostics: &mut Vec<Diagnostic>) -> f64 {
    if estimate.value.is_zero() {
        let code = if estimate.error.is_zero() {
            DiagnosticCode::LogarithmOfZero
        } else {
            DiagnosticCode::LostToRounding
        };
        note(index, code, first, diagnostics);
    }
    estimate.value.log10()
}

/// Adds a diagnostic of this direction unless it is there already.
fn note(index: usize, code: DiagnosticCode, first: usize, diagnostics: &mut Vec<Diagnostic>) {
    if !diagnostics[first..].iter().any(|d| d.code == code) {
        diagnostics.push(Diagnostic { index, code });
    }
}

#[cfg(test)]
mod tests {
    use super::{Columns, Estimate, Scaled};

    #[test]
    fn a_subnormal_total_is_within_its_bound_of_the_least_that_it_can_be() {
        let smallest = Scaled::new(f64::from_bits(1));
        for (value, least) in [(2.6, 0.4), (1.4, 1.39), (3.5, 0.1), (1000.5, 999.0)] {
            let [value, least] = [value, least].map(|factor: f64| smallest * factor);
            let total = Estimate { value, error: value.distance(least), least };
            let answered = Columns::new(&[], 1, false).push(0, &[None; 3], total);
            let off = Scaled::new(answered.value).distance(least) / least;
            // The bound itself is rounded.
            assert!(off.to_f64() <= answered.relative_error_bound * (1.0 + 1e-15), "{total:?}");
        }
    }
}
