//! What happens around every request: its name, who may ask, its headers, its line in the log, what is counted.

mod access_log;
mod deadline;
mod gate;
mod headers;
mod identity;
mod known;
mod metrics;
mod peer;
mod record;
mod route;
mod settle;

pub(super) use deadline::Deadline;
pub(super) use known::Tally;
pub(super) use settle::not_found;

use super::app::App;
use crate::config::Config;
use access_log::AccessLog;
use axum::Router;
use axum::body::{Body, Bytes, HttpBody};
use axum::http::Request;
use axum::response::Response;
use gate::Gate;
use headers::Headers;
use identity::{Names, Trace};
use known::Known;
use metrics::Metrics;
use peer::Peer;
use record::Record;
use std::convert::Infallible;
use std::net::SocketAddr;
use std::pin::Pin;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Arc, OnceLock};
use std::task::{Context, Poll};
use tokio::time::Instant;

/// What all requests share.
pub(super) struct State {
    names: Names,
    headers: Headers,
    log: AccessLog,
    metrics: Metrics,
    in_flight: AtomicUsize,
    connections: AtomicUsize,
    draining: AtomicBool,
}

impl State {
    /// As the configuration has it.
    pub(super) fn new(config: &Config) -> Self {
        Self {
            names: Names::new(),
            headers: Headers::new(config),
            log: AccessLog::new(&config.telemetry),
            metrics: Metrics::new(),
            in_flight: AtomicUsize::new(0),
            connections: AtomicUsize::new(0),
            draining: AtomicBool::new(false),
        }
    }

    /// Requests that are being answered.
    pub(super) fn in_flight(&self) -> usize {
        self.in_flight.load(Ordering::Relaxed)
    }

    /// Open connections.
    pub(super) fn connections(&self) -> usize {
        self.connections.load(Ordering::Relaxed)
    }

    /// From now on the service says that it is not ready.
    pub(super) fn drain(&self) {
        self.draining.store(true, Ordering::Relaxed);
    }

    /// Whether the service was told to stop.
    pub(super) fn is_draining(&self) -> bool {
        self.draining.load(Ordering::Relaxed)
    }

    /// A large request found no turn.
    pub(super) fn no_turn(&self) {
        self.metrics.no_turn();
    }

    /// The text of `/metrics`.
    pub(super) fn metrics_text(&self, app: &App) -> String {
        self.metrics.text(app)
    }

    /// What is to be done every few seconds.
    pub(super) fn tidy(&self) {
        self.metrics.tidy();
    }
}

/// The service behind one connection.
#[derive(Clone)]
pub(super) struct Edge {
    gate: Gate,
    peer: Arc<Peer>,
}

impl Edge {
    /// Around these routes; without a connection yet.
    pub(super) fn new(app: App, routes: Router) -> Self {
        Self { gate: Gate { app, routes }, peer: Arc::new(Peer::none()) }
    }

    /// For the connection of this client.
    pub(super) fn of(&self, client: SocketAddr) -> Self {
        Self { gate: self.gate.clone(), peer: Arc::new(Peer::new(client)) }
    }

    async fn answer(self, request: Request<Body>) -> Response {
        let app = &self.gate.app;
        let edge = app.edge();
        let known = Arc::new(Known {
            started: Instant::now(),
            method: request.method().clone(),
            uri: request.uri().clone(),
            route: route::of(request.uri().path()),
            id: edge.names.of_request(request.headers()),
            trace: Trace::of_request(request.headers(), &edge.names),
            peer: self.peer,
            key: OnceLock::new(),
            directions: AtomicUsize::new(0),
            counted: AtomicBool::new(false),
        });
        let app = app.clone();
        let record = Record::new(app.clone(), Arc::clone(&known));
        let mut response = self.gate.answer(request, Arc::clone(&known)).await;
        app.edge().headers.add(&known, response.headers_mut());
        record.answered(response)
    }
}

impl<B> tower_service::Service<Request<B>> for Edge
where
    B: HttpBody<Data = Bytes> + Send + 'static,
    B::Error: Into<axum::BoxError>,
{
    type Response = Response;
    type Error = Infallible;
    type Future = Pin<Box<dyn Future<Output = Result<Response, Infallible>> + Send>>;

    fn poll_ready(&mut self, _: &mut Context<'_>) -> Poll<Result<(), Infallible>> {
        Poll::Ready(Ok(()))
    }

    fn call(&mut self, request: Request<B>) -> Self::Future {
        let (edge, request) = (self.clone(), request.map(Body::new));
        Box::pin(async move { Ok(edge.answer(request).await) })
    }
}
