//! Content codings of answers and of bodies.

use crate::server::{Server, problem, scene};
use reqwest::blocking::Response;
use serde_json::{Value, json};
use std::io::{Read as _, Write as _};
use std::net::TcpStream;

const CODINGS: [&str; 3] = ["zstd", "br", "gzip"];

fn unpack(coding: &str, bytes: &[u8]) -> Vec<u8> {
    let mut text = Vec::new();
    match coding {
        "zstd" => text = zstd::decode_all(bytes).unwrap(),
        "br" => drop(brotli::Decompressor::new(bytes, 4096).read_to_end(&mut text).unwrap()),
        "gzip" => drop(flate2::read::GzDecoder::new(bytes).read_to_end(&mut text).unwrap()),
        other => panic!("{other}"),
    }
    text
}

fn pack(coding: &str, bytes: &[u8]) -> Vec<u8> {
    match coding {
        "zstd" => zstd::encode_all(bytes, 1).unwrap(),
        "br" => {
            let mut writer = brotli::CompressorWriter::new(Vec::new(), 4096, 5, 22);
            writer.write_all(bytes).unwrap();
            writer.into_inner()
        }
        "gzip" => {
            let mut writer = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::default());
            writer.write_all(bytes).unwrap();
            writer.finish().unwrap()
        }
        other => panic!("{other}"),
    }
}

fn post(server: &Server, body: &Value, accept_encoding: &str) -> Response {
    let request = server.request("POST", "/v1/radiance").header("content-type", "application/json");
    request.header("accept-encoding", accept_encoding).body(body.to_string()).send().unwrap()
}

fn send_packed(server: &Server, coding: &str, body: Vec<u8>) -> Response {
    let request = server.request("POST", "/v1/radiance").header("content-type", "application/json");
    request.header("content-encoding", coding).body(body).send().unwrap()
}

fn with_directions(count: usize) -> Value {
    let mut body = scene();
    body["geometry"]["theta_r_deg"] = (0..count).map(|i| json!(89.0 * i as f64 / count as f64)).collect();
    body
}

#[test]
fn answers_of_every_size_are_packed_to_the_same_bytes() {
    let server = Server::start();
    // In place, in one frame, and while it is made.
    for directions in [100, 3000, 60_000] {
        let body = with_directions(directions);
        let plain = post(&server, &body, "identity").bytes().unwrap();
        for coding in CODINGS {
            let response = post(&server, &body, coding);
            assert_eq!(response.status(), 200);
            assert_eq!(response.headers()["content-encoding"], coding);
            let packed = response.bytes().unwrap();
            assert!(packed.len() < plain.len() * 2 / 3, "{coding}: {} of {}", packed.len(), plain.len());
            assert!(unpack(coding, &packed) == plain, "{coding} {directions}");
        }
    }
}

#[test]
fn small_answers_and_clients_that_ask_for_nothing_get_answers_as_they_are() {
    let server = Server::start();
    let small = post(&server, &scene(), "gzip, br, zstd");
    assert!(small.headers().get("content-encoding").is_none());
    let large = with_directions(500);
    for accept in ["identity", "deflate", "gzip;q=0", "*;q=0"] {
        let response = post(&server, &large, accept);
        assert!(response.headers().get("content-encoding").is_none(), "{accept}");
        let vary = response.headers().get_all("vary").iter().map(|value| value.to_str().unwrap());
        assert!(vary.collect::<Vec<_>>().join(",").contains("accept-encoding"), "{accept}");
        assert!(response.headers().contains_key("content-length"));
    }
    // Unless that is what they refuse.
    let refused = post(&server, &scene(), "gzip, identity;q=0");
    assert_eq!(refused.headers()["content-encoding"], "gzip");
    assert!(unpack("gzip", &refused.bytes().unwrap()).starts_with(b"{\"quantity\""));
    for path in ["/v1/figures", "/docs/swagger-ui-bundle.js"] {
        let vary = server.get(path).headers()["vary"].to_str().unwrap().to_owned();
        assert!(vary.contains("accept-encoding"), "{path}: {vary}");
    }
}

