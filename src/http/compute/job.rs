//! The work of one request: whether anybody still waits for it, and what it has taken.

use rustix::time::{ClockId, clock_gettime};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::time::Duration;

/// The work of one request.
#[derive(Debug)]
pub(crate) struct Job {
    abandoned: AtomicBool,
    cpu_nanoseconds: AtomicU64,
    cpu_limit: Duration,
}

impl Job {
    /// Nothing done yet. The guard is held by whoever waits for the work.
    pub(crate) fn new(cpu_limit: Duration) -> (Arc<Self>, Abandon) {
        let job = Arc::new(Self {
            abandoned: AtomicBool::new(false),
            cpu_nanoseconds: AtomicU64::new(0),
            cpu_limit,
        });
        (Arc::clone(&job), Abandon(job))
    }

    /// Whether to do no more: checked between pieces of some tens of microseconds.
    pub(crate) fn is_stopped(&self) -> bool {
        self.abandoned.load(Ordering::Relaxed) || self.is_exhausted()
    }

    /// Whether its processor time is used up.
    pub(crate) fn is_exhausted(&self) -> bool {
        self.cpu_time() > self.cpu_limit
    }

    /// The processor time of the pieces that are done.
    pub(crate) fn cpu_time(&self) -> Duration {
        Duration::from_nanos(self.cpu_nanoseconds.load(Ordering::Relaxed))
    }

    /// Does a piece of it and counts the processor time, which it says.
    pub(super) fn measured<T>(&self, piece: impl FnOnce() -> T) -> (T, Duration) {
        let before = thread_time();
        let value = piece();
        let taken = thread_time().saturating_sub(before);
        let nanoseconds = u64::try_from(taken.as_nanos()).unwrap_or(u64::MAX);
        self.cpu_nanoseconds.fetch_add(nanoseconds, Ordering::Relaxed);
        (value, taken)
    }
}

/// Stops a job when it is dropped: with the answer, or with the client who left.
#[derive(Debug)]
pub(crate) struct Abandon(Arc<Job>);

impl Drop for Abandon {
    fn drop(&mut self) {
        self.0.abandoned.store(true, Ordering::Relaxed);
    }
}

/// Processor time of the calling thread.
fn thread_time() -> Duration {
    let time = clock_gettime(ClockId::ThreadCPUTime);
    let seconds = u64::try_from(time.tv_sec).unwrap_or(0);
    Duration::new(seconds, u32::try_from(time.tv_nsec).unwrap_or(0))
}
