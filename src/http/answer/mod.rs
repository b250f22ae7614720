//! Answers: from what is asked for to bytes. Small ones are made where the request is read; large ones on the pool, a
//! stretch at a time, and sent while they are made.

mod columns;
mod json;
mod output;
mod text;
mod work;

pub(crate) use work::{Over, Work};

use crate::http::app::App;
use crate::http::compute::admission::Turn;
use crate::http::problem::Problem;
use crate::http::track::Deadline;
use axum::http::header;
use axum::response::{IntoResponse as _, Response};
use std::sync::Arc;

/// Nanoseconds of work that is done at once: a tenth of what a client notices, and ten changes of threads.
const SMALL: f64 = 3e5;

/// Answers.
pub(crate) async fn respond(
    app: &App,
    deadline: Deadline,
    turn: Option<Turn>,
    work: Work,
) -> Result<Response, Problem> {
    let nanoseconds = work.nanoseconds_a_row() * work.rows() as f64;
    if nanoseconds <= SMALL {
        let body = json::whole(&work)?;
        return Ok(([(header::CONTENT_TYPE, "application/json")], body).into_response());
    }
    // The estimate is good to a factor of two.
    if nanoseconds > 2e9 * app.limits().cpu_time.as_secs_f64() {
        return Err(output::cpu_time(app));
    }
    let turn = match turn {
        Some(turn) => turn,
        None => app.admission().turn().await?,
    };
    let work = Arc::new(work);
    output::begin(app, deadline, turn, "application/json", move |output| json::stream(work, output)).await
}
