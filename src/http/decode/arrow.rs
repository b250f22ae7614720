//! Columns as an Arrow IPC stream: a schema, then record batches, read where they lie.
//!
//! The metadata of each message is verified as a flatbuffer; offsets and lengths are then taken from it as claims, each
//! held against the bytes that arrived. Types that no column can have end the reading before the first batch.

use super::scalar::{ACCEPTED, Scalar};
use super::{Column, Notes, wanted};
use crate::http::input::node::Node;
use crate::http::problem::Code;
use arrow_ipc::{Endianness, Field, Message, MessageHeader, Precision, RecordBatch, Schema, Type};

/// What stands before the length of a message's metadata.
const CONTINUATION: [u8; 4] = [0xff; 4];
/// Metadata of a schema: three fields have about 500 bytes, what pandas adds about 2000.
const LONGEST_SCHEMA: usize = 64 << 10;
/// Metadata of a record batch of three columns: about 300 bytes. Verifying takes time in proportion to its square.
const LONGEST_BATCH: usize = 4 << 10;

pub(super) fn columns(bytes: &[u8], most: usize, notes: &mut Notes) -> Result<Vec<Column>, String> {
    let mut messages = Messages { rest: bytes };
    let (schema, _) = messages.next(LONGEST_SCHEMA)?.ok_or("it is empty: the first message is its schema")?;
    let schema = schema.header_as_schema().ok_or("its first message is not a schema")?;
    if schema.endianness() != Endianness::Little {
        notes.error_of_all(Code::WrongType, "the numbers are big-endian: expected little-endian".to_owned());
        return Ok(Vec::new());
    }
    let Some(mut columns) = fields(&schema, notes) else { return Ok(Vec::new()) };
    let mut length = 0;
    while let Some((message, body)) = messages.next(LONGEST_BATCH)? {
        if message.header_type() == MessageHeader::DictionaryBatch {
            return Err("a dictionary came, but no column is dictionary-encoded".to_owned());
        }
        let batch = message.header_as_record_batch().ok_or("a message is not a record batch")?;
        if batch.compression().is_some() {
            let detail = "the record batches are compressed: expected uncompressed ones";
            notes.error_of_all(Code::NotOffered, detail.to_owned());
            return Ok(Vec::new());
        }
        length = append(&mut columns, &batch, body, length, most)?;
    }
    let mut columns: Vec<Column> = columns.into_iter().map(|(column, _)| column).collect();
    if length > most {
        for column in &mut columns {
            column.only_length(length);
        }
    }
    Ok(columns)
}

/// The messages of a stream, each with its body.
struct Messages<'a> {
    rest: &'a [u8],
}

impl<'a> Messages<'a> {
    /// The next message, unless the stream is at its end.
    fn next(&mut self, longest: usize) -> Result<Option<(Message<'a>, &'a [u8])>, String> {
        if self.rest.is_empty() {
            return Ok(None);
        }
        if self.rest.starts_with(b"ARROW1") {
            return Err("it is a file in Arrow's format: expected a stream".to_owned());
        }
        // Streams from before Arrow 0.15 have the length alone.
        let marked = self.rest.strip_prefix(&CONTINUATION);
        self.rest = marked.unwrap_or(self.rest);
        let length = self.take(4)?.first_chunk().map_or(0, |length| i32::from_le_bytes(*length));
        if length == 0 {
            return match self.rest.len() {
                0 => Ok(None),
                more => Err(format!("{more} bytes follow its end")),
            };
        }
        let length = usize::try_from(length).ok().filter(|length| *length <= longest).ok_or_else(|| {
            format!("the metadata of a message has {length} bytes: expected at most {longest}")
        })?;
        let metadata = self.take(length)?;
        let message = arrow_ipc::root_as_message(metadata)
            .map_err(|_| "the metadata of a message is no flatbuffer of a message".to_owned())?;
        let body = usize::try_from(message.bodyLength()).map_err(|_| self.short())?;
        Ok(Some((message, self.take(body)?)))
    }

    fn take(&mut self, length: usize) -> Result<&'a [u8], String> {
        let (taken, rest) = self.rest.split_at_checked(length).ok_or_else(|| self.short())?;
        self.rest = rest;
        Ok(taken)
    }

    fn short(&self) -> String {
        format!("it ends within a message, of which {} bytes are there", self.rest.len())
    }
}

