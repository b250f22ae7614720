//! What a direction costs, predicted from what has to be evaluated in it.
//!
//! The unit is one exp() of the `wide` crate in vectors of four, 3.7 ns where the numbers were fitted: one direction of a batch of
//! 20,000 on one thread, with AVX2 (`cargo bench --bench requirement`). They say which of two requests is dearer and by what
//! factor, within a factor of two; a request's own overhead is not in them.

use super::evaluate::EvaluatedBy;
use super::fresnel::Medium;
use super::numeric::lobe_series::Method;
use super::receiver::viewers;
use super::scene::{Component, Model, Scene};

/// Angles to geometry, the sum of the components and its bound, direction by direction
const DIRECTION: f64 = 35.0;
/// The same in vector lanes, the factors of a lobe with it
const LANES_ALONE: f64 = 10.0;
/// F′ with its error in lanes
const LANES_FRESNEL: f64 = 6.0;
/// (57)
const DIFFUSE_LOBE: f64 = 10.0;
/// (70) without F′
const FACET_LOBE: f64 = 20.0;
/// (47) without F′: the exponential and two sincs with their errors
const SPIKE: f64 = 60.0;
/// F′ of a refractive index, with its error
const FRESNEL: f64 = 20.0;
/// The mean of F′ over the slopes under one source: 0.7 ms for σ_h/T below 0.3 and the default tolerance, ten times that for the
/// steepest
pub(super) const SLOPE_AVERAGE: f64 = 2e5;
/// The factors of the lobe of (47) around S
const HEIGHT_LOBE: f64 = 20.0;
/// One term in closed form, in vector lanes
const CLOSED: f64 = 10.0;
/// The saddle with a polynomial, in vector lanes
const SADDLE: f64 = 20.0;
/// The sum by `auto`, in vector lanes: a start and a term
const LANE_SUM: f64 = 20.0;
const LANE_TERM: f64 = 2.0;
/// The sum or a form compared with it, alone: a start and a term
const SUM: f64 = 150.0;
const TERM: f64 = 3.0;
/// The first 100 terms
const HUNDRED_TERMS: f64 = 600.0;
/// Terms of the sum: ± 9 standard deviations and a few, with strides beyond so many.
const DEVIATIONS: f64 = 18.0;
const MOST_TERMS: f64 = 150.0;

/// What the series is asked for in one direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Lobe {
    /// What evaluates it.
    pub(super) by: EvaluatedBy,
    /// Variance of its terms.
    pub(super) variance: f64,
}

impl Lobe {
    fn terms(self) -> f64 {
        (4.0 + DEVIATIONS * self.variance.sqrt()).min(MOST_TERMS)
    }

    /// S by the method that the scene asked for.
    fn cost(self, asked: Method) -> f64 {
        match (self.by, asked) {
            (EvaluatedBy::ClosedForm, _) => 0.0,
            (EvaluatedBy::Lobe(Method::Series), Method::Auto) => LANE_SUM + LANE_TERM * self.terms(),
            // Of a cone's mean that of one viewer.
            (EvaluatedBy::ConeQuadrature, _) | (EvaluatedBy::Lobe(Method::Uniform), Method::Auto) => SADDLE,
            (EvaluatedBy::Lobe(_), Method::Auto) => CLOSED,
            (EvaluatedBy::Lobe(Method::Paper), _) => HUNDRED_TERMS,
            (EvaluatedBy::Lobe(_), _) => self.summed(),
        }
    }

    /// S by its sum.
    fn summed(self) -> f64 {
        SUM + TERM * self.terms()
    }
}

/// The cost of these components in one direction: of a receiver of finite size the mean over its cone.
pub(super) fn direction(scene: &Scene, components: &[Component], lobe: Option<Lobe>) -> f64 {
    let viewer = of_viewer(scene, components, lobe);
    match scene.parameters().receiver {
        Some(half_angle) if components.contains(&Component::SpecularLobe) => viewers(half_angle) * viewer,
        _ => viewer,
    }
}

/// The cost of these components for one viewer.
fn of_viewer(scene: &Scene, components: &[Component], lobe: Option<Lobe>) -> f64 {
    let p = scene.parameters();
    let height_lobe = p.model == Model::BeckmannSpizzichino;
    let in_lanes = !components.contains(&Component::SpecularSpike)
        && (!height_lobe || lobe.is_some() && p.accuracy.method == Method::Auto);
    if in_lanes {
        let of_medium = reflectance(scene, components, LANES_FRESNEL);
        return LANES_ALONE + of_medium + lobe.map_or(0.0, |lobe| lobe.cost(Method::Auto));
    }
    let parts: f64 = components
        .iter()
        .map(|component| match component {
            Component::DiffuseLobe => DIFFUSE_LOBE,
            Component::SpecularSpike => SPIKE,
            Component::SpecularLobe if height_lobe => {
                HEIGHT_LOBE + lobe.map_or(0.0, |lobe| lobe.cost(p.accuracy.method))
            }
            Component::SpecularLobe => FACET_LOBE,
        })
        .sum();
    DIRECTION + reflectance(scene, components, FRESNEL) + parts
}

/// The cost of a direction of which nothing is known, the lobe by the method asked for; `alone` where a batch is of no help.
pub(super) fn expected(scene: &Scene, alone: bool) -> f64 {
    let p = scene.parameters();
    let by = match p.accuracy.method {
        Method::Auto => Method::Uniform,
        method => method,
    };
    let is_summed =
        p.model == Model::BeckmannSpizzichino && scene.evaluated().contains(&Component::SpecularLobe);
    let lobe = is_summed.then_some(Lobe { by: EvaluatedBy::Lobe(by), variance: f64::INFINITY });
    let cost = direction(scene, scene.evaluated(), lobe);
    if alone { cost + DIRECTION } else { cost }
}

/// The cost of every component in one direction, the lobe of (47) by its sum.
pub(super) fn full(scene: &Scene, components: &[Component], lobe: Option<Lobe>) -> f64 {
    let parts = direction(scene, components, None);
    match lobe {
        Some(lobe) if components.contains(&Component::SpecularLobe) => parts + lobe.summed(),
        _ => parts,
    }
}

/// F′, once for all specular components.
fn reflectance(scene: &Scene, components: &[Component], of_index: f64) -> f64 {
    let is_specular = components.iter().any(|&component| component != Component::DiffuseLobe);
    if is_specular && scene.parameters().surface.medium != Medium::PerfectConductor { of_index } else { 0.0 }
}
