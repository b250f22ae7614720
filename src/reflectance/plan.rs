//! What a scene requires: regime, components, methods, cost and strained assumptions, before it is evaluated.
//!
//! Which components are needed and which assumptions are strained holds in every direction. What depends on values, the method of
//! the series, its bound and its cost, is looked up in some directions only, equally spaced along the request.

use super::cost::{self, Lobe};
use super::directions::{Directions, Extents};
use super::evaluate::{EvaluatedBy, Evaluation, Output, Quantity, evaluate_required};
use super::findings::{Omitted, Warning};
use super::numeric::lobe_series::{self, Method};
use super::region::Region;
use super::requirement::Requirement;
use super::scene::{Component, Model, Scene};
use super::strain;
use super::surface::Regime;
use core::f64::consts::PI;

/// Directions that are looked at one by one.
pub const MOST_SAMPLED: usize = 1024;
/// The same of a receiver of finite size, each of whose directions takes as long as a thousand.
pub const MOST_RECEIVED: usize = 16;
/// Ranges of one method that are listed.
pub const MOST_RANGES: usize = 64;

/// What a scene requires in some directions.
#[derive(Clone, Debug, PartialEq)]
pub struct Plan {
    /// N.
    pub directions: usize,
    /// How many of them were looked at one by one: all up to [`MOST_SAMPLED`], or [`MOST_RECEIVED`], else so many from the first to the last, equally
    /// spaced.
    pub sampled: usize,
    /// g of (34) is between these in every direction; none for a scene without heights or wavelength.
    pub roughness_g: Option<[f64; 2]>,
    /// The regimes of both.
    pub regimes: Option<[Regime; 2]>,
    /// The components to evaluate, in the model's order.
    pub needed: Vec<Component>,
    /// The others.
    pub omitted: Vec<Omitted>,
    /// By how many of the sampled directions each method would be used.
    pub methods: Vec<(EvaluatedBy, usize)>,
    /// Runs of one method along the sampled directions; none if there are more than [`MOST_RANGES`].
    pub ranges: Option<Vec<MethodRange>>,
    /// The largest bound of a total's relative error among the sampled directions.
    pub largest_bound: f64,
    /// Predicted.
    pub cost: Cost,
    /// As an evaluation has them. What depends on values is from the sampled directions.
    pub warnings: Vec<Warning>,
}

/// Neighbouring sampled directions that one method evaluates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MethodRange {
    /// Which.
    pub by: EvaluatedBy,
    /// Index of the first direction.
    pub first: usize,
    /// Index of the last sampled one.
    pub last: usize,
}

/// Predicted cost, in vectorised exponentials: see `cost.rs`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cost {
    /// Of one direction, on the average.
    pub per_direction: f64,
    /// The same if every component were evaluated, the lobe of (47) by its sum.
    pub full: f64,
}

impl Cost {
    /// Over the full series.
    pub fn relative(&self) -> f64 {
        self.per_direction / self.full
    }
}

impl Plan {
    /// Of a scene in these directions.
    pub fn of(scene: &Scene, directions: &Directions) -> Self {
        let requirement = Requirement::of(scene, directions);
        let needed = scene.with_only(&requirement.evaluated);
        let count = directions.count();
        let most = if scene.parameters().receiver.is_some() { MOST_RECEIVED } else { MOST_SAMPLED };
        let indices = sample(count, most);
        let sampled = directions.select(&indices);
        let output = Output { log10: false, per_direction: true };
        let evaluation = evaluate_required(scene, &sampled, Quantity::Radiance, output, requirement.clone());
        let by = evaluation.method.as_deref().unwrap_or_default();
        let roughness_g = g_extremes(scene, &requirement.extents);
        let mut warnings =
            strain::warnings(scene, &needed, directions, &requirement.extents, &requirement.omitted);
        warnings.extend(of_values(&evaluation, &indices));
        let finite = evaluation
            .relative_error_bound
            .iter()
            .zip(&evaluation.total)
            .filter(|(_, total)| total.is_finite());
        Self {
            directions: count,
            sampled: indices.len(),
            roughness_g,
            regimes: roughness_g.map(|extremes| extremes.map(Regime::of)),
            methods: evaluation.methods.clone(),
            ranges: ranges(by, &indices),
            largest_bound: finite.map(|(bound, _)| *bound).reduce(f64::max).unwrap_or(f64::INFINITY),
            cost: predicted(scene, &needed, &sampled, by),
            needed: requirement.evaluated,
            omitted: requirement.omitted,
            warnings,
        }
    }
}

/// The directions to look at.
fn sample(count: usize, most: usize) -> Vec<usize> {
    let sampled = count.min(most);
    let last = (sampled - 1).max(1);
    (0..sampled).map(|place| place * (count - 1) / last).collect()
}

/// g over all directions, or beyond.
fn g_extremes(scene: &Scene, extents: &Extents) -> Option<[f64; 2]> {
    let roughness = scene.relative_roughness()?;
    let cos_sum = Region::new(extents, None).cos_sum;
    Some([cos_sum.least, cos_sum.most].map(|cos_sum| {
        let root = 2.0 * PI * roughness.height * cos_sum;
        root * root
    }))
}

/// Runs of one method.
fn ranges(by: &[EvaluatedBy], indices: &[usize]) -> Option<Vec<MethodRange>> {
    let mut ranges: Vec<MethodRange> = Vec::new();
    for (&by, &index) in by.iter().zip(indices) {
        match ranges.last_mut().filter(|range| range.by == by) {
            Some(range) => range.last = index,
            None => ranges.push(MethodRange { by, first: index, last: index }),
        }
        if ranges.len() > MOST_RANGES {
            return None;
        }
    }
    Some(ranges)
}

/// The warnings that an evaluation of the sample adds, about the request's own directions.
fn of_values(evaluation: &Evaluation, indices: &[usize]) -> impl Iterator<Item = Warning> {
    evaluation.warnings.iter().filter(|warning| warning.code.depends_on_values()).map(|warning| Warning {
        indices: warning.indices.iter().map(|&place| indices[place]).collect(),
        ..warning.clone()
    })
}

/// The mean over the sampled directions.
fn predicted(scene: &Scene, needed: &Scene, sampled: &Directions, by: &[EvaluatedBy]) -> Cost {
    let heights =
        scene.relative_roughness().filter(|_| scene.parameters().model == Model::BeckmannSpizzichino);
    let mut cost = Cost { per_direction: 0.0, full: 0.0 };
    for (geometry, &by) in sampled.geometries().zip(by) {
        let lobe = heights.map(|roughness| {
            let (g, x) = (roughness.g(&geometry), roughness.x(&geometry));
            let variance = if g == 0.0 { 0.0 } else { lobe_series::variance(g, x) };
            // A lobe that is left out still counts in the full cost.
            let by = if by == EvaluatedBy::ClosedForm { EvaluatedBy::Lobe(Method::Series) } else { by };
            Lobe { by, variance }
        });
        cost.per_direction += cost::direction(needed, needed.evaluated(), lobe);
        cost.full += cost::full(scene, scene.evaluated(), lobe);
    }
    let count = by.len().max(1) as f64;
    Cost { per_direction: cost.per_direction / count, full: cost.full / count }
}
