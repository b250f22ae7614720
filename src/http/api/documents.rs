//! What the service says about itself: the `OpenAPI` document and the interactive reference.

use crate::http::app::App;
use crate::http::link::{Known, document};
use crate::http::negotiate::Format;
use crate::http::openapi::openapi_json;
use axum::Router;
use axum::response::Response;
use std::sync::LazyLock;
use utoipa_swagger_ui::{Config, SwaggerUi};

static DOCUMENT: LazyLock<String> = LazyLock::new(openapi_json);

/// This document: `OpenAPI` 3.1.
#[utoipa::path(
    get,
    path = "/openapi.json",
    tag = "reference",
    responses(
        (status = 200, description = "The document.", body = serde_json::Value, content_type = "application/json"),
        (status = 304, description = "The client has this document already.")
    )
)]
pub(crate) async fn openapi(known: Known) -> Response {
    document(&known, Format::Json.content_type(), DOCUMENT.as_str()).await
}

/// The reference at `/docs`; its pages and scripts are part of the program.
pub(crate) fn reference() -> Router<App> {
    // Without "none" the page asks a public validator about every document that is not on localhost.
    let config = Config::from("/openapi.json").validator_url("none");
    Router::from(SwaggerUi::new("/docs").config(config))
}
