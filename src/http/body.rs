//! The JSON body of a request: checked head first, then read, then parsed.

use super::app::{App, Limits};
use super::compute;
use super::input::node;
use super::input::reader::Reader;
use super::input::wire::Wire;
use super::problem::{Code, FieldError, Kind, Problem};
use super::track::Deadline;
use axum::body::{Bytes, HttpBody as _};
use axum::extract::{FromRequest, FromRequestParts as _, Request};
use axum::http::{HeaderMap, header};
use http_body_util::BodyExt as _;

/// Bodies up to this length are parsed where they are: about 100 µs.
const SMALL: usize = 16 << 10;

/// Announced lengths that are believed before the bytes arrive.
const TRUSTED: usize = 1 << 20;
/// How many times the limit is read of a body that is too long.
const DROPPED_AT_MOST: u64 = 4;

/// A value read from a JSON body.
pub(super) struct JsonBody<T>(pub(super) T);

impl<T: Wire + Send + 'static> FromRequest<App> for JsonBody<T> {
    type Rejection = Problem;

    async fn from_request(request: Request, app: &App) -> Result<Self, Problem> {
        let limits = app.limits();
        check_content_type(request.headers())?;
        let (mut parts, body) = request.into_parts();
        let Ok(deadline) = Deadline::from_request_parts(&mut parts, app).await;
        let request = Request::from_parts(parts, body);
        let read = tokio::time::timeout_at(deadline.at, bytes(request, limits));
        let bytes = read.await.unwrap_or_else(|_| {
            let limit = limits.request_time.as_secs_f64();
            Err(Problem::new(Kind::RequestTimeout, format!("the body did not arrive within {limit} s")))
        })?;
        if bytes.len() <= SMALL {
            read_json(&bytes).map(Self)
        } else {
            compute::blocking(deadline, move || read_json(&bytes)).await?.map(Self)
        }
    }
}

/// Accepts `application/json` and `application/…+json`, in UTF-8.
fn check_content_type(headers: &HeaderMap) -> Result<(), Problem> {
    let value = headers.get(header::CONTENT_TYPE).and_then(|value| value.to_str().ok()).unwrap_or_default();
    let mut parts = value.split(';').map(|part| part.trim().to_ascii_lowercase());
    let essence = parts.next().unwrap_or_default();
    let json = essence == "application/json"
        || essence.strip_prefix("application/").is_some_and(|subtype| subtype.ends_with("+json"));
    let charset = parts.find_map(|part| Some(part.strip_prefix("charset=")?.trim_matches('"').to_owned()));
    let unicode = charset.is_none_or(|charset| charset == "utf-8" || charset == "us-ascii");
    if json && unicode {
        return Ok(());
    }
    let found = if value.is_empty() {
        "there is no Content-Type".to_owned()
    } else {
        format!("Content-Type is {value}")
    };
    Err(Problem::new(Kind::UnsupportedMediaType, format!("{found}; accepted: application/json, in UTF-8")))
}

/// All of a body within the limit.
///
/// Of a longer one some more is read and dropped: a client that sends before it listens would
/// otherwise find its connection reset instead of an answer. One that waits for `100 Continue` is
/// told at once.
async fn bytes(request: Request, limits: &Limits) -> Result<Bytes, Problem> {
    let limit = limits.body_bytes;
    let too_large = || Problem::new(Kind::ContentTooLarge, format!("the limit of a body is {limit} bytes"));
    let announced = request.body().size_hint().lower();
    if announced > limit && request.headers().contains_key(header::EXPECT) {
        return Err(too_large());
    }
    let mut body = request.into_body();
    let mut collected = Vec::with_capacity(usize::try_from(announced).unwrap_or(0).min(TRUSTED));
    let mut length = 0;
    while let Some(frame) = body.frame().await {
        let frame = frame.map_err(|error| {
            tracing::debug!(%error, "a body ended early");
            Problem::new(Kind::BodyUnreadable, "the body ended early or was not framed as HTTP asks")
        })?;
        let Ok(data) = frame.into_data() else { continue };
        length += data.len() as u64;
        if length.max(announced) <= limit {
            collected.extend_from_slice(&data);
        } else if length > limit.saturating_mul(DROPPED_AT_MOST) {
            break;
        } else {
            collected = Vec::new();
        }
    }
    if length.max(announced) > limit { Err(too_large()) } else { Ok(collected.into()) }
}

/// Parses and checks.
fn read_json<T: Wire>(bytes: &[u8]) -> Result<T, Problem> {
    let node = node::parse(bytes).map_err(|error| {
        if error.oversized {
            let pointer = String::new();
            Problem::invalid(vec![FieldError { pointer, code: Code::TooMany, detail: error.detail }])
        } else {
            Problem::new(Kind::MalformedJson, error.detail)
        }
    })?;
    let mut reader = Reader::json();
    let value = T::read(node, &mut reader);
    reader.finish(value).map_err(Problem::invalid)
}
