//! Who gets in: the limit of requests in flight, and the routes behind it.

use super::known::Known;
use super::route::Class;
use super::settle::{on_panic, settle};
use crate::http::app::App;
use crate::http::problem::{Kind, Problem};
use axum::Router;
use axum::extract::Request;
use axum::response::{IntoResponse as _, Response};
use futures_util::FutureExt as _;
use std::panic::AssertUnwindSafe;
use std::sync::Arc;
use std::sync::atomic::Ordering;
use tower_service::Service as _;

/// What stands between a request and its handler.
#[derive(Clone)]
pub(super) struct Gate {
    pub(super) app: App,
    pub(super) routes: Router,
}

impl Gate {
    /// Answers a request, whatever it is.
    pub(super) async fn answer(mut self, mut request: Request, known: Arc<Known>) -> Response {
        let response = match self.admit(&known) {
            Ok(()) => {
                request.extensions_mut().insert(Arc::clone(&known));
                match AssertUnwindSafe(self.routes.call(request)).catch_unwind().await {
                    Ok(Ok(response)) => response,
                    Err(panic) => on_panic(&*panic, &known),
                }
            }
            Err(problem) => problem.into_response(),
        };
        settle(response, &known)
    }

    /// Whether the request may go on; no byte of its body has been read.
    fn admit(&self, known: &Known) -> Result<(), Problem> {
        if matches!(known.route.class, Class::Health | Class::Metrics) {
            return Ok(());
        }
        let edge = self.app.edge();
        let limit = self.app.limits().in_flight;
        known.counted.store(true, Ordering::Relaxed);
        if edge.in_flight.fetch_add(1, Ordering::Relaxed) >= limit {
            edge.metrics.shed_in_flight.increment(1);
            let detail = format!("{limit} requests are in flight, the limit; ask again later");
            return Err(Problem::new(Kind::Overloaded, detail));
        }
        Ok(())
    }
}
