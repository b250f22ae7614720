//! Log lines: where they go, and the library that writes all but one kind of them.
//!
//! Lines go to standard error by way of a buffer that a thread of its own empties, so that a request costs no system
//! call for its line and never waits for a slow reader of the log. [`Logs`] empties the buffer when it is dropped.

use crate::config::{LogFormat, Telemetry};
use std::io::{IsTerminal as _, Write};
use std::sync::{Condvar, LazyLock, Mutex, MutexGuard, PoisonError};
use std::time::Duration;
use tracing_subscriber::fmt::MakeWriter;

/// How long lines are gathered before they are written.
const GATHER: Duration = Duration::from_millis(10);
/// Bytes that wait at most; lines beyond are lost, and their number is logged.
const CAPACITY: usize = 4 << 20;

/// Standard error, with its buffer.
pub(crate) static SINK: LazyLock<Sink> = LazyLock::new(|| {
    let writer = std::thread::Builder::new().name("log".to_owned()).spawn(|| SINK.serve());
    let sink = Sink::default();
    sink.state().direct = writer.is_err();
    sink
});

/// A buffer of lines and the thread that waits for some.
#[derive(Debug, Default)]
pub(crate) struct Sink {
    state: Mutex<State>,
    filled: Condvar,
    /// Held while bytes go out, so that they go out in order.
    output: Mutex<()>,
}

#[derive(Debug, Default)]
struct State {
    lines: Vec<u8>,
    lost: usize,
    /// Whether there is no thread to write.
    direct: bool,
}

impl Sink {
    /// Adds a line, which `write` ends.
    pub(crate) fn line(&self, write: impl FnOnce(&mut Vec<u8>)) {
        let mut state = self.state();
        if state.lines.len() >= CAPACITY {
            state.lost += 1;
            return;
        }
        let idle = state.lines.is_empty();
        write(&mut state.lines);
        let direct = state.direct;
        drop(state);
        if direct {
            self.flush();
        } else if idle {
            self.filled.notify_one();
        }
    }

    /// Writes what waits.
    fn flush(&self) {
        let _order = self.output.lock().unwrap_or_else(PoisonError::into_inner);
        let mut state = self.state();
        let lines = std::mem::take(&mut state.lines);
        let lost = std::mem::take(&mut state.lost);
        drop(state);
        // A log that nobody can read is no reason to stop the service.
        let _ = std::io::stderr().lock().write_all(&lines);
        if lost > 0 {
            tracing::warn!(lost, "lines were not logged: the log is read too slowly");
        }
    }

    fn serve(&self) {
        loop {
            let mut state = self.state();
            while state.lines.is_empty() {
                state = self.filled.wait(state).unwrap_or_else(PoisonError::into_inner);
            }
            drop(state);
            std::thread::sleep(GATHER);
            self.flush();
        }
    }

    fn state(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// One line of the library, whole when it is dropped.
struct Line(Vec<u8>);

impl Write for Line {
    fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize> {
        self.0.extend_from_slice(bytes);
        Ok(bytes.len())
    }

    fn flush(&mut self) -> std::io::Result<()> {
        Ok(())
    }
}

impl Drop for Line {
    fn drop(&mut self) {
        SINK.line(|lines| lines.extend_from_slice(&self.0));
    }
}

struct Lines;

impl MakeWriter<'_> for Lines {
    type Writer = Line;

    fn make_writer(&self) -> Line {
        Line(Vec::new())
    }
}

/// The log of this process: nothing is lost that was logged before this is dropped.
#[derive(Debug)]
#[must_use = "lines that wait are written when it is dropped"]
pub struct Logs(());

impl Logs {
    /// Begins to log what the configuration asks for.
    pub fn begin(telemetry: &Telemetry) -> Self {
        let logs = tracing_subscriber::fmt()
            .with_max_level(telemetry.log_level)
            .with_ansi(std::io::stderr().is_terminal())
            .with_target(false)
            .with_writer(Lines);
        match telemetry.log_format {
            LogFormat::Human => logs.init(),
            LogFormat::Json => logs.json().flatten_event(true).init(),
        }
        Self(())
    }
}

impl Drop for Logs {
    fn drop(&mut self) {
        SINK.flush();
    }
}
