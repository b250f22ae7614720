//! Who may ask, how often, and from which pages.

use crate::server::{Server, problem, scene};
use crate::telemetry::metric;
use reqwest::blocking::Response;
use std::io::{BufRead as _, BufReader, Read as _, Write as _};
use std::net::TcpStream;
use std::path::PathBuf;
use std::process::Command;

const KEY: &str = "a-key-of-20-letters.";
const OTHER: &str = "another-key-of-24-chars~";

/// A file of keys that goes with the test.
struct KeysFile(PathBuf);

impl KeysFile {
    fn new(name: &str, text: &str) -> Self {
        let path = std::env::temp_dir().join(format!("reflectance-{name}-{}", std::process::id()));
        std::fs::write(&path, text).unwrap();
        Self(path)
    }

    fn path(&self) -> &str {
        self.0.to_str().unwrap()
    }
}

impl Drop for KeysFile {
    fn drop(&mut self) {
        // It may be gone already.
        let _ = std::fs::remove_file(&self.0);
    }
}

fn with_key(server: &Server, path: &str, key: &str) -> Response {
    server.request("GET", path).header("authorization", format!("Bearer {key}")).send().unwrap()
}

#[test]
fn without_a_key_there_is_no_answer_but_to_what_is_open() {
    let file = KeysFile::new("open", &format!("# clients\nfirst {KEY}\nsecond {OTHER}\n"));
    let server = Server::with(&["--api-keys-file", file.path()]);
    for path in ["/", "/livez", "/readyz", "/docs/", "/openapi.json"] {
        assert_eq!(server.get(path).status(), 200, "{path}");
    }
    for path in ["/v1/figures", "/v1/figures/18", "/metrics", "/v1/nothing", "/nothing", "//livez", "/livez/"]
    {
        let response = server.get(path);
        assert_eq!(response.headers()["www-authenticate"], "Bearer realm=\"reflectance\"", "{path}");
        let document = problem(response, 401);
        assert!(document["detail"].as_str().unwrap().contains("Authorization: Bearer"), "{document}");
        let response = with_key(&server, path, "wrong-key-of-24-letters.");
        let challenge = response.headers()["www-authenticate"].to_str().unwrap();
        assert!(challenge.contains("invalid_token"), "{challenge}");
        problem(response, 401);
    }
    for key in [KEY, OTHER] {
        for path in ["/v1/figures", "/v1/figures/18", "/metrics"] {
            assert_eq!(with_key(&server, path, key).status(), 200, "{path}");
        }
        assert_eq!(with_key(&server, "/nothing", key).status(), 404);
    }
    let body = scene().to_string();
    let post = |key: &str| {
        let request = server.request("POST", "/v1/radiance").header("authorization", format!("Bearer {key}"));
        request
            .header("content-type", "application/json")
            .body(body.clone())
            .send()
            .unwrap()
            .status()
            .as_u16()
    };
    assert_eq!((post(KEY), post(&KEY[1..])), (200, 401));
}

#[test]
fn keys_are_nowhere_in_the_log() {
    let file = KeysFile::new("log", &format!("first {KEY}\n"));
    let flags = ["--api-keys-file", file.path(), "--log-level", "trace", "--log-format", "json"];
    let mut server = Server::with(&flags);
    assert_eq!(with_key(&server, "/v1/figures", KEY).status(), 200);
    problem(with_key(&server, "/v1/figures", OTHER), 401);
    let stopped = Command::new("kill").args(["-INT", &server.process.id().to_string()]).status().unwrap();
    assert!(stopped.success());
    server.process.wait().unwrap();
    let mut log = String::new();
    server.process.stderr.take().unwrap().read_to_string(&mut log).unwrap();
    assert!(log.contains("\"client\":\"first\"") && log.contains("\"client\":\"127.0.0.1\""), "{log}");
    assert!(!log.contains(KEY) && !log.contains(OTHER), "{log}");
}

#[test]
fn keys_are_read_again_on_a_hangup_and_kept_if_the_file_is_wrong() {
    let file = KeysFile::new("reload", &format!("first {KEY}\n"));
    let mut server = Server::with(&["--api-keys-file", file.path(), "--log-level", "info"]);
    let mut log = BufReader::new(server.process.stderr.take().unwrap()).lines();
    let mut logged = |words: &str| log.any(|line| line.is_ok_and(|line| line.contains(words)));
    let hang_up = || {
        let sent = Command::new("kill").args(["-HUP", &server.process.id().to_string()]).status().unwrap();
        assert!(sent.success());
    };
    let status = |key: &str| with_key(&server, "/v1/figures", key).status().as_u16();
    std::fs::write(&file.0, "first short\n").unwrap();
    hang_up();
    assert!(logged("the old keys stay"));
    assert_eq!((status(KEY), status(OTHER)), (200, 401));
    std::fs::write(&file.0, format!("second {OTHER}\n")).unwrap();
    hang_up();
    assert!(logged("keys were read again"));
    assert_eq!((status(KEY), status(OTHER)), (401, 200));
}

