//! What a receiver of finite size reads: the mean over a cone of viewers.
//!
//! A receiver that sees the patch under the half angle β collects ∫ L_r cos θ_r dω over its cone, times the patch. Divided by
//! ∫ cos θ_r dω, the projected solid angle, that is the radiance (or BRDF) that it reports; of the cone what is above the horizon
//! counts. The diffuse lobe is the same from everywhere. The spike is taken as sharp, the patch being large against the
//! wavelength: all of F′ e^{−g} goes in the mirror direction, and the receiver reads it whole or not at all. The specular lobe is
//! integrated, to the tolerance.

mod cone;
mod folds;
#[cfg(test)]
mod tests;

use super::degrees::{SinCos, to_radians};
use super::directions::Directions;
use super::estimate::Estimate;
use super::evaluate::{EvaluatedBy, Quantity, Stretch};
use super::fresnel::Medium;
use super::kernel::{Kernel, Reflection};
use super::numeric::EPSILON;
use super::numeric::cubature::{self, Goal, Grid, NODES};
use super::numeric::dispatch::InstructionSet;
use super::numeric::lobe_series::LobeSeries;
use super::numeric::lobe_series::lanes::{self, Batch, LANES};
use super::numeric::scaled::Scaled;
use super::quantity::{Quantity as _, ReceiverHalfAngle, Tolerance};
use super::scene::{Accuracy, Component, Scene};
use super::shadowing::ShadowingFunction;
use super::unified;
use cone::{Cone, Viewer};
use core::f64::consts::PI;
use core::ops::Range;
use folds::Folds;

/// Rectangles of a rule at most: up to a quarter of a second.
const MOST_RECTANGLES: usize = 1000;
/// The error stated is so many times what the rule says.
const CAUTION: f64 = 4.0;
/// What a rule may overlook, of the whole, of a fold that keeps its distance all around: it may lie before the first point of all
/// rays, 0.0043 of their length, half of whose square it changes at most, times the slope's.
const OVERLOOKED: f64 = 5e-5;
/// Of the tolerance, what the lobe may be off at each viewer. The rule counts it twice and has what is left.
const SHARE_OF_VIEWERS: f64 = 0.02;
/// Rounding of a viewer's place and of what surrounds the lobe there, in ε, and for each power of e by which the lobe falls.
const VIEWER_UNITS: f64 = 64.0;
const FALL_UNITS: f64 = 64.0;
/// Rounding of g at the mirror direction in ε.
const G_UNITS: f64 = 16.0;

/// A scene seen by a receiver of finite size.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Receiver {
    half_angle: ReceiverHalfAngle,
    /// The scene to the accuracy that viewers need.
    scene: Scene,
    /// Of the mean's lobe.
    tolerance: f64,
}

/// Room for the lobe's series at the points of one rule.
struct Nodes {
    viewers: Vec<Option<Viewer>>,
    series: Vec<Option<LobeSeries>>,
    batch: Batch,
}

impl Receiver {
    /// Of a scene, if it has one that is not a point; components that are left out add a share to what it reads.
    pub(super) fn of(scene: &Scene, omitted_share: f64) -> Option<Self> {
        let half_angle = scene.parameters().receiver?;
        let accuracy = scene.parameters().accuracy;
        let tolerance = accuracy.relative_tolerance.get() - omitted_share;
        let of_viewers = Tolerance::new(SHARE_OF_VIEWERS * tolerance).unwrap_or(Tolerance::FINEST);
        Some(Self {
            half_angle,
            scene: scene.with_accuracy(Accuracy { relative_tolerance: of_viewers, ..accuracy }),
            tolerance: 0.75 * tolerance,
        })
    }

    /// The scene that its kernel is made of.
    pub(super) fn scene(&self) -> &Scene {
        &self.scene
    }

    /// Adds directions of its axis to an answer, until `is_over` says to stop.
    pub(super) fn evaluate(
        &self,
        kernel: &Kernel<'_>,
        directions: &Directions,
        range: Range<usize>,
        answer: &mut Stretch,
        is_over: impl Fn() -> bool,
    ) {
        for index in range {
            let Some(reflection) = self.mean(kernel, directions, index, &is_over) else { return };
            answer.push(index, &reflection);
            if answer.needs_g() {
                answer.push_g(index, kernel.g(&directions.geometry(index)));
            }
        }
    }

