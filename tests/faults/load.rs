//! Small requests, one after the other beside whatever else happens.

use crate::client::{Connection, small};
use std::fmt;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

/// A client of good behaviour.
pub(crate) struct Small {
    stop: Arc<AtomicBool>,
    thread: JoinHandle<Vec<Duration>>,
}

/// How its requests went; all of them were answered with 200.
pub(crate) struct Times {
    count: usize,
    median: Duration,
    worst: Duration,
}

impl fmt::Display for Times {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let Self { count, median, worst } = self;
        write!(f, "{count} small requests, median {median:.1?}, worst {worst:.1?}")
    }
}

impl Small {
    /// Asks every few milliseconds.
    pub(crate) fn begin(address: &str) -> Self {
        let stop = Arc::new(AtomicBool::new(false));
        let (stopped, address) = (Arc::clone(&stop), address.to_owned());
        let thread = std::thread::spawn(move || {
            let request = small();
            let mut connection = Connection::open(&address).expect("it accepts");
            let mut times = Vec::new();
            while !stopped.load(Ordering::Relaxed) {
                let begin = Instant::now();
                connection.send(&request).expect("it reads");
                let answer = connection.answer().expect("an answer");
                assert_eq!(answer.status, 200, "{}", String::from_utf8_lossy(&answer.body));
                times.push(begin.elapsed());
                std::thread::sleep(Duration::from_millis(5));
            }
            times
        });
        Self { stop, thread }
    }

    /// Stops, and says how it went. Fails where a request did.
    pub(crate) fn end(self) -> Times {
        self.stop.store(true, Ordering::Relaxed);
        let mut times = self.thread.join().expect("small requests are answered");
        times.sort_unstable();
        assert!(!times.is_empty(), "no small request was answered");
        Times { count: times.len(), median: times[times.len() / 2], worst: times[times.len() - 1] }
    }
}
