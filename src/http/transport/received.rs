//! The body of a request, and whether all of it was read.

use super::activity::Activity;
use axum::body::{Bytes, HttpBody};
use hyper::body::{Frame, Incoming, SizeHint};
use std::pin::Pin;
use std::sync::Arc;
use std::task::{Context, Poll};

/// A body that tells its connection if it is dropped before its end.
#[derive(Debug)]
pub(super) struct Received {
    body: Incoming,
    unread: Option<Arc<Activity>>,
}

impl Received {
    pub(super) fn new(body: Incoming, activity: &Arc<Activity>) -> Self {
        let unread = (!body.is_end_stream()).then(|| Arc::clone(activity));
        Self { body, unread }
    }
}

impl HttpBody for Received {
    type Data = Bytes;
    type Error = hyper::Error;

    fn poll_frame(
        mut self: Pin<&mut Self>,
        cx: &mut Context,
    ) -> Poll<Option<Result<Frame<Bytes>, hyper::Error>>> {
        let frame = Pin::new(&mut self.body).poll_frame(cx);
        if matches!(frame, Poll::Ready(None)) {
            self.unread = None;
        }
        frame
    }

    fn is_end_stream(&self) -> bool {
        self.body.is_end_stream()
    }

    fn size_hint(&self) -> SizeHint {
        self.body.size_hint()
    }
}

impl Drop for Received {
    fn drop(&mut self) {
        if let Some(activity) = &self.unread
            && !self.body.is_end_stream()
        {
            activity.leave_unread();
        }
    }
}
