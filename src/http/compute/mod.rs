//! Where the computing happens: small work at once, large work off the threads that serve connections.

pub(crate) mod admission;
pub(crate) mod job;
pub(crate) mod pool;

use super::edge::Deadline;
use super::problem::{Kind, Problem};
use std::cell::RefCell;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use tokio::sync::{Semaphore, SemaphorePermit};

/// Directions that are evaluated without a change of thread, which costs as much as dozens of them.
const SMALL: usize = 1000;

/// What a request is told whose answer did not begin in time.
pub(crate) fn too_slow(deadline: Deadline) -> Problem {
    let limit = deadline.limit.as_secs_f64();
    Problem::new(
        Kind::TooSlow,
        format!(
            "the answer did not begin within {limit} s, the limit of a request; ask for fewer directions"
        ),
    )
}

fn passed(deadline: Deadline) -> bool {
    tokio::time::Instant::now() >= deadline.at
}

/// Does work of so many directions.
pub(super) async fn run<T: Send + 'static>(
    deadline: Deadline,
    directions: usize,
    work: impl FnOnce() -> T + Send + 'static,
) -> Result<T, Problem> {
    if directions > SMALL {
        blocking(deadline, work).await
    } else if passed(deadline) {
        Err(too_slow(deadline))
    } else {
        Ok(work())
    }
}

/// Waits for a turn among those who share `turns`; a turn lasts until the permit is dropped.
pub(super) async fn turn(
    deadline: Deadline,
    turns: &'static Semaphore,
) -> Result<SemaphorePermit<'static>, Problem> {
    match tokio::time::timeout_at(deadline.at, turns.acquire()).await {
        Ok(Ok(permit)) => Ok(permit),
        // Nobody closes them.
        Ok(Err(_)) => Err(Problem::internal()),
        Err(_) => Err(too_slow(deadline)),
    }
}

thread_local! {
    /// Whether anybody waits for what the calling thread does in [`blocking`].
    static ABANDONED: RefCell<Arc<AtomicBool>> = RefCell::default();
}

/// Whether nobody waits any more for the work that the calling thread does: for loops that take long.
pub(super) fn is_abandoned() -> bool {
    ABANDONED.with_borrow(|abandoned| abandoned.load(Ordering::Relaxed))
}

/// Says so when it is dropped.
struct Abandon(Arc<AtomicBool>);

impl Drop for Abandon {
    fn drop(&mut self) {
        self.0.store(true, Ordering::Relaxed);
    }
}

/// Does work on a thread of its own. Work that was still waiting for one at the deadline is never begun.
pub(super) async fn blocking<T: Send + 'static>(
    deadline: Deadline,
    work: impl FnOnce() -> T + Send + 'static,
) -> Result<T, Problem> {
    let waiting = Abandon(Arc::default());
    let abandoned = Arc::clone(&waiting.0);
    let work = move || {
        pool::lower_priority();
        let is_wanted = !passed(deadline) && !abandoned.load(Ordering::Relaxed);
        ABANDONED.set(abandoned);
        let done = is_wanted.then(work);
        ABANDONED.set(Arc::default());
        done
    };
    match tokio::time::timeout_at(deadline.at, tokio::task::spawn_blocking(work)).await {
        Ok(Ok(Some(value))) => Ok(value),
        Ok(Err(error)) => {
            tracing::error!(%error, "work did not finish");
            Err(Problem::internal())
        }
        Ok(Ok(None)) | Err(_) => Err(too_slow(deadline)),
    }
}

#[cfg(test)]
mod tests {
    use super::{Deadline, blocking, run};
    use std::sync::Arc;
    use std::sync::atomic::{AtomicBool, Ordering};
    use std::time::Duration;
    use tokio::time::Instant;

    #[test]
    fn work_whose_deadline_passed_before_it_began_is_not_begun() {
        // One thread, which is held until the deadline has passed.
        let runtime =
            tokio::runtime::Builder::new_multi_thread().max_blocking_threads(1).enable_all().build().unwrap();
        runtime.block_on(async {
            let (release, held) = std::sync::mpsc::channel::<()>();
            let holder = tokio::task::spawn_blocking(move || held.recv());
            let begun = Arc::new(AtomicBool::new(false));
            let work = |begun: &Arc<AtomicBool>| {
                let begun = Arc::clone(begun);
                move || begun.store(true, Ordering::SeqCst)
            };
            let limit = Duration::from_millis(20);
            let soon = Deadline { at: Instant::now() + limit, limit };
            assert!(blocking(soon, work(&begun)).await.is_err());
            assert!(run(soon, 1, work(&begun)).await.is_err());
            release.send(()).unwrap();
            holder.await.unwrap().unwrap();
            // Behind the work that has to be passed over, on the same thread.
            tokio::task::spawn_blocking(|| ()).await.unwrap();
            assert!(!begun.load(Ordering::SeqCst));
        });
    }
}
