//! When a request has to be answered.

use super::known::Known;
use crate::http::app::{App, Limits};
use axum::extract::FromRequestParts;
use axum::http::request::Parts;
use std::convert::Infallible;
use std::sync::Arc;

/// When a request has to be answered.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Deadline(pub(crate) tokio::time::Instant);

impl FromRequestParts<App> for Deadline {
    type Rejection = Infallible;

    async fn from_request_parts(parts: &mut Parts, app: &App) -> Result<Self, Infallible> {
        let known = parts.extensions.get::<Arc<Known>>();
        Ok(known.map_or_else(|| Self::from_now(app.limits()), |known| known.deadline(app.limits())))
    }
}

impl Deadline {
    fn from_now(limits: &Limits) -> Self {
        Self(tokio::time::Instant::now() + limits.request_time)
    }
}
