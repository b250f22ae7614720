//! JSON, written in one pass into a buffer of about the right size.

use crate::http::negotiate::Format;
use crate::http::problem::Problem;
use axum::http::header;
use axum::response::{IntoResponse, Response};
use serde::Serialize;

/// The answer's bytes; `size_hint` is about how many there are.
pub(crate) fn bytes<T: Serialize>(answer: &T, size_hint: usize) -> Result<Vec<u8>, Problem> {
    let mut bytes = Vec::with_capacity(size_hint);
    serde_json::to_writer(&mut bytes, answer).map_err(|error| Problem::unwritten(&error))?;
    Ok(bytes)
}

/// The answer as a response.
pub(crate) fn response<T: Serialize>(answer: &T, size_hint: usize) -> Result<Response, Problem> {
    let bytes = bytes(answer, size_hint)?;
    Ok(([(header::CONTENT_TYPE, Format::Json.content_type())], bytes).into_response())
}
