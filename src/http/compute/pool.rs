//! Threads of low priority for large work, fed in pieces of about a millisecond, first come first served: the
//! threads that serve connections keep the processor whenever they want it.

use super::job::Job;
use std::num::NonZeroUsize;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::pin::Pin;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, AtomicUsize, Ordering};
use std::task::{Context, Poll};
use std::thread::available_parallelism;
use std::time::Duration;
use tokio::runtime::{Builder, Runtime};
use tokio::task::JoinHandle;

/// How far below the connections' threads: at 10 a thread gets a tenth of a processor that others want, and all
/// of one that nobody wants.
const NICENESS: i32 = 10;

/// The pool: a runtime of its own, whose threads sleep when there is nothing to do. Those of rayon look for work for a while
/// first, which took a tenth of a batch's processor time.
pub(crate) struct Pool {
    threads: Option<Runtime>,
    width: usize,
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
        let width = threads.unwrap_or_else(|| available_parallelism().map_or(1, NonZeroUsize::get)).max(1);
        let threads = Builder::new_multi_thread()
            .worker_threads(width)
            .thread_name("compute")
            .on_thread_start(lower_priority)
            .build()
            .inspect_err(|error| tracing::error!(%error, "no threads of their own for large work"))
            .ok();
        Self { threads, width, counts: Arc::default() }
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
        self.width
    }

    /// Does one piece of a job's work.
    pub(crate) async fn run<T: Send + 'static>(
        &self,
        job: &Arc<Job>,
        work: impl FnOnce() -> T + Send + 'static,
    ) -> Result<T, NotDone> {
        let (job, counts) = (Arc::clone(job), Arc::clone(&self.counts));
        let piece = move || {
            if job.is_stopped() {
                return Err(NotDone::Stopped);
            }
            counts.active.fetch_add(1, Ordering::Relaxed);
            let (done, taken) = job.measured(|| catch_unwind(AssertUnwindSafe(work)));
            counts.active.fetch_sub(1, Ordering::Relaxed);
            counts.pieces.fetch_add(1, Ordering::Relaxed);
            let nanoseconds = u64::try_from(taken.as_nanos()).unwrap_or(u64::MAX);
            counts.busy_nanoseconds.fetch_add(nanoseconds, Ordering::Relaxed);
            done.map_err(|_| NotDone::Panicked)
        };
        match &self.threads {
            Some(threads) => {
                let piece = Wanted(threads.spawn(async { piece() }));
                piece.await
            }
            None => piece(),
        }
    }
}

/// A piece of work that is not begun once nobody waits for it.
struct Wanted<T>(JoinHandle<Result<T, NotDone>>);

impl<T> Future for Wanted<T> {
    type Output = Result<T, NotDone>;

    fn poll(mut self: Pin<&mut Self>, cx: &mut Context) -> Poll<Self::Output> {
        Pin::new(&mut self.0).poll(cx).map(|done| done.unwrap_or(Err(NotDone::Panicked)))
    }
}

impl<T> Drop for Wanted<T> {
    fn drop(&mut self) {
        self.0.abort();
    }
}

impl Drop for Pool {
    fn drop(&mut self) {
        if let Some(threads) = self.threads.take() {
            // Waiting for them would block whoever drops it, which may be another runtime.
            threads.shutdown_background();
        }
    }
}

/// Makes the calling thread yield to those of ordinary priority, for good.
pub(super) fn lower_priority() {
    if let Err(error) = rustix::process::setpriority_process(Some(rustix::thread::gettid()), NICENESS) {
        tracing::warn!(%error, "large work keeps the priority of small work");
    }
}
