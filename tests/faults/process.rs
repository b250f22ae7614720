//! The started binary, and what the system knows about it.

use crate::client::{Answer, Connection};
use std::collections::BTreeMap;
use std::ffi::OsString;
use std::fs;
use std::io::{BufRead as _, BufReader};
use std::path::PathBuf;
use std::process::{Child, ChildStdout, Command, ExitStatus, Stdio};
use std::time::{Duration, Instant};

/// A running service; stopped when dropped.
pub(crate) struct Service {
    process: Child,
    pub(crate) address: String,
    // Kept open: a closed pipe would be another test.
    _stdout: BufReader<ChildStdout>,
}

impl Service {
    /// The binary of this build, or the one that `REFLECTANCE_BINARY` names.
    pub(crate) fn start(flags: &[&str]) -> Self {
        let binary = std::env::var_os("REFLECTANCE_BINARY")
            .map_or_else(|| PathBuf::from(env!("CARGO_BIN_EXE_reflectance")), PathBuf::from);
        let mut process = Command::new(&binary)
            .args(["--listen", "127.0.0.1:0", "--log-level", "off"])
            .args(flags)
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()
            .unwrap_or_else(|error| panic!("{}: {error}", binary.display()));
        let mut stdout = BufReader::new(process.stdout.take().expect("its output is piped"));
        let mut greeting = String::new();
        while !greeting.contains("Try:") {
            assert_ne!(stdout.read_line(&mut greeting).expect("text"), 0, "it ended: {greeting}");
        }
        let address = greeting
            .split_whitespace()
            .find_map(|word| word.strip_prefix("http://"))
            .expect("it says where it listens")
            .trim_end_matches('/')
            .to_owned();
        Self { process, address, _stdout: stdout }
    }

    pub(crate) fn connect(&self) -> Connection {
        Connection::open(&self.address).expect("it accepts")
    }

    /// The answer to a whole request on a connection of its own.
    pub(crate) fn ask(&self, request: &[u8]) -> Answer {
        let mut connection = self.connect();
        connection.send(request).expect("it reads");
        connection.answer().expect("an answer")
    }

    /// Checks that it runs and answers.
    pub(crate) fn lives(&mut self) {
        assert!(self.process.try_wait().expect("a child").is_none(), "the process ended");
        assert_eq!(self.ask(&crate::client::small()).status, 200);
    }

    /// Sends SIGTERM.
    pub(crate) fn terminate(&self) {
        rustix::process::kill_process(self.pid(), rustix::process::Signal::TERM).expect("it runs");
    }

    /// Waits for its end.
    pub(crate) fn ended(&mut self, within: Duration) -> ExitStatus {
        let mut status = None;
        until(within, "the process ends", || {
            status = self.process.try_wait().expect("a child");
            status.is_some()
        });
        status.expect("it ended")
    }

    fn pid(&self) -> rustix::process::Pid {
        rustix::process::Pid::from_child(&self.process)
    }

    fn file(&self, name: &str) -> String {
        fs::read_to_string(format!("/proc/{}/{name}", self.process.id())).expect("it runs")
    }

    /// Memory in use, in MiB.
    pub(crate) fn memory(&self) -> f64 {
        let status = self.file("status");
        let line = status.lines().find_map(|line| line.strip_prefix("VmRSS:")).expect("a line");
        let kilobytes: f64 = line.trim().trim_end_matches(" kB").parse().expect("a number");
        kilobytes / 1024.0
    }

    /// Memory in use once it no longer falls, in MiB: at most ten seconds later.
    pub(crate) fn settled_memory(&self) -> f64 {
        let mut least = self.memory();
        let mut since = Instant::now();
        let begin = since;
        while since.elapsed() < Duration::from_secs(2) && begin.elapsed() < Duration::from_secs(10) {
            std::thread::sleep(Duration::from_millis(100));
            let now = self.memory();
            if now < least * 0.99 {
                since = Instant::now();
            }
            least = least.min(now);
        }
        self.memory()
    }

    /// Open descriptors.
    pub(crate) fn descriptors(&self) -> usize {
        fs::read_dir(format!("/proc/{}/fd", self.process.id())).expect("it runs").count()
    }

    /// Open descriptors once connections have come and gone: their number stands still for a while.
    pub(crate) fn settled_descriptors(&self) -> usize {
        let mut count = self.descriptors();
        let mut since = Instant::now();
        until(Duration::from_secs(10), "connections come and go no more", || {
            let now = self.descriptors();
            if now != count {
                (count, since) = (now, Instant::now());
            }
            since.elapsed() > Duration::from_millis(500)
        });
        count
    }

    /// Processor time of each of its threads so far.
    pub(crate) fn work(&self) -> Work {
        let folder = format!("/proc/{}/task", self.process.id());
        let threads = fs::read_dir(folder).expect("it runs").flatten().filter_map(|task| {
            // A thread may end while it is looked at.
            let times = fs::read_to_string(task.path().join("schedstat")).ok()?;
            let nanoseconds = times.split_whitespace().next()?.parse().ok()?;
            Some((task.file_name(), Duration::from_nanos(nanoseconds)))
        });
        Work(threads.collect())
    }
}

/// Processor time by thread.
pub(crate) struct Work(BTreeMap<OsString, Duration>);

impl Work {
    /// What was done since an earlier look, by the threads that still are.
    pub(crate) fn since(&self, before: &Self) -> Duration {
        let times = self.0.iter();
        let before = |thread| before.0.get(thread).copied().unwrap_or_default();
        times.map(|(thread, time)| time.saturating_sub(before(thread))).sum()
    }
}

impl Drop for Service {
    fn drop(&mut self) {
        // Both fail only if the process is gone already.
        let _ = self.process.kill();
        let _ = self.process.wait();
    }
}

/// Waits for something that has to happen.
pub(crate) fn until(within: Duration, what: &str, mut happened: impl FnMut() -> bool) {
    let begin = Instant::now();
    while !happened() {
        assert!(begin.elapsed() < within, "not within {within:?}: {what}");
        std::thread::sleep(Duration::from_millis(5));
    }
}
