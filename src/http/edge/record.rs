//! What became of a request: written down once, when the last byte of its answer has left or can leave no more.

use super::known::Known;
use super::meter::Asked;
use crate::http::app::App;
use crate::http::problem::Problem;
use axum::body::{Body, BodyDataStream, Bytes, HttpBody as _};
use axum::http::header;
use axum::response::Response;
use futures_util::Stream;
use std::pin::Pin;
use std::sync::Arc;
use std::sync::atomic::Ordering;
use std::task::{Context, Poll, ready};
use std::time::Duration;

/// What is logged of a request that nobody waited for: the client left before there was an answer.
pub(super) const CLIENT_LEFT: u16 = 499;
/// Answers up to this length count as sent once they are made: they fit a socket's buffer.
const SHORT: u64 = 64 << 10;

/// How a request ended.
#[derive(Debug)]
pub(super) struct Outcome {
    pub(super) status: u16,
    /// From the head of the request to the end of the answer.
    pub(super) duration: Duration,
    /// Of the answer's body, as it left.
    pub(super) bytes: u64,
    /// Whether the answer ended before its end.
    pub(super) cut: bool,
    /// How many directions were asked for, where that is known.
    pub(super) directions: usize,
    /// What went wrong, where that is the service's own matter.
    pub(super) problem: Option<String>,
}

impl Outcome {
    pub(super) fn microseconds(&self) -> u64 {
        u64::try_from(self.duration.as_micros()).unwrap_or(u64::MAX)
    }
}

/// Writes down what became of a request when it is dropped.
pub(super) struct Record {
    app: App,
    known: Arc<Known>,
    outcome: Outcome,
}

impl Record {
    pub(super) fn new(app: App, known: Arc<Known>) -> Self {
        let outcome = Outcome {
            status: CLIENT_LEFT,
            duration: Duration::ZERO,
            bytes: 0,
            directions: 0,
            cut: false,
            problem: None,
        };
        Self { app, known, outcome }
    }

    /// The request is answered. A long answer, and one whose length nobody knows, takes the record along.
    pub(super) fn answered(mut self, response: Response) -> Response {
        self.outcome.status = response.status().as_u16();
        if let Some(Asked(directions)) = response.extensions().get() {
            self.outcome.directions = *directions;
        }
        if response.status().is_server_error()
            && let Some(problem) = response.extensions().get::<Problem>()
        {
            self.outcome.problem = Some(problem.summary());
        }
        let length = response.body().size_hint().exact();
        if let Some(length) = length.filter(|length| *length <= SHORT) {
            self.outcome.bytes = length;
            return response;
        }
        let (mut parts, body) = response.into_parts();
        if let Some(length) = length {
            // The stream below does not say its length.
            parts.headers.insert(header::CONTENT_LENGTH, length.into());
        }
        self.outcome.cut = true;
        let body = Body::from_stream(Sent { body: body.into_data_stream(), length, record: self });
        Response::from_parts(parts, body)
    }
}

impl Drop for Record {
    fn drop(&mut self) {
        self.outcome.duration = self.known.started.elapsed();
        let edge = self.app.edge();
        if self.known.counted.load(Ordering::Relaxed) {
            edge.in_flight.fetch_sub(1, Ordering::Relaxed);
        }
        edge.metrics.answered(&self.known, &self.outcome);
        edge.log.write(&self.known, &self.outcome);
        if let Some(spans) = &edge.spans {
            spans.answered(&self.known, &self.outcome);
        }
    }
}

/// A body on its way.
struct Sent {
    body: BodyDataStream,
    length: Option<u64>,
    record: Record,
}

impl Stream for Sent {
    type Item = Result<Bytes, axum::Error>;

    fn poll_next(mut self: Pin<&mut Self>, cx: &mut Context<'_>) -> Poll<Option<Self::Item>> {
        let piece = ready!(Pin::new(&mut self.body).poll_next(cx));
        let this = &mut *self;
        let outcome = &mut this.record.outcome;
        match &piece {
            Some(Ok(bytes)) => {
                outcome.bytes += bytes.len() as u64;
                // Nobody asks for what comes after the last byte of a known length.
                outcome.cut = this.length != Some(outcome.bytes);
            }
            Some(Err(_)) => {}
            None => outcome.cut = false,
        }
        Poll::Ready(piece)
    }
}
