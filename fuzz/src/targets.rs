//! What each fuzz target does with its input.

use crate::service::{ask, post};
use axum::body::Body;
use axum::http::{HeaderValue, Request};
use reflectance::config::KeysFile;
use std::collections::BTreeSet;

/// One scene in a query.
pub const SCENE: &str =
    "model=beckmann_spizzichino&rms_height_um=0.2&correlation_length_um=4&wavelength_um=0.55";

/// A sweep of it.
const SWEEP: &str = "sweep=theta_r_deg&from_deg=-80&to_deg=80&points=100&at_deg=30";

/// A body of columns for the resource that takes its scene from the query.
const COLUMNS: &str = "theta_i_deg,theta_r_deg\r\n30,30\r\n";

/// The resources that take directions in JSON.
pub const OF_DIRECTIONS: [&str; 4] = ["/v1/radiance", "/v1/brdf", "/v1/plan", "/v1/tradeoff"];

/// The resources that take a query, and the columns' scene.
pub const OF_QUERIES: [&str; 4] = ["/v1/diagrams", "/v1/roughness", "/v1/figures/11a", "/v1/radiance"];

/// The ways to pack a body.
pub const ENCODINGS: [&str; 3] = ["gzip", "br", "zstd"];

/// The headers that are read, in the order in which an input's lines fill them.
pub const HEADERS: [&str; 11] = [
    "accept",
    "accept-encoding",
    "if-none-match",
    "traceparent",
    "tracestate",
    "x-request-id",
    "authorization",
    "origin",
    "content-type",
    "content-encoding",
    "range",
];

/// A name, and what is done with the bytes.
pub type Target = (&'static str, fn(&[u8]));

/// The targets whose input is bytes, by name.
pub const TARGETS: [Target; 10] = [
    ("json_directions", json_directions),
    ("json_diagrams", json_diagrams),
    ("json_image_irradiance", json_image_irradiance),
    ("columns_arrow", columns_arrow),
    ("columns_csv", columns_csv),
    ("columns_npy", columns_npy),
    ("packed", packed),
    ("query", query),
    ("headers", headers),
    ("keys", keys),
];

/// The one of several that an input's first byte chooses, and the rest of the input.
fn choice<'a, T: Copy>(of: &[T], data: &'a [u8]) -> Option<(T, &'a [u8])> {
    let (first, rest) = data.split_first()?;
    Some((of[usize::from(*first) % of.len()], rest))
}

/// JSON bodies of the resources that take directions; the first byte chooses which.
pub fn json_directions(data: &[u8]) {
    if let Some((path, body)) = choice(&OF_DIRECTIONS, data) {
        post(path, "application/json", body.to_vec());
    }
}

/// JSON bodies of diagrams.
pub fn json_diagrams(data: &[u8]) {
    post("/v1/diagrams", "application/json", data.to_vec());
}

/// JSON bodies of images.
pub fn json_image_irradiance(data: &[u8]) {
    post("/v1/image-irradiance", "application/json", data.to_vec());
}

fn columns(media_type: &str, data: &[u8]) {
    post(&format!("/v1/radiance?{SCENE}"), media_type, data.to_vec());
}

/// Arrow streams of directions.
pub fn columns_arrow(data: &[u8]) {
    columns("application/vnd.apache.arrow.stream", data);
}

/// CSV tables of directions.
pub fn columns_csv(data: &[u8]) {
    columns("text/csv", data);
}

/// NumPy files of directions.
pub fn columns_npy(data: &[u8]) {
    columns("application/x-npy", data);
}

/// Packed bodies; the first byte chooses the encoding.
pub fn packed(data: &[u8]) {
    let Some((encoding, body)) = choice(&ENCODINGS, data) else { return };
    let request = Request::post("/v1/radiance")
        .header("content-type", "application/json")
        .header("content-encoding", encoding)
        .body(Body::from(body.to_vec()));
    ask(request.expect("a request"));
}

/// Query strings; the first byte chooses the resource.
pub fn query(data: &[u8]) {
    let Some((path, query)) = choice(&OF_QUERIES, data) else { return };
    let uri = [path.as_bytes(), b"?", query].concat();
    let request = Request::builder().uri(uri.as_slice());
    let request = if path == "/v1/radiance" {
        request.method("POST").header("content-type", "text/csv").body(Body::from(COLUMNS))
    } else {
        request.body(Body::empty())
    };
    // Not every text is a URI; a connection would have refused it.
    if let Ok(request) = request {
        ask(request);
    }
}

/// Header values, one a line after the method; an empty line leaves the header out.
pub fn headers(data: &[u8]) {
    let mut lines = data.split(|byte| *byte == b'\n');
    let mut request = match lines.next() {
        Some(b"post") => Request::post("/v1/radiance"),
        Some(b"options") => Request::options("/v1/radiance"),
        Some(b"head") => Request::head(format!("/v1/diagrams?{SCENE}&{SWEEP}")),
        _ => Request::get(format!("/v1/diagrams?{SCENE}&{SWEEP}")),
    };
    for (name, value) in HEADERS.iter().zip(lines) {
        if value.is_empty() {
            continue;
        }
        // Not every text is a value; a connection would have refused it.
        let Ok(value) = HeaderValue::from_bytes(value) else { return };
        request = request.header(*name, value);
    }
    ask(request.body(Body::from("{}")).expect("a request"));
}

/// Files of keys.
pub fn keys(data: &[u8]) {
    let path = std::env::temp_dir().join(format!("reflectance-fuzz-{}", std::process::id()));
    std::fs::write(&path, data).expect("a folder to write to");
    match KeysFile::open(path.to_str().expect("a path in UTF-8")) {
        Ok(file) => {
            let names: BTreeSet<_> = file.keys().iter().map(|key| &key.name).collect();
            assert_eq!(names.len(), file.keys().len(), "two clients of one name");
            assert!(file.keys().iter().all(|key| key.secret.len() >= 16 && key.secret.is_ascii()));
        }
        // The service says it in one line and ends.
        Err(reason) => assert_eq!(reason.lines().count(), 1, "{reason}"),
    }
}
