//! What `/metrics` says.

use super::known::Known;
use super::meter::Meter;
use super::process;
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
const POOL_THREADS: Description =
    Description("reflectance_pool_threads", "Threads that large requests are worked on with");
const POOL_ACTIVE: Description =
    Description("reflectance_pool_active", "Pieces of large requests that are worked on now");
const POOL_PIECES: Description =
    Description("reflectance_pool_pieces_total", "Pieces of large requests that were worked on");
const POOL_BUSY: Description =
    Description("reflectance_pool_busy_seconds", "Processor time of those pieces, ever growing");
const MEMORY: Description = Description("process_resident_memory_bytes", "Memory that the process holds");
const DESCRIPTORS: Description = Description("process_open_fds", "Open file descriptors of the process");
const PROCESSOR: Description =
    Description("process_cpu_seconds_total", "Processor time of the process, ever growing");
const DRAINING: Description = Description("reflectance_draining", "1 while the service stops, else 0");

/// What is read when somebody asks, in the order of [`Metrics::read`].
const GAUGES: [Description; 10] = [
    IN_FLIGHT,
    WAITING,
    CONNECTIONS,
    DRAINING,
    POOL_THREADS,
    POOL_ACTIVE,
    POOL_BUSY,
    MEMORY,
    DESCRIPTORS,
    PROCESSOR,
];

/// Counters and histograms, each looked up once.
pub(super) struct Metrics {
    recorder: PrometheusRecorder,
    handle: PrometheusHandle,
    /// By route, then by status; the last for any other status.
    requests: Vec<[OnceLock<(Counter, Histogram)>; STATUSES.len() + 1]>,
    pub(super) meter: Meter,
    pub(super) rate_limited: Counter,
    pub(super) keys_missing: Counter,
    pub(super) keys_wrong: Counter,
    pub(super) shed_in_flight: Counter,
    pub(super) shed_queue: Counter,
    pool_pieces: Counter,
    gauges: [Gauge; GAUGES.len()],
}

impl Metrics {
    pub(super) fn new() -> Self {
        let builder = PrometheusBuilder::new();
        // Only an empty list is refused.
        let builder = builder
            .set_buckets_for_metric(Matcher::Full(DURATION.0.to_owned()), &SECONDS)
            .unwrap_or_else(|_| PrometheusBuilder::new());
        let recorder = builder.build_recorder();
        for Description(name, text) in [REQUESTS, DIRECTIONS, SHED, RATE_LIMITED, KEYS_REJECTED, POOL_PIECES]
        {
            recorder.describe_counter(name.into(), None, SharedString::from(text));
        }
        for Description(name, text) in GAUGES {
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
            meter: Meter::new(
                EvaluatedBy::ALL
                    .map(|by| counter(&DIRECTIONS, vec![Label::from_static_parts("method", by.name())])),
            ),
            rate_limited: counter(&RATE_LIMITED, Vec::new()),
            keys_missing: counter(&KEYS_REJECTED, reason("missing")),
            keys_wrong: counter(&KEYS_REJECTED, reason("wrong")),
            shed_in_flight: counter(&SHED, reason("in_flight")),
            shed_queue: counter(&SHED, reason("queue")),
            pool_pieces: counter(&POOL_PIECES, Vec::new()),
            gauges: GAUGES.each_ref().map(gauge),
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

    /// The text of `/metrics`.
    pub(super) fn text(&self, app: &App) -> String {
        for (gauge, value) in self.gauges.iter().zip(Self::read(app)) {
            gauge.set(value);
        }
        self.pool_pieces.absolute(app.pool().pieces());
        self.handle.render()
    }

    /// What the gauges say now.
    fn read(app: &App) -> [f64; GAUGES.len()] {
        let (edge, pool) = (app.edge(), app.pool());
        [
            edge.in_flight() as f64,
            app.admission().waiting() as f64,
            app.doors().connections() as f64,
            f64::from(u8::from(app.doors().are_closing())),
            pool.width() as f64,
            pool.active() as f64,
            pool.busy().as_secs_f64(),
            process::memory() as f64,
            process::descriptors() as f64,
            process::processor_time().as_secs_f64(),
        ]
    }

    /// Sorts the durations of late into their buckets; until then each takes a word of memory.
    pub(super) fn tidy(&self) {
        self.handle.run_upkeep();
    }
}
