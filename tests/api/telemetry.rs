//! What the service says about its requests: names, log lines, metrics, spans, headers.

use crate::server::{Server, scene};
use serde_json::{Value, json};
use std::io::{BufRead as _, BufReader, Read as _, Write as _};
use std::net::{TcpListener, TcpStream};
use std::process::Command;
use std::sync::mpsc::{Receiver, channel};
use std::time::Duration;

const TRACE: &str = "4bf92f3577b34da6a3ce929d0e0e4736";
const PARENT: &str = "00f067aa0ba902b7";

/// Stops the service and returns its log.
fn log(mut server: Server) -> Vec<Value> {
    let stopped = Command::new("kill").args(["-INT", &server.process.id().to_string()]).status().unwrap();
    assert!(stopped.success());
    server.process.wait().unwrap();
    let mut log = String::new();
    server.process.stderr.take().unwrap().read_to_string(&mut log).unwrap();
    log.lines().map(|line| serde_json::from_str(line).unwrap_or_else(|_| panic!("{line}"))).collect()
}

fn logging() -> Server {
    Server::with(&["--log-format", "json", "--log-level", "info"])
}

fn requests(log: &[Value]) -> Vec<&Value> {
    log.iter().filter(|line| line["message"] == "request").collect()
}

/// The value of a metric with these labels, 0 if it is not there.
pub(crate) fn metric(server: &Server, name: &str, labels: &[&str]) -> f64 {
    let text = server.get("/metrics").text().unwrap();
    let matching = |line: &&str| {
        line.split(['{', ' ']).next() == Some(name) && labels.iter().all(|label| line.contains(label))
    };
    let value = |line: &str| line.rsplit(' ').next().unwrap().parse::<f64>().unwrap();
    text.lines().filter(matching).map(value).sum()
}

#[test]
fn a_request_keeps_its_name_from_end_to_end() {
    let server = logging();
    let named = |name: &str| {
        let response = server.request("GET", "/livez").header("x-request-id", name).send().unwrap();
        response.headers()["x-request-id"].to_str().unwrap().to_owned()
    };
    assert_eq!(named("client-17"), "client-17");
    let made: Vec<_> = ["with space", "quo\"te", &"x".repeat(129)].into_iter().map(named).collect();
    for name in &made {
        assert!(name.len() == 16 && name.bytes().all(|byte| byte.is_ascii_hexdigit()), "{name}");
    }
    assert!(made[0] != made[1] && made[1] != made[2]);
    // Errors have one too.
    for (method, path) in [("GET", "/nothing"), ("PUT", "/livez"), ("POST", "/v1/radiance")] {
        let response = server.request(method, path).header("x-request-id", "e").send().unwrap();
        assert_eq!(response.headers()["x-request-id"], "e", "{path}");
    }
    let log = log(server);
    let names: Vec<_> = requests(&log).iter().map(|line| line["request_id"].as_str().unwrap()).collect();
    assert_eq!(names, ["client-17", &made[0], &made[1], &made[2], "e", "e", "e"]);
}

#[test]
fn a_trace_is_passed_on() {
    let server = logging();
    let asked = |traceparent: &str| {
        let request = server.request("GET", "/livez").header("traceparent", traceparent);
        let response = request.send().unwrap();
        response.headers().get("traceparent").map(|value| value.to_str().unwrap().to_owned())
    };
    let passed = asked(&format!("00-{TRACE}-{PARENT}-01")).unwrap();
    assert!(passed.starts_with(&format!("00-{TRACE}-")) && passed.ends_with("-01"), "{passed}");
    assert!(!passed.contains(PARENT), "{passed}");
    for malformed in ["", "00-0-0-01", &format!("00-{}-{PARENT}-01", "0".repeat(32))] {
        assert_eq!(asked(malformed), None, "{malformed}");
    }
    let log = log(server);
    let traces: Vec<_> = requests(&log).iter().map(|line| line["trace_id"].as_str()).collect();
    assert_eq!(traces, [Some(TRACE), None, None, None]);
}

#[test]
fn a_line_says_what_was_asked_by_whom_and_what_became_of_it() {
    let server = logging();
    server.answer("/v1/radiance", &scene());
    server.get("/v1/figures/18");
    server.get("/a\"b/c");
    server.get(&format!("/{}", "é".repeat(2000)));
    let log = log(server);
    let lines = requests(&log);
    let expected = [
        ("POST", "/v1/radiance", 200),
        ("GET", "/v1/figures/{id}", 200),
        ("GET", "none", 404),
        ("GET", "none", 404),
    ];
    for (line, (method, route, status)) in lines.iter().zip(expected) {
        assert_eq!(line["level"], "INFO");
        assert_eq!(
            (&line["method"], &line["route"], &line["status"]),
            (&method.into(), &route.into(), &status.into())
        );
        assert_eq!(line["client"], "127.0.0.1", "{line}");
        assert!(line["microseconds"].as_u64().is_some_and(|time| time > 0), "{line}");
        assert!(line["bytes"].as_u64().is_some_and(|bytes| bytes > 0), "{line}");
        assert_eq!(line["timestamp"].as_str().unwrap().len(), "2026-11-22T10:20:30.123456Z".len());
        assert!(line["path"].as_str().unwrap().len() <= 512);
    }
    assert_eq!(lines.len(), 4);
    assert_eq!(lines[0]["directions"], 2);
    assert_eq!(lines[1]["path"], "/v1/figures/18");
}