    /// What it reads around one direction; none as soon as `is_over` says so.
    fn mean(
        &self,
        kernel: &Kernel<'_>,
        directions: &Directions,
        index: usize,
        is_over: impl Fn() -> bool,
    ) -> Option<Reflection> {
        let (theta_i, ..) = directions.angles(index);
        let source = SinCos::of_degrees(theta_i.get());
        let slope = self.slope(source);
        let cone = Cone::new(directions.angles(index), self.half_angle, slope);
        let (projected, rounding) = cone.projected();
        let over = Estimate::within(Scaled::ONE / projected, rounding + 4.0 * EPSILON);
        let mut components = [None; 3];
        let mut evaluated_by = EvaluatedBy::ClosedForm;
        for &component in self.scene.evaluated() {
            components[component.index()] = match component {
                Component::DiffuseLobe => Some(kernel.diffuse_lobe(&directions.geometry(index))),
                Component::SpecularSpike => self.spike(kernel, &cone, source).map(|spike| spike.times(over)),
                Component::SpecularLobe => None,
            };
        }
        if self.scene.evaluated().contains(&Component::SpecularLobe) {
            evaluated_by = EvaluatedBy::ConeQuadrature;
            let beside = Estimate::total(&components).value * projected;
            let sum = self.integral(kernel, &cone, slope, beside, MOST_RECTANGLES, is_over)?;
            components[Component::SpecularLobe.index()] = Some(sum.times(over));
        }
        Some(Reflection { total: Estimate::total(&components), components, evaluated_by })
    }

    /// Where the lobe is folded: by G of (65), and where n < 1 begins to reflect all.
    fn folds(&self) -> Folds {
        let critical = match self.scene.parameters().surface.medium {
            // More absorption rounds the corner off.
            Medium::Index(index) if index.n.get() < 1.0 && index.k.get() < 0.5 => {
                Some((1.0 - index.n.get()) * (1.0 + index.n.get()))
            }
            Medium::Index(_) | Medium::PerfectConductor => None,
        };
        Folds { grooves: self.scene.shadowing_function() == ShadowingFunction::VGroove, critical }
    }

    /// tan α of the facets that make the lobe, about.
    fn slope(&self, source: SinCos) -> f64 {
        match (&self.scene.facets, self.scene.relative_roughness()) {
            (Some(facets), _) => libm::tan(facets.sigma_alpha.min(0.785)),
            (None, Some(roughness)) => roughness.facet_width(source.cos),
            (None, None) => 1.0,
        }
    }

    /// ∫ L cos θ_r dω of the spike: F′ e^{−g} of what arrives.
    fn spike(&self, kernel: &Kernel<'_>, cone: &Cone, source: SinCos) -> Option<Estimate> {
        let holds = cone.holds_mirror();
        if holds == Some(false) {
            return Some(Estimate::ZERO);
        }
        let p = self.scene.parameters();
        let roughness = self.scene.relative_roughness()?;
        let g = unified::mirror_g(roughness.height, 1.0, source.cos);
        let share = Estimate::within(Scaled::exp(-g), EPSILON * (4.0 + G_UNITS * g));
        let plate = p.surface.medium.reflectance(source, p.illumination.polarization);
        let arrives = match kernel.quantity() {
            Quantity::Brdf => Scaled::ONE,
            Quantity::Radiance => Scaled::new(source.cos) * p.illumination.irradiance.get(),
            Quantity::ImageIrradiance { factor } => {
                Scaled::new(source.cos) * p.illumination.irradiance.get() * factor
            }
        };
        let whole = share.times(plate.into()).scaled_by(arrives).widened(32.0 * EPSILON);
        Some(match holds {
            Some(_) => whole,
            // On the rim as far as can be told.
            None => Estimate { error: whole.value + whole.error, least: Scaled::ZERO, ..whole },
        })
    }

