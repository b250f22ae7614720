//! Is the process there, does it take requests, and how is it doing?

use crate::http::app::App;
use crate::http::problem::{Document, Kind, PROBLEM_JSON, Problem};
use axum::Json;
use axum::extract::State;
use axum::http::{HeaderValue, header};
use axum::response::{IntoResponse as _, Response};
use serde::Serialize;
use utoipa::ToSchema;

/// The text format of Prometheus.
const METRICS_TEXT: HeaderValue = HeaderValue::from_static("text/plain; version=0.0.4; charset=utf-8");

/// The state of the service.
#[derive(Serialize, ToSchema)]
pub(crate) struct Health {
    /// Always `ok`: a service that is not ok does not answer so.
    #[schema(example = "ok")]
    status: &'static str,
}

/// Whether the process is alive.
#[utoipa::path(
    get,
    path = "/livez",
    tag = "operations",
    responses((status = 200, description = "The process is alive.", body = Health))
)]
pub(crate) async fn livez() -> Json<Health> {
    Json(Health { status: "ok" })
}

/// Whether new requests should be sent here.
///
/// The service loads nothing after it starts to listen, so that it is ready until it is told to stop. From then on the
/// answer is 503: requests are still answered, for the time that a balancer takes to notice, but new ones should go
/// elsewhere.
#[utoipa::path(
    get,
    path = "/readyz",
    tag = "operations",
    responses(
        (status = 200, description = "The service takes requests.", body = Health),
        (status = 503, description = "The service is stopping.", body = Document, content_type = PROBLEM_JSON)
    )
)]
pub(crate) async fn readyz(State(app): State<App>) -> Result<Json<Health>, Problem> {
    if app.doors().are_closing() {
        return Err(Problem::new(Kind::Stopping, "The service is stopping; send new requests elsewhere."));
    }
    Ok(Json(Health { status: "ok" }))
}

/// Metrics in the text format of Prometheus.
#[utoipa::path(
    get,
    path = "/metrics",
    tag = "operations",
    responses((status = 200, description = "Every metric.", body = String, content_type = "text/plain"))
)]
pub(crate) async fn metrics(State(app): State<App>) -> Response {
    ([(header::CONTENT_TYPE, METRICS_TEXT)], app.edge().metrics_text(&app)).into_response()
}
