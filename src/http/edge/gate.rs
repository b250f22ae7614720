//! Who gets in: keys, the allowance of a client, the limit of requests in flight; and the routes behind.

use super::keys::Refused;
use super::known::Known;
use super::rate::Standing;
use super::route::Class;
use super::settle::{on_panic, settle};
use crate::http::app::App;
use crate::http::coding::Wanted;
use crate::http::link::take_version;
use crate::http::problem::{Kind, Problem};
use axum::Router;
use axum::extract::Request;
use axum::http::{HeaderMap, HeaderValue, header};
use axum::response::{IntoResponse as _, Response};
use futures_util::FutureExt as _;
use std::panic::AssertUnwindSafe;
use std::sync::Arc;
use std::sync::atomic::Ordering;
use tower_service::Service as _;

/// How to show a key, RFC 6750.
const CHALLENGE: HeaderValue = HeaderValue::from_static("Bearer realm=\"reflectance\"");
const CHALLENGE_AGAIN: HeaderValue =
    HeaderValue::from_static("Bearer realm=\"reflectance\", error=\"invalid_token\"");

/// What stands between a request and its handler.
#[derive(Clone)]
pub(super) struct Gate {
    pub(super) app: App,
    pub(super) routes: Router,
}

/// Why a request does not get in.
enum Closed {
    Key(Refused),
    Often { wait: u64 },
    Full,
}

impl Gate {
    /// Answers a request, whatever it is.
    pub(super) async fn answer(mut self, mut request: Request, known: Arc<Known>) -> Response {
        let (standing, open) = self.open(&known, request.headers());
        let wanted = Wanted::of(request.headers());
        let response = match &open {
            Ok(()) => match take_version(&mut request) {
                Ok(()) => {
                    request.extensions_mut().insert(Arc::clone(&known));
                    match AssertUnwindSafe(self.routes.call(request)).catch_unwind().await {
                        Ok(Ok(response)) => response,
                        Err(panic) => on_panic(&*panic, &known),
                    }
                }
                Err(problem) => problem.into_response(),
            },
            Err(closed) => self.problem(closed).into_response(),
        };
        if open.is_ok() && response.extensions().get().is_some_and(Problem::is_overload) {
            self.app.edge().metrics.shed_queue.increment(1);
        }
        let mut response = settle(&self.app, wanted, response, &known).await;
        if let Err(Closed::Key(refused)) = open {
            let challenge = if refused == Refused::Missing { CHALLENGE } else { CHALLENGE_AGAIN };
            response.headers_mut().insert(header::WWW_AUTHENTICATE, challenge);
        }
        if let (Some(rate), Some(standing)) = (&self.app.edge().rate, standing) {
            rate.add(standing, response.headers_mut());
        }
        response
    }

    /// Whether the request may go on; no byte of its body has been read. And where its client stands.
    fn open(&self, known: &Known, headers: &HeaderMap) -> (Option<Standing>, Result<(), Closed>) {
        let edge = self.app.edge();
        let class = known.route.class;
        let key = match &edge.keys {
            Some(keys) if matches!(class, Class::Guarded | Class::Metrics) => keys.name(headers).map(Some),
            _ => Ok(None),
        };
        let key = key.map(|name| name.map(|name| known.key.set(name)));
        if matches!(class, Class::Health | Class::Metrics) {
            return (None, key.map(drop).map_err(|refused| self.refuse(refused)));
        }
        // Guesses at keys count against the address that they come from.
        let standing = edge.rate.as_ref().and_then(|rate| rate.check(known));
        if let Some(wait) = standing.and_then(|standing| standing.wait) {
            edge.metrics.rate_limited.increment(1);
            return (standing, Err(Closed::Often { wait }));
        }
        if let Err(refused) = key {
            return (standing, Err(self.refuse(refused)));
        }
        known.counted.store(true, Ordering::Relaxed);
        if edge.in_flight.fetch_add(1, Ordering::Relaxed) >= self.app.limits().in_flight {
            edge.metrics.shed_in_flight.increment(1);
            return (standing, Err(Closed::Full));
        }
        (standing, Ok(()))
    }

    fn refuse(&self, refused: Refused) -> Closed {
        let metrics = &self.app.edge().metrics;
        match refused {
            Refused::Missing => metrics.keys_missing.increment(1),
            Refused::Wrong => metrics.keys_wrong.increment(1),
        }
        Closed::Key(refused)
    }

    fn problem(&self, closed: &Closed) -> Problem {
        let asked =
            "send the header Authorization: Bearer and a key that the operator of the service gave you";
        match closed {
            Closed::Key(Refused::Missing) => {
                Problem::new(Kind::Unauthorized, format!("no key was sent; {asked}"))
            }
            Closed::Key(Refused::Wrong) => {
                Problem::new(Kind::Unauthorized, format!("the key that was sent is not in force; {asked}"))
            }
            Closed::Often { wait } => {
                let refusal = self.app.edge().rate.as_ref().map(|rate| rate.refusal(*wait));
                Problem::new(Kind::RateLimited, refusal.unwrap_or_default())
            }
            Closed::Full => {
                let limit = self.app.limits().in_flight;
                let detail = format!("{limit} requests are in flight, the limit; ask again later");
                Problem::new(Kind::Overloaded, detail)
            }
        }
    }
}
