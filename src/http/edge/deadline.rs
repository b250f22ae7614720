//! When a request has to be answered.

use super::known::Known;
use crate::http::app::{App, Limits};
use axum::extract::FromRequestParts;
use axum::http::request::Parts;
use std::convert::Infallible;
use std::sync::Arc;
use std::time::Duration;
use tokio::time::Instant;

/// When a request has to be answered.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Deadline {
    pub(crate) at: Instant,
    /// How long it was at first: for messages.
    pub(crate) limit: Duration,
}

impl Deadline {
    fn new(started: Instant, limits: &Limits) -> Self {
        Self { at: started + limits.request_time, limit: limits.request_time }
    }
}

impl FromRequestParts<App> for Deadline {
    type Rejection = Infallible;

    async fn from_request_parts(parts: &mut Parts, app: &App) -> Result<Self, Infallible> {
        let started = parts.extensions.get::<Arc<Known>>().map_or_else(Instant::now, |known| known.started);
        Ok(Self::new(started, app.limits()))
    }
}
