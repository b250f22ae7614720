//! Threads of low priority for large work, fed in pieces of about a millisecond, first come first served: the
//! threads that serve connections keep the processor whenever they want it.

use super::job::Job;
use rayon::{ThreadPool, ThreadPoolBuilder};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, AtomicUsize, Ordering};
use std::time::Duration;
use tokio::sync::oneshot;

/// How far below the connections' threads: at 10 a thread gets a tenth of a processor that others want, and all
/// of one that nobody wants.
const NICENESS: i32 = 10;

/// The pool.
pub(crate) struct Pool {
    threads: Option<ThreadPool>,
    counts: Arc<Counts>,
}

/// What the pool has done and does.
#[derive(Debug, Default)]
struct Counts {
    pieces: AtomicU64,
    busy_nanoseconds: AtomicU64,
    active: AtomicUsize,
}

/// Why a piece of work has no result.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum NotDone {
    /// Nobody wants it any more, or its time is over: [`Job`] says which.
    Stopped,
    /// It panicked: a defect.
    Panicked,
}

impl Pool {
    /// As many threads as there are processors unless the configuration says otherwise.
    pub(crate) fn new(threads: Option<usize>) -> Self {
        let threads = ThreadPoolBuilder::new()
            .num_threads(threads.unwrap_or(0))
            .thread_name(|index| format!("compute-{index}"))
            .start_handler(|_| lower_priority())
            .build();
        let threads = threads
            .inspect_err(|error| tracing::error!(%error, "no threads of their own for large work"))
            .ok();
        Self { threads, counts: Arc::default() }
    }

    /// Pieces that were worked on.
    pub(crate) fn pieces(&self) -> u64 {
        self.counts.pieces.load(Ordering::Relaxed)
    }

    /// Pieces that are worked on now.
    pub(crate) fn active(&self) -> usize {
        self.counts.active.load(Ordering::Relaxed)
    }

    /// The processor time of all pieces.
    pub(crate) fn busy(&self) -> Duration {
        Duration::from_nanos(self.counts.busy_nanoseconds.load(Ordering::Relaxed))
    }

    /// How many pieces are worked on at a time.
    pub(crate) fn width(&self) -> usize {
        self.threads.as_ref().map_or(1, ThreadPool::current_num_threads)
    }

    /// Does one piece of a job's work.
    pub(crate) async fn run<T: Send + 'static>(
        &self,
        job: &Arc<Job>,
        work: impl FnOnce() -> T + Send + 'static,
    ) -> Result<T, NotDone> {
        let (sender, result) = oneshot::channel();
        let (job, counts) = (Arc::clone(job), Arc::clone(&self.counts));
        let piece = move || {
            let done = if job.is_stopped() || sender.is_closed() {
                Err(NotDone::Stopped)
            } else {
                counts.active.fetch_add(1, Ordering::Relaxed);
                let (done, taken) = job.measured(|| catch_unwind(AssertUnwindSafe(work)));
                counts.active.fetch_sub(1, Ordering::Relaxed);
                counts.pieces.fetch_add(1, Ordering::Relaxed);
                let nanoseconds = u64::try_from(taken.as_nanos()).unwrap_or(u64::MAX);
                counts.busy_nanoseconds.fetch_add(nanoseconds, Ordering::Relaxed);
                done.map_err(|_| NotDone::Panicked)
            };
            // Whoever waited for it may have left.
            let _ = sender.send(done);
        };
        match &self.threads {
            Some(threads) => threads.spawn_fifo(piece),
            None => piece(),
        }
        result.await.unwrap_or(Err(NotDone::Panicked))
    }
}

/// Makes the calling thread yield to those of ordinary priority, for good.
pub(super) fn lower_priority() {
    if let Err(error) = rustix::process::setpriority_process(Some(rustix::thread::gettid()), NICENESS) {
        tracing::warn!(%error, "large work keeps the priority of small work");
    }
}
