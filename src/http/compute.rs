//! Where the computing happens: small work at once, large work off the threads that serve connections.

use super::problem::{Kind, Problem};
use super::track::Deadline;

/// Directions that are evaluated without a change of thread, which costs as much as dozens of them.
const SMALL: usize = 1000;

/// Does work of so many directions.
pub(super) async fn run<T: Send + 'static>(
    deadline: Deadline,
    directions: usize,
    work: impl FnOnce() -> T + Send + 'static,
) -> Result<T, Problem> {
    if directions <= SMALL { Ok(work()) } else { blocking(deadline, work).await }
}

/// Does work on a thread of its own.
pub(super) async fn blocking<T: Send + 'static>(
    deadline: Deadline,
    work: impl FnOnce() -> T + Send + 'static,
) -> Result<T, Problem> {
    match tokio::time::timeout_at(deadline.0, tokio::task::spawn_blocking(work)).await {
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
