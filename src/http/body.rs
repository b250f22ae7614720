//! Bodies of requests: checked head first, then read, then parsed. JSON, or columns of directions with the rest of the
//! request in the query.

use super::app::App;
use super::coding::expand;
use super::compute;
use super::compute::admission::Turn;
use super::decode;
use super::edge::Deadline;
use super::input::node;
use super::input::object::WireObject;
use super::input::query;
use super::input::reader::Reader;
use super::input::wire::Wire;
use super::negotiate::Format;
use super::problem::{Code, FieldError, Kind, Problem};
use axum::body::{Body, Bytes, HttpBody as _};
use axum::extract::{FromRequest, FromRequestParts as _, Request};
use axum::http::request::Parts;
use axum::http::{HeaderMap, header};
use http_body_util::BodyExt as _;
use tokio::time::{Instant, timeout_at};

/// Bodies up to this length are parsed where they are: about 100 µs.
const SMALL: usize = 16 << 10;

/// Bodies beyond this length are read only in turn: before, they cost no more than their connection.
const LARGE: u64 = 64 << 10;

/// Announced lengths that are believed before the bytes arrive.
const TRUSTED: usize = 1 << 20;
/// Bytes of a body that are taken before others have their turn: a tenth of a millisecond.
const AT_ONCE: usize = 128 << 10;

/// How many times the limit is read of a body that is too long.
const DROPPED_AT_MOST: u64 = 4;

/// A value read from a JSON body.
pub(super) struct JsonBody<T> {
    pub(super) value: T,
    /// What a large body waited for, good for the work as well: held until the request is answered.
    pub(super) turn: Option<Turn>,
}

impl<T: Wire + Send + 'static> FromRequest<App> for JsonBody<T> {
    type Rejection = Problem;

    async fn from_request(request: Request, app: &App) -> Result<Self, Problem> {
        check_content_type(request.headers(), &[Format::Json])?;
        let Received { bytes, turn, deadline, .. } = receive(request, app).await?;
        let most = app.limits().directions;
        let value = parsed(deadline, bytes, move |bytes| read_json(bytes, most)).await?;
        Ok(Self { value, turn })
    }
}

/// A value read from a JSON body, or from columns in the body and the rest in the query.
pub(super) struct JsonOrColumns<T> {
    pub(super) value: T,
    /// Of the body.
    pub(super) format: Format,
    /// As that of [`JsonBody`].
    pub(super) turn: Option<Turn>,
}

impl<T: WireObject + Wire + Send + 'static> FromRequest<App> for JsonOrColumns<T> {
    type Rejection = Problem;

    async fn from_request(request: Request, app: &App) -> Result<Self, Problem> {
        let format = check_content_type(request.headers(), &Format::TABULAR)?;
        let Received { bytes, turn, deadline, parts } = receive(request, app).await?;
        let most = app.limits().directions;
        let value = parsed(deadline, bytes, move |bytes| {
            let query = parts.uri.query().unwrap_or_default();
            if format == Format::Json {
                query::refuse(query, "in the body, which is JSON")?;
                return read_json(bytes, most);
            }
            let mut reader = Reader::query().with_most_directions(most);
            let columns = decode::columns(format, bytes, &mut reader)?;
            query::read_beside(query, columns, reader)
        });
        Ok(Self { value: value.await?, format, turn })
    }
}

/// Which of the accepted formats the body is declared as; text in UTF-8.
fn check_content_type(headers: &HeaderMap, accepted: &[Format]) -> Result<Format, Problem> {
    let value = headers.get(header::CONTENT_TYPE).and_then(|value| value.to_str().ok()).unwrap_or_default();
    let mut parts = value.split(';').map(|part| part.trim().to_ascii_lowercase());
    let essence = parts.next().unwrap_or_default();
    let json = essence.strip_prefix("application/").is_some_and(|subtype| subtype.ends_with("+json"));
    let format = if json { Some(Format::Json) } else { Format::named(&essence) };
    let charset = parts.find_map(|part| Some(part.strip_prefix("charset=")?.trim_matches('"').to_owned()));
    let unicode = charset.is_none_or(|charset| charset == "utf-8" || charset == "us-ascii");
    if let Some(format) = format.filter(|format| unicode && accepted.contains(format)) {
        return Ok(format);
    }
    let found = if value.is_empty() {
        "there is no Content-Type".to_owned()
    } else {
        format!("Content-Type is {value}")
    };
    let list = accepted.iter().map(|format| format.media_type()).collect::<Vec<_>>().join(", ");
    Err(Problem::new(Kind::UnsupportedMediaType, format!("{found}; accepted: {list}, in UTF-8")))
}

/// A request whose body has arrived.
struct Received {
    parts: Parts,
    bytes: Bytes,
    turn: Option<Turn>,
    deadline: Deadline,
}

