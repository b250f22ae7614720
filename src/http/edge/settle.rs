//! What leaves the service in place of a handler's error, or of one that a library underneath made.

use super::known::Known;
use crate::http::app::App;
use crate::http::coding::Wanted;
use crate::http::coding::compress::compress;
use crate::http::problem::{Kind, Problem};
use axum::body::{Body, HttpBody as _};
use axum::http::{HeaderValue, Method, StatusCode, header};
use axum::response::{IntoResponse as _, Response};
use std::any::Any;

/// Gives every error its document, the client the coding that it wants, and HEAD no body.
pub(super) async fn settle(app: &App, wanted: Wanted, response: Response, known: &Known) -> Response {
    let response = with_document(response, &known.method, known.path());
    let is_head = known.method == Method::HEAD;
    let mut response = compress(app, wanted, is_head, response).await;
    if is_head {
        // The length is that of the answer to GET; the bytes stay here.
        if let Some(length) = response.body().size_hint().exact() {
            response.headers_mut().entry(header::CONTENT_LENGTH).or_insert(length.into());
        }
        *response.body_mut() = Body::empty();
    }
    response
}

fn with_document(response: Response, method: &Method, path: &str) -> Response {
    let status = response.status();
    if status.is_success() || status.is_redirection() {
        return response;
    }
    if status == StatusCode::METHOD_NOT_ALLOWED {
        return method_not_allowed(&response, method, path);
    }
    if let Some(problem) = response.extensions().get::<Problem>() {
        let mut document = problem.render(path);
        if status.is_server_error() {
            // For the log.
            document.extensions_mut().insert(problem.clone());
        }
        return document;
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

/// No route has this path.
pub(crate) fn not_found() -> Problem {
    Problem::new(Kind::NotFound, "No resource has this path. The reference at /docs lists those that exist.")
}

/// A panic in a handler is a defect. It costs its own request and no other.
pub(super) fn on_panic(panic: &(dyn Any + Send), known: &Known) -> Response {
    let message = panic
        .downcast_ref::<&str>()
        .map(|text| (*text).to_owned())
        .or_else(|| panic.downcast_ref::<String>().cloned())
        .unwrap_or_default();
    tracing::error!(message, request_id = ?known.id, "a handler panicked");
    Problem::internal().into_response()
}
