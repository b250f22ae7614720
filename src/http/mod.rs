//! The service around the core: HTTP, JSON and nothing of the models.

mod answer;
mod api;
mod app;
mod body;
mod coding;
mod compute;
mod decode;
mod edge;
mod encode;
mod input;
mod link;
mod negotiate;
mod openapi;
mod page;
mod plot;
mod problem;
mod routes;
mod transport;

pub use openapi::openapi_json;
pub use transport::run;

use crate::config::Config;
use app::App;
use axum::Router;
use edge::Edge;
use std::net::SocketAddr;

/// The whole service as one `tower` service.
pub fn router(config: &Config) -> Router {
    Router::new().fallback_service(service(&App::new(config)))
}

/// The same, to be given the client of each connection.
fn service(app: &App) -> Edge {
    Edge::new(app.clone(), routes::routes(app.clone()))
}

/// What the program says when it is ready.
fn greeting(scheme: &str, address: SocketAddr) -> String {
    format!(
        "reflectance {version} on {scheme}://{address}/  (reference: {scheme}://{address}/docs)\n\
         Try: curl -s {scheme}://{address}/v1/radiance -H 'content-type: application/json' -d '{body}'\n",
        version = env!("CARGO_PKG_VERSION"),
        body = api::FIRST_REQUEST.replace('\n', ""),
    )
}
