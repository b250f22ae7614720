//! Where the computing happens: small work at once, large work off the threads that serve connections.

use super::Limits;
use super::problem::{Kind, Problem};
use super::track::Deadline;
use tokio::time::Instant;

/// Directions that are evaluated without a change of thread, which costs as much as dozens of them.
const SMALL: usize = 1000;

/// When this request has to be answered.
pub(super) fn deadline(known: Option<&Deadline>, limits: Limits) -> Instant {
    known.map_or_else(|| Instant::now() + limits.request_time, |deadline| deadline.0)
}

/// Does work of so many directions.
pub(super) async fn run<T: Send + 'static>(
    deadline: Instant,
    directions: usize,
    work: impl FnOnce() -> T + Send + 'static,
) -> Result<T, Problem> {
    if directions <= SMALL { Ok(work()) } else { blocking(deadline, work).await }
}

/// Does work on a thread of its own.
pub(super) async fn blocking<T: Send + 'static>(
    deadline: Instant,
    work: impl FnOnce() -> T + Send + 'static,
) -> Result<T, Problem> {
    match tokio::time::timeout_at(deadline, tokio::task::spawn_blocking(work)).await {
        Ok(Ok(value)) => Ok(value),
        Ok(Err(error)) => {
            tracing::error!(%error, "work did not finish");
            Err(Problem::internal())
        }
        Err(_) => {
            Err(Problem::new(Kind::TooSlow, "the time limit of a request passed; ask for fewer directions"))
        }
    }
}
