//! Threads of low priority for large work, fed in pieces of about a millisecond, first come first served: the
//! threads that serve connections keep the processor whenever they want it.

use super::job::Job;
use rayon::{ThreadPool, ThreadPoolBuilder};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Arc;
use tokio::sync::oneshot;

/// How far below the connections' threads: at 10 a thread gets a tenth of a processor that others want, and all
/// of one that nobody wants.
const NICENESS: i32 = 10;

/// The pool.
pub(crate) struct Pool {
    threads: Option<ThreadPool>,
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
        match threads {
            Ok(threads) => Self { threads: Some(threads) },
            Err(error) => {
                tracing::error!(%error, "no threads of their own for large work");
                Self { threads: None }
            }
        }
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
        let job = Arc::clone(job);
        let piece = move || {
            let done = if job.is_stopped() || sender.is_closed() {
                Err(NotDone::Stopped)
            } else {
                job.measured(|| catch_unwind(AssertUnwindSafe(work))).map_err(|_| NotDone::Panicked)
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
