//! One request and its answer, as the connection sees them: counted, and neither side allowed to stand still.

use super::Protocol;
use super::activity::{Activity, Exchange};
use super::answer::Answer;
use super::doors::Doors;
use super::received::Received;
use super::refusal;
use crate::http::app::Limits;
use crate::http::edge::Edge;
use axum::body::Body;
use axum::extract::Request;
use axum::http::{HeaderValue, Response, header};
use hyper::body::{Body as _, Incoming};
use std::convert::Infallible;
use std::sync::Arc;

/// A body of this length has mostly arrived with its head, and is passed over without ending the connection.
const SHORT: u64 = 4096;

/// What answers the requests of a connection.
pub(super) struct Service {
    pub(super) edge: Edge,
    pub(super) doors: Arc<Doors>,
    pub(super) limits: Limits,
    pub(super) activity: Arc<Activity>,
    pub(super) protocol: Protocol,
}

impl Service {
    /// Answers one request.
    pub(super) async fn answer(
        self: Arc<Self>,
        exchange: Exchange,
        request: Request<Incoming>,
    ) -> Result<Response<Answer>, Infallible> {
        if self.protocol == Protocol::Http2
            && let Some(refusal) =
                refusal::of_http2(request.method(), request.uri(), request.headers(), &self.limits)
        {
            let (parts, body) = refusal.into_parts();
            return Ok(Response::from_parts(parts, Answer::plain(body, exchange)));
        }
        let long = request.body().size_hint().exact().is_none_or(|length| length > SHORT);
        let request = request.map(|body| Body::new(Received::new(body, &self.activity)));
        let (mut parts, body) = self.edge.clone().answer(request).await.into_parts();
        let body = match self.protocol {
            Protocol::Http1 => {
                // Whoever reads this asks elsewhere next time, and nothing that was sent is lost. Nor can the
                // next request be found behind a body that nobody reads.
                if self.doors.are_closing() || long && self.activity.has_unread() {
                    parts.headers.insert(header::CONNECTION, HeaderValue::from_static("close"));
                }
                self.activity.answering();
                Answer::plain(body, exchange)
            }
            Protocol::Http2 => Answer::watched(body, exchange, &self.limits),
        };
        Ok(Response::from_parts(parts, body))
    }
}
