//! The service around the core: HTTP, JSON and nothing of the models.

mod api;
mod body;
mod compute;
mod connection;
mod encode;
mod input;
mod link;
mod negotiate;
mod openapi;
mod problem;
mod routes;
mod serve;
mod track;

pub use openapi::openapi_json;
pub use serve::{StopSignals, serve};

use crate::config::Config;
use axum::Router;
use axum::middleware::from_fn_with_state;
use std::net::SocketAddr;
use std::time::Duration;
use tower_http::catch_panic::CatchPanicLayer;

/// What every handler may need to know.
#[derive(Clone, Copy, Debug)]
struct Limits {
    body_bytes: u64,
    request_time: Duration,
}

/// The whole service as one `tower` service.
pub fn router(config: &Config) -> Router {
    let limits = Limits { body_bytes: config.body_limit_bytes, request_time: config.request_timeout_seconds };
    // As a service of its own: a layer on the routes themselves would not see the `Allow` that axum adds
    // outside of them.
    Router::new()
        .fallback_service(routes::routes(limits))
        .layer(CatchPanicLayer::custom(track::on_panic))
        .layer(from_fn_with_state(limits, track::track))
}

/// What the program says when it is ready.
pub fn greeting(address: SocketAddr) -> String {
    format!(
        "reflectance {version} on http://{address}/  (reference: http://{address}/docs)\n\
         Try: curl -s http://{address}/v1/radiance -H 'content-type: application/json' -d '{body}'\n",
        version = env!("CARGO_PKG_VERSION"),
        body = api::FIRST_REQUEST.replace('\n', ""),
    )
}
