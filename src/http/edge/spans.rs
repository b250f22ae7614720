//! Spans for a collector, OTLP over HTTP: one a request.

use super::identity::Trace;
use super::known::Known;
use super::record::Outcome;
use opentelemetry::trace::{SpanContext, SpanId, SpanKind, Status, TraceFlags, TraceId, TraceState};
use opentelemetry::{InstrumentationScope, KeyValue};
use opentelemetry_otlp::{Protocol, WithExportConfig as _};
use opentelemetry_sdk::Resource;
use opentelemetry_sdk::error::{OTelSdkError, OTelSdkResult};
use opentelemetry_sdk::trace::{
    BatchConfigBuilder, BatchSpanProcessor, SpanData, SpanEvents, SpanExporter, SpanLinks, SpanProcessor as _,
};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, SystemTime};
use tokio::runtime::Handle;

/// Where a collector takes spans.
const PATH: &str = "/v1/traces";
/// How long a collector may take for a batch, and the end of the service for the last one.
const PATIENCE: Duration = Duration::from_secs(5);
/// Spans that wait to be sent; more are dropped.
const QUEUE: usize = 16 << 10;
const BATCH: usize = 1024;
const EVERY: Duration = Duration::from_secs(2);

/// Where spans go.
#[derive(Debug)]
pub(super) struct Spans {
    processor: BatchSpanProcessor,
    scope: InstrumentationScope,
}

impl Spans {
    /// Needs the runtime whose threads send the batches. None without an endpoint.
    pub(super) fn new(endpoint: Option<&str>) -> Option<Self> {
        let endpoint = endpoint?;
        let exporter = opentelemetry_otlp::SpanExporter::builder()
            .with_http()
            .with_protocol(Protocol::HttpBinary)
            .with_endpoint(format!("{endpoint}{PATH}"))
            .with_timeout(PATIENCE)
            .build();
        let exporter = Handle::try_current().map_err(|error| error.to_string()).and_then(|runtime| {
            let exporter = exporter.map_err(|error| error.to_string())?;
            Ok(OnRuntime { exporter: Arc::new(exporter), runtime, failing: AtomicBool::new(false) })
        });
        let mut exporter = match exporter {
            Ok(exporter) => exporter,
            Err(error) => {
                tracing::error!(error, "no spans are sent");
                return None;
            }
        };
        let resource = Resource::builder()
            .with_service_name("reflectance")
            .with_attribute(KeyValue::new("service.version", env!("CARGO_PKG_VERSION")))
            .build();
        exporter.set_resource(&resource);
        let batches = BatchConfigBuilder::default()
            .with_max_queue_size(QUEUE)
            .with_max_export_batch_size(BATCH)
            .with_scheduled_delay(EVERY)
            .build();
        let processor = BatchSpanProcessor::builder(exporter).with_batch_config(batches).build();
        let scope = InstrumentationScope::builder("reflectance").with_version(env!("CARGO_PKG_VERSION"));
        Some(Self { processor, scope: scope.build() })
    }

    /// The span of a request, unless its caller records none.
    pub(super) fn answered(&self, known: &Known, outcome: &Outcome) {
        let Some(trace) = known.trace.filter(|trace| trace.sampled) else { return };
        let Some((context, parent)) = identifiers(&trace) else { return };
        let end_time = SystemTime::now();
        let status = i64::from(outcome.status);
        let mut attributes = vec![
            KeyValue::new("http.request.method", known.method.as_str().to_owned()),
            KeyValue::new("http.route", known.route.pattern.as_str()),
            KeyValue::new("http.response.status_code", status),
            KeyValue::new("http.response.body.size", i64::try_from(outcome.bytes).unwrap_or(i64::MAX)),
            KeyValue::new("reflectance.client", known.client().to_owned()),
            KeyValue::new(
                "reflectance.request_id",
                String::from_utf8_lossy(known.id.as_bytes()).into_owned(),
            ),
        ];
        if outcome.directions > 0 {
            let directions = i64::try_from(outcome.directions).unwrap_or(i64::MAX);
            attributes.push(KeyValue::new("reflectance.directions", directions));
        }
        let failed = outcome.status >= 500 && outcome.status < 600;
        let status =
            if failed { Status::error(outcome.problem.clone().unwrap_or_default()) } else { Status::Unset };
        self.processor.on_end(SpanData {
            span_context: context,
            parent_span_id: parent,
            parent_span_is_remote: trace.parent.is_some(),
            span_kind: SpanKind::Server,
            name: format!("{} {}", known.method, known.route.pattern).into(),
            start_time: end_time.checked_sub(outcome.duration).unwrap_or(end_time),
            end_time,
            attributes,
            dropped_attributes_count: 0,
            events: SpanEvents::default(),
            links: SpanLinks::default(),
            status,
            instrumentation_scope: self.scope.clone(),
        });
    }

    /// Sends what waits, and no more. Blocks for as long as a collector may take.
    pub(super) fn finish(&self) {
        if let Err(error) = self.processor.shutdown_with_timeout(PATIENCE) {
            tracing::warn!(%error, "the last spans were not sent");
        }
    }
}

fn identifiers(trace: &Trace) -> Option<(SpanContext, SpanId)> {
    let text = |digits: &[u8]| String::from_utf8_lossy(digits).into_owned();
    let id = TraceId::from_hex(&text(&trace.id)).ok()?;
    let parent = match trace.parent {
        Some(parent) => SpanId::from_hex(&text(&parent)).ok()?,
        None => SpanId::INVALID,
    };
    let span = SpanId::from_bytes(trace.span.get().to_be_bytes());
    Some((SpanContext::new(id, span, TraceFlags::SAMPLED, false, TraceState::NONE), parent))
}

/// The exporter waits for the network by way of the runtime, while the thread that fills it belongs to none.
#[derive(Debug)]
struct OnRuntime {
    exporter: Arc<opentelemetry_otlp::SpanExporter>,
    runtime: Handle,
    /// Whether the last batch was lost: said once, not with every batch.
    failing: AtomicBool,
}

impl SpanExporter for OnRuntime {
    async fn export(&self, batch: Vec<SpanData>) -> OTelSdkResult {
        let exporter = Arc::clone(&self.exporter);
        let sent = self.runtime.spawn(async move { exporter.export(batch).await }).await;
        let sent = sent.unwrap_or_else(|error| Err(OTelSdkError::InternalFailure(error.to_string())));
        let failed = sent.is_err();
        if self.failing.swap(failed, Ordering::Relaxed) != failed {
            match &sent {
                Ok(()) => tracing::info!("spans are sent again"),
                Err(error) => tracing::warn!(%error, "spans are lost: the collector did not take them"),
            }
        }
        sent
    }

    fn set_resource(&mut self, resource: &Resource) {
        if let Some(exporter) = Arc::get_mut(&mut self.exporter) {
            exporter.set_resource(resource);
        }
    }
}
