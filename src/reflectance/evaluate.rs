//! From a scene and directions to answers: one pass, columns of f64, no allocation per direction.

use super::columns::Columns;
use super::directions::Directions;
use super::findings::{Concern, Diagnostic, DiagnosticCode, Omitted, Warning, WarningCode};
use super::kernel::{Kernel, Reflection};
use super::requirement::Requirement;
use super::scene::Scene;
use super::strain;

pub use super::columns::ComponentColumn;
pub use super::kernel::{EvaluatedBy, Quantity};

/// What to add to the answer.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
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

/// Evaluates a scene in every direction.
pub fn evaluate(scene: &Scene, directions: &Directions, quantity: Quantity, output: Output) -> Evaluation {
    let requirement = Requirement::of(scene, directions);
    let needed = scene.with_only(&requirement.evaluated);
    let kernel = Kernel::new(&needed, quantity);
    let mut answer = Answer::new(&needed, directions.count(), output, requirement.share);
    for (index, geometry) in directions.geometries().enumerate() {
        let reflection = kernel.reflect(&geometry);
        answer.push(index, &reflection);
        if answer.roughness_g.is_some() {
            answer.push_g(index, kernel.g(&geometry));
        }
    }
    let warnings = strain::warnings(scene, &requirement, directions);
    answer.finish(requirement.omitted, warnings)
}

/// The answer while it is being made.
struct Answer<'a> {
    scene: &'a Scene,
    columns: Columns,
    method: Option<Vec<EvaluatedBy>>,
    roughness_g: Option<Vec<f64>>,
    counts: [usize; EvaluatedBy::ALL.len()],
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
            underflow: Concern::default(),
            tolerance: Concern::default(),
        }
    }

    fn push_g(&mut self, index: usize, g: Option<f64>) {
        if let Some(column) = &mut self.roughness_g {
            column.push(g.unwrap_or(f64::NAN));
            if g.is_none() {
                self.columns.diagnostics.push(Diagnostic { index, code: DiagnosticCode::NoRoughness });
            }
        }
    }

    fn push(&mut self, index: usize, reflection: &Reflection) {
        let total = self.columns.push(index, &reflection.components);
        if total.relative_error_bound > self.scene.parameters().accuracy.relative_tolerance.get()
            && total.exact.is_finite()
        {
            self.tolerance.add(index, total.relative_error_bound);
        }
        if total.value.abs() < f64::MIN_POSITIVE && !total.exact.is_zero() {
            self.underflow.add(index, 0.0);
        }
        self.count(reflection.evaluated_by);
    }

    fn count(&mut self, by: EvaluatedBy) {
        for (candidate, count) in EvaluatedBy::ALL.iter().zip(&mut self.counts) {
            *count += usize::from(*candidate == by);
        }
        if let Some(method) = &mut self.method {
            method.push(by);
        }
    }

    fn finish(self, omitted: Vec<Omitted>, mut warnings: Vec<Warning>) -> Evaluation {
        let methods = EvaluatedBy::ALL.into_iter().zip(self.counts).filter(|(_, count)| *count > 0).collect();
        let largest = self.tolerance.largest;
        warnings.extend(
            self.tolerance
                .warning(WarningCode::ToleranceNotMet, largest.is_finite().then_some(largest))
                .into_iter()
                .chain(self.underflow.warning(WarningCode::Underflow, None)),
        );
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
