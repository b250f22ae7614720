//! Tables as rows, in the formats that can be written a stretch at a time.
//!
//! An answer is a head, then stretches of consecutive rows, then a tail. A stretch depends on the head alone and on
//! nothing before it, so that stretches can be encoded side by side.

use super::{arrow, csv, npy};
use crate::http::problem::Problem;
use std::borrow::Cow;
use utoipa::openapi::schema::{ObjectBuilder, Schema, Type};
use utoipa::openapi::{KnownFormat, RefOr, SchemaFormat};
use utoipa::{PartialSchema, ToSchema};

/// What a column holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Kind {
    /// 64-bit floats.
    Number,
    /// Texts of at most so many characters.
    Text { longest: usize },
}

/// What is known of a column before its rows are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Heading {
    pub(crate) name: &'static str,
    /// Empty for a pure number and for texts.
    pub(crate) unit: &'static str,
    pub(crate) kind: Kind,
}

/// What is known of a table before its rows are.
#[derive(Clone, Debug, Default)]
pub(crate) struct Head {
    pub(crate) columns: Vec<Heading>,
    /// How many rows there are in all.
    pub(crate) rows: usize,
    /// What is to be said of the table, by name: the quantity, what was left out, warnings as JSON.
    pub(crate) notes: Vec<(&'static str, String)>,
}

/// One column of some consecutive rows.
#[derive(Clone, Debug)]
pub(crate) enum Cells<'a> {
    Numbers(Cow<'a, [f64]>),
    /// The same number in all.
    Number(f64),
    Names(&'a [&'static str]),
    /// The same text in all.
    Name(&'a str),
    /// Nothing in any.
    Absent,
}

/// Some consecutive rows: as many columns as the head has, each of `count` cells.
#[derive(Clone, Debug)]
pub(crate) struct Rows<'a> {
    pub(crate) count: usize,
    pub(crate) columns: Vec<Cells<'a>>,
}

/// A way to write tables.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) enum RowFormat {
    Csv,
    Arrow,
    Npy,
}

impl RowFormat {
    /// About the nanoseconds that one number takes to write.
    pub(crate) const fn nanoseconds_a_number(self) -> f64 {
        match self {
            Self::Csv => 30.0,
            Self::Arrow | Self::Npy => 3.0,
        }
    }

    /// What stands before the rows.
    pub(crate) fn head(self, head: &Head) -> Result<Vec<u8>, Problem> {
        match self {
            Self::Csv => Ok(csv::head(head)),
            Self::Arrow => arrow::head(head),
            Self::Npy => npy::head(head),
        }
    }

    /// Writes a stretch of rows.
    pub(crate) fn rows(self, head: &Head, rows: Rows, out: &mut Vec<u8>) -> Result<(), Problem> {
        match self {
            Self::Csv => csv::rows(&rows, out),
            Self::Arrow => arrow::rows(head, rows, out),
            Self::Npy => npy::rows(head, &rows, out),
        }
    }

    /// What stands after the rows.
    pub(crate) fn tail(self, head: &Head) -> Result<Vec<u8>, Problem> {
        match self {
            Self::Csv | Self::Npy => Ok(Vec::new()),
            Self::Arrow => arrow::tail(head),
        }
    }
}

/// A table that does not have the cells which its head promises: a defect.
pub(super) fn unfit() -> Problem {
    tracing::error!("a table has other cells than its head says");
    Problem::internal()
}

/// A body that is no text, for the document.
pub(crate) struct Binary;

impl PartialSchema for Binary {
    fn schema() -> RefOr<Schema> {
        ObjectBuilder::new()
            .schema_type(Type::String)
            .format(Some(SchemaFormat::KnownFormat(KnownFormat::Binary)))
            .description(Some("Bytes in the format that the media type names."))
            .into()
    }
}

impl ToSchema for Binary {
    fn name() -> Cow<'static, str> {
        Cow::Borrowed("Binary")
    }
}