#[test]
fn what_has_no_body_is_not_packed() {
    let server = Server::start();
    let get = |method: &str, known: &str| {
        let request = server.request(method, "/v1/figures").header("accept-encoding", "gzip");
        request.header("if-none-match", known).send().unwrap()
    };
    let full = get("GET", "");
    assert_eq!(full.headers()["content-encoding"], "gzip");
    let unchanged = get("GET", full.headers()["etag"].to_str().unwrap());
    assert_eq!(unchanged.status(), 304);
    assert!(unchanged.headers().get("content-encoding").is_none());
    let head = get("HEAD", "");
    assert_eq!(head.headers()["content-encoding"], "gzip");
    assert_eq!(head.headers()["etag"], full.headers()["etag"]);
    // Not that of the answer as it is, and nothing is packed to know the other.
    assert!(head.headers().get("content-length").is_none());
    assert!(head.bytes().unwrap().is_empty());
}

#[test]
fn the_first_packed_bytes_leave_before_the_last_are_made() {
    let server = Server::start();
    let body = with_directions(300_000).to_string();
    let mut stream = TcpStream::connect(server.address()).unwrap();
    write!(
        stream,
        "POST /v1/radiance HTTP/1.1\r\nhost: t\r\ncontent-type: application/json\r\naccept-encoding: zstd\r\n\
         connection: close\r\ncontent-length: {}\r\n\r\n{body}",
        body.len()
    )
    .unwrap();
    let mut answer = Vec::new();
    stream.read_to_end(&mut answer).unwrap();
    let text = String::from_utf8_lossy(&answer[..1000]).to_ascii_lowercase();
    assert!(text.contains("transfer-encoding: chunked") && !text.contains("content-length"), "{text}");
    // A client that leaves in the middle costs nothing but what was made by then.
    for _ in 0..3 {
        let mut stream = TcpStream::connect(server.address()).unwrap();
        write!(
            stream,
            "POST /v1/radiance HTTP/1.1\r\nhost: t\r\ncontent-type: application/json\r\naccept-encoding: gzip\r\n\
             content-length: {}\r\n\r\n{body}",
            body.len()
        )
        .unwrap();
        stream.read_exact(&mut [0; 1000]).unwrap();
    }
    assert_eq!(server.get("/livez").status(), 200);
}

#[test]
fn packed_bodies_are_read() {
    let server = Server::start();
    for directions in [1, 2000, 30_000] {
        let body = with_directions(directions);
        let expected = server.answer("/v1/radiance", &body);
        for coding in CODINGS {
            let response = send_packed(&server, coding, pack(coding, body.to_string().as_bytes()));
            assert_eq!(response.status(), 200, "{coding}");
            assert_eq!(response.json::<Value>().unwrap(), expected);
        }
    }
    let members = scene().to_string();
    let (one, other) = members.as_bytes().split_at(20);
    let body = [pack("gzip", one), pack("gzip", other)].concat();
    assert_eq!(send_packed(&server, "gzip", body).status(), 200);
    assert_eq!(send_packed(&server, "identity", members.into_bytes()).status(), 200);
}

#[test]
fn a_coding_that_is_not_read_is_told_which_are() {
    let server = Server::start();
    for coding in ["deflate", "compress", "gzip, br", "none"] {
        let response = send_packed(&server, coding, scene().to_string().into_bytes());
        assert_eq!(response.headers()["accept-encoding"], "zstd, br, gzip");
        let document = problem(response, 415);
        assert_eq!(document["type"], "/problems/unsupported-content-coding");
        assert!(document["detail"].as_str().unwrap().contains("zstd, br, gzip"), "{document}");
    }
}

#[test]
fn bodies_that_do_not_unpack_are_refused() {
    let server = Server::with(&["--expanded-body-limit-bytes", "100000"]);
    let body = scene().to_string();
    for coding in CODINGS {
        let packed = pack(coding, body.as_bytes());
        for wrong in [body.as_bytes(), &packed[..packed.len() - 1], b""] {
            let document = problem(send_packed(&server, coding, wrong.to_vec()), 400);
            assert!(document["detail"].as_str().unwrap().contains(coding), "{document}");
        }
        let bomb = pack(coding, &vec![b' '; 50_000_000]);
        assert!(bomb.len() < 100_000, "{coding}: {}", bomb.len());
        let document = problem(send_packed(&server, coding, bomb), 413);
        assert!(document["detail"].as_str().unwrap().contains("100000 bytes"), "{document}");
        let padded = format!("{body}{}", " ".repeat(100_000 - body.len()));
        assert_eq!(send_packed(&server, coding, pack(coding, padded.as_bytes())).status(), 200);
    }
}
