//! Columns as CSV: RFC 4180, the first line their names, in any order.

use super::{BETWEEN_LOOKS, Column, Notes, wanted};
use crate::http::input::node::{Node, excerpt};
use csv::{ByteRecord, Error, ErrorKind, ReaderBuilder};

pub(super) fn columns(bytes: &[u8], most: usize, notes: &mut Notes) -> Result<Vec<Column>, String> {
    let mut lines = ReaderBuilder::new().has_headers(false).from_reader(bytes);
    let mut record = ByteRecord::new();
    if !lines.read_byte_record(&mut record).map_err(|error| broken(&error))? {
        return Err("it is empty: the first line has to name the columns".to_owned());
    }
    let mut columns: Vec<Option<Column>> =
        record.iter().map(|name| notes.accept(String::from_utf8_lossy(name).trim())).collect();
    let mut length = 0;
    while lines.read_byte_record(&mut record).map_err(|error| broken(&error))? {
        if length < most {
            for (column, cell) in columns.iter_mut().zip(&record) {
                let Some(column) = column else { continue };
                match number(cell) {
                    Some(number) => column.push(number),
                    None => column.push_other(Node::Text(excerpt(&String::from_utf8_lossy(cell)))),
                }
            }
        }
        length += 1;
        if length.is_multiple_of(BETWEEN_LOOKS) {
            wanted()?;
        }
    }
    let mut columns: Vec<Column> = columns.into_iter().flatten().collect();
    if length > most {
        for column in &mut columns {
            column.only_length(length);
        }
    }
    Ok(columns)
}

/// A finite number; blanks around it do not matter.
fn number(cell: &[u8]) -> Option<f64> {
    let text = str::from_utf8(cell.trim_ascii()).ok()?;
    text.parse().ok().filter(|number: &f64| number.is_finite())
}

fn broken(error: &Error) -> String {
    match error.kind() {
        ErrorKind::UnequalLengths { pos, expected_len, len } => {
            let line = pos.as_ref().map_or(0, csv::Position::line);
            format!("line {line} has {len} fields, the first line has {expected_len}")
        }
        // A body in memory has no other error.
        _ => "it cannot be read".to_owned(),
    }
}
