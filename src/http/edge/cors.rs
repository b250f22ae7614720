//! Pages of other origins: which may read answers.

use super::gate::Gate;
use super::identity::{REQUEST_ID, TRACEPARENT};
use super::known::Known;
use super::rate;
use axum::body::Body;
use axum::http::{HeaderName, HeaderValue, Method, Request, header};
use axum::response::Response;
use std::convert::Infallible;
use std::pin::Pin;
use std::sync::Arc;
use std::task::{Context, Poll};
use std::time::Duration;
use tower_http::cors::{AllowOrigin, Any, Cors};
use tower_service::Service;

/// How long a browser may keep what it was allowed.
const MAX_AGE: Duration = Duration::from_hours(1);
/// What a page may send.
const ALLOWED: [HeaderName; 7] = [
    header::ACCEPT,
    header::AUTHORIZATION,
    header::CONTENT_ENCODING,
    header::CONTENT_TYPE,
    header::IF_NONE_MATCH,
    REQUEST_ID,
    TRACEPARENT,
];
/// What a page may read besides the few headers that every page may.
const EXPOSED: [HeaderName; 9] = [
    header::ETAG,
    header::RETRY_AFTER,
    REQUEST_ID,
    TRACEPARENT,
    rate::RATE_LIMIT,
    rate::RATE_LIMIT_POLICY,
    rate::LIMIT,
    rate::REMAINING,
    rate::RESET,
];

/// The origins whose pages may read answers.
#[derive(Debug)]
pub(super) struct Origins(AllowOrigin);

impl Origins {
    /// None if only the service's own pages may.
    pub(super) fn new(origins: &[String]) -> Option<Self> {
        if origins.is_empty() {
            return None;
        }
        if origins.iter().any(|origin| origin == "*") {
            return Some(Self(Any.into()));
        }
        // What is no header value was refused with the configuration.
        Some(Self(AllowOrigin::list(origins.iter().filter_map(|origin| HeaderValue::from_str(origin).ok()))))
    }

    /// Answers a request from a page, or a browser's question whether the page may ask.
    pub(super) async fn answer(&self, gate: Gate, request: Request<Body>, known: Arc<Known>) -> Response {
        let mut cors = Cors::new(Behind { gate, known })
            .allow_origin(self.0.clone())
            .allow_methods([Method::GET, Method::HEAD, Method::POST])
            .allow_headers(ALLOWED)
            .expose_headers(EXPOSED)
            .max_age(MAX_AGE);
        match cors.call(request).await {
            Ok(response) => response,
        }
    }
}

/// What a browser asks for once it knows that it may.
#[derive(Clone)]
struct Behind {
    gate: Gate,
    known: Arc<Known>,
}

impl Service<Request<Body>> for Behind {
    type Response = Response;
    type Error = Infallible;
    type Future = Pin<Box<dyn Future<Output = Result<Response, Infallible>> + Send>>;

    fn poll_ready(&mut self, _: &mut Context<'_>) -> Poll<Result<(), Infallible>> {
        Poll::Ready(Ok(()))
    }

    fn call(&mut self, request: Request<Body>) -> Self::Future {
        let Self { gate, known } = self.clone();
        Box::pin(async move { Ok(gate.answer(request, known).await) })
    }
}
