//! HTTP itself: methods, negotiation, limits, slow clients, the end.

use crate::server::{Server, problem};
use std::io::{ErrorKind, Read as _, Write as _};
use std::net::TcpStream;
use std::process::Command;
use std::time::Duration;

const BODY: &str = r#"{"model": "lambertian", "surface": {"diffuse_albedo": 0.5}, "illumination": {},
    "geometry": {"theta_i_deg": 0, "theta_r_deg": 0}}"#;

#[test]
fn alive_and_ready() {
    let server = Server::start();
    for path in ["/livez", "/readyz"] {
        let response = server.get(path);
        assert_eq!(response.status(), 200);
        assert_eq!(response.text().unwrap(), r#"{"status":"ok"}"#);
    }
}

#[test]
fn unknown_paths_are_problems() {
    let server = Server::start();
    for path in [
        "/v1",
        "/v1/radiance/",
        "/v2/radiance",
        "/docs/nothing.js",
        "/%ff",
        "/v1/figures/99z",
        "/v1/figures/%ff",
    ] {
        problem(server.get(path), 404);
    }
}

#[test]
fn a_wrong_method_says_which_are_right() {
    let server = Server::start();
    for (method, path, allowed) in [
        ("GET", "/v1/radiance", vec!["POST"]),
        ("DELETE", "/v1/diagrams", vec!["GET", "HEAD", "POST"]),
        ("PUT", "/livez", vec!["GET", "HEAD"]),
    ] {
        let response = server.request(method, path).send().unwrap();
        let allow = response.headers()["allow"].to_str().unwrap().to_owned();
        for method in allowed {
            assert!(allow.split(", ").any(|m| m == method), "{allow}");
        }
        let document = problem(response, 405);
        assert!(document["detail"].as_str().unwrap().contains(&allow));
        let options = server.request("OPTIONS", path).send().unwrap();
        assert_eq!(options.status(), 204);
        assert_eq!(options.headers()["allow"].to_str().unwrap(), allow);
    }
}

#[test]
fn head_is_get_without_the_body() {
    let server = Server::start();
    for path in ["/livez", "/openapi.json", "/v1/figures", "/v1/figures/18", "/docs/", "/nothing"] {
        let (get, head) = (server.get(path), server.request("HEAD", path).send().unwrap());
        assert_eq!(head.status(), get.status(), "{path}");
        assert_eq!(head.headers()["content-type"], get.headers()["content-type"]);
        assert_eq!(head.headers().get("etag"), get.headers().get("etag"));
        let length = get.bytes().unwrap().len().to_string();
        assert_eq!(head.headers()["content-length"], length.as_str(), "{path}");
        assert!(head.bytes().unwrap().is_empty());
    }
}

#[test]
fn an_unacceptable_accept_is_told_what_is_offered() {
    let server = Server::start();
    for (method, path, offered) in [
        (
            "POST",
            "/v1/radiance",
            "application/json, text/csv, application/vnd.apache.arrow.stream, application/x-npy",
        ),
        ("POST", "/v1/plan", "application/json"),
        (
            "POST",
            "/v1/diagrams",
            "application/json, text/csv, application/vnd.apache.arrow.stream, application/x-npy, image/svg+xml, image/png",
        ),
        (
            "GET",
            "/v1/figures/18",
            "application/json, text/csv, application/vnd.apache.arrow.stream, application/x-npy, image/svg+xml, image/png",
        ),
    ] {
        let request = server.request(method, path).header("accept", "image/webp");
        let document =
            problem(request.header("content-type", "application/json").body(BODY).send().unwrap(), 406);
        assert!(document["detail"].as_str().unwrap().ends_with(offered), "{document}");
    }
}

#[test]
fn a_body_has_to_be_declared_as_json() {
    let server = Server::start();
    let send = |kind: Option<&str>| {
        let request = server.request("POST", "/v1/radiance").body(BODY);
        kind.map_or(request.try_clone().unwrap(), |kind| request.header("content-type", kind)).send().unwrap()
    };
    for wrong in [None, Some("text/plain"), Some("application/xml"), Some("application/json; charset=latin1")]
    {
        problem(send(wrong), 415);
    }
    for right in ["application/json", "Application/JSON; charset=UTF-8", "application/vnd.scene+json"] {
        assert_eq!(send(Some(right)).status(), 200, "{right}");
    }
}

#[test]
fn a_body_beyond_the_limit_is_refused_with_the_limit() {
    let server = Server::with(&["--body-limit-bytes", "2000"]);
    let padded = |length: usize| format!("{BODY}{}", " ".repeat(length - BODY.len()));
    assert_eq!(server.post("/v1/radiance", padded(2000)).status(), 200);
    let document = problem(server.post("/v1/radiance", padded(2001)), 413);
    assert!(document["detail"].as_str().unwrap().contains("2000 bytes"), "{document}");
    // The same without a Content-Length to tell it beforehand.
    let chunked = reqwest::blocking::Body::new(std::io::Cursor::new(padded(3000)));
    problem(server.post("/v1/radiance", chunked), 413);
}

#[test]
fn a_client_that_sends_before_it_listens_gets_its_answer() {
    let server = Server::with(&["--body-limit-bytes", "4000000"]);
    let mut stream = TcpStream::connect(server.address()).unwrap();
    let length = 10_000_000;
    write!(stream, "POST /v1/radiance HTTP/1.1\r\nhost: t\r\nconnection: close\r\n").unwrap();
    write!(stream, "content-type: application/json\r\ncontent-length: {length}\r\n\r\n").unwrap();
    stream.write_all(&vec![b' '; length]).unwrap();
    let mut answer = String::new();
    stream.read_to_string(&mut answer).unwrap();
    assert!(answer.starts_with("HTTP/1.1 413 "), "{answer}");
}

#[test]
fn a_client_that_stops_sending_is_let_go() {
    let server = Server::with(&["--request-timeout-seconds", "0.3", "--idle-timeout-seconds", "0.3"]);
    let head = "POST /v1/radiance HTTP/1.1\r\nhost: x\r\ncontent-type: application/json\r\ncontent-length: 100\r\n\r\n{";
    let stalled = |sent: &str| {
        let mut stream = TcpStream::connect(server.address()).unwrap();
        stream.set_read_timeout(Some(Duration::from_secs(30))).unwrap();
        stream.write_all(sent.as_bytes()).unwrap();
        let mut answer = String::new();
        // Bytes that the service never took make the end a reset.
        if let Err(error) = stream.read_to_string(&mut answer) {
            assert_eq!(error.kind(), ErrorKind::ConnectionReset, "{sent}");
        }
        answer
    };
    // In the middle of the body: a problem, then the connection ends.
    let answer = stalled(head);
    assert!(answer.starts_with("HTTP/1.1 408"), "{answer}");
    assert!(answer.contains("/problems/request-timeout"), "{answer}");
    // In the middle of the head: the connection ends. So it does in the middle of the words with which HTTP/2
    // begins, and where nothing is sent at all.
    for sent in [&head[..40], "PRI * HTTP/2.0\r\n", "P", ""] {
        stalled(sent);
    }
    assert_eq!(server.get("/livez").status(), 200);
}

#[test]
fn bytes_that_are_not_http_do_no_harm() {
    let server = Server::start();
    for bytes in [&b"\x16\x03\x01\x02\x00\x01\x00"[..], b"\0\0\0\0\r\n\r\n", b"GET / HTTP/9.9\r\n\r\n"] {
        let mut stream = TcpStream::connect(server.address()).unwrap();
        stream.write_all(bytes).unwrap();
        stream.shutdown(std::net::Shutdown::Write).unwrap();
        let mut answer = Vec::new();
        // A reset is an answer too.
        let _ = stream.read_to_end(&mut answer);
        assert!(!answer.starts_with(b"HTTP/1.1 2"));
    }
    let long = format!("/{}", "x".repeat(200_000));
    let response = server.request("GET", &long).send();
    assert!(response.is_err() || response.is_ok_and(|response| response.status().is_client_error()));
    assert_eq!(server.get("/livez").status(), 200);
}

#[test]
fn a_request_in_flight_is_finished_after_sigterm() {
    let mut server = Server::start();
    let (first, second) = BODY.split_at(20);
    let mut stream = begin(&server, "/v1/radiance", BODY.len());
    stream.write_all(first.as_bytes()).unwrap();
    let stopped = Command::new("kill").args(["-TERM", &server.process.id().to_string()]).status().unwrap();
    assert!(stopped.success());
    // New connections are refused once the listening socket is closed.
    while TcpStream::connect(server.address()).is_ok() {
        std::thread::yield_now();
    }
    stream.write_all(second.as_bytes()).unwrap();
    let mut answer = String::new();
    stream.read_to_string(&mut answer).unwrap();
    assert!(answer.starts_with("HTTP/1.1 200"), "{answer}");
    assert!(answer.contains("\"diffuse_lobe\""), "{answer}");
    assert_eq!(server.process.wait().unwrap().code(), Some(0));
}

/// Begins a POST request and returns once the service reads it: it says so where a client asks for it.
fn begin(server: &Server, path: &str, length: usize) -> TcpStream {
    let mut stream = TcpStream::connect(server.address()).unwrap();
    let head = format!(
        "POST {path} HTTP/1.1\r\nhost: x\r\ncontent-type: application/json\r\ncontent-length: {length}\r\n\
         expect: 100-continue\r\n\r\n"
    );
    stream.write_all(head.as_bytes()).unwrap();
    let mut answer = [0; 25];
    stream.read_exact(&mut answer).unwrap();
    assert_eq!(&answer, b"HTTP/1.1 100 Continue\r\n\r\n");
    stream
}

#[test]
fn the_end_does_not_wait_for_work_longer_than_it_was_told() {
    let mut server = Server::with(&["--shutdown-timeout-seconds", "0.01"]);
    // Far longer than any test waits.
    let body = r#"{"model": "beckmann_spizzichino", "surface": {"rms_height_um": 1, "correlation_length_um": 4},
        "illumination": {"wavelength_um": 0.5}, "accuracy": {"method": "series"}, "sweep": "theta_r_deg",
        "from_deg": -90, "to_deg": 90, "points": 1000000, "at_deg": [10]}"#;
    let mut stream = begin(&server, "/v1/diagrams", body.len());
    stream.write_all(body.as_bytes()).unwrap();
    let stopped = Command::new("kill").args(["-TERM", &server.process.id().to_string()]).status().unwrap();
    assert!(stopped.success());
    assert_eq!(server.process.wait().unwrap().code(), Some(1), "a request was cut");
}

