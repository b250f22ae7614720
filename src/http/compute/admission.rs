//! Who may do large work now, who waits, and who is sent away before any work is done.

use crate::http::app::Limits;
use crate::http::problem::{Kind, Problem};
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Duration;
use tokio::sync::{OwnedSemaphorePermit, Semaphore};

/// The turns of large requests.
pub(crate) struct Admission {
    turns: Arc<Semaphore>,
    waiting: AtomicUsize,
    queue: usize,
    queue_time: Duration,
}

/// The right to do large work, until it is dropped.
pub(crate) type Turn = OwnedSemaphorePermit;

impl Admission {
    pub(crate) fn new(limits: &Limits) -> Self {
        Self {
            turns: Arc::new(Semaphore::new(limits.large_requests)),
            waiting: AtomicUsize::new(0),
            queue: limits.queue,
            queue_time: limits.queue_time,
        }
    }

    /// Large requests that wait.
    pub(crate) fn waiting(&self) -> usize {
        self.waiting.load(Ordering::Relaxed)
    }

    /// Waits for a turn, in order of arrival, unless too many wait already.
    pub(crate) async fn turn(&self) -> Result<Turn, Problem> {
        if let Ok(turn) = Arc::clone(&self.turns).try_acquire_owned() {
            return Ok(turn);
        }
        let place = Place::take(&self.waiting);
        if place.before >= self.queue {
            let limit = self.queue;
            let detail =
                format!("{limit} large requests wait already, the limit of the queue; ask again later");
            return Err(Problem::new(Kind::Overloaded, detail));
        }
        match tokio::time::timeout(self.queue_time, Arc::clone(&self.turns).acquire_owned()).await {
            Ok(Ok(turn)) => Ok(turn),
            // Nobody closes it.
            Ok(Err(_)) => Err(Problem::internal()),
            Err(_) => {
                let limit = self.queue_time.as_secs_f64();
                let detail = format!("no turn for a large request came within {limit} s; ask again later");
                Err(Problem::new(Kind::Overloaded, detail))
            }
        }
    }
}

/// A place in the queue.
struct Place<'a> {
    waiting: &'a AtomicUsize,
    before: usize,
}

impl<'a> Place<'a> {
    fn take(waiting: &'a AtomicUsize) -> Self {
        Self { waiting, before: waiting.fetch_add(1, Ordering::Relaxed) }
    }
}

impl Drop for Place<'_> {
    fn drop(&mut self) {
        self.waiting.fetch_sub(1, Ordering::Relaxed);
    }
}
