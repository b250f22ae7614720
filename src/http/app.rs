//! What every handler may need: the limits, the pool for large work, and who may enter it.

use super::compute::admission::Admission;
use super::compute::pool::Pool;
use super::edge;
use super::transport::doors::Doors;
use crate::config::Config;
use std::num::NonZeroU32;
use std::sync::Arc;
use std::time::Duration;

/// The service's shared state; a clone is another handle to it.
#[derive(Clone)]
pub(crate) struct App(Arc<Shared>);

struct Shared {
    limits: Limits,
    pool: Pool,
    admission: Admission,
    edge: edge::State,
    doors: Arc<Doors>,
}

/// What a request may be and take. Each has a flag, a place in `/v1/limits` and in the message of the error it causes.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Limits {
    pub(crate) body_bytes: u64,
    pub(crate) expanded_body_bytes: u64,
    pub(crate) head_bytes: u64,
    pub(crate) directions: usize,
    pub(crate) rows: usize,
    pub(crate) incidences: usize,
    /// From the head of a request to the beginning of its answer.
    pub(crate) request_time: Duration,
    /// From the beginning of an answer to its end.
    pub(crate) answer_time: Duration,
    pub(crate) cpu_time: Duration,
    pub(crate) in_flight: usize,
    pub(crate) large_requests: usize,
    pub(crate) queue: usize,
    pub(crate) queue_time: Duration,
    pub(crate) connections: usize,
    pub(crate) idle_time: Duration,
    pub(crate) stall_time: Duration,
    /// Requests of one client in a second, and at once after a pause, if they are limited.
    pub(crate) rate: Option<[NonZeroU32; 2]>,
}

impl Limits {
    fn of(config: &Config) -> Self {
        let (requests, capacity, connections) = (&config.requests, &config.capacity, &config.connections);
        Self {
            body_bytes: requests.body_limit_bytes,
            expanded_body_bytes: requests.expanded_body_limit_bytes,
            head_bytes: requests.head_limit_bytes,
            directions: requests.direction_limit,
            rows: requests.row_limit,
            incidences: requests.incidence_limit,
            request_time: requests.request_timeout_seconds,
            answer_time: requests.answer_timeout_seconds,
            cpu_time: requests.cpu_limit_seconds,
            in_flight: capacity.in_flight_limit,
            large_requests: capacity.large_request_limit,
            queue: capacity.queue_limit,
            queue_time: capacity.queue_timeout_seconds,
            connections: connections.connection_limit,
            idle_time: connections.idle_timeout_seconds,
            stall_time: connections.stall_timeout_seconds,
            rate: config.access.rate_limit(),
        }
    }
}

impl App {
    /// With threads of its own for large work.
    pub(crate) fn new(config: &Config) -> Self {
        let limits = Limits::of(config);
        Self(Arc::new(Shared {
            limits,
            pool: Pool::new(config.capacity.pool_threads),
            admission: Admission::new(&limits),
            edge: edge::State::new(config),
            doors: Doors::new(limits.connections),
        }))
    }

    pub(crate) fn limits(&self) -> &Limits {
        &self.0.limits
    }

    pub(crate) fn pool(&self) -> &Pool {
        &self.0.pool
    }

    pub(super) fn edge(&self) -> &edge::State {
        &self.0.edge
    }

    pub(crate) fn admission(&self) -> &Admission {
        &self.0.admission
    }

    /// Whether the service is on its way out, and how many connections it has.
    pub(crate) fn doors(&self) -> &Arc<Doors> {
        &self.0.doors
    }
}