#[test]
fn a_silent_client_of_http_2_does_not_hold_up_the_end() {
    let mut server = Server::start();
    let mut stream = TcpStream::connect(server.address()).unwrap();
    stream.write_all(b"PRI * HTTP/2.0\r\n\r\nSM\r\n\r\n\0\0\0\x04\0\0\0\0\0").unwrap();
    // The service's own settings: it took the client for one of HTTP/2.
    let mut settings = [0; 9];
    stream.read_exact(&mut settings).unwrap();
    assert_eq!(settings[3], 4, "a SETTINGS frame");
    let stopped = Command::new("kill").args(["-TERM", &server.process.id().to_string()]).status().unwrap();
    assert!(stopped.success());
    // 1 would mean that the time for the end had run out.
    assert_eq!(server.process.wait().unwrap().code(), Some(0));
}

#[test]
fn an_answer_that_is_not_ready_in_time_says_when_to_ask_again() {
    // Rows begin once it is known what all of a million directions require: milliseconds.
    let server = Server::with(&["--request-timeout-seconds", "0.001"]);
    let path = "/v1/diagrams?model=beckmann_spizzichino&rms_height_um=1&correlation_length_um=4&wavelength_um=0.5\
         &method=series&sweep=theta_r_deg&from_deg=-90&to_deg=90&points=1000000&at_deg=10";
    let response = server.request("GET", path).header("accept", "text/csv").send().unwrap();
    assert_eq!(response.headers()["retry-after"], "1");
    problem(response, 503);
}
