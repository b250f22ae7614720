//! What `/metrics` says.

use super::known::Known;
use super::record::Outcome;
use super::route;
use crate::http::app::App;
use crate::reflectance::evaluate::EvaluatedBy;
use metrics::{Counter, Gauge, Histogram, Key, Label, Level, Metadata, Recorder as _, SharedString};
use metrics_exporter_prometheus::{Matcher, PrometheusBuilder, PrometheusHandle, PrometheusRecorder};
use std::sync::OnceLock;

/// Upper bounds of the durations' buckets, seconds.
const SECONDS: [f64; 18] = [
    0.0001, 0.0002, 0.0005, 0.001, 0.002, 0.005, 0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0, 30.0,
    60.0,
];
/// Statuses that have a label of their own.
const STATUSES: [u16; 23] = [
    200, 204, 206, 304, 307, 400, 401, 404, 405, 406, 408, 412, 413, 415, 416, 417, 422, 429, 431, 499, 500,
    501, 503,
];
const METADATA: Metadata<'static> = Metadata::new("reflectance", Level::INFO, None);

/// A metric's name and what it counts.
struct Description(&'static str, &'static str);

const REQUESTS: Description =
    Description("http_requests_total", "Requests answered, by route and status; 499: the client left first");
const DURATION: Description = Description(
    "http_request_duration_seconds",
    "From the head of a request to the end of its answer, by route and status",
);
const DIRECTIONS: Description =
    Description("reflectance_directions_total", "Directions evaluated, by what evaluated them");
const SHED: Description =
    Description("reflectance_requests_shed_total", "Requests refused with 503 before any work, by reason");
const RATE_LIMITED: Description =
    Description("reflectance_requests_rate_limited_total", "Requests refused with 429");
const KEYS_REJECTED: Description =
    Description("reflectance_keys_rejected_total", "Requests refused with 401, by what was shown");
const IN_FLIGHT: Description =
    Description("reflectance_requests_in_flight", "Requests that are being answered");
const WAITING: Description =
    Description("reflectance_queue_waiting", "Large requests that wait for their turn");
const CONNECTIONS: Description = Description("reflectance_connections", "Open connections");
const DRAINING: Description = Description("reflectance_draining", "1 while the service stops, else 0");

/// Counters and histograms, each looked up once.
pub(super) struct Metrics {
    recorder: PrometheusRecorder,
    handle: PrometheusHandle,
    /// By route, then by status; the last for any other status.
    requests: Vec<[OnceLock<(Counter, Histogram)>; STATUSES.len() + 1]>,
    directions: [Counter; EvaluatedBy::ALL.len()],
    pub(super) rate_limited: Counter,
    pub(super) keys_missing: Counter,
    pub(super) keys_wrong: Counter,
    pub(super) shed_in_flight: Counter,
    pub(super) shed_queue: Counter,
    in_flight: Gauge,
    waiting: Gauge,
    connections: Gauge,
    draining: Gauge,
}

impl Metrics {
    pub(super) fn new() -> Self {
        let builder = PrometheusBuilder::new();
        // Only an empty list is refused.
        let builder = builder
            .set_buckets_for_metric(Matcher::Full(DURATION.0.to_owned()), &SECONDS)
            .unwrap_or_else(|_| PrometheusBuilder::new());
        let recorder = builder.build_recorder();
        for Description(name, text) in [REQUESTS, DIRECTIONS, SHED, RATE_LIMITED, KEYS_REJECTED] {
            recorder.describe_counter(name.into(), None, SharedString::from(text));
        }
        for Description(name, text) in [IN_FLIGHT, WAITING, CONNECTIONS, DRAINING] {
            recorder.describe_gauge(name.into(), None, SharedString::from(text));
        }
        recorder.describe_histogram(DURATION.0.into(), None, SharedString::from(DURATION.1));
        let counter = |description: &Description, labels: Vec<Label>| {
            recorder.register_counter(&Key::from_parts(description.0, labels), &METADATA)
        };
        let gauge =
            |description: &Description| recorder.register_gauge(&Key::from_name(description.0), &METADATA);
        let reason = |value: &'static str| vec![Label::from_static_parts("reason", value)];
        Self {
            handle: recorder.handle(),
            requests: route::all().iter().map(|_| [const { OnceLock::new() }; STATUSES.len() + 1]).collect(),
            directions: EvaluatedBy::ALL
                .map(|by| counter(&DIRECTIONS, vec![Label::from_static_parts("method", by.name())])),
            rate_limited: counter(&RATE_LIMITED, Vec::new()),
            keys_missing: counter(&KEYS_REJECTED, reason("missing")),
            keys_wrong: counter(&KEYS_REJECTED, reason("wrong")),
            shed_in_flight: counter(&SHED, reason("in_flight")),
            shed_queue: counter(&SHED, reason("queue")),
            in_flight: gauge(&IN_FLIGHT),
            waiting: gauge(&WAITING),
            connections: gauge(&CONNECTIONS),
            draining: gauge(&DRAINING),
            recorder,
        }
    }

    /// Counts a request.
    pub(super) fn answered(&self, known: &Known, outcome: &Outcome) {
        let status = STATUSES.binary_search(&outcome.status).unwrap_or(STATUSES.len());
        let (requests, duration) = self.requests[known.route.index][status].get_or_init(|| {
            let name = STATUSES.get(status).map_or_else(|| "other".to_owned(), u16::to_string);
            let labels = || {
                vec![Label::new("route", known.route.pattern.as_str()), Label::new("status", name.clone())]
            };
            (
                self.recorder.register_counter(&Key::from_parts(REQUESTS.0, labels()), &METADATA),
                self.recorder.register_histogram(&Key::from_parts(DURATION.0, labels()), &METADATA),
            )
        });
        requests.increment(1);
        duration.record(outcome.duration.as_secs_f64());
    }

    /// Counts directions.
    pub(super) fn evaluated(&self, by: EvaluatedBy, directions: usize) {
        if let Some(place) = EvaluatedBy::ALL.iter().position(|one| *one == by) {
            self.directions[place].increment(directions as u64);
        }
    }

    /// The text of `/metrics`.
    pub(super) fn text(&self, app: &App) -> String {
        let edge = app.edge();
        self.in_flight.set(edge.in_flight() as f64);
        self.waiting.set(app.admission().waiting() as f64);
        self.connections.set(app.doors().connections() as f64);
        self.draining.set(f64::from(u8::from(app.doors().are_closing())));
        self.handle.render()
    }

    /// Sorts the durations of late into their buckets; until then each takes a word of memory.
    pub(super) fn tidy(&self) {
        self.handle.run_upkeep();
    }
}
