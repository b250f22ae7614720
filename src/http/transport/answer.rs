//! The body of an answer, whose receiver may not stand still.
//!
//! Over HTTP/1 the socket shows whether the client takes what it is sent, and the connection ends if it does not.
//! Over HTTP/2 a client may stop a single answer and keep the rest moving. Each answer that does not fit into a
//! buffer is watched by itself there, and what makes it is dropped when nobody takes it: memory, its turn among
//! the large requests, and the work behind it.

use super::activity::{Exchange, now};
use crate::http::app::Limits;
use axum::body::{Body, Bytes, HttpBody};
use futures_util::task::AtomicWaker;
use hyper::body::{Frame, SizeHint};
use std::pin::Pin;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError, Weak};
use std::task::{Context, Poll, ready};
use std::time::Duration;

/// What one stream of HTTP/2 may hold of its answer for a client that does not take it.
pub(super) const BUFFER: usize = 64 << 10;

/// An answer's body.
#[derive(Debug)]
pub(super) enum Answer {
    /// Not watched.
    Plain(Body, Option<Exchange>),
    /// Watched.
    Watched(Arc<Watched>),
}

impl Answer {
    pub(super) fn plain(body: Body, exchange: Exchange) -> Self {
        Self::Plain(body, Some(exchange))
    }

    /// Watched unless it fits into the buffer of a stream: then it counts as sent, and does not keep a connection
    /// that is otherwise idle.
    pub(super) fn watched(body: Body, exchange: Exchange, limits: &Limits) -> Self {
        if body.size_hint().upper().is_some_and(|length| length <= BUFFER as u64) {
            return Self::Plain(body, None);
        }
        let watched = Arc::new(Watched {
            held: Mutex::new(Some(Held { body, rest: Bytes::new(), _exchange: exchange })),
            taken: AtomicU64::new(now()),
            waiting: AtomicBool::new(false),
            waker: AtomicWaker::new(),
        });
        tokio::spawn(watch(Arc::downgrade(&watched), limits.stall_time, limits.answer_time));
        Self::Watched(watched)
    }
}

impl HttpBody for Answer {
    type Data = Bytes;
    type Error = axum::Error;

    fn poll_frame(self: Pin<&mut Self>, cx: &mut Context) -> Poll<Option<Result<Frame<Bytes>, axum::Error>>> {
        match self.get_mut() {
            Self::Plain(body, exchange) => {
                let frame = ready!(Pin::new(body).poll_frame(cx));
                if frame.is_none() {
                    *exchange = None;
                }
                Poll::Ready(frame)
            }
            Self::Watched(watched) => watched.poll_frame(cx),
        }
    }

    fn is_end_stream(&self) -> bool {
        match self {
            Self::Plain(body, _) => body.is_end_stream(),
            Self::Watched(watched) => {
                watched.hold().as_ref().is_some_and(|held| held.rest.is_empty() && held.body.is_end_stream())
            }
        }
    }

    fn size_hint(&self) -> SizeHint {
        match self {
            Self::Plain(body, _) => body.size_hint(),
            Self::Watched(watched) => {
                // Asked before the first frame, when there is no rest.
                watched.hold().as_ref().map_or_else(SizeHint::default, |held| held.body.size_hint())
            }
        }
    }
}

/// An answer's body that is dropped if nobody takes it.
#[derive(Debug)]
pub(super) struct Watched {
    held: Mutex<Option<Held>>,
    /// When something was last taken of it.
    taken: AtomicU64,
    /// It is the client who waits.
    waiting: AtomicBool,
    waker: AtomicWaker,
}

#[derive(Debug)]
struct Held {
    body: Body,
    /// What is left of a piece too long for the buffer.
    rest: Bytes,
    _exchange: Exchange,
}

impl Watched {
    fn hold(&self) -> MutexGuard<'_, Option<Held>> {
        self.held.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn poll_frame(&self, cx: &mut Context) -> Poll<Option<Result<Frame<Bytes>, axum::Error>>> {
        self.waker.register(cx.waker());
        let mut held = self.hold();
        let Some(Held { body, rest, .. }) = held.as_mut() else {
            return Poll::Ready(Some(Err(axum::Error::new("the client did not take the answer in time"))));
        };
        if rest.is_empty() {
            let polled = Pin::new(body).poll_frame(cx);
            self.waiting.store(polled.is_pending(), Ordering::Relaxed);
            self.taken.store(now(), Ordering::Relaxed);
            match ready!(polled).map(|frame| frame.map(Frame::into_data)) {
                Some(Ok(Ok(data))) => *rest = data,
                Some(Ok(Err(other))) => return Poll::Ready(Some(Ok(other))),
                Some(Err(error)) => return Poll::Ready(Some(Err(error))),
                None => return Poll::Ready(None),
            }
        } else {
            self.taken.store(now(), Ordering::Relaxed);
        }
        let length = rest.len().min(BUFFER);
        Poll::Ready(Some(Ok(Frame::data(rest.split_to(length)))))
    }

    /// The milliseconds after which to look again; none if it was dropped.
    fn look(&self, stall_time: u64, end: u64) -> Option<u64> {
        let now = now();
        let stalled = if self.waiting.load(Ordering::Relaxed) {
            now + stall_time
        } else {
            self.taken.load(Ordering::Relaxed) + stall_time
        };
        let due = stalled.min(end);
        if now < due {
            return Some(due - now);
        }
        *self.hold() = None;
        self.waker.wake();
        tracing::debug!("an answer that was not taken in time was dropped");
        None
    }
}

/// Looks at an answer until it is sent.
async fn watch(watched: Weak<Watched>, stall_time: Duration, answer_time: Duration) {
    let stall_time = super::milliseconds(stall_time);
    let end = now() + super::milliseconds(answer_time);
    while let Some(wait) = watched.upgrade().and_then(|watched| watched.look(stall_time, end)) {
        // The clock that is read is coarser than the one that wakes.
        tokio::time::sleep(Duration::from_millis(wait + 5)).await;
    }
}