#[test]
fn a_wrong_file_of_keys_ends_the_start_with_one_line() {
    let file = KeysFile::new("wrong", &format!("first {KEY}\nsecond short\n"));
    for (path, words) in
        [(file.path(), "line 2: expected a key of 16 to 256"), ("/nowhere", "cannot read it")]
    {
        let output = Command::new(env!("CARGO_BIN_EXE_reflectance"))
            .args(["--listen", "127.0.0.1:0", "--api-keys-file", path])
            .output()
            .unwrap();
        let text = String::from_utf8(output.stderr).unwrap();
        assert_eq!((output.status.code(), text.lines().count()), (Some(2), 1), "{text}");
        assert!(text.contains(words) && text.contains("REFLECTANCE_API_KEYS_FILE"), "{text}");
        assert!(!text.contains(KEY), "{text}");
    }
}

fn number(response: &Response, name: &str) -> u64 {
    response.headers()[name].to_str().unwrap().parse().unwrap()
}

#[test]
fn a_client_that_asks_too_often_is_told_when_to_ask_again() {
    let server = Server::with(&["--rate-limit-per-second", "1", "--rate-limit-burst", "3"]);
    for left in [2, 1, 0] {
        let response = server.get("/v1/figures");
        assert_eq!((response.status().as_u16(), number(&response, "ratelimit-remaining")), (200, left));
        assert_eq!(response.headers()["ratelimit-policy"], "\"default\";q=3;w=3");
        let standing = response.headers()["ratelimit"].to_str().unwrap();
        assert!(standing.starts_with(&format!("\"default\";r={left};t=")), "{standing}");
        assert_eq!(number(&response, "ratelimit-limit"), 3);
        assert!(number(&response, "ratelimit-reset") <= 3);
    }
    let response = server.get("/v1/figures");
    assert_eq!(number(&response, "retry-after"), 1);
    assert_eq!(number(&response, "ratelimit-remaining"), 0);
    let document = problem(response, 429);
    let detail = document["detail"].as_str().unwrap();
    assert!(detail.contains("1 times a second") && detail.contains("3 times at once"), "{detail}");
    // Those who watch the service are never refused.
    for _ in 0..5 {
        assert_eq!(server.get("/livez").status(), 200);
    }
    assert!(metric(&server, "reflectance_requests_rate_limited_total", &[]) >= 1.0);
}

#[test]
fn every_key_has_an_allowance_of_its_own_and_guesses_count_against_the_address() {
    let file = KeysFile::new("rate", &format!("first {KEY}\nsecond {OTHER}\n"));
    let flags = ["--api-keys-file", file.path(), "--rate-limit-per-second", "1", "--rate-limit-burst", "2"];
    let server = Server::with(&flags);
    let statuses = |key: &str| -> Vec<u16> {
        (0..3).map(|_| with_key(&server, "/v1/figures", key).status().as_u16()).collect()
    };
    assert_eq!(statuses(KEY), [200, 200, 429]);
    assert_eq!(statuses(OTHER), [200, 200, 429]);
    assert_eq!(statuses("wrong-key-of-24-letters."), [401, 401, 429]);
}

