//! Answers in the content coding that the client wants, where that is worth it.
//!
//! A function of our own rather than a layer: it costs nothing where there is nothing to do, and what costs is done
//! on the pool for large work, not on the threads that serve connections.

use super::pack::{Packer, whole};
use super::{Coding, Wanted};
use crate::http::app::App;
use crate::http::compute::job::{Abandon, Job};
use axum::BoxError;
use axum::body::{Body, Bytes, HttpBody as _};
use axum::http::{HeaderMap, HeaderValue, StatusCode, header};
use axum::response::Response;
use futures_util::stream;
use http_body_util::BodyExt as _;
use std::io;
use std::sync::Arc;

/// Answers below this length fit a packet or two: packing them saves no time.
const WORTH_IT: u64 = 1 << 10;
/// Answers up to this length are packed where they are: a fraction of a millisecond.
const INLINE: u64 = 64 << 10;
/// Bytes that are packed in one piece of work.
const PIECE: usize = 64 << 10;

/// The answer as its client wants it.
pub(crate) async fn compress(app: &App, wanted: Wanted, is_head: bool, response: Response) -> Response {
    let length = if is_head { announced(response.headers()) } else { response.body().size_hint().exact() };
    if length.is_some_and(|length| length == 0 || (length < WORTH_IT && !wanted.always))
        || !is_packable(response.status(), response.headers())
    {
        return response;
    }
    let (mut parts, body) = response.into_parts();
    vary(&mut parts.headers);
    let Some(coding) = wanted.coding else { return Response::from_parts(parts, body) };
    parts.headers.insert(header::CONTENT_ENCODING, HeaderValue::from_static(coding.name()));
    parts.headers.remove(header::CONTENT_LENGTH);
    let body = if is_head {
        // The bytes would not be sent; how many they are packed is not known.
        Body::from_stream(stream::empty::<Result<Bytes, BoxError>>())
    } else if length.is_some_and(|length| length <= INLINE) {
        inline(coding, body).await.unwrap_or_else(failed)
    } else {
        match Packer::new(coding) {
            Ok(packer) => in_pieces(app.clone(), packer, body),
            Err(error) => failed(error.into()),
        }
    };
    Response::from_parts(parts, body)
}

/// The length of the answer to GET, whose body the router took off already.
fn announced(headers: &HeaderMap) -> Option<u64> {
    headers.get(header::CONTENT_LENGTH)?.to_str().ok()?.parse().ok()
}

/// Whether an answer's bytes may be packed and can be expected to get fewer.
fn is_packable(status: StatusCode, headers: &HeaderMap) -> bool {
    let text =
        |name| headers.get(name).and_then(|value: &HeaderValue| value.to_str().ok()).unwrap_or_default();
    let kind = text(header::CONTENT_TYPE);
    let is_packed = ["image/", "font/", "video/", "audio/", "application/zip", "application/gzip"]
        .iter()
        .any(|packed| kind.starts_with(packed))
        && !kind.starts_with("image/svg");
    !is_packed
        && !status.is_informational()
        && !matches!(status, StatusCode::NO_CONTENT | StatusCode::NOT_MODIFIED | StatusCode::PARTIAL_CONTENT)
        && !headers.contains_key(header::CONTENT_ENCODING)
        && !text(header::CACHE_CONTROL).contains("no-transform")
}

/// Says that the answer depends on `Accept-Encoding`, also where this one was left as it is.
fn vary(headers: &mut HeaderMap) {
    const NAME: &str = "accept-encoding";
    let has_it = |value: &HeaderValue| {
        let text = value.to_str().unwrap_or_default();
        text.split(',').any(|name| name.trim().eq_ignore_ascii_case(NAME) || name.trim() == "*")
    };
    if !headers.get_all(header::VARY).iter().any(has_it) {
        headers.append(header::VARY, HeaderValue::from_static(NAME));
    }
}

async fn inline(coding: Coding, body: Body) -> Result<Body, BoxError> {
    let bytes = body.collect().await?.to_bytes();
    Ok(whole(coding, &bytes)?.into())
}

/// A body that ends with an error: the client sees an answer cut short, not one that looks whole.
fn failed(error: BoxError) -> Body {
    tracing::error!(error, "an answer could not be packed");
    Body::from_stream(stream::iter([Err::<Bytes, BoxError>(error)]))
}

/// An answer that is packed while it is sent, no faster than the client takes it.
struct Packing {
    app: App,
    job: Arc<Job>,
    /// Stops the work when the client is gone.
    _abandon: Abandon,
    body: Body,
    /// Of the last frame of the body, what is not packed yet.
    rest: Bytes,
    packer: Packer,
}

fn in_pieces(app: App, packer: Packer, body: Body) -> Body {
    let (job, abandon) = Job::new(app.limits().cpu_time);
    let packing = Packing { app, job, _abandon: abandon, body, rest: Bytes::new(), packer };
    Body::from_stream(stream::try_unfold(Some(packing), |packing| async {
        match packing {
            Some(packing) => packing.next().await.map(Some),
            None => Ok(None),
        }
    }))
}

impl Packing {
    /// The next packed bytes, and what comes after them.
    async fn next(mut self) -> Result<(Bytes, Option<Self>), BoxError> {
        loop {
            if self.rest.is_empty() {
                let Some(frame) = self.body.frame().await else {
                    let packer = self.packer;
                    let last = self.app.pool().run(&self.job, move || packer.finish()).await;
                    return Ok((done(last)?.into(), None));
                };
                let Ok(data) = frame?.into_data() else { continue };
                self.rest = data;
                continue;
            }
            let piece = self.rest.split_to(self.rest.len().min(PIECE));
            // What is there goes out before more is waited for.
            let flush = self.rest.is_empty();
            let mut packer = self.packer;
            let work = move || packer.pack(&piece, flush).map(|packed| (packed, packer));
            let (packed, packer) = done(self.app.pool().run(&self.job, work).await)?;
            self.packer = packer;
            if !packed.is_empty() {
                return Ok((packed.into(), Some(self)));
            }
        }
    }
}

/// The value of a piece of work, or why the answer ends here.
fn done<T>(piece: Result<io::Result<T>, crate::http::compute::pool::NotDone>) -> Result<T, BoxError> {
    match piece {
        Ok(value) => Ok(value?),
        Err(reason) => Err(format!("an answer was packed in part: {reason:?}").into()),
    }
}
