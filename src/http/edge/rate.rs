//! How often one client may ask.

use super::known::Known;
use crate::config::Access;
use axum::http::{HeaderMap, HeaderName, HeaderValue, header};
use governor::clock::{Clock as _, DefaultClock};
use governor::middleware::StateInformationMiddleware;
use governor::state::keyed::DefaultKeyedStateStore;
use governor::{Quota, RateLimiter};
use std::num::NonZeroU32;
use std::sync::Arc;
use std::time::Duration;

/// The draft of the IETF (httpapi, RateLimit header fields).
pub(super) const RATE_LIMIT: HeaderName = HeaderName::from_static("ratelimit");
pub(super) const RATE_LIMIT_POLICY: HeaderName = HeaderName::from_static("ratelimit-policy");
/// What clients of before that draft read.
pub(super) const LIMIT: HeaderName = HeaderName::from_static("ratelimit-limit");
pub(super) const REMAINING: HeaderName = HeaderName::from_static("ratelimit-remaining");
pub(super) const RESET: HeaderName = HeaderName::from_static("ratelimit-reset");

/// Who shares one allowance.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
enum Client {
    Key(Arc<str>),
    Address(u64),
}

type Limiter = RateLimiter<Client, DefaultKeyedStateStore<Client>, DefaultClock, StateInformationMiddleware>;

/// The allowance of every client: `burst` at once, and `rate` a second from then on.
pub(super) struct RateLimit {
    limiter: Limiter,
    clock: DefaultClock,
    rate: NonZeroU32,
    burst: NonZeroU32,
    policy: HeaderValue,
    limit: HeaderValue,
}

/// Where a client stands after a request.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Standing {
    /// Requests that it may still make at once.
    remaining: u32,
    /// Seconds until it has its whole allowance again.
    reset: u64,
    /// Seconds until it may ask again, if it may not now.
    pub(super) wait: Option<u64>,
}

impl RateLimit {
    /// None if there is no limit.
    pub(super) fn new(access: &Access) -> Option<Self> {
        let [rate, burst] = access.rate_limit()?;
        let quota = Quota::per_second(rate).allow_burst(burst);
        let window = u64::from(burst.get()).div_ceil(u64::from(rate.get()));
        Some(Self {
            limiter: RateLimiter::keyed(quota).with_middleware(),
            clock: DefaultClock::default(),
            rate,
            burst,
            policy: HeaderValue::from_str(&format!("\"default\";q={burst};w={window}")).ok()?,
            limit: HeaderValue::from(burst.get()),
        })
    }

    /// Counts a request. None where nobody knows whose it is: it came from within the process.
    pub(super) fn check(&self, known: &Known) -> Option<Standing> {
        let client = match known.key.get() {
            Some(name) => Client::Key(Arc::clone(name)),
            None => Client::Address(known.peer.client()?),
        };
        let seconds = |requests: u32| u64::from(requests).div_ceil(u64::from(self.rate.get()));
        Some(match self.limiter.check_key(&client) {
            Ok(state) => {
                let remaining = state.remaining_burst_capacity().min(self.burst.get());
                Standing { remaining, reset: seconds(self.burst.get() - remaining), wait: None }
            }
            Err(later) => {
                let wait = whole_seconds(later.wait_time_from(self.clock.now()));
                Standing { remaining: 0, reset: seconds(self.burst.get()), wait: Some(wait) }
            }
        })
    }

    /// What a client is told that asked too often.
    pub(super) fn refusal(&self, wait: u64) -> String {
        let (rate, burst) = (self.rate, self.burst);
        format!(
            "a client may ask {rate} times a second, and {burst} times at once after a pause; ask again in {wait} s"
        )
    }

    /// Tells a client where it stands.
    pub(super) fn add(&self, standing: Standing, headers: &mut HeaderMap) {
        let Standing { remaining, reset, wait } = standing;
        let next = wait.unwrap_or(reset);
        if let Ok(value) = HeaderValue::from_str(&format!("\"default\";r={remaining};t={next}")) {
            headers.insert(RATE_LIMIT, value);
        }
        headers.insert(RATE_LIMIT_POLICY, self.policy.clone());
        headers.insert(LIMIT, self.limit.clone());
        headers.insert(REMAINING, remaining.into());
        headers.insert(RESET, next.into());
        if let Some(wait) = wait {
            headers.insert(header::RETRY_AFTER, wait.into());
        }
    }

    /// Forgets clients that have their whole allowance again.
    pub(super) fn tidy(&self) {
        self.limiter.retain_recent();
        self.limiter.shrink_to_fit();
    }
}

/// At least one: a client told to ask again at once would be refused again.
fn whole_seconds(wait: Duration) -> u64 {
    (wait.as_secs() + u64::from(wait.subsec_nanos() > 0)).max(1)
}
