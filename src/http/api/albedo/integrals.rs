//! Albedos, one piece of work each, on the pool.

use super::answer::Table;
use crate::http::answer::output::{self, End, Output};
use crate::http::app::App;
use crate::http::compute::admission::Turn;
use crate::http::edge::Deadline;
use crate::http::encode::rows::RowFormat;
use crate::http::negotiate::Format;
use crate::http::problem::Problem;
use crate::reflectance::albedo::Albedo;
use axum::body::Body;
use axum::response::Response;
use futures_util::StreamExt as _;
use std::pin::pin;
use std::sync::Arc;

/// Answers: what is closed at once, CSV while it is worked out, the other formats at the end, for what they begin with is known
/// only then.
pub(super) async fn respond(
    app: &App,
    deadline: Deadline,
    turn: Option<Turn>,
    table: Arc<Table>,
    format: Format,
) -> Result<Response, Problem> {
    if table.is_closed() {
        let albedos: Vec<_> = (0..table.rows()).filter_map(|row| table.at(row, || false)).collect();
        return Ok(Response::new(Body::from(whole(&table, format, &albedos)?)));
    }
    let turn = match turn {
        Some(turn) => turn,
        None => app.admission().turn().await?,
    };
    output::begin(app, deadline, turn, format.content_type(), move |output| send(table, format, output)).await
}

async fn send(table: Arc<Table>, format: Format, output: Output) -> Result<(), End> {
    let by_row = format.row_format().filter(|&rows| rows == RowFormat::Csv);
    let head = match by_row {
        None => None,
        Some(_) => Some(table.head(None)?),
    };
    let mut albedos: Vec<Albedo> = Vec::new();
    let pieces = (0..table.rows()).map(|row| {
        let table = Arc::clone(&table);
        move |job: &crate::http::compute::job::Job| table.at(row, || job.is_stopped())
    });
    let mut done = pin!(output.run_all(pieces));
    let mut row = 0;
    while let Some(albedo) = done.next().await {
        // None is what a piece gives that was told to stop.
        let albedo = albedo?.ok_or_else(|| output.stopped())?;
        if let (Some(rows), Some(head)) = (by_row, &head) {
            // The names with the first row: a problem before it can still be told.
            let mut text = if row == 0 { rows.head(head)? } else { Vec::new() };
            rows.rows(head, table.some_rows(row, &[albedo]), &mut text)?;
            output.send(text).await?;
        } else {
            albedos.push(albedo);
        }
        row += 1;
    }
    if head.is_some() { Ok(()) } else { output.send(whole(&table, format, &albedos)?).await }
}

fn whole(table: &Table, format: Format, albedos: &[Albedo]) -> Result<Vec<u8>, Problem> {
    let Some(rows) = format.row_format() else { return table.json(albedos) };
    let head = table.head(Some(albedos))?;
    let mut bytes = rows.head(&head)?;
    rows.rows(&head, table.some_rows(0, albedos), &mut bytes)?;
    bytes.append(&mut rows.tail(&head)?);
    Ok(bytes)
}
