//! Answers: from what is asked for to bytes. Small ones are made where the request is read; large ones on the pool, a
//! stretch at a time, and sent while they are made.

mod columns;
mod json;
pub(crate) mod output;
pub(crate) mod picture;
mod table;
mod text;
mod work;

#[cfg(test)]
mod tests;

pub(crate) use work::{Over, Subject, Work};

use crate::http::app::App;
use crate::http::compute::admission::Turn;
use crate::http::edge::{Asked, Deadline};
use crate::http::negotiate::{Drawable, Format, Tabular, VARY};
use crate::http::problem::Problem;
use axum::extract::FromRequestParts;
use axum::http::request::Parts;
use axum::http::{HeaderValue, header};
use axum::response::{IntoResponse as _, Response};
use std::sync::Arc;

/// Nanoseconds of work that is done at once: a tenth of what a client notices, and ten changes of threads.
const SMALL: f64 = 3e5;

/// What an answer needs of its request besides what is asked for.
pub(crate) struct Call {
    app: App,
    pub(crate) format: Format,
    deadline: Deadline,
}

impl FromRequestParts<App> for Call {
    type Rejection = Problem;

    async fn from_request_parts(parts: &mut Parts, app: &App) -> Result<Self, Problem> {
        let Tabular(format) = Tabular::from_request_parts(parts, app).await?;
        Ok(Self::of(parts, app, format).await)
    }
}

impl Call {
    async fn of(parts: &mut Parts, app: &App, format: Format) -> Self {
        let Ok(deadline) = Deadline::from_request_parts(parts, app).await;
        Self { app: app.clone(), format, deadline }
    }
}

/// The same for an answer that can be drawn too.
pub(crate) struct DrawableCall(pub(crate) Call);

impl FromRequestParts<App> for DrawableCall {
    type Rejection = Problem;

    async fn from_request_parts(parts: &mut Parts, app: &App) -> Result<Self, Problem> {
        let Drawable(format) = Drawable::from_request_parts(parts, app).await?;
        Ok(Self(Call::of(parts, app, format).await))
    }
}

/// Answers; `turn` if the request has had to wait for one already.
pub(crate) async fn respond(call: Call, turn: Option<Turn>, mut work: Work) -> Result<Response, Problem> {
    let Call { app, format, deadline } = call;
    work.check(app.limits()).map_err(Problem::invalid)?;
    work.meter = app.edge().meter();
    let asked = Asked(work.rows());
    let nanoseconds = work.nanoseconds(format.row_format());
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
            return Err(output::cpu_time(&app));
        }
        let turn = match turn {
            Some(turn) => turn,
            None => app.admission().turn().await?,
        };
        let work = Arc::new(work);
        match format.row_format() {
            None => {
                output::begin(&app, deadline, turn, content_type, move |output| json::stream(work, output))
                    .await
            }
            Some(rows) => {
                let make = move |output| table::stream(work, rows, output);
                output::begin(&app, deadline, turn, content_type, make).await
            }
        }?
    };
    response.headers_mut().insert(header::VARY, HeaderValue::from_static(VARY));
    response.extensions_mut().insert(asked);
    Ok(response)
}