#[test]
fn a_client_that_leaves_is_logged_as_such() {
    let server = logging();
    let mut stream = TcpStream::connect(server.address()).unwrap();
    let head = "POST /v1/radiance HTTP/1.1\r\nhost: x\r\ncontent-type: application/json\r\ncontent-length: 9\r\n\r\n{";
    stream.write_all(head.as_bytes()).unwrap();
    while metric(&server, "reflectance_requests_in_flight", &[]) < 1.0 {
        std::thread::yield_now();
    }
    drop(stream);
    while metric(&server, "reflectance_requests_in_flight", &[]) > 0.0 {
        std::thread::yield_now();
    }
    // Half a body is answered as such if the service sees its end before the connection's.
    let ended = |status: &str| metric(&server, "http_requests_total", &["/v1/radiance", status]);
    assert_eq!(ended("status=\"499\"") + ended("status=\"400\""), 1.0);
}

#[test]
fn a_terminal_is_shown_a_line_as_well() {
    let mut server = Server::with(&["--log-level", "info"]);
    server.request("GET", "/livez").header("x-request-id", "mine").send().unwrap();
    let mut log = BufReader::new(server.process.stderr.take().unwrap()).lines();
    let line = log.find_map(|line| line.ok().filter(|line| line.contains(" INFO request "))).unwrap();
    assert!(line.contains("  INFO request GET /livez 200 "), "{line}");
    assert!(line.ends_with(" µs 15 B; 127.0.0.1 mine"), "{line}");
}

#[test]
fn metrics_count_requests_by_route_and_status() {
    let server = Server::start();
    server.answer("/v1/radiance", &scene());
    server.answer("/v1/radiance", &scene());
    server.post("/v1/radiance", "{");
    server.get("/v1/figures/18");
    server.get("/v1/figures/11a");
    for path in ["/one", "/two", "/three"] {
        server.get(path);
    }
    let count = |labels: &[&str]| metric(&server, "http_requests_total", labels);
    assert_eq!(count(&["route=\"/v1/radiance\"", "status=\"200\""]), 2.0);
    assert_eq!(count(&["route=\"/v1/radiance\"", "status=\"400\""]), 1.0);
    assert_eq!(count(&["route=\"/v1/figures/{id}\""]), 2.0);
    assert_eq!(count(&["route=\"none\"", "status=\"404\""]), 3.0);
    let durations = ["route=\"/v1/radiance\"", "status=\"200\""];
    assert_eq!(metric(&server, "http_request_duration_seconds_count", &durations), 2.0);
    let all = [&durations[..], &["le=\"+Inf\""]].concat();
    assert_eq!(metric(&server, "http_request_duration_seconds_bucket", &all), 2.0);
    assert!(metric(&server, "http_request_duration_seconds_sum", &durations) > 0.0);
    let text = server.get("/metrics");
    assert!(text.headers()["content-type"].to_str().unwrap().starts_with("text/plain; version=0.0.4"));
    let text = text.text().unwrap();
    assert!(!text.contains("/one") && !text.contains("figures/18"), "{text}");
    for line in text.lines().filter(|line| line.starts_with("# TYPE")) {
        let name = line.split(' ').nth(2).unwrap();
        assert!(text.contains(&format!("# HELP {name} ")), "{name} is not explained");
    }
}

#[test]
fn metrics_count_directions_by_method() {
    let server = Server::start();
    let before = metric(&server, "reflectance_directions_total", &[]);
    let answer = server.answer("/v1/radiance", &scene());
    let methods = answer["methods"].as_object().unwrap();
    for (method, count) in methods {
        let label = format!("method=\"{method}\"");
        assert_eq!(metric(&server, "reflectance_directions_total", &[&label]), count.as_f64().unwrap());
    }
    assert_eq!(metric(&server, "reflectance_directions_total", &[]) - before, 2.0);
    // A linear model has one way to be evaluated.
    let linear = json!({
        "model": "fixed_source", "C_dl": 1, "C_sl": 1, "C_ss": 0, "facet_slope_deg": 5, "spike": "delta",
        "geometry": {"theta_i_deg": 30, "theta_r_deg": [0, 30, 40]}
    });
    server.answer("/v1/image-irradiance", &linear);
    assert_eq!(metric(&server, "reflectance_directions_total", &["method=\"closed_form\""]), 3.0);
}

