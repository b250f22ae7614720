//! `POST /v1/plan`: what a scene requires, before it is evaluated.

use super::answer::{OmittedAnswer, WarningAnswer};
use super::light::MediumAnswer;
use super::radiance::{CheckedDirections, RadianceRequest};
use super::responses::PostProblems;
use crate::http::body::JsonBody;
use crate::http::compute;
use crate::http::edge::Deadline;
use crate::http::encode::json;
use crate::http::negotiate::JsonOnly;
use crate::http::problem::Problem;
use crate::reflectance::material::Lookup;
use crate::reflectance::plan::{MethodRange, Plan};
use crate::reflectance::scene::Component;
use axum::response::Response;
use serde::Serialize;
use std::collections::BTreeMap;
use utoipa::ToSchema;

/// What a scene requires in the directions asked for. Components, `roughness_g` and the warnings about assumptions hold in every
/// direction; methods, bound, cost, and the warnings `tolerance_not_met`, `underflow` and `method_out_of_range`, are from the
/// sampled directions.
#[derive(Serialize, ToSchema)]
#[schema(as = Plan)]
pub(crate) struct PlanAnswer {
    /// What was looked up, where the medium is a material.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schema(nullable = false)]
    medium: Option<MediumAnswer>,
    /// Directions of the request.
    directions: usize,
    /// How many of them were looked at one by one: all up to 1024 (16 with a
    /// `receiver_half_angle_deg`), else so many from the first to the last, equally spaced.
    sampled: usize,
    /// g of (34) is between these in every direction; absent where the scene has no heights or wavelength.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schema(nullable = false)]
    roughness_g: Option<RoughnessRange>,
    /// What those mean: `smooth` up to g = π²/4, `rough` from g = 10 on, `moderate` between.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schema(nullable = false)]
    regime: Option<RegimeRange>,
    /// The components to evaluate.
    #[schema(example = json!(["specular_lobe"]))]
    components: Vec<&'static str>,
    /// Those that `components: "auto"` leaves out.
    omitted: Vec<OmittedAnswer>,
    /// How many of the sampled directions each method would evaluate.
    methods: BTreeMap<&'static str, usize>,
    /// Runs of one method along the sampled directions; null if there are more than 64.
    method_ranges: Option<Vec<RangeAnswer>>,
    /// The largest bound of a total's relative error among the sampled directions whose total is a number; null where
    /// there are none, or it is not finite.
    relative_error_bound: Option<f64>,
    /// Predicted.
    cost: CostAnswer,
    /// As `/v1/radiance` answers them.
    warnings: Vec<WarningAnswer>,
}

/// The ends of g.
#[derive(Serialize, ToSchema)]
pub(crate) struct RoughnessRange {
    /// Least.
    least: f64,
    /// Largest.
    largest: f64,
}

/// The regimes at the ends of g.
#[derive(Serialize, ToSchema)]
pub(crate) struct RegimeRange {
    /// At the least g.
    #[schema(example = "moderate")]
    least: &'static str,
    /// At the largest g.
    #[schema(example = "rough")]
    largest: &'static str,
}

/// Neighbouring directions that one method would evaluate.
#[derive(Serialize, ToSchema)]
#[schema(as = MethodRange)]
pub(crate) struct RangeAnswer {
    /// Which.
    #[schema(example = "uniform")]
    method: &'static str,
    /// Index of the first direction.
    first: usize,
    /// Index of the last one.
    last: usize,
}

/// What a direction costs, on the average and within a factor of two, in units of one vectorised exp() of a 64-bit float.
#[derive(Serialize, ToSchema)]
#[schema(as = Cost)]
pub(crate) struct CostAnswer {
    /// As planned.
    per_direction: f64,
    /// With every component evaluated, the lobe of (47) by its sum.
    full_series: f64,
    /// The first over the second.
    relative_to_full_series: f64,
}

impl From<MethodRange> for RangeAnswer {
    fn from(range: MethodRange) -> Self {
        Self { method: range.by.name(), first: range.first, last: range.last }
    }
}

impl PlanAnswer {
    fn new(plan: Plan, lookup: Option<Lookup>) -> Self {
        Self {
            medium: lookup.map(MediumAnswer::from),
            directions: plan.directions,
            sampled: plan.sampled,
            roughness_g: plan.roughness_g.map(|[least, largest]| RoughnessRange { least, largest }),
            regime: plan
                .regimes
                .map(|[least, largest]| RegimeRange { least: least.name(), largest: largest.name() }),
            components: plan.needed.into_iter().map(Component::name).collect(),
            omitted: plan.omitted.into_iter().map(OmittedAnswer::from).collect(),
            methods: plan.methods.into_iter().map(|(by, count)| (by.name(), count)).collect(),
            method_ranges: plan.ranges.map(|ranges| ranges.into_iter().map(RangeAnswer::from).collect()),
            relative_error_bound: plan.largest_bound.is_finite().then_some(plan.largest_bound),
            cost: CostAnswer {
                per_direction: plan.cost.per_direction,
                full_series: plan.cost.full,
                relative_to_full_series: plan.cost.relative(),
            },
            warnings: plan.warnings.into_iter().map(WarningAnswer::from).collect(),
        }
    }
}

/// What a scene requires.
///
/// Takes a request of `/v1/radiance` and evaluates at most 1024 of its directions. Answers which components are needed at the
/// tolerance and which not, the method of the lobe series along the directions, the predicted cost, and which assumptions of the
/// models the scene strains. `output` is read and not used.
#[utoipa::path(
    post,
    path = "/v1/plan",
    tag = "reflection",
    request_body(content = RadianceRequest, description = "The scene and the directions."),
    responses((status = 200, description = "What the scene requires.", body = PlanAnswer), PostProblems)
)]
pub(crate) async fn plan(
    _: JsonOnly,
    deadline: Deadline,
    JsonBody { value: request, .. }: JsonBody<RadianceRequest>,
) -> Result<Response, Problem> {
    let RadianceRequest { geometry: CheckedDirections(directions), scene, .. } = request;
    let (scene, lookup) = scene.single()?;
    // An average over slopes takes as long as a thousand directions, the mean over a cone as long.
    let is_long = scene.averages_slopes() || scene.parameters().receiver.is_some();
    let effort = if is_long { usize::MAX } else { directions.count() };
    compute::run(deadline, effort, move || {
        json::response(&PlanAnswer::new(Plan::of(&scene, &directions), lookup), 4096)
    })
    .await?
}
