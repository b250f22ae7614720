//! From a scene and directions to answers: one pass, columns of f64, no allocation per direction.

use super::directions::Directions;
use super::estimate::Estimate;
use super::findings::{Diagnostic, DiagnosticCode, LISTED_INDICES, Omitted, Warning, WarningCode};
use super::kernel::{Kernel, Reflection};
use super::numeric::EPSILON;
use super::numeric::scaled::Scaled;
use super::scene::{Component, Components, Model, Scene};

pub use super::kernel::{EvaluatedBy, Quantity};

/// What to add to the answer.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Output {
    /// Decimal logarithms of total and components, right also where the value underflows.
    pub log10: bool,
    /// Method and g of each direction.
    pub per_direction: bool,
}

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
    /// g of (34) for each direction, if asked for and the surface has heights.
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
    let kernel = Kernel::new(scene, quantity);
    let mut answer = Answer::new(scene, directions.count(), output);
    for (index, geometry) in directions.geometries().enumerate() {
        let reflection = kernel.reflect(&geometry);
        answer.push(index, &reflection);
        if output.per_direction || !answer.spike_share_known() {
            answer.push_g(kernel.g(&geometry));
        }
    }
    answer.finish()
}

/// The answer while it is being made.
struct Answer<'a> {
    scene: &'a Scene,
    evaluation: Evaluation,
    counts: [usize; EvaluatedBy::ALL.len()],
    underflow: Concern,
    tolerance: Concern,
    /// min g over the directions, while the spike is left out.
    least_g: Option<f64>,
    lacks_spike: bool,
}

/// Directions that a warning is about, and the largest value seen.
#[derive(Default)]
struct Concern {
    indices: Vec<usize>,
    count: usize,
    largest: f64,
}

impl Concern {
    fn add(&mut self, index: usize, value: f64) {
        if self.indices.len() < LISTED_INDICES {
            self.indices.push(index);
        }
        self.count += 1;
        self.largest = self.largest.max(value);
    }

    fn warning(self, code: WarningCode, value: Option<f64>) -> Option<Warning> {
        (self.count > 0).then_some(Warning { code, value, indices: self.indices, count: self.count })
    }
}

impl<'a> Answer<'a> {
    fn new(scene: &'a Scene, count: usize, output: Output) -> Self {
        let column = || Vec::with_capacity(count);
        let components = scene
            .evaluated()
            .iter()
            .map(|&component| ComponentColumn {
                component,
                values: column(),
                log10: output.log10.then(column),
            })
            .collect();
        let p = scene.parameters();
        let has_heights = p.surface.rms_height.is_some() && p.illumination.wavelength.is_some();
        let lacks_spike = p.components == Components::Auto
            && p.model.components().contains(&Component::SpecularSpike)
            && !scene.evaluated().contains(&Component::SpecularSpike);
        Self {
            scene,
            evaluation: Evaluation {
                total: column(),
                log10_total: output.log10.then(column),
                components,
                relative_error_bound: column(),
                methods: Vec::new(),
                method: output.per_direction.then(|| Vec::with_capacity(count)),
                roughness_g: (output.per_direction && has_heights).then(column),
                omitted: Vec::new(),
                warnings: Vec::new(),
                diagnostics: Vec::new(),
            },
            counts: [0; EvaluatedBy::ALL.len()],
            underflow: Concern::default(),
            tolerance: Concern::default(),
            least_g: None,
            lacks_spike,
        }
    }

    /// Whether g is of no use to the omitted spike.
    fn spike_share_known(&self) -> bool {
        !self.lacks_spike
    }

    fn push_g(&mut self, g: Option<f64>) {
        let Some(g) = g else { return };
        self.least_g = Some(self.least_g.map_or(g, |least| least.min(g)));
        if let Some(column) = &mut self.evaluation.roughness_g {
            column.push(g);
        }
    }

