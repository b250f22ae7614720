//! What became of a request: written down once, when the last byte of its answer has left or can leave no more.

use super::known::Known;
use super::meter::Asked;
use crate::http::app::App;
use crate::http::problem::Problem;
use axum::body::{Body, Bytes, HttpBody};
use axum::response::Response;
use hyper::body::{Frame, SizeHint};
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
        self.outcome.cut = true;
        response.map(|body| Body::new(Sent { body, length, record: self }))
    }
}

impl Drop for Record {
    fn drop(&mut self) {
        self.outcome.duration = self.known.started.elapsed();
        let edge = self.app.edge();
        edge.metrics.answered(&self.known, &self.outcome);
        edge.log.write(&self.known, &self.outcome);
        if let Some(spans) = &edge.spans {
            spans.answered(&self.known, &self.outcome);
        }
        // Last: whoever sees that nothing is in flight finds it counted.
        if self.known.counted.load(Ordering::Relaxed) {
            edge.in_flight.fetch_sub(1, Ordering::Relaxed);
        }
    }
}

/// A body on its way.
struct Sent {
    body: Body,
    length: Option<u64>,
    record: Record,
}

impl HttpBody for Sent {
    type Data = Bytes;
    type Error = axum::Error;

    fn poll_frame(
        mut self: Pin<&mut Self>,
        cx: &mut Context<'_>,
    ) -> Poll<Option<Result<Frame<Bytes>, axum::Error>>> {
        let frame = ready!(Pin::new(&mut self.body).poll_frame(cx));
        let length = self.length;
        let outcome = &mut self.record.outcome;
        match &frame {
            Some(Ok(frame)) => {
                outcome.bytes += frame.data_ref().map_or(0, |data| data.len() as u64);
                // Nobody asks for what comes after the last byte of a known length.
                outcome.cut = length != Some(outcome.bytes);
            }
            Some(Err(_)) => {}
            None => outcome.cut = false,
        }
        Poll::Ready(frame)
    }

    fn is_end_stream(&self) -> bool {
        self.body.is_end_stream()
    }

    fn size_hint(&self) -> SizeHint {
        self.body.size_hint()
    }
}
