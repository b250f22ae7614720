//! Answers: from what is asked for to bytes. Small ones are made where the request is read; large ones on the pool, a
//! stretch at a time, and sent while they are made.

mod columns;
mod json;
mod output;
mod table;
mod text;
mod work;

#[cfg(test)]
mod tests;

pub(crate) use work::{Over, Subject, Work};

use crate::http::app::App;
use crate::http::compute::admission::Turn;
use crate::http::edge::Asked;
use crate::http::negotiate::{Format, VARY};
use crate::http::problem::Problem;
use crate::http::track::Deadline;
use axum::http::{HeaderValue, header};
use axum::response::{IntoResponse as _, Response};
use std::sync::Arc;

/// Nanoseconds of work that is done at once: a tenth of what a client notices, and ten changes of threads.
const SMALL: f64 = 3e5;

/// Answers.
pub(crate) async fn respond(
    app: &App,
    deadline: Deadline,
    turn: Option<Turn>,
    mut work: Work,
    format: Format,
) -> Result<Response, Problem> {
    work.check(app.limits()).map_err(Problem::invalid)?;
    work.meter = app.edge().meter();
    let asked = Asked(work.rows());
    let nanoseconds = work.nanoseconds_a_row() * work.rows() as f64;
    let content_type = format.content_type();
    let mut response = if nanoseconds <= SMALL {
        let body = match format.row_format() {
            None => json::whole(&work)?,
            Some(rows) => table::whole(&work, rows)?,
        };
        ([(header::CONTENT_TYPE, content_type)], body).into_response()
    } else {
        // The estimate is good to a factor of two.
        if nanoseconds > 2e9 * app.limits().cpu_time.as_secs_f64() {
            return Err(output::cpu_time(app));
        }
        let turn = match turn {
            Some(turn) => turn,
            None => app.admission().turn().await?,
        };
        let work = Arc::new(work);
        match format.row_format() {
            None => {
                output::begin(app, deadline, turn, content_type, move |output| json::stream(work, output))
                    .await
            }
            Some(rows) => {
                let make = move |output| table::stream(work, rows, output);
                output::begin(app, deadline, turn, content_type, make).await
            }
        }?
    };
    response.headers_mut().insert(header::VARY, HeaderValue::from_static(VARY));
    response.extensions_mut().insert(asked);
    Ok(response)
}
