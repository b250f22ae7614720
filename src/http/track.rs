//! What happens around every request: its deadline, its problem document, its line in the log.

use super::app::{App, Limits};
use super::problem::{Kind, Problem};
use axum::body::{Body, HttpBody as _};
use axum::extract::{FromRequestParts, Request, State};
use axum::http::request::Parts;
use axum::http::{HeaderValue, Method, StatusCode, header};
use axum::middleware::Next;
use axum::response::{IntoResponse as _, Response};
use std::any::Any;
use std::convert::Infallible;
use std::time::Instant;

/// When a request has to be answered.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Deadline {
    pub(crate) at: tokio::time::Instant,
    /// How long it was at first: for messages.
    pub(crate) limit: std::time::Duration,
}

impl FromRequestParts<App> for Deadline {
    type Rejection = Infallible;

    async fn from_request_parts(parts: &mut Parts, app: &App) -> Result<Self, Infallible> {
        Ok(parts.extensions.get::<Self>().copied().unwrap_or_else(|| Self::from_now(app.limits())))
    }
}

impl Deadline {
    fn from_now(limits: &Limits) -> Self {
        Self { at: tokio::time::Instant::now() + limits.request_time, limit: limits.request_time }
    }
}

/// Outermost layer: everything that leaves the service passes here.
pub(super) async fn track(State(app): State<App>, mut request: Request, next: Next) -> Response {
    let started = Instant::now();
    let method = request.method().clone();
    let path = request.uri().path().to_owned();
    request.extensions_mut().insert(Deadline::from_now(app.limits()));

    let response = next.run(request).await;
    let mut response = settle(response, &method, &path);
    if method == Method::HEAD {
        // The length is that of the answer to GET; the bytes stay here.
        if let Some(length) = response.body().size_hint().exact() {
            response.headers_mut().entry(header::CONTENT_LENGTH).or_insert(length.into());
        }
        *response.body_mut() = Body::empty();
    }

    tracing::info!(
        %method,
        path,
        status = response.status().as_u16(),
        microseconds = u64::try_from(started.elapsed().as_micros()).unwrap_or(u64::MAX),
        bytes = response.body().size_hint().exact(),
        "request"
    );
    response
}

/// Gives every error its document.
fn settle(response: Response, method: &Method, path: &str) -> Response {
    let status = response.status();
    if status == StatusCode::METHOD_NOT_ALLOWED {
        return method_not_allowed(&response, method, path);
    }
    if let Some(problem) = response.extensions().get::<Problem>() {
        return problem.render(path);
    }
    // Errors made by the libraries underneath: a missing page of the reference, for one.
    match status {
        StatusCode::NOT_FOUND => not_found().render(path),
        _ if status.is_server_error() => Problem::internal().render(path),
        _ if status.is_client_error() => {
            Problem::new(Kind::BadRequest, "The request could not be read.").render(path)
        }
        _ => response,
    }
}

/// OPTIONS asks what is allowed; any other method gets an error that says it.
fn method_not_allowed(response: &Response, method: &Method, path: &str) -> Response {
    let allowed =
        response.headers().get(header::ALLOW).and_then(|allow| allow.to_str().ok()).unwrap_or_default();
    let allow = allowed.split(',').chain(["OPTIONS"]).collect::<Vec<_>>().join(", ");
    let mut answer = if method == Method::OPTIONS {
        StatusCode::NO_CONTENT.into_response()
    } else {
        Problem::new(Kind::MethodNotAllowed, format!("{method} is not answered here; allowed: {allow}"))
            .render(path)
    };
    if let Ok(allow) = HeaderValue::from_str(&allow) {
        answer.headers_mut().insert(header::ALLOW, allow);
    }
    answer
}

pub(super) fn not_found() -> Problem {
    Problem::new(Kind::NotFound, "No resource has this path. The reference at /docs lists those that exist.")
}

/// A panic in a handler is a defect. It costs its own request and no other.
#[expect(clippy::needless_pass_by_value, reason = "the layer hands it over so")]
pub(super) fn on_panic(panic: Box<dyn Any + Send>) -> Response {
    let message = panic
        .downcast_ref::<&str>()
        .map(|text| (*text).to_owned())
        .or_else(|| panic.downcast_ref::<String>().cloned())
        .unwrap_or_default();
    tracing::error!(message, "a handler panicked");
    Problem::internal().into_response()
}
