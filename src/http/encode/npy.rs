//! Tables as a NumPy array: structured, one dimension, little endian, a record a row. What is absent is NaN or an
//! empty text.

use super::rows::{Cells, Head, Kind, Rows, unfit};
use crate::http::problem::Problem;
use std::fmt::Write as _;

/// Where the records begin is a multiple of this.
const ALIGNMENT: usize = 64;

/// Bytes of a number.
const NUMBER: usize = size_of::<f64>();
/// Bytes of a character.
const CHARACTER: usize = size_of::<u32>();

/// Magic, version 2.0 (whose header may be longer than 64 KiB), and the array's description as a Python literal.
pub(super) fn head(head: &Head) -> Result<Vec<u8>, Problem> {
    let mut text = "{'descr': [".to_owned();
    for heading in &head.columns {
        let written = match heading.kind {
            Kind::Number => write!(text, "('{}', '<f8'), ", heading.name),
            Kind::Text { longest } => write!(text, "('{}', '<U{}'), ", heading.name, longest.max(1)),
        };
        written.map_err(|error| Problem::unwritten(&error))?;
    }
    write!(text, "], 'fortran_order': False, 'shape': ({},), }}", head.rows)
        .map_err(|error| Problem::unwritten(&error))?;
    let mut bytes = b"\x93NUMPY\x02\x00".to_vec();
    let length_field = size_of::<u32>();
    // One byte more for the line's end.
    let end = (bytes.len() + length_field + text.len() + 1).next_multiple_of(ALIGNMENT);
    let length = u32::try_from(end - bytes.len() - length_field).map_err(|_| unfit())?;
    bytes.extend_from_slice(&length.to_le_bytes());
    bytes.extend_from_slice(text.as_bytes());
    bytes.resize(end - 1, b' ');
    bytes.push(b'\n');
    Ok(bytes)
}

/// Fills the records column by column: one cell to the next is a record further on.
pub(super) fn rows(head: &Head, rows: &Rows, out: &mut Vec<u8>) -> Result<(), Problem> {
    if rows.columns.len() != head.columns.len() {
        return Err(unfit());
    }
    let widths: Vec<usize> = head.columns.iter().map(|heading| width(heading.kind)).collect();
    let record: usize = widths.iter().sum();
    let before = out.len();
    out.resize(before + record * rows.count, 0);
    let mut at = 0;
    for ((heading, cells), width) in head.columns.iter().zip(&rows.columns).zip(widths) {
        let places = out[before..].chunks_exact_mut(record).map(|record| &mut record[at..at + width]);
        fill(heading.kind, cells, places, rows.count)?;
        at += width;
    }
    Ok(())
}

fn width(kind: Kind) -> usize {
    match kind {
        Kind::Number => NUMBER,
        Kind::Text { longest } => CHARACTER * longest.max(1),
    }
}

/// Writes one column's cells to their places.
fn fill<'a>(
    kind: Kind,
    cells: &Cells,
    places: impl Iterator<Item = &'a mut [u8]>,
    count: usize,
) -> Result<(), Problem> {
    match (kind, cells) {
        (Kind::Number, Cells::Numbers(numbers)) if numbers.len() == count => {
            for (place, number) in places.zip(numbers.iter()) {
                place.copy_from_slice(&number.to_le_bytes());
            }
        }
        (Kind::Number, Cells::Number(number)) => copy_to_all(&number.to_le_bytes(), places),
        (Kind::Number, Cells::Absent) => copy_to_all(&f64::NAN.to_le_bytes(), places),
        (Kind::Text { .. }, Cells::Names(names)) if names.len() == count => {
            for (place, name) in places.zip(*names) {
                text(name, place)?;
            }
        }
        (Kind::Text { .. }, Cells::Name(name)) => {
            let mut cell = vec![0; width(kind)];
            text(name, &mut cell)?;
            copy_to_all(&cell, places);
        }
        // The places are zero, which is an empty text.
        (Kind::Text { .. }, Cells::Absent) => {}
        _ => return Err(unfit()),
    }
    Ok(())
}

fn copy_to_all<'a>(cell: &[u8], places: impl Iterator<Item = &'a mut [u8]>) {
    for place in places {
        place.copy_from_slice(cell);
    }
}

/// A text in UTF-32; what the text leaves is zero.
fn text(text: &str, place: &mut [u8]) -> Result<(), Problem> {
    let mut places = place.chunks_exact_mut(CHARACTER);
    for character in text.chars() {
        places.next().ok_or_else(unfit)?.copy_from_slice(&u32::from(character).to_le_bytes());
    }
    Ok(())
}
