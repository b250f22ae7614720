//! The binary, started on a free port and stopped with the test.

use reqwest::blocking::{Client, RequestBuilder, Response};
use serde_json::{Value, json};
use std::ffi::OsString;
use std::io::{BufRead as _, BufReader, Read as _};
use std::process::{Child, ChildStdout, Command, Stdio};

/// The binary of this build, or the program that `REFLECTANCE_SERVER` names: it runs it somewhere else.
fn binary() -> OsString {
    std::env::var_os("REFLECTANCE_SERVER").unwrap_or_else(|| env!("CARGO_BIN_EXE_reflectance").into())
}

pub(crate) struct Server {
    pub(crate) process: Child,
    pub(crate) url: String,
    /// What it says at the start: where it is, and one request to try.
    pub(crate) greeting: Vec<String>,
    client: Client,
    // Kept open: a closed pipe would be another test.
    _stdout: BufReader<ChildStdout>,
}

impl Server {
    pub(crate) fn start() -> Self {
        Self::with(&[])
    }

    pub(crate) fn with(flags: &[&str]) -> Self {
        let mut process = Command::new(binary())
            .args(["--listen", "127.0.0.1:0"])
            .args(flags)
            .env("REFLECTANCE_LOG_LEVEL", "off")
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .expect("the binary starts");
        let mut stdout = BufReader::new(process.stdout.take().expect("stdout is piped"));
        let mut greeting = Vec::new();
        for _ in 0..2 {
            let mut line = String::new();
            stdout.read_line(&mut line).expect("the greeting is text");
            greeting.push(line);
        }
        let url = greeting[0]
            .split_whitespace()
            .find(|word| word.starts_with("http://") || word.starts_with("https://"))
            .expect("the greeting says where")
            .trim_end_matches('/')
            .to_owned();
        Self { process, url, greeting, client: Client::new(), _stdout: stdout }
    }

    /// Host and port, for raw sockets.
    pub(crate) fn address(&self) -> &str {
        self.url.split_once("://").expect("a scheme").1
    }

    /// Sends the process a signal, by the name that `kill` knows.
    pub(crate) fn signal(&self, name: &str) {
        let sent = Command::new("kill").args([&format!("-{name}"), &self.process.id().to_string()]).status();
        assert!(sent.expect("kill runs").success());
    }

    /// Waits for the end: its exit code and what it wrote to standard error.
    pub(crate) fn end(&mut self) -> (Option<i32>, String) {
        let mut text = String::new();
        let mut stderr = self.process.stderr.take().expect("stderr is piped");
        stderr.read_to_string(&mut text).expect("text");
        (self.process.wait().expect("an end").code(), text)
    }

    pub(crate) fn request(&self, method: &str, path: &str) -> RequestBuilder {
        let method = method.parse().expect("a method");
        self.client.request(method, format!("{}{path}", self.url))
    }

    pub(crate) fn get(&self, path: &str) -> Response {
        self.request("GET", path).send().expect("an answer")
    }

    pub(crate) fn post(&self, path: &str, body: impl Into<reqwest::blocking::Body>) -> Response {
        self.request("POST", path)
            .header("content-type", "application/json")
            .body(body)
            .send()
            .expect("an answer")
    }

    /// A request that has to succeed.
    pub(crate) fn answer(&self, path: &str, body: &Value) -> Value {
        let response = self.post(path, body.to_string());
        let status = response.status();
        let text = response.text().expect("a body");
        assert_eq!(status, 200, "{path} {body}: {text}");
        serde_json::from_str(&text).expect("JSON")
    }
}

impl Drop for Server {
    fn drop(&mut self) {
        // Both fail only if the process is gone already.
        let _ = self.process.kill();
        let _ = self.process.wait();
    }
}

/// A problem document of this status, checked for the members that every one has.
pub(crate) fn problem(response: Response, status: u16) -> Value {
    assert_eq!(response.status(), status);
    assert_eq!(response.headers()["content-type"], "application/problem+json");
    let path = response.url().path().to_owned();
    let document: Value = response.json().expect("JSON");
    assert_eq!(document["status"], status);
    assert_eq!(document["instance"], path);
    for member in ["type", "title", "detail"] {
        assert!(document[member].as_str().is_some_and(|text| !text.is_empty()), "{member}: {document}");
    }
    document
}

/// Requests that the service is answering, by its own count.
pub(crate) fn in_flight(server: &Server) -> usize {
    let text = server.get("/metrics").text().expect("text");
    let line = text.lines().find_map(|line| line.strip_prefix("reflectance_requests_in_flight "));
    line.and_then(|count| count.parse().ok()).expect("a gauge")
}

/// Pointer and code of every error of a problem, sorted.
pub(crate) fn errors(problem: &Value) -> Vec<(String, String)> {
    let text = |value: &Value| value.as_str().expect("a string").to_owned();
    let mut errors: Vec<_> = problem["errors"]
        .as_array()
        .expect("errors")
        .iter()
        .map(|error| (text(&error["pointer"]), text(&error["code"])))
        .collect();
    errors.sort();
    errors
}

/// A request for radiance that is right.
pub(crate) fn scene() -> Value {
    json!({
        "model": "beckmann_spizzichino",
        "surface": {"rms_height_um": 0.2, "correlation_length_um": 4},
        "illumination": {"wavelength_um": 0.55},
        "geometry": {"theta_i_deg": 30, "theta_r_deg": [0, 30]}
    })
}
