//! The service around the core: HTTP, JSON and nothing of the models.

mod answer;
mod api;
mod app;
mod body;
mod coding;
mod compute;
mod connection;
mod decode;
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
use app::App;
use axum::Router;
use axum::middleware::from_fn_with_state;
use std::net::SocketAddr;
use tower_http::catch_panic::CatchPanicLayer;

/// The whole service as one `tower` service.
pub fn router(config: &Config) -> Router {
    let app = App::new(config);
    // As a service of its own: a layer on the routes themselves would not see the `Allow` that axum adds
    // outside of them.
    Router::new()
        .fallback_service(routes::routes(app.clone()))
        .layer(CatchPanicLayer::custom(track::on_panic))
        .layer(from_fn_with_state(app, track::track))
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
