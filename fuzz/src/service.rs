//! The service in this process, asked without a network, and what has to hold of every answer.

use axum::Router;
use axum::body::Body;
use axum::http::{HeaderMap, Request, StatusCode, header};
use clap::Parser as _;
use http_body_util::BodyExt as _;
use reflectance::config::Cli;
use serde_json::Value;
use std::io::Read as _;
use std::sync::LazyLock;
use tokio::runtime::{Builder, Runtime};
use tower_service::Service as _;

/// Small, so that inputs are many rather than large.
const FLAGS: [&str; 15] = [
    "reflectance",
    "--log-level",
    "off",
    "--body-limit-bytes",
    "65536",
    "--expanded-body-limit-bytes",
    "65536",
    "--direction-limit",
    "64",
    "--row-limit",
    "256",
    "--pool-threads",
    "1",
    "--cpu-limit-seconds",
    "5",
];

struct Service {
    runtime: Runtime,
    router: Router,
}

static SERVICE: LazyLock<Service> = LazyLock::new(|| {
    let runtime = Builder::new_current_thread().enable_all().build().expect("a runtime");
    let cli = Cli::try_parse_from(FLAGS).expect("flags of the service");
    let router = runtime.block_on(async { reflectance::http::router(&cli.config) });
    Service { runtime, router }
});

/// An answer that passed the checks.
pub struct Answer {
    /// Its status.
    pub status: StatusCode,
    /// Its headers.
    pub headers: HeaderMap,
    /// Its body, unpacked.
    pub body: Vec<u8>,
}

impl Answer {
    /// The body of an answer in JSON.
    pub fn json(&self) -> Value {
        serde_json::from_slice(&self.body).expect("JSON")
    }
}

/// Asks, and checks what has to hold of every answer: no failure of the service, errors as problem documents, and
/// bodies that are what they say.
pub fn ask(request: Request<Body>) -> Answer {
    let service = &*SERVICE;
    let (head, body) = service.runtime.block_on(async {
        let Ok(answer) = service.router.clone().call(request).await;
        let (head, body) = answer.into_parts();
        let body = body.collect().await.expect("an answer that was begun is finished");
        (head, body.to_bytes())
    });
    let body = unpacked(&head.headers, &body);
    let answer = Answer { status: head.status, headers: head.headers, body };
    check(&answer);
    answer
}

fn check(answer: &Answer) {
    let Answer { status, headers, body } = answer;
    let text = String::from_utf8_lossy(body);
    assert!(!status.is_server_error() || *status == StatusCode::SERVICE_UNAVAILABLE, "{status}: {text}");
    let media_type = headers.get(header::CONTENT_TYPE).map(|value| value.to_str().expect("ASCII"));
    let media_type = media_type.map(|value| value.split(';').next().unwrap_or_default());
    if status.is_client_error() || status.is_server_error() {
        assert_eq!(media_type, Some("application/problem+json"), "{status}: {text}");
        let document = answer.json();
        assert_eq!(document["status"], status.as_u16(), "{text}");
        assert!(document["detail"].as_str().is_some_and(|detail| !detail.is_empty()), "{text}");
        if let Some(errors) = document.get("errors") {
            let errors = errors.as_array().expect("a list");
            assert!(errors.iter().all(|error| error["pointer"].is_string() && error["code"].is_string()));
        }
        return;
    }
    match media_type {
        None => assert!(body.is_empty(), "{status}: a body without a type"),
        Some("application/json") => drop(answer.json()),
        Some("text/csv") => assert!(std::str::from_utf8(body).is_ok_and(|text| text.ends_with("\r\n"))),
        Some("application/vnd.apache.arrow.stream") => {
            let reader = arrow_ipc::reader::StreamReader::try_new(body.as_slice(), None).expect("a schema");
            assert!(reader.into_iter().all(|batch| batch.is_ok()));
        }
        Some("application/x-npy") => assert!(body.starts_with(b"\x93NUMPY")),
        Some("text/html" | "text/plain" | "image/svg+xml") => {}
        Some(other) => panic!("an undeclared type: {other}"),
    }
}

fn unpacked(headers: &HeaderMap, body: &[u8]) -> Vec<u8> {
    let mut plain = Vec::new();
    let encoding = headers.get(header::CONTENT_ENCODING).map(|value| value.to_str().expect("ASCII"));
    let read = match encoding {
        None => return body.to_vec(),
        // Of no body there is nothing to unpack.
        Some(_) if body.is_empty() => return Vec::new(),
        Some("gzip") => flate2::read::MultiGzDecoder::new(body).read_to_end(&mut plain),
        Some("br") => brotli::Decompressor::new(body, 4096).read_to_end(&mut plain),
        Some("zstd") => zstd::stream::copy_decode(body, &mut plain).map(|()| 0),
        Some(other) => panic!("an undeclared encoding: {other}"),
    };
    read.expect("a body that is packed as it says");
    plain
}

/// Posts a body.
pub fn post(path: &str, media_type: &str, body: Vec<u8>) -> Answer {
    let request = Request::post(path).header(header::CONTENT_TYPE, media_type).body(Body::from(body));
    ask(request.expect("a request"))
}