#[test]
fn more_requests_than_the_limit_are_shed_before_their_body_is_read() {
    let server = Server::with(&["--in-flight-limit", "1"]);
    let mut held = TcpStream::connect(server.address()).unwrap();
    let head = "POST /v1/radiance HTTP/1.1\r\nhost: x\r\ncontent-type: application/json\r\ncontent-length: 9\r\n\
                expect: 100-continue\r\n\r\n";
    held.write_all(head.as_bytes()).unwrap();
    let mut answer = [0; 25];
    held.read_exact(&mut answer).unwrap();
    assert_eq!(&answer, b"HTTP/1.1 100 Continue\r\n\r\n");
    // It does not say "100 Continue": the body is not wanted.
    let mut shed = TcpStream::connect(server.address()).unwrap();
    shed.write_all(head.as_bytes()).unwrap();
    let mut answer = [0; 12];
    shed.read_exact(&mut answer).unwrap();
    assert_eq!(&answer, b"HTTP/1.1 503");
    let response = server.get("/v1/figures");
    assert_eq!(response.headers()["retry-after"], "1");
    let document = problem(response, 503);
    assert_eq!(document["type"], "/problems/overloaded");
    assert!(document["detail"].as_str().unwrap().starts_with("1 requests are in flight"), "{document}");
    assert_eq!(server.get("/readyz").status(), 200);
    assert_eq!(metric(&server, "reflectance_requests_shed_total", &["in_flight"]), 2.0);
    assert_eq!(metric(&server, "reflectance_requests_in_flight", &[]), 1.0);
    drop(held);
    while metric(&server, "reflectance_requests_in_flight", &[]) > 0.0 {
        std::thread::yield_now();
    }
    assert_eq!(server.get("/v1/figures").status(), 200);
}

#[test]
fn pages_of_the_configured_origins_may_read_answers() {
    let file = KeysFile::new("cors", &format!("first {KEY}\n"));
    let origins = "https://one.example,http://localhost:3000";
    let server = Server::with(&["--cors-origin", origins, "--api-keys-file", file.path()]);
    let from = |method: &str, origin: &str| {
        let request = server.request(method, "/v1/radiance").header("origin", origin);
        let request = request.header("access-control-request-method", "POST");
        request.header("access-control-request-headers", "authorization,content-type").send().unwrap()
    };
    for origin in ["https://one.example", "http://localhost:3000"] {
        // A browser asks first, and does not show the key then.
        let asked = from("OPTIONS", origin);
        assert_eq!(asked.status(), 200);
        assert_eq!(asked.headers()["access-control-allow-origin"], origin);
        for (name, value) in [
            ("access-control-allow-methods", "POST"),
            ("access-control-allow-headers", "authorization"),
            ("access-control-allow-headers", "content-type"),
        ] {
            let allowed = asked.headers()[name].to_str().unwrap();
            assert!(allowed.contains(value), "{allowed}");
        }
        // An error may be read like an answer.
        let refused = from("POST", origin);
        assert_eq!(
            (refused.status().as_u16(), &refused.headers()["access-control-allow-origin"]),
            (401, &origin.parse().unwrap())
        );
        let exposed = refused.headers()["access-control-expose-headers"].to_str().unwrap();
        for name in ["etag", "x-request-id", "ratelimit", "retry-after"] {
            assert!(exposed.split(',').any(|exposed| exposed.trim() == name), "{exposed}");
        }
        assert_eq!(refused.headers()["cross-origin-resource-policy"], "cross-origin");
    }
    for other in ["https://two.example", "null"] {
        assert!(!from("OPTIONS", other).headers().contains_key("access-control-allow-origin"));
    }
    let plain = with_key(&server, "/v1/figures", KEY);
    assert!(plain.headers().get_all("vary").iter().any(|vary| vary.to_str().unwrap().contains("origin")));
}

#[test]
fn any_page_may_read_answers_where_the_operator_says_so() {
    let server = Server::with(&["--cors-origin", "*"]);
    let response =
        server.request("GET", "/v1/figures").header("origin", "https://any.example").send().unwrap();
    assert_eq!(response.headers()["access-control-allow-origin"], "*");
    let origin = ["--cors-origin", "https://one.example/path"];
    let output = Command::new(env!("CARGO_BIN_EXE_reflectance")).args(origin).output().unwrap();
    let text = String::from_utf8(output.stderr).unwrap();
    assert_eq!((output.status.code(), text.lines().count()), (Some(2), 1), "{text}");
    assert!(text.contains("https://example.org") && text.contains("REFLECTANCE_CORS_ORIGIN"), "{text}");
}

#[test]
fn the_document_says_that_a_key_may_be_needed() {
    let document: serde_json::Value = Server::start().get("/openapi.json").json().unwrap();
    assert_eq!(document["components"]["securitySchemes"]["key"]["scheme"], "bearer");
    for (path, item) in document["paths"].as_object().unwrap() {
        let guarded = path.starts_with("/v1") || path == "/metrics";
        for operation in item.as_object().unwrap().values() {
            let security = operation["security"].as_array().unwrap();
            assert_eq!(security.iter().any(|one| one.get("key").is_some()), guarded, "{path}");
            assert_eq!(operation["responses"].get("401").is_some(), guarded, "{path}");
        }
    }
}