    fn push(&mut self, index: usize, reflection: &Reflection) {
        let first_diagnostic = self.evaluation.diagnostics.len();
        let mut total = Estimate::ZERO;
        for column in &mut self.evaluation.components {
            // Every evaluated component has a value: the scene was checked for what it needs.
            let Some(estimate) = reflection.components[column.component.index()] else { continue };
            total = total.plus(estimate);
            let diagnostics = &mut self.evaluation.diagnostics;
            column.values.push(finite(estimate.value, index, first_diagnostic, diagnostics));
            if let Some(log10) = &mut column.log10 {
                log10.push(logarithm(estimate.value, index, first_diagnostic, diagnostics));
            }
        }
        let diagnostics = &mut self.evaluation.diagnostics;
        let value = finite(total.value, index, first_diagnostic, diagnostics);
        if let Some(log10) = &mut self.evaluation.log10_total {
            log10.push(logarithm(total.value, index, first_diagnostic, diagnostics));
        }
        // Sums of three components and the rounding of the total itself.
        let model_bound = total.relative_error() + if total.error.is_zero() { 0.0 } else { 4.0 * EPSILON };
        let bound = model_bound + rounding_below_normal(total.value, value);
        if model_bound > self.scene.parameters().accuracy.relative_tolerance.get() && total.value.is_finite()
        {
            self.tolerance.add(index, model_bound);
        }
        if value.abs() < f64::MIN_POSITIVE && !total.value.is_zero() {
            self.underflow.add(index, 0.0);
        }
        if !bound.is_finite() && total.value.is_finite() {
            note(index, DiagnosticCode::NoErrorBound, first_diagnostic, diagnostics);
        }
        self.evaluation.total.push(value);
        self.evaluation.relative_error_bound.push(bound);
        self.count(reflection.evaluated_by);
    }

    fn count(&mut self, by: EvaluatedBy) {
        for (candidate, count) in EvaluatedBy::ALL.iter().zip(&mut self.counts) {
            *count += usize::from(*candidate == by);
        }
        if let Some(method) = &mut self.evaluation.method {
            method.push(by);
        }
    }

    fn finish(mut self) -> Evaluation {
        self.evaluation.methods =
            EvaluatedBy::ALL.into_iter().zip(self.counts).filter(|(_, count)| *count > 0).collect();
        let p = self.scene.parameters();
        if self.lacks_spike {
            self.evaluation.omitted.push(Omitted {
                component: Component::SpecularSpike,
                bound: None,
                reason: "the specular spike depends on the sensor's footprint and none was given",
            });
            let share = libm::exp(-self.least_g.unwrap_or(0.0));
            if share > p.accuracy.relative_tolerance.get() {
                self.evaluation.warnings.push(Warning {
                    code: WarningCode::SpikeWithoutSensor,
                    value: Some(share),
                    indices: Vec::new(),
                    count: 0,
                });
            }
        }
        if p.model == Model::BeckmannSpizzichino && p.surface.diffuse_albedo.get() > 0.0 {
            self.evaluation.warnings.push(Warning {
                code: WarningCode::ParameterNotUsed,
                value: Some(p.surface.diffuse_albedo.get()),
                indices: Vec::new(),
                count: 0,
            });
        }
        let largest = self.tolerance.largest;
        self.evaluation.warnings.extend(
            self.tolerance
                .warning(WarningCode::ToleranceNotMet, largest.is_finite().then_some(largest))
                .into_iter()
                .chain(self.underflow.warning(WarningCode::Underflow, None)),
        );
        self.evaluation
    }
}

/// What rounding to a subnormal or to 0 adds to the relative error; 1 where all is lost.
fn rounding_below_normal(exact: Scaled, value: f64) -> f64 {
    if value.abs() >= f64::MIN_POSITIVE || exact.is_zero() || !exact.is_finite() {
        0.0
    } else if value == 0.0 {
        1.0
    } else {
        (Scaled::new(2f64.powi(-1074)) * 0.5 / exact).to_f64()
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
fn logarithm(value: Scaled, index: usize, first: usize, diagnostics: &mut Vec<Diagnostic>) -> f64 {
    if value.is_zero() {
        note(index, DiagnosticCode::LogarithmOfZero, first, diagnostics);
    }
    value.log10()
}

/// Adds a diagnostic of this direction unless it is there already.
fn note(index: usize, code: DiagnosticCode, first: usize, diagnostics: &mut Vec<Diagnostic>) {
    if !diagnostics[first..].iter().any(|d| d.code == code) {
        diagnostics.push(Diagnostic { index, code });
    }
}