#[test]
fn every_answer_tells_browsers_to_be_careful() {
    let server = Server::start();
    for path in ["/", "/livez", "/nothing", "/v1/figures", "/docs/", "/metrics"] {
        let response = server.get(path);
        let header = |name: &str| response.headers()[name].to_str().unwrap().to_owned();
        assert_eq!(header("x-content-type-options"), "nosniff", "{path}");
        assert_eq!(header("referrer-policy"), "no-referrer", "{path}");
        assert_eq!(header("cross-origin-resource-policy"), "same-origin", "{path}");
        let policy = header("content-security-policy");
        assert!(policy.starts_with("default-src 'none'"), "{path}: {policy}");
        assert!(policy.ends_with("frame-ancestors 'none'"), "{path}: {policy}");
        assert_eq!(policy.contains("script-src 'self'"), ["/", "/docs/"].contains(&path), "{path}: {policy}");
        assert!(!response.headers().contains_key("strict-transport-security"), "not over plain HTTP");
        assert!(!response.headers().contains_key("access-control-allow-origin"));
    }
}

#[test]
fn the_reference_needs_no_more_than_its_policy_allows() {
    let page = Server::start().get("/docs/").text().unwrap();
    for script in page.split("<script").skip(1) {
        let (tag, rest) = script.split_once('>').unwrap();
        assert!(tag.contains("src=") && rest.trim_start().starts_with("</script>"), "inline: {script}");
    }
    assert!(!page.contains(" onload=") && !page.contains("javascript:"));
}

/// A collector: hands out every request that it is sent, and takes it.
fn collector() -> (String, Receiver<(String, Vec<u8>)>) {
    let listener = TcpListener::bind("127.0.0.1:0").unwrap();
    let address = format!("http://{}", listener.local_addr().unwrap());
    let (sender, receiver) = channel();
    std::thread::spawn(move || {
        for stream in listener.incoming() {
            let mut reader = BufReader::new(stream.unwrap());
            let (mut head, mut length) = (String::new(), 0);
            loop {
                let mut line = String::new();
                reader.read_line(&mut line).unwrap();
                if line == "\r\n" || line.is_empty() {
                    break;
                }
                if let Some(value) = line.to_ascii_lowercase().strip_prefix("content-length:") {
                    length = value.trim().parse().unwrap();
                }
                head.push_str(&line);
            }
            let mut body = vec![0; length];
            reader.read_exact(&mut body).unwrap();
            let answer = b"HTTP/1.1 200 OK\r\ncontent-length: 0\r\nconnection: close\r\n\r\n";
            reader.get_mut().write_all(answer).unwrap();
            if sender.send((head, body)).is_err() {
                return;
            }
        }
    });
    (address, receiver)
}

#[test]
fn spans_reach_a_collector_before_the_service_ends() {
    let (address, received) = collector();
    let mut server = Server::with(&["--otlp-endpoint", &address]);
    let sampled = |flags: &str| {
        let parent = format!("00-{TRACE}-{PARENT}-{flags}");
        let request = server.request("POST", "/v1/radiance").header("traceparent", parent);
        let request = request.header("x-request-id", format!("flags-{flags}"));
        let request = request.header("content-type", "application/json").body(scene().to_string());
        request.send().unwrap().headers()["traceparent"].to_str().unwrap().to_owned()
    };
    let (recorded, ignored) = (sampled("01"), sampled("00"));
    assert!(ignored.ends_with("-00"));
    // Without a trace of the caller's one begins here.
    assert!(server.get("/livez").headers().contains_key("traceparent"));
    let stopped = Command::new("kill").args(["-INT", &server.process.id().to_string()]).status().unwrap();
    assert!(stopped.success());
    assert_eq!(server.process.wait().unwrap().code(), Some(0));
    let mut bytes = Vec::new();
    while let Ok((head, body)) = received.recv_timeout(Duration::from_millis(200)) {
        assert!(head.starts_with("POST /v1/traces HTTP/1.1"), "{head}");
        assert!(head.to_ascii_lowercase().contains("content-type: application/x-protobuf"), "{head}");
        bytes.extend(body);
    }
    let holds = |part: &[u8]| bytes.windows(part.len()).any(|window| window == part);
    let hex = |digits: &str| -> Vec<u8> {
        (0..digits.len()).step_by(2).map(|i| u8::from_str_radix(&digits[i..i + 2], 16).unwrap()).collect()
    };
    for part in [hex(TRACE), hex(PARENT), hex(&recorded[36..52])] {
        assert!(holds(&part), "{part:?}");
    }
    for text in ["reflectance", "POST /v1/radiance", "http.route", "GET /livez", "flags-01"] {
        assert!(holds(text.as_bytes()), "{text}");
    }
    assert!(!holds(b"flags-00") && !holds(&hex(&ignored[36..52])));
}
