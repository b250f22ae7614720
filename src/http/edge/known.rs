//! What is known about a request while it is answered.

use super::identity::Trace;
use super::peer::Peer;
use super::route::Route;
use crate::http::app::App;
use crate::reflectance::evaluate;
use axum::extract::FromRequestParts;
use axum::http::request::Parts;
use axum::http::{HeaderValue, Method, Uri};
use std::convert::Infallible;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
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
    /// How many directions were asked for.
    pub(super) directions: AtomicUsize,
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

/// Where a handler says what it evaluated: for the log and the metrics.
#[derive(Clone)]
pub(crate) struct Tally {
    app: App,
    known: Option<Arc<Known>>,
}

impl FromRequestParts<App> for Tally {
    type Rejection = Infallible;

    async fn from_request_parts(parts: &mut Parts, app: &App) -> Result<Self, Infallible> {
        Ok(Self { app: app.clone(), known: parts.extensions.get::<Arc<Known>>().cloned() })
    }
}

impl Tally {
    /// So many directions were asked for.
    pub(crate) fn asked(&self, directions: usize) {
        if let Some(known) = &self.known {
            known.directions.fetch_add(directions, Ordering::Relaxed);
        }
    }

    /// So many directions were evaluated, each in some way.
    pub(crate) fn evaluated(&self, tally: &evaluate::Tally) {
        for (by, directions) in tally.methods() {
            self.app.edge().metrics.evaluated(by, directions);
        }
    }
}
