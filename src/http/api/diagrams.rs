//! `GET` and `POST /v1/diagrams`: a sweep over one zenith angle at several fixed ones.

use super::radiance::OutputWire;
use super::responses::{GetProblems, PostProblems};
use super::scene::CheckedScene;
use super::sweep::CheckedSweep;
use crate::http::body::JsonBody;
use crate::http::compute;
use crate::http::encode::rows::Binary;
use crate::http::encode::table::Diagram;
use crate::http::encode::{flat, json};
use crate::http::input::object::object;
use crate::http::input::query::Query;
use crate::http::input::wire::named;
use crate::http::link::{Known, tagged};
use crate::http::negotiate::{Format, Tabular, VARY};
use crate::http::problem::Problem;
use crate::http::track::Deadline;
use crate::reflectance::evaluate::Quantity;
use axum::http::header;
use axum::response::{IntoResponse as _, Response};

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
    Tabular(format): Tabular,
    known: Known,
    deadline: Deadline,
    Query(request): Query<DiagramRequest>,
) -> Result<Response, Problem> {
    let body = draw(format, deadline, request).await?;
    Ok(tagged(&known, format.content_type(), body))
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
    Tabular(format): Tabular,
    deadline: Deadline,
    JsonBody(request): JsonBody<DiagramRequest>,
) -> Result<Response, Problem> {
    let body = draw(format, deadline, request).await?;
    Ok(([(header::CONTENT_TYPE, format.content_type()), (header::VARY, VARY)], body).into_response())
}

async fn draw(format: Format, deadline: Deadline, request: DiagramRequest) -> Result<Vec<u8>, Problem> {
    let DiagramRequest { quantity, output, sweep: CheckedSweep(sweep), scene: CheckedScene(scene) } = request;
    let quantity = quantity.unwrap_or(Quantity::Radiance);
    let output = OutputWire::chosen(output);
    compute::run(deadline, sweep.rows(), move || {
        let table = sweep.evaluate(&scene, quantity, output, "").map_err(|error| {
            tracing::error!(%error, "a checked sweep left its range");
            Problem::internal()
        })?;
        if let Some(rows) = format.row_format() {
            return flat::write(rows, &[table], false);
        }
        let diagram = Diagram::new(table, false);
        json::bytes(&diagram, diagram.size_hint())
    })
    .await?
}
