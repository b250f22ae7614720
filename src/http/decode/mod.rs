//! Requests as columns: a body whose columns are the angles of many directions, so that a million of them need no
//! JSON. What else a request says stands in the query.
//!
//! A decoder trusts nothing that a body says of itself: it keeps as many numbers as the limit allows and no more, and
//! reserves memory for what has arrived, not for what is announced.

mod arrow;
mod csv;
mod npy;
mod npy_header;
mod scalar;
#[cfg(test)]
mod tests;

use super::compute::is_abandoned;
use super::input::node::{Array, Node, excerpt};
use super::input::reader::Reader;
use super::negotiate::Format;
use super::problem::{Code, Kind, Problem};

/// The columns that a body can have.
pub(crate) const NAMES: [&str; 3] = ["theta_i_deg", "theta_r_deg", "phi_r_deg"];

/// Where in a JSON request the columns would stand.
pub(crate) const OBJECT: &str = "geometry";

/// Cells without a number that are kept for messages, more than one column's errors list.
const KEPT: usize = 32;

/// The columns of a body.
#[derive(Debug, Default)]
pub(crate) struct Columns(Vec<Column>);

impl Columns {
    /// Takes a column out.
    pub(crate) fn take(&mut self, name: &str) -> Option<Array> {
        let position = self.0.iter().position(|column| column.name == name)?;
        Some(self.0.swap_remove(position).array)
    }

    /// Whether a column of this name is there.
    pub(crate) fn has(&self, name: &str) -> bool {
        self.0.iter().any(|column| column.name == name)
    }
}

/// A column while it fills.
#[derive(Debug)]
struct Column {
    name: &'static str,
    array: Array,
}

impl Column {
    const fn new(name: &'static str) -> Self {
        Self { name, array: Array { numbers: Vec::new(), others: Vec::new(), length: 0 } }
    }

    /// A cell that holds something else than a number.
    fn push_other(&mut self, other: Node) {
        if self.array.others.len() < KEPT {
            self.array.others.push((self.array.numbers.len(), other));
        }
        self.array.numbers.push(f64::NAN);
        self.array.length += 1;
    }

    fn push(&mut self, number: f64) {
        self.array.numbers.push(number);
        self.array.length += 1;
    }

    /// Puts something else in the place of a number that was pushed already.
    fn replace(&mut self, index: usize, other: Node) {
        self.array.numbers[index] = f64::NAN;
        if self.array.others.len() < KEPT {
            self.array.others.push((index, other));
        }
    }

    /// Forgets the numbers of a column that is too long.
    fn only_length(&mut self, length: usize) {
        self.array = Array { length, ..Array::default() };
    }
}

/// Reads the columns of a body. What is wrong with a column as a whole is noted; the columns with the numbers of at
/// most [`Reader::most_directions`] rows come back, or their length where there are more. A body that is not in the
/// format that it is declared as is a problem of its own.
pub(crate) fn columns(format: Format, bytes: &[u8], reader: &mut Reader) -> Result<Columns, Problem> {
    let most = reader.most_directions();
    let mut notes = Notes { reader, seen: Vec::new() };
    let columns = match format {
        Format::Csv => csv::columns(bytes, most, &mut notes),
        Format::Arrow => arrow::columns(bytes, most, &mut notes),
        Format::Npy => npy::columns(bytes, most, &mut notes),
        // A body that is not of columns is read elsewhere, and none is a picture.
        Format::Json | Format::Picture(_) => Err("it has no columns".to_owned()),
    };
    columns.map(Columns).map_err(|detail| {
        let media_type = format.media_type();
        Problem::new(Kind::MalformedColumns, format!("the body is not {media_type}: {detail}"))
    })
}

/// Rows between two looks at whether anybody still waits.
const BETWEEN_LOOKS: usize = 4096;

/// Ends the reading of a body whose client has left.
fn wanted() -> Result<(), String> {
    if is_abandoned() { Err("nobody waits for it".to_owned()) } else { Ok(()) }
}

/// What is wrong with columns as a whole, noted where JSON has them.
struct Notes<'a> {
    reader: &'a mut Reader,
    seen: Vec<&'static str>,
}

impl Notes<'_> {
    /// The column of this name, unless there is no such column or it was there before.
    fn accept(&mut self, name: &str) -> Option<Column> {
        let Some(known) = NAMES.into_iter().find(|known| *known == name) else {
            let detail = format!("an unknown column; accepted: {}", NAMES.join(", "));
            self.error(name, Code::UnknownField, detail);
            return None;
        };
        if self.seen.contains(&known) {
            self.error(name, Code::Duplicate, "the body has more than one column of this name".to_owned());
            return None;
        }
        self.seen.push(known);
        Some(Column::new(known))
    }

    fn error(&mut self, name: &str, code: Code, detail: String) {
        let name = excerpt(name);
        self.reader.in_body(|reader| {
            reader.within(OBJECT, |reader| reader.within(name, |reader| reader.error(code, detail)));
        });
    }

    /// What is wrong with all columns together.
    fn error_of_all(&mut self, code: Code, detail: String) {
        self.reader.in_body(|reader| reader.within(OBJECT, |reader| reader.error(code, detail)));
    }
}
