//! What happens around every request: its name, who may ask, its headers, its line in the log, what is counted.

mod access_log;
mod cors;
mod deadline;
mod document;
mod gate;
mod headers;
mod identity;
mod keys;
mod known;
mod meter;
mod metrics;
mod peer;
mod process;
mod rate;
mod record;
mod route;
mod settle;
mod spans;

pub(super) use deadline::Deadline;
pub(super) use document::complete as complete_document;
pub(super) use meter::{Asked, Meter};
pub(super) use settle::not_found;

use super::app::App;
use crate::config::Config;
use access_log::AccessLog;
use axum::Router;
use axum::body::{Body, Bytes, HttpBody};
use axum::http::{HeaderMap, HeaderValue, Request, header};
use axum::response::Response;
use cors::Origins;
use gate::Gate;
use headers::Headers;
use identity::{Names, Trace};
use keys::Keys;
use known::Known;
use metrics::Metrics;
use peer::Peer;
use rate::RateLimit;
use record::Record;
use spans::Spans;
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
    spans: Option<Spans>,
    keys: Option<Keys>,
    rate: Option<RateLimit>,
    origins: Option<Origins>,
    in_flight: AtomicUsize,
}

impl State {
    /// As the configuration has it.
    pub(super) fn new(config: &Config) -> Self {
        Self {
            names: Names::new(),
            headers: Headers::new(config),
            log: AccessLog::new(&config.telemetry),
            metrics: Metrics::new(),
            spans: Spans::new(config.telemetry.otlp_endpoint.as_deref()),
            keys: config.access.api_keys_file.as_ref().map(Keys::new),
            rate: RateLimit::new(&config.access),
            origins: Origins::new(&config.access.cors_origin),
            in_flight: AtomicUsize::new(0),
        }
    }

    /// The trace that a request is part of. One begins here if it is to be recorded.
    fn trace(&self, headers: &HeaderMap) -> Option<Trace> {
        let given = Trace::of_request(headers, &self.names);
        given.or_else(|| self.spans.is_some().then(|| Trace::begin(&self.names)))
    }

    /// Requests that are being answered.
    pub(super) fn in_flight(&self) -> usize {
        self.in_flight.load(Ordering::Relaxed)
    }

    /// Counts what is evaluated.
    pub(super) fn meter(&self) -> Meter {
        self.metrics.meter.clone()
    }

    /// The text of `/metrics`.
    pub(super) fn metrics_text(&self, app: &App) -> String {
        self.metrics.text(app)
    }

    /// Reads the keys again, if there are any: says how many there are, or why the old ones stay.
    pub(super) fn reload(&self) -> Option<Result<usize, String>> {
        self.keys.as_ref().map(Keys::reload)
    }

    /// What is to be done every few seconds.
    pub(super) fn tidy(&self) {
        self.metrics.tidy();
        if let Some(rate) = &self.rate {
            rate.tidy();
        }
    }

    /// What is to be done at the end, once no request is under way. May block.
    pub(super) fn finish(&self) {
        if let Some(spans) = &self.spans {
            spans.finish();
        }
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

    /// Answers a request.
    pub(super) async fn answer(self, request: Request<Body>) -> Response {
        let app = &self.gate.app;
        let edge = app.edge();
        let known = Arc::new(Known {
            started: Instant::now(),
            method: request.method().clone(),
            uri: request.uri().clone(),
            route: route::of(request.uri().path()),
            id: edge.names.of_request(request.headers()),
            trace: edge.trace(request.headers()),
            peer: self.peer,
            key: OnceLock::new(),
            counted: AtomicBool::new(false),
        });
        let app = app.clone();
        let record = Record::new(app.clone(), Arc::clone(&known));
        let edge = app.edge();
        let mut response = match &edge.origins {
            None => self.gate.answer(request, Arc::clone(&known)).await,
            Some(origins) if request.headers().contains_key(header::ORIGIN) => {
                origins.answer(self.gate, request, Arc::clone(&known)).await
            }
            Some(_) => {
                // A cache may hold it that a page asks later.
                let mut response = self.gate.answer(request, Arc::clone(&known)).await;
                response.headers_mut().append(header::VARY, const { HeaderValue::from_static("origin") });
                response
            }
        };
        edge.headers.add(&known, response.headers_mut());
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
