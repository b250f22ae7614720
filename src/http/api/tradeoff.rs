//! `POST /v1/tradeoff`: what each way to evaluate the lobe series costs in a scene, and how far off it is.

use super::light::MediumAnswer;
use super::radiance::{CheckedDirections, OutputWire, RadianceRequest};
use super::responses::PostProblems;
use crate::http::body::JsonBody;
use crate::http::compute;
use crate::http::edge::Deadline;
use crate::http::encode::json;
use crate::http::negotiate::JsonOnly;
use crate::http::problem::{Code, FieldError, Problem};
use crate::reflectance::evaluate::Quantity;
use crate::reflectance::material::Lookup;
use crate::reflectance::numeric::lobe_series::Method;
use crate::reflectance::tradeoff::{Row, Tradeoff, measure};
use axum::response::Response;
use serde::Serialize;
use std::collections::BTreeMap;
use std::time::Instant;
use tokio::sync::Semaphore;
use utoipa::ToSchema;

/// Measurements would slow each other, and measure that: they are made one after the other.
static ONE_AT_A_TIME: Semaphore = Semaphore::const_new(1);

/// What was measured. Errors are relative, of the total radiance.
#[derive(Serialize, ToSchema)]
#[schema(as = Tradeoff)]
pub(crate) struct TradeoffAnswer {
    /// `radiance`.
    #[schema(example = "radiance")]
    quantity: &'static str,
    /// What was looked up, where the medium is a material.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schema(nullable = false)]
    medium: Option<MediumAnswer>,
    /// How many directions the request has.
    directions: usize,
    /// Indices of the directions measured: all of them up to 64, otherwise 64 at even distances with the first and
    /// the last.
    directions_used: Vec<usize>,
    /// How many of them have a finite total; the errors are those of these.
    directions_compared: usize,
    /// What errors are measured against.
    reference: Reference,
    /// What `auto` takes at the tolerance asked for: how many of the directions each method evaluates.
    auto: BTreeMap<&'static str, usize>,
    /// One a way to evaluate the scene: `auto` at the tolerances 1e-1, 1e-3, 1e-6, 1e-9, 1e-12 and the one asked for,
    /// then every method by name. A scene that needs no lobe series has one row, `closed_form`.
    rows: Vec<RowAnswer>,
}

/// The converged reference.
#[derive(Serialize, ToSchema)]
#[schema(as = TradeoffReference)]
struct Reference {
    /// `series`, summed to convergence, or `closed_form`.
    #[schema(example = "series")]
    method: &'static str,
    /// The largest bound of its own error: no smaller error can be told. Null where no total is finite.
    largest_relative_error_bound: Option<f64>,
}

/// One way to evaluate the scene.
#[derive(Serialize, ToSchema)]
#[schema(as = TradeoffRow)]
struct RowAnswer {
    /// How the lobe series is evaluated.
    #[schema(example = "auto")]
    method: &'static str,
    /// The tolerance to keep.
    #[schema(example = 1e-9)]
    relative_tolerance: f64,
    /// Whether the request asks for just this.
    as_requested: bool,
    /// The largest relative error. An error below the reference's own bound in that direction is counted as that
    /// bound. Null where it is infinite, or no total is finite.
    largest_relative_error: Option<f64>,
    /// The median relative error, counted likewise.
    median_relative_error: Option<f64>,
    /// The largest `relative_error_bound` stated. Null where it is infinite, or no total is finite.
    largest_relative_error_bound: Option<f64>,
    /// Whether every bound stated is within the tolerance. Null where no total is finite.
    keeps_tolerance: Option<bool>,
    /// Nanoseconds a direction: everything that an evaluation of these directions does, over their number. The
    /// median of `repeats` timings, made now: it depends on the machine and on what else it does.
    nanoseconds_per_direction: f64,
    /// That time over the shortest of any row.
    time_ratio: f64,
    /// Timings that the median is of.
    repeats: usize,
    /// How many directions each method evaluated.
    methods: BTreeMap<&'static str, usize>,
}

impl From<Row> for RowAnswer {
    fn from(row: Row) -> Self {
        // serde_json writes infinities as null.
        Self {
            method: row.method.map_or("closed_form", Method::name),
            relative_tolerance: row.relative_tolerance,
            as_requested: row.as_requested,
            largest_relative_error: row.errors.map(|errors| errors.largest),
            median_relative_error: row.errors.map(|errors| errors.median),
            largest_relative_error_bound: row.errors.map(|errors| errors.largest_bound),
            keeps_tolerance: row.errors.map(|errors| errors.keeps_tolerance),
            nanoseconds_per_direction: 1e9 * row.seconds,
            time_ratio: row.time_ratio,
            repeats: row.repeats,
            methods: row.methods.into_iter().map(|(method, count)| (method.name(), count)).collect(),
        }
    }
}

impl TradeoffAnswer {
    fn new(directions: usize, relative_tolerance: f64, trade: Tradeoff, lookup: Option<Lookup>) -> Self {
        let in_series = trade.rows.iter().any(|row| row.method.is_some());
        let rows: Vec<_> = trade.rows.into_iter().map(RowAnswer::from).collect();
        let auto = rows.iter().find(|row| {
            !in_series || row.method == Method::Auto.name() && row.relative_tolerance == relative_tolerance
        });
        Self {
            quantity: Quantity::Radiance.name(),
            medium: lookup.map(MediumAnswer::from),
            directions,
            directions_used: trade.used,
            directions_compared: trade.compared,
            reference: Reference {
                method: if in_series { Method::Series.name() } else { "closed_form" },
                largest_relative_error_bound: trade.reference_error_bound,
            },
            auto: auto.map(|row| row.methods.clone()).unwrap_or_default(),
            rows,
        }
    }
}

/// The trade of speed for accuracy in this scene, measured.
///
/// Takes a request of `/v1/radiance`, evaluates it by every method, and answers each one's true error against the
/// converged series, its stated bound and the time it takes here and now. Of more than 64 directions 64 are measured.
/// A measurement takes 50 ms at most, longer with `slope_average` under many sources, and waits for those before it.
#[utoipa::path(
    post,
    path = "/v1/tradeoff",
    tag = "reflection",
    request_body(content = RadianceRequest, description = "The scene and the directions."),
    responses((status = 200, description = "Error, bound and time by method.", body = TradeoffAnswer), PostProblems)
)]
pub(crate) async fn tradeoff(
    _: JsonOnly,
    deadline: Deadline,
    JsonBody { value: request, .. }: JsonBody<RadianceRequest>,
) -> Result<Response, Problem> {
    let RadianceRequest { geometry: CheckedDirections(directions), output, scene } = request;
    let (scene, lookup) = scene.single()?;
    if scene.parameters().receiver.is_some() {
        let detail = "the trade is measured of points: expected 0, or no receiver_half_angle_deg";
        let pointer = "/sensor/receiver_half_angle_deg".to_owned();
        return Err(Problem::invalid(vec![FieldError {
            pointer,
            code: Code::Inconsistent,
            detail: detail.into(),
        }]));
    }
    let permit = compute::turn(deadline, &ONE_AT_A_TIME).await?;
    compute::blocking(deadline, move || {
        let _permit = permit;
        let started = Instant::now();
        let trade = measure(&scene, &directions, OutputWire::chosen(output), || started.elapsed());
        let tolerance = scene.parameters().accuracy.relative_tolerance.get();
        json::response(&TradeoffAnswer::new(directions.count(), tolerance, trade, lookup), 8192)
    })
    .await?
}
