//! Is the process there, and does it take requests?

use axum::Json;
use serde::Serialize;
use utoipa::ToSchema;

/// The state of the service.
#[derive(Serialize, ToSchema)]
pub(crate) struct Health {
    /// Always `ok`: a service that is not ok does not answer.
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

/// Whether requests are taken.
///
/// The service loads nothing after it starts to listen, so that it is ready whenever it is alive. When it is
/// told to stop it closes its listening socket at once, and this request fails to connect.
#[utoipa::path(
    get,
    path = "/readyz",
    tag = "operations",
    responses((status = 200, description = "The service takes requests.", body = Health))
)]
pub(crate) async fn readyz() -> Json<Health> {
    Json(Health { status: "ok" })
}
