//! Flags, environment, exit codes, logs.

use crate::server::Server;
use serde_json::Value;
use std::io::Read as _;
use std::net::TcpListener;
use std::process::{Command, Output};

fn run(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_reflectance")).args(arguments).output().unwrap()
}

#[test]
fn a_wrong_configuration_ends_the_start_with_one_line() {
    let taken = TcpListener::bind("127.0.0.1:0").unwrap();
    let taken = taken.local_addr().unwrap().to_string();
    for arguments in [
        &["--listen", "nowhere"][..],
        &["--listen", &taken],
        &["--body-limit-bytes", "-1"],
        &["--request-timeout-seconds", "soon"],
        &["--log-format", "xml"],
        &["--unknown"],
        &["serve"],
    ] {
        let output = run(arguments);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}");
        let text = String::from_utf8(output.stderr).unwrap();
        assert_eq!(text.lines().count(), 1, "{arguments:?}: {text}");
        assert!(text.starts_with("reflectance: "), "{text}");
        assert!(output.stdout.is_empty());
    }
}

#[test]
fn a_wrong_value_is_told_with_the_values_there_are_and_where_it_may_come_from() {
    for (arguments, words) in [
        (["--log-format", "xml"], ["human, json", "REFLECTANCE_LOG_FORMAT"]),
        (["--log-level", "loud"], ["debug", "REFLECTANCE_LOG_LEVEL"]),
        (["--body-limit-bytes", "-1"], ["1024", "REFLECTANCE_BODY_LIMIT_BYTES"]),
        (["--request-timeout-seconds", "soon"], ["86400", "REFLECTANCE_REQUEST_TIMEOUT_SECONDS"]),
        (["--listen", "nowhere"], ["--listen", "REFLECTANCE_LISTEN"]),
    ] {
        let text = String::from_utf8(run(&arguments).stderr).unwrap();
        for word in [words[0], words[1], arguments[0], "--help"] {
            assert!(text.contains(word), "{word}: {text}");
        }
    }
}

#[test]
fn the_environment_mirrors_the_flags_and_is_checked_as_well() {
    let output = Command::new(env!("CARGO_BIN_EXE_reflectance"))
        .env("REFLECTANCE_LISTEN", "no such host:1")
        .output()
        .unwrap();
    assert_eq!(output.status.code(), Some(2));
    assert!(String::from_utf8(output.stderr).unwrap().contains("no such host:1"));
}

#[test]
fn help_and_version_are_there() {
    let help = String::from_utf8(run(&["--help"]).stdout).unwrap();
    for word in ["--listen", "REFLECTANCE_LISTEN", "127.0.0.1:8080", "openapi", "health"] {
        assert!(help.contains(word), "{word}: {help}");
    }
    let version = String::from_utf8(run(&["--version"]).stdout).unwrap();
    assert_eq!(version.trim(), format!("reflectance {}", env!("CARGO_PKG_VERSION")));
}

#[test]
fn a_request_leaves_one_line_in_the_log() {
    let mut server = Server::with(&["--log-format", "json", "--log-level", "info"]);
    server.get("/livez");
    server.get("/nothing");
    let stopped = Command::new("kill").args(["-INT", &server.process.id().to_string()]).status().unwrap();
    assert!(stopped.success());
    server.process.wait().unwrap();
    let mut log = String::new();
    server.process.stderr.take().unwrap().read_to_string(&mut log).unwrap();
    let lines: Vec<Value> = log.lines().map(|line| serde_json::from_str(line).unwrap()).collect();
    let requests: Vec<_> = lines.iter().filter(|line| line["message"] == "request").collect();
    assert_eq!(requests.len(), 2, "{log}");
    for (line, (path, status)) in requests.iter().zip([("/livez", 200), ("/nothing", 404)]) {
        assert_eq!(line["method"], "GET");
        assert_eq!(line["path"], path);
        assert_eq!(line["status"], status);
        assert!(line["microseconds"].is_u64() && line["bytes"].is_u64());
    }
}

/// Exit code and what was said of `health`, with more arguments.
fn health(before: &[&str], after: &[&str]) -> (Option<i32>, String) {
    let output = run(&[before, &["health"], after].concat());
    assert!(output.stdout.is_empty());
    (output.status.code(), String::from_utf8(output.stderr).unwrap())
}

#[test]
fn health_tells_a_service_that_is_ready_from_one_that_is_not() {
    let mut server = Server::with(&["--drain-delay-seconds", "60"]);
    let address = server.address().to_owned();
    assert_eq!(health(&["--listen", &address], &[]), (Some(0), String::new()));
    assert_eq!(health(&[], &["--url", &server.url]), (Some(0), String::new()));
    // Where a proxy would serve it.
    let (code, text) = health(&[], &["--url", &format!("{}/under/", server.url)]);
    assert!(code == Some(1) && text.contains("/under/readyz: not ready, status 404"), "{text}");

    server.signal("TERM");
    // The signal is taken within a moment.
    while server.get("/readyz").status() == 200 {}
    let (code, text) = health(&["--listen", &address], &[]);
    assert!(code == Some(1) && text.contains("status 503"), "{text}");
    server.signal("INT");
    server.process.wait().unwrap();
    let (code, text) = health(&["--listen", &address], &[]);
    assert!(code == Some(1) && text.starts_with("reflectance: ") && text.lines().count() == 1, "{text}");
}

#[test]
fn health_does_not_wait_for_a_service_that_says_nothing() {
    let mute = TcpListener::bind("127.0.0.1:0").unwrap();
    let address = mute.local_addr().unwrap().to_string();
    let (code, text) = health(&["--listen", &address], &["--timeout-seconds", "0.1"]);
    assert!(code == Some(1) && text.contains("no answer within 0.1 s"), "{text}");
}
