//! The started binary, and one keep-alive connection to it.

use serde_json::Value;
use std::io::{BufRead as _, BufReader};
use std::process::{Child, Command, Stdio};
use tokio::runtime::Runtime;

/// A running service; stopped when dropped, if it was started here.
pub(crate) struct Server {
    process: Option<Child>,
    address: String,
    runtime: Runtime,
    client: reqwest::Client,
}

impl Server {
    /// The one at `REFLECTANCE_URL`, or one of this build.
    pub(crate) fn start() -> Self {
        let (process, address) = match std::env::var("REFLECTANCE_URL") {
            Ok(address) => (None, address),
            Err(_) => Self::begin(),
        };
        let runtime = tokio::runtime::Builder::new_current_thread().enable_all().build().expect("runtime");
        Self { process, address, runtime, client: reqwest::Client::new() }
    }

    /// Starts it on a free port and reads from its output which.
    fn begin() -> (Option<Child>, String) {
        let mut process = Command::new(env!("CARGO_BIN_EXE_reflectance"))
            .args(["--listen", "127.0.0.1:0"])
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()
            .expect("the binary starts");
        let output = BufReader::new(process.stdout.take().expect("its output is piped"));
        let address = output
            .lines()
            .map_while(Result::ok)
            .find_map(|line| {
                let url = &line[line.find("http://")?..];
                Some(url.split_whitespace().next()?.trim_end_matches('/').to_owned())
            })
            .expect("it prints where it listens");
        (Some(process), address)
    }

    /// Posts JSON; the answer has to be a success.
    pub(crate) fn post(&self, path: &str, body: &Value) -> Value {
        self.runtime.block_on(async {
            let url = format!("{}{path}", self.address);
            let answer = self.client.post(url).json(body).send().await.expect("an answer");
            let status = answer.status();
            let text = answer.text().await.expect("a body");
            assert!(status.is_success(), "{status} {text} to {body}");
            serde_json::from_str(&text).expect("JSON")
        })
    }
}

impl Drop for Server {
    fn drop(&mut self) {
        // Nothing to be done about a process that is gone already.
        if let Some(process) = &mut self.process {
            let _ = process.kill();
            let _ = process.wait();
        }
    }
}