/// All of a body within the limit.
async fn receive(request: Request, app: &App) -> Result<Received, Problem> {
    let (mut parts, body) = request.into_parts();
    let Ok(deadline) = Deadline::from_request_parts(&mut parts, app).await;
    let coding = expand::coding(&parts.headers)?;
    let mut incoming = Incoming { app, deadline, body, turn: None };
    let mut bytes = incoming.bytes(&parts.headers).await?;
    let mut turn = incoming.turn;
    if let Some(coding) = coding {
        bytes = expand::body(app, deadline, &mut turn, coding, bytes).await?;
    }
    Ok(Received { parts, bytes, turn, deadline })
}

/// A body on its way.
struct Incoming<'a> {
    app: &'a App,
    deadline: Deadline,
    body: Body,
    turn: Option<Turn>,
}

impl Incoming<'_> {
    /// Reads to the end.
    ///
    /// Of a body that is longer than the limit some more is read and dropped: a client that sends before it listens
    /// would otherwise find its connection reset instead of an answer. One that waits for `100 Continue` is told at
    /// once.
    async fn bytes(&mut self, headers: &HeaderMap) -> Result<Bytes, Problem> {
        let limit = self.app.limits().body_bytes;
        let too_large =
            || Problem::new(Kind::ContentTooLarge, format!("the limit of a body is {limit} bytes"));
        let announced = self.body.size_hint().lower();
        if announced > limit && headers.contains_key(header::EXPECT) {
            return Err(too_large());
        }
        if announced <= limit {
            self.await_turn(announced).await?;
        }
        // Whoever has a turn is believed: growing in steps copies megabytes while small requests wait.
        let trusted = if self.turn.is_some() { usize::MAX } else { TRUSTED };
        let mut collected = Vec::with_capacity(usize::try_from(announced).unwrap_or(0).min(trusted));
        let mut length = 0;
        let mut at_once = 0;
        while let Some(data) = self.next().await? {
            length += data.len() as u64;
            at_once += data.len();
            if at_once > AT_ONCE {
                // What has arrived already would be copied without a pause, while small requests wait.
                tokio::task::yield_now().await;
                at_once = 0;
            }
            if length.max(announced) <= limit {
                self.await_turn(length).await?;
                collected.extend_from_slice(&data);
            } else if length > limit.saturating_mul(DROPPED_AT_MOST) {
                break;
            } else {
                collected = Vec::new();
            }
        }
        if length.max(announced) > limit { Err(too_large()) } else { Ok(collected.into()) }
    }

    /// Waits until a body of this length may be read.
    async fn await_turn(&mut self, length: u64) -> Result<(), Problem> {
        if length > LARGE && self.turn.is_none() {
            self.turn = Some(self.app.admission().turn().await?);
        }
        Ok(())
    }

    /// What arrives next.
    async fn next(&mut self) -> Result<Option<Bytes>, Problem> {
        let limits = self.app.limits();
        let stalled = Instant::now() + limits.stall_time;
        loop {
            let frame = match timeout_at(stalled.min(self.deadline.at), self.body.frame()).await {
                Ok(Some(frame)) => frame,
                Ok(None) => return Ok(None),
                Err(_) => {
                    let detail = if stalled < self.deadline.at {
                        format!("nothing of the body arrived for {} s", limits.stall_time.as_secs_f64())
                    } else {
                        format!("the body did not arrive within {} s", self.deadline.limit.as_secs_f64())
                    };
                    return Err(Problem::new(Kind::RequestTimeout, detail));
                }
            };
            let frame = frame.map_err(|error| {
                tracing::debug!(%error, "a body ended early");
                Problem::new(Kind::BodyUnreadable, "the body ended early or was not framed as HTTP asks")
            })?;
            if let Ok(data) = frame.into_data() {
                return Ok(Some(data));
            }
        }
    }
}

/// Parses small bodies at once, large ones off the threads that serve connections.
async fn parsed<T: Send + 'static>(
    deadline: Deadline,
    bytes: Bytes,
    parse: impl FnOnce(&[u8]) -> Result<T, Problem> + Send + 'static,
) -> Result<T, Problem> {
    if bytes.len() <= SMALL {
        parse(&bytes)
    } else {
        compute::blocking(deadline, move || parse(&bytes)).await?
    }
}

/// Parses and checks.
fn read_json<T: Wire>(bytes: &[u8], most_directions: usize) -> Result<T, Problem> {
    let node = node::parse(bytes).map_err(|error| {
        if error.oversized {
            let pointer = String::new();
            Problem::invalid(vec![FieldError { pointer, code: Code::TooMany, detail: error.detail }])
        } else {
            Problem::new(Kind::MalformedJson, error.detail)
        }
    })?;
    let mut reader = Reader::json().with_most_directions(most_directions);
    let value = T::read(node, &mut reader);
    reader.finish(value).map_err(Problem::invalid)
}
