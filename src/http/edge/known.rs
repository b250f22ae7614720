//! What is known about a request while it is answered.

use super::identity::Trace;
use super::peer::Peer;
use super::route::Route;
use axum::http::{HeaderValue, Method, Uri};
use std::sync::atomic::AtomicBool;
use std::sync::{Arc, OnceLock};
use tokio::time::Instant;

/// What is known about a request, for the log, the metrics and the trace.
#[derive(Debug)]
pub(super) struct Known {
    pub(super) started: Instant,
    pub(super) method: Method,
    pub(super) uri: Uri,
    pub(super) route: &'static Route,
    pub(super) id: HeaderValue,
    pub(super) trace: Option<Trace>,
    pub(super) peer: Arc<Peer>,
    /// The name of the key that was shown.
    pub(super) key: OnceLock<Arc<str>>,
    /// Whether it counts as in flight.
    pub(super) counted: AtomicBool,
}

impl Known {
    /// The path as it was asked for.
    pub(super) fn path(&self) -> &str {
        self.uri.path()
    }

    /// Who asks, for people: the key's name, or else the address.
    pub(super) fn client(&self) -> &str {
        self.key.get().map_or(self.peer.text(), |name| name)
    }
}
