//! From a scene and directions to answers: one pass, columns of f64, no allocation per direction.

use super::block::Block;
use super::columns::Columns;
use super::directions::Directions;
use super::findings::{Diagnostic, DiagnosticCode, LISTED_INDICES, Omitted, Warning, WarningCode};
use super::kernel::{Kernel, Reflection};
use super::numeric::lobe_series::lanes::LANES;
use super::scene::{Component, Components, Scene};
use rayon::iter::{IntoParallelIterator as _, ParallelIterator as _};

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

/// Directions that one thread evaluates at a time: some tens of microseconds of work at least.
const PART: usize = 16 * LANES;

/// Evaluates a scene in every direction; many directions on all threads of rayon's current pool.
///
/// A direction's answer does not depend on the others.
pub fn evaluate(scene: &Scene, directions: &Directions, quantity: Quantity, output: Output) -> Evaluation {
    let kernel = Kernel::new(scene, quantity);
    let count = directions.count();
    let part = |block: &mut Block, first: usize| {
        let end = count.min(first + PART);
        let mut answer = Answer::new(scene, end - first, output);
        block.evaluate(&kernel, directions, first..end, &mut answer);
        answer
    };
    if count <= PART {
        return part(&mut Block::new(), 0).finish();
    }
    let mut whole = Answer::new(scene, count, output);
    // A few parts a thread at a time, so that what is not yet in its place stays small.
    let at_once = 4 * PART * rayon::current_num_threads();
    for first in (0..count).step_by(at_once) {
        let starts: Vec<usize> = (first..count.min(first + at_once)).step_by(PART).collect();
        let parts: Vec<Answer> = starts.into_par_iter().map_init(Block::new, part).collect();
        for part in parts {
            whole.append(part);
        }
    }
    whole.finish()
}

/// The answer while it is being made.
pub(super) struct Answer<'a> {
    scene: &'a Scene,
    columns: Columns,
    method: Option<Vec<EvaluatedBy>>,
    roughness_g: Option<Vec<f64>>,
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

    /// Those of the directions that follow.
    fn append(&mut self, next: &Self) {
        let room = LISTED_INDICES - self.indices.len();
        self.indices.extend(next.indices.iter().take(room));
        self.count += next.count;
        self.largest = self.largest.max(next.largest);
    }

    fn warning(self, code: WarningCode, value: Option<f64>) -> Option<Warning> {
        (self.count > 0).then_some(Warning {
            code,
            value,
            parameter: None,
            indices: self.indices,
            count: self.count,
        })
    }
}

impl<'a> Answer<'a> {
    fn new(scene: &'a Scene, count: usize, output: Output) -> Self {
        let p = scene.parameters();
        let lacks_spike = p.components == Components::Auto
            && p.model.components().contains(&Component::SpecularSpike)
            && !scene.evaluated().contains(&Component::SpecularSpike);
        Self {
            scene,
            columns: Columns::new(scene.evaluated(), count, output.log10),
            method: output.per_direction.then(|| Vec::with_capacity(count)),
            roughness_g: output.per_direction.then(|| Vec::with_capacity(count)),
            counts: [0; EvaluatedBy::ALL.len()],
            underflow: Concern::default(),
            tolerance: Concern::default(),
            least_g: None,
            lacks_spike,
        }
    }

    /// Whether g is asked for, or tells how much the omitted spike carries.
    pub(super) fn needs_g(&self) -> bool {
        self.roughness_g.is_some() || self.lacks_spike
    }

    pub(super) fn push_g(&mut self, index: usize, g: Option<f64>) {
        if let Some(g) = g {
            self.least_g = Some(self.least_g.map_or(g, |least| least.min(g)));
        }
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
        self.count(reflection.evaluated_by);
    }

    /// Directions in which one component is all there is; none of the numbers needs a word but those that are 0
    /// because they underflow.
    pub(super) fn extend(
        &mut self,
        first: usize,
        values: &[f64],
        bounds: &[f64],
        by: impl Fn(usize) -> EvaluatedBy,
    ) {
        self.columns.extend(values, bounds);
        let tolerance = self.scene.parameters().accuracy.relative_tolerance.get();
        let (mut largest, mut least) = (0.0, f64::MAX);
        for (&value, &bound) in values.iter().zip(bounds) {
            largest = if bound > largest { bound } else { largest };
            least = if value < least { value } else { least };
        }
        if largest > tolerance || least == 0.0 {
            for (place, (&value, &bound)) in values.iter().zip(bounds).enumerate() {
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
        self.underflow.append(&next.underflow);
        self.tolerance.append(&next.tolerance);
        self.least_g = self.least_g.into_iter().chain(next.least_g).reduce(f64::min);
    }

    fn count(&mut self, by: EvaluatedBy) {
        self.counts[by.index()] += 1;
        if let Some(method) = &mut self.method {
            method.push(by);
        }
    }

    fn finish(self) -> Evaluation {
        let (mut omitted, mut warnings) = (Vec::new(), Vec::new());
        let methods = EvaluatedBy::ALL.into_iter().zip(self.counts).filter(|(_, count)| *count > 0).collect();
        let p = self.scene.parameters();
        if self.lacks_spike {
            omitted.push(Omitted {
                component: Component::SpecularSpike,
                bound: None,
                reason: "the specular spike depends on the sensor's footprint and none was given",
            });
            let share = self.least_g.map(|g| libm::exp(-g));
            if share.is_none_or(|share| share > p.accuracy.relative_tolerance.get()) {
                warnings.push(Warning::of_scene(WarningCode::SpikeWithoutSensor, share, None));
            }
        }
        let unused = self.scene.unused().into_iter();
        warnings
            .extend(unused.map(|name| Warning::of_scene(WarningCode::ParameterNotUsed, None, Some(name))));
        let largest = self.tolerance.largest;
        warnings.extend(
            self.tolerance
                .warning(WarningCode::ToleranceNotMet, largest.is_finite().then_some(largest))
                .into_iter()
                .chain(self.underflow.warning(WarningCode::Underflow, None)),
        );
        let Columns { total, log10_total, components, relative_error_bound, diagnostics } = self.columns;
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