/// The columns of a schema, unless one of them is not accepted.
fn fields(schema: &Schema, notes: &mut Notes) -> Option<Vec<(Column, Scalar)>> {
    let mut columns = Vec::new();
    let mut accepted = true;
    for field in schema.fields().into_iter().flatten() {
        let name = field.name().unwrap_or_default();
        let column = notes.accept(name);
        let scalar = scalar(&field);
        if let (Err(found), Some(_)) = (&scalar, &column) {
            notes.error(name, Code::WrongType, format!("found {found}: expected {ACCEPTED}"));
        }
        match column.zip(scalar.ok()) {
            Some(column) => columns.push(column),
            None => accepted = false,
        }
    }
    accepted.then_some(columns)
}

/// How a column's numbers are stored, or what it holds instead.
fn scalar(field: &Field) -> Result<Scalar, &'static str> {
    let kind = field.type_type();
    let other = || kind.variant_name().unwrap_or("a type that is not known");
    if field.dictionary().is_some() {
        return Err("a dictionary-encoded column");
    }
    let scalar = match kind {
        Type::Int => field
            .type_as_int()
            .and_then(|int| Scalar::integer(int.is_signed(), usize::try_from(int.bitWidth()).ok()?)),
        Type::FloatingPoint => field.type_as_floating_point().and_then(|float| match float.precision() {
            Precision::DOUBLE => Some(Scalar::F64),
            Precision::SINGLE => Some(Scalar::F32),
            _ => None,
        }),
        _ => None,
    };
    scalar.ok_or_else(other)
}

/// Adds the rows of a batch to the columns, and to the number of rows; rows beyond the limit are counted alone.
fn append(
    columns: &mut [(Column, Scalar)],
    batch: &RecordBatch,
    body: &[u8],
    length: usize,
    most: usize,
) -> Result<usize, String> {
    let count = usize::try_from(batch.length()).map_err(|_| "a record batch has a negative length")?;
    let nodes = batch.nodes().filter(|nodes| nodes.len() == columns.len());
    // A bitmap of what is not null, and the numbers.
    let buffers = batch.buffers().filter(|buffers| buffers.len() == 2 * columns.len());
    let (Some(nodes), Some(buffers)) = (nodes, buffers) else {
        return if columns.is_empty() {
            Ok(length)
        } else {
            Err("a record batch has not the schema's columns".to_owned())
        };
    };
    let total = length.saturating_add(count);
    for (index, (column, scalar)) in columns.iter_mut().enumerate() {
        wanted()?;
        let node = nodes.get(index);
        if node.length() != batch.length() {
            return Err("the columns of a record batch differ in length".to_owned());
        }
        let valid = part(body, buffers.get(2 * index))?;
        let numbers = part(body, buffers.get(2 * index + 1))?;
        let numbers = count
            .checked_mul(scalar.width())
            .and_then(|bytes| numbers.get(..bytes))
            .ok_or("a column of a record batch has more rows than bytes")?;
        if valid.is_empty() && node.null_count() != 0 || !valid.is_empty() && valid.len() < count.div_ceil(8)
        {
            return Err("the nulls of a record batch are not said".to_owned());
        }
        if total <= most {
            let first = column.array.numbers.len();
            scalar.extend(numbers, scalar.width(), 0, false, &mut column.array.numbers);
            column.array.length = total;
            note_nulls(column, first, count, valid);
        }
    }
    Ok(total)
}

/// The bytes of a batch's body that a buffer claims.
fn part<'a>(body: &'a [u8], buffer: &arrow_ipc::Buffer) -> Result<&'a [u8], String> {
    let range = usize::try_from(buffer.offset()).ok().zip(usize::try_from(buffer.length()).ok());
    range
        .and_then(|(offset, length)| body.get(offset..offset.checked_add(length)?))
        .ok_or_else(|| "a buffer lies outside of the body of its message".to_owned())
}

/// Puts nulls in their places: a bit that is not set is one.
fn note_nulls(column: &mut Column, first: usize, count: usize, valid: &[u8]) {
    let nulls = valid.iter().enumerate().filter(|(_, bits)| **bits != u8::MAX);
    for (byte, bits) in nulls {
        for bit in (0..8).filter(|bit| bits & (1 << bit) == 0) {
            let index = 8 * byte + bit;
            if index < count {
                column.replace(first + index, Node::Null);
            }
        }
    }
}
