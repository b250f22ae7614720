//! Tables as an Arrow IPC stream, a record batch for each stretch of rows.
//!
//! Numbers are Float64 as they are, NaN and infinities included; null is what is absent. Units stand in the fields'
//! metadata, what is to be said of the table in the schema's.

use super::rows::{Cells, Head, Heading, Kind, Rows, unfit};
use crate::http::problem::Problem;
use arrow_array::{ArrayRef, Float64Array, RecordBatch, StringArray};
use arrow_ipc::writer::StreamWriter;
use arrow_schema::{ArrowError, DataType, Field, Schema};
use std::collections::HashMap;
use std::iter::repeat_n;
use std::sync::Arc;

/// The schema.
pub(super) fn head(head: &Head) -> Result<Vec<u8>, Problem> {
    let notes: HashMap<_, _> =
        head.notes.iter().map(|(name, text)| ((*name).to_owned(), text.clone())).collect();
    StreamWriter::try_new(Vec::new(), &schema(head).with_metadata(notes))
        .map(|mut writer| std::mem::take(writer.get_mut()))
        .map_err(|error| Problem::unwritten(&error))
}

pub(super) fn rows(head: &Head, rows: Rows, out: &mut Vec<u8>) -> Result<(), Problem> {
    if rows.columns.len() != head.columns.len() {
        return Err(unfit());
    }
    let cells = head.columns.iter().zip(rows.columns);
    let columns = cells.map(|(heading, cells)| column(heading.kind, cells, rows.count)).collect();
    let schema = Arc::new(schema(head));
    let batch = RecordBatch::try_new(Arc::clone(&schema), columns).map_err(|error| refused(&error))?;
    batch_after_schema(&schema, &batch, out).map_err(|error| refused(&error))
}

/// The end of the stream.
pub(super) fn tail(head: &Head) -> Result<Vec<u8>, Problem> {
    let end = || {
        let mut writer = StreamWriter::try_new(Vec::new(), &schema(head))?;
        writer.get_mut().clear();
        writer.finish()?;
        Ok(std::mem::take(writer.get_mut()))
    };
    end().map_err(|error: ArrowError| Problem::unwritten(&error))
}

/// Writes a batch as it stands in a stream whose schema was written before.
fn batch_after_schema(schema: &Schema, batch: &RecordBatch, out: &mut Vec<u8>) -> Result<(), ArrowError> {
    let before = out.len();
    out.reserve(batch.get_array_memory_size() + 1024);
    let mut writer = StreamWriter::try_new(out, schema)?;
    writer.get_mut().truncate(before);
    writer.write(batch)
}

/// Without the notes, which stand at the head alone.
fn schema(head: &Head) -> Schema {
    Schema::new(head.columns.iter().map(field).collect::<Vec<_>>())
}

fn field(heading: &Heading) -> Field {
    let kind = match heading.kind {
        Kind::Number => DataType::Float64,
        Kind::Text { .. } => DataType::Utf8,
    };
    let field = Field::new(heading.name, kind, true);
    if heading.unit.is_empty() {
        field
    } else {
        field.with_metadata(HashMap::from([("unit".to_owned(), heading.unit.to_owned())]))
    }
}

/// A column of the kind that its cells are; one that is not what the head says, or too short, is refused with the
/// batch.
fn column(kind: Kind, cells: Cells, count: usize) -> ArrayRef {
    match (kind, cells) {
        (_, Cells::Numbers(numbers)) => Arc::new(Float64Array::from(numbers.into_owned())),
        (_, Cells::Number(value)) => Arc::new(Float64Array::from(vec![value; count])),
        (_, Cells::Names(names)) => Arc::new(StringArray::from_iter_values(names)),
        (_, Cells::Name(name)) => Arc::new(StringArray::from_iter_values(repeat_n(name, count))),
        (Kind::Number, Cells::Absent) => Arc::new(Float64Array::new_null(count)),
        (Kind::Text { .. }, Cells::Absent) => Arc::new(StringArray::new_null(count)),
    }
}

/// Only a defect makes a batch that cannot be written.
fn refused(error: &ArrowError) -> Problem {
    tracing::error!(%error, "a record batch could not be written");
    unfit()
}
