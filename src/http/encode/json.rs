//! JSON, written in one pass into a buffer of about the right size.

use crate::http::negotiate::Format;
use crate::http::problem::Problem;
use axum::body::Body;
use axum::http::{HeaderValue, header};
use axum::response::{IntoResponse, Response};
use serde::Serialize;

/// The answer as a response; `size_hint` is about its length in bytes.
pub(crate) fn response<T: Serialize>(answer: &T, size_hint: usize) -> Response {
    let mut bytes = Vec::with_capacity(size_hint);
    if let Err(error) = serde_json::to_writer(&mut bytes, answer) {
        tracing::error!(%error, "an answer did not serialize");
        return Problem::internal().into_response();
    }
    let mut response = Response::new(Body::from(bytes));
    response
        .headers_mut()
        .insert(header::CONTENT_TYPE, HeaderValue::from_static(Format::Json.content_type()));
    response
}
