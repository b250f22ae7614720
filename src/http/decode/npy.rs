//! Columns as a NumPy array: structured, one dimension, a field a column.

use super::npy_header::{self, Layout};
use super::scalar::{ACCEPTED, Scalar};
use super::{Column, NAMES, Notes, wanted};
use crate::http::input::node::excerpt;
use crate::http::problem::Code;

/// A field of a record.
struct Field {
    column: Column,
    scalar: Scalar,
    big: bool,
    at: usize,
}

pub(super) fn columns(bytes: &[u8], most: usize, notes: &mut Notes) -> Result<Vec<Column>, String> {
    let header = npy_header::read(bytes)?;
    let Layout::Fields(named) = header.layout else {
        let names = NAMES.join(", ");
        let detail = format!("the array has no fields: expected a structured array with fields of {names}");
        notes.error_of_all(Code::WrongType, detail);
        return Ok(Vec::new());
    };
    let &[length] = header.shape.as_slice() else {
        let detail = format!("the array has {} dimensions: expected one", header.shape.len());
        notes.error_of_all(Code::WrongType, detail);
        return Ok(Vec::new());
    };
    let Some((mut fields, record)) = layout(&named, notes) else { return Ok(Vec::new()) };
    let records = &bytes[header.length..];
    if length.checked_mul(record) != Some(records.len()) {
        let found = records.len();
        return Err(format!("it has {found} bytes of records: expected {length} records of {record} bytes"));
    }
    for field in &mut fields {
        wanted()?;
        if length > most {
            field.column.only_length(length);
        } else {
            let numbers = &mut field.column.array.numbers;
            numbers.reserve_exact(length);
            field.scalar.extend(records, record, field.at, field.big, numbers);
            field.column.array.length = length;
        }
    }
    Ok(fields.into_iter().map(|field| field.column).collect())
}

/// The fields and the length of a record, unless there is a type among them whose width is not known.
fn layout(named: &[(String, String)], notes: &mut Notes) -> Option<(Vec<Field>, usize)> {
    let mut fields = Vec::new();
    let mut record = Some(0_usize);
    for (name, code) in named {
        let padding = padding(code).filter(|_| name.is_empty());
        let width = if let Some(padding) = padding {
            Some(padding)
        } else {
            let column = notes.accept(name);
            let scalar = scalar(code);
            if scalar.is_none() && column.is_some() {
                let detail = format!("found type '{}': expected {ACCEPTED}", excerpt(code));
                notes.error(name, Code::WrongType, detail);
            }
            if let (Some(column), Some((scalar, big)), Some(at)) = (column, scalar, record) {
                fields.push(Field { column, scalar, big, at });
            }
            scalar.map(|(scalar, _)| scalar.width())
        };
        record = record.zip(width).and_then(|(record, width)| record.checked_add(width));
    }
    record.map(|record| (fields, record))
}

/// The bytes between the fields of an aligned record: `|V4`.
fn padding(code: &str) -> Option<usize> {
    code.strip_prefix("|V")?.parse().ok()
}

/// The type that a code names, and whether its bytes come in big-endian order.
fn scalar(code: &str) -> Option<(Scalar, bool)> {
    let mut characters = code.chars();
    let big = match characters.next()? {
        '<' | '|' => false,
        '>' => true,
        _ => return None,
    };
    let kind = characters.next()?;
    let scalar = match (kind, characters.as_str()) {
        ('f', "8") => Scalar::F64,
        ('f', "4") => Scalar::F32,
        ('i' | 'u', bytes) => Scalar::integer(kind == 'i', bytes.parse::<usize>().ok()?.checked_mul(8)?)?,
        _ => return None,
    };
    Some((scalar, big))
}
