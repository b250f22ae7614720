//! Tabulated answers: what the encoders of the service write, whatever made the numbers.

use super::evaluate::{EvaluatedBy, Evaluation};
use super::findings::{Diagnostic, Omitted, Warning};

/// Values along one axis.
#[derive(Clone, Debug, PartialEq)]
pub struct Column {
    /// Name in requests and answers.
    pub name: &'static str,
    /// Unit; the empty string for a pure number.
    pub unit: &'static str,
    /// NaN and infinities are explained by a diagnostic of the curve.
    pub values: Vec<f64>,
}

/// One curve of a diagram: its columns are as long as the axis.
#[derive(Clone, Debug, PartialEq)]
pub struct Curve {
    /// What tells it from its neighbours besides the fixed angle.
    pub label: String,
    /// The fixed angle, degrees.
    pub at_deg: Option<f64>,
    /// The total first, its components, their logarithms, the error bound, and g if asked for.
    pub columns: Vec<Column>,
    /// What evaluated each point, if asked for.
    pub method: Option<Vec<EvaluatedBy>>,
    /// How many points each method evaluated.
    pub methods: Vec<(EvaluatedBy, usize)>,
    /// Components left out, and why.
    pub omitted: Vec<Omitted>,
    /// What the caller should know of the curve.
    pub warnings: Vec<Warning>,
    /// Why values are not numbers; indices count along the axis.
    pub diagnostics: Vec<Diagnostic>,
}

/// Curves over one axis.
#[derive(Clone, Debug, PartialEq)]
pub struct Table {
    /// `radiance`, `brdf`, …
    pub quantity: &'static str,
    /// Unit of the quantity.
    pub unit: &'static str,
    /// The swept angle.
    pub axis: Column,
    /// Name of the fixed angle.
    pub fixed: Option<&'static str>,
    /// Azimuth of the viewer, the same for all curves.
    pub phi_r_deg: f64,
    /// One for each fixed angle.
    pub curves: Vec<Curve>,
}

impl Curve {
    /// The curve that an evaluation along an axis makes.
    pub(super) fn of(evaluation: Evaluation, label: String, at_deg: f64, unit: &'static str) -> Self {
        let mut columns = vec![Column { name: "total", unit, values: evaluation.total }];
        let mut logarithms = Vec::new();
        if let Some(values) = evaluation.log10_total {
            logarithms.push(Column { name: "log10_total", unit: "", values });
        }
        for column in evaluation.components {
            columns.push(Column { name: column.component.name(), unit, values: column.values });
            if let Some(values) = column.log10 {
                logarithms.push(Column { name: column.component.log10_name(), unit: "", values });
            }
        }
        columns.append(&mut logarithms);
        columns.push(Column {
            name: "relative_error_bound",
            unit: "",
            values: evaluation.relative_error_bound,
        });
        if let Some(values) = evaluation.roughness_g {
            columns.push(Column { name: "roughness_g", unit: "", values });
        }
        Self {
            label,
            at_deg: Some(at_deg),
            columns,
            method: evaluation.method,
            methods: evaluation.methods,
            omitted: evaluation.omitted,
            warnings: evaluation.warnings,
            diagnostics: evaluation.diagnostics,
        }
    }

    /// A curve of one plain column.
    pub(super) fn plain(label: String, at_deg: Option<f64>, column: Column) -> Self {
        Self {
            label,
            at_deg,
            columns: vec![column],
            method: None,
            methods: Vec::new(),
            omitted: Vec::new(),
            warnings: Vec::new(),
            diagnostics: Vec::new(),
        }
    }
}