    /// ∫ L cos θ_r dω of the lobe, to a tolerance of it and what is `beside` it.
    fn integral(
        &self,
        kernel: &Kernel<'_>,
        cone: &Cone,
        slope: f64,
        beside: Scaled,
        most_rectangles: usize,
        is_over: impl Fn() -> bool,
    ) -> Option<Estimate> {
        // Values in units of about what is most of it, so that none of those that matter underflows.
        let nearest = cone.nearest();
        let most = kernel.lobe(&nearest, None).map_or(Scaled::ZERO, |most| most.value * nearest.cos_r);
        let unit = if most.is_zero() || !most.is_finite() { Scaled::ONE } else { most };
        let is_folded = cone.has(self.folds());
        let overlooked = if is_folded && cone.is_even() { OVERLOOKED } else { 0.0 };
        let mut nodes = Nodes::new();
        let goal = Goal {
            tolerance: self.tolerance / CAUTION,
            beside: (beside / unit).to_f64(),
            most: most_rectangles,
            has_kinks: is_folded,
        };
        let fill = |square: usize, grid: &mut Grid| nodes.fill(kernel, cone, square, unit, grid);
        let sum = cubature::integrate(cone.squares(), goal, is_over, fill)?;
        if !sum.value.is_finite() {
            return Some(if sum.value.is_nan() { Estimate::UNDEFINED } else { Estimate::INFINITE });
        }
        if sum.value == 0.0 && !most.is_zero() {
            // All of it is in a rim too thin for any point of the rule.
            return Some(Estimate { value: Scaled::ZERO, error: unit * PI, least: Scaled::ZERO });
        }
        let error = CAUTION * sum.error + (cone.rim(slope) + overlooked) * sum.value;
        let least = Scaled::new((sum.value - error).max(0.0));
        let whole = Estimate { value: Scaled::new(sum.value), error: Scaled::new(error), least };
        Some(whole.scaled_by(unit))
    }
}

impl Nodes {
    fn new() -> Self {
        let count = NODES * NODES;
        Self { viewers: Vec::with_capacity(count), series: Vec::with_capacity(count), batch: Batch::new() }
    }

    fn fill(&mut self, kernel: &Kernel<'_>, cone: &Cone, square: usize, unit: Scaled, grid: &mut Grid) {
        self.viewers.clear();
        for &first in &grid.first {
            let ray = cone.ray(square, first);
            self.viewers.extend(grid.second.iter().map(|&second| cone.viewer(&ray, second)));
        }
        self.expand(kernel);
        for (place, viewer) in self.viewers.iter().enumerate() {
            let (value, error) = viewer.map_or((0.0, 0.0), |viewer| {
                let lobe = kernel.lobe(&viewer.geometry, self.series[place]).unwrap_or(Estimate::UNDEFINED);
                sent(lobe, unit, viewer.measure)
            });
            grid.values[place / NODES][place % NODES] = value;
            grid.errors[place / NODES][place % NODES] = error;
        }
    }

    /// The lobe series of the viewers, where it is evaluated many points at once.
    fn expand(&mut self, kernel: &Kernel<'_>) {
        self.series.clear();
        let Some((roughness, choice)) = kernel.series() else {
            self.series.resize(self.viewers.len(), None);
            return;
        };
        for viewers in self.viewers.chunks(LANES) {
            let (mut g, mut x) = ([1.0; LANES], [1.0; LANES]);
            for (place, viewer) in viewers.iter().enumerate() {
                if let Some(viewer) = viewer {
                    (g[place], x[place]) = (roughness.g(&viewer.geometry), roughness.x(&viewer.geometry));
                }
            }
            let count = viewers.len();
            lanes::evaluate(InstructionSet::widest(), choice, &g[..count], &x[..count], &mut self.batch);
            self.series.extend((0..count).map(|place| self.batch.get(place)));
        }
    }
}

/// What a viewer's share of the cone sends, and the bound of its error.
fn sent(lobe: Estimate, unit: Scaled, measure: f64) -> (f64, f64) {
    let relative = lobe.value / unit;
    let value = relative.to_f64() * measure;
    if value == 0.0 {
        return (0.0, (lobe.error / unit).to_f64() * measure);
    }
    // A place that is off by ε changes what falls off as e^{−x} by a few x ε.
    let fall = relative.ln().abs();
    let rounding = EPSILON * (VIEWER_UNITS + FALL_UNITS * fall);
    (value, (lobe.error / unit).to_f64() * measure + rounding * value)
}

/// What one direction costs more than a point's, about, in viewers.
pub(super) fn viewers(half_angle: ReceiverHalfAngle) -> f64 {
    let squares = if to_radians(half_angle.get()) < 0.1 { 4.0 } else { 16.0 };
    squares * (NODES * NODES) as f64
}
