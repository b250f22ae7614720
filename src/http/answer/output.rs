//! The way of a large answer to its client: parts are sent as they are made, no more than a few ahead of what the client
//! takes, and when the client leaves the making ends.

use crate::http::app::App;
use crate::http::compute::admission::Turn;
use crate::http::compute::job::{Abandon, Job};
use crate::http::compute::pool::NotDone;
use crate::http::edge::Deadline;
use crate::http::problem::{Kind, Problem};
use axum::body::{Body, Bytes};
use axum::http::{HeaderValue, header};
use axum::response::Response;
use futures_util::{Stream, StreamExt as _, stream};
use std::future::Future;
use std::sync::Arc;
use tokio::sync::mpsc;

/// Parts that may be made before the client took those before them.
const AHEAD: usize = 2;

/// Bytes that are sent before others have their turn: a tenth of a millisecond.
const AT_ONCE: usize = 128 << 10;

/// Where a large answer goes, part by part.
pub(crate) struct Output {
    app: App,
    job: Arc<Job>,
    parts: mpsc::Sender<Result<Bytes, Problem>>,
}

/// Why an answer ends early.
pub(crate) enum End {
    /// Nobody waits for it.
    Unwanted,
    /// Something is wrong.
    Problem(Problem),
}

impl From<Problem> for End {
    fn from(problem: Problem) -> Self {
        Self::Problem(problem)
    }
}

impl Output {
    /// Sends a part.
    pub(crate) async fn send(&self, part: impl Into<Bytes>) -> Result<(), End> {
        let part = part.into();
        if part.is_empty() {
            return Ok(());
        }
        self.parts.send(Ok(part)).await.map_err(|_| End::Unwanted)
    }

    /// Does a piece of the work on the pool.
    pub(crate) async fn run<T: Send + 'static>(
        &self,
        work: impl FnOnce(&Job) -> T + Send + 'static,
    ) -> Result<T, End> {
        let job = Arc::clone(&self.job);
        let done = self.app.pool().run(&self.job, move || work(&job)).await;
        done.map_err(|reason| match reason {
            NotDone::Panicked => End::Problem(Problem::internal()),
            NotDone::Stopped => self.stopped(),
        })
    }

    /// Why a piece was told to stop.
    pub(crate) fn stopped(&self) -> End {
        if self.job.is_exhausted() { End::Problem(cpu_time(&self.app)) } else { End::Unwanted }
    }

    /// Does pieces side by side and gives their results in order.
    pub(crate) fn run_all<'a, T: Send + 'static, W: FnOnce(&Job) -> T + Send + 'static>(
        &'a self,
        pieces: impl Iterator<Item = W> + Send + 'a,
    ) -> impl Stream<Item = Result<T, End>> + Send + 'a {
        stream::iter(pieces).map(|work| self.run(work)).buffered(self.app.pool().width() + 1)
    }
}

/// What a request is told that takes more processor time than it may.
pub(super) fn cpu_time(app: &App) -> Problem {
    let limit = app.limits().cpu_time.as_secs_f64();
    Problem::new(
        Kind::CpuTime,
        format!(
            "the limit of a request is {limit} s of processor time; ask for fewer directions or a coarser tolerance"
        ),
    )
}

/// Starts an answer and returns it with its first part. What is wrong before that is a problem of its own; after it, the
/// connection is cut, which is the only way left to say so.
pub(crate) async fn begin<F: Future<Output = Result<(), End>> + Send + 'static>(
    app: &App,
    deadline: Deadline,
    turn: Turn,
    content_type: &'static str,
    make: impl FnOnce(Output) -> F,
) -> Result<Response, Problem> {
    let (job, abandon) = Job::new(app.limits().cpu_time);
    let (sender, mut parts) = mpsc::channel(AHEAD);
    let problems = sender.clone();
    let making = make(Output { app: app.clone(), job, parts: sender });
    tokio::spawn(async move {
        if let Err(End::Problem(problem)) = making.await {
            // The client may have left meanwhile.
            let _ = problems.send(Err(problem)).await;
        }
        drop(turn);
    });
    let first = match tokio::time::timeout_at(deadline.at, parts.recv()).await {
        Ok(Some(first)) => first?,
        Ok(None) => return Err(Problem::internal()),
        Err(_) => return Err(crate::http::compute::too_slow(deadline)),
    };
    let parts = Parts { first: Some(first), rest: parts, at_once: 0, _abandon: abandon };
    let mut response = Response::new(Body::from_stream(stream::unfold(parts, Parts::next)));
    response.headers_mut().insert(header::CONTENT_TYPE, HeaderValue::from_static(content_type));
    Ok(response)
}

/// The body of an answer that is being made.
struct Parts {
    first: Option<Bytes>,
    rest: mpsc::Receiver<Result<Bytes, Problem>>,
    /// Bytes that were sent since others had their turn.
    at_once: usize,
    _abandon: Abandon,
}

impl Parts {
    async fn next(mut self) -> Option<(Result<Bytes, std::io::Error>, Self)> {
        if self.at_once > AT_ONCE {
            // A client that takes all at once would have it copied without a pause, while small requests wait.
            tokio::task::yield_now().await;
            self.at_once = 0;
        }
        let part = match self.first.take() {
            Some(first) => Ok(first),
            None => self.rest.recv().await?,
        };
        let part = part.map_err(|problem| {
            tracing::warn!(detail = problem.detail, "an answer was cut short");
            std::io::Error::other(problem.detail)
        });
        self.at_once += part.as_ref().map_or(0, Bytes::len);
        Some((part, self))
    }
}
