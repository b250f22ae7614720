//! `GET` and `POST /v1/diagrams`: a sweep over one zenith angle at several fixed ones.

use super::radiance::OutputWire;
use super::responses::{GetProblems, PostProblems};
use super::scene::CheckedScene;
use super::sweep::CheckedSweep;
use crate::http::answer::{self, Over, Subject, Work};
use crate::http::app::App;
use crate::http::body::JsonBody;
use crate::http::compute::admission::Turn;
use crate::http::edge::Meter;
use crate::http::encode::rows::Binary;
use crate::http::encode::table::Diagram;
use crate::http::input::object::object;
use crate::http::input::query::Query;
use crate::http::input::wire::named;
use crate::http::link::{Known, linked};
use crate::http::negotiate::{Format, Tabular};
use crate::http::problem::Problem;
use crate::http::track::Deadline;
use crate::reflectance::evaluate::Quantity;
use axum::extract::State;
use axum::response::Response;

named! {
    Quantity, "a quantity", [Quantity::Radiance, Quantity::Brdf];
}

object! {
    /// A scene, and a sweep through its directions.
    DiagramRequest as "DiagramRequest" {
        /// `radiance` (when absent or null) or `brdf`.
        quantity: Option<Quantity>,
        /// What to add.
        output: Option<OutputWire>,
        ..sweep: CheckedSweep,
        ..scene: CheckedScene,
    }
}

/// A tabulated diagram, as a link.
///
/// The fields of the POST request, flattened into the query: `medium=perfect_conductor` or `n` and `k`,
/// `at_deg=10,30,45,60`. The answer is a function of the link alone and carries a strong entity tag.
#[utoipa::path(
    get,
    path = "/v1/diagrams",
    tag = "diagrams",
    params(DiagramRequest),
    responses(
        (status = 200, description = "The diagram.", content(
            (Diagram = "application/json"),
            (String = "text/csv"),
            (Binary = "application/vnd.apache.arrow.stream"),
            (Binary = "application/x-npy")
        )),
        (status = 304, description = "The client has this answer already."),
        GetProblems
    )
)]
pub(crate) async fn link(
    State(app): State<App>,
    Tabular(format): Tabular,
    known: Known,
    deadline: Deadline,
    Query(request): Query<DiagramRequest>,
) -> Result<Response, Problem> {
    let key = format!("{request:?}{format:?}");
    linked(&known, &key, draw(&app, format, deadline, None, request)).await
}

/// A tabulated diagram.
#[utoipa::path(
    post,
    path = "/v1/diagrams",
    tag = "diagrams",
    request_body(content = DiagramRequest, description = "The scene and the sweep."),
    responses(
        (status = 200, description = "The diagram.", content(
            (Diagram = "application/json"),
            (String = "text/csv"),
            (Binary = "application/vnd.apache.arrow.stream"),
            (Binary = "application/x-npy")
        )),
        PostProblems
    )
)]
pub(crate) async fn diagram(
    State(app): State<App>,
    Tabular(format): Tabular,
    deadline: Deadline,
    JsonBody { value: request, turn }: JsonBody<DiagramRequest>,
) -> Result<Response, Problem> {
    draw(&app, format, deadline, turn, request).await
}

async fn draw(
    app: &App,
    format: Format,
    deadline: Deadline,
    turn: Option<Turn>,
    request: DiagramRequest,
) -> Result<Response, Problem> {
    let DiagramRequest { quantity, output, sweep: CheckedSweep(sweep), scene: CheckedScene(scene) } = request;
    let subject = Subject::Scene {
        scene: Box::new(scene),
        quantity: quantity.unwrap_or(Quantity::Radiance),
        output: OutputWire::chosen(output),
    };
    let work = Work { subject, over: Over::Sweep(Box::new(sweep)), meter: Meter::default() };
    answer::respond(app, deadline, turn, work, format).await
}
