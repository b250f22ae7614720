//! Columns of numbers.

use serde::{Serialize, Serializer};
use std::borrow::Cow;
use utoipa::openapi::RefOr;
use utoipa::openapi::schema::{ArrayBuilder, ObjectBuilder, Schema, SchemaType, Type};
use utoipa::{PartialSchema, ToSchema};

/// A column. JSON has no infinities and no NaN: they are written as null.
#[derive(Default)]
pub(crate) struct Numbers(pub(crate) Vec<f64>);

impl Serialize for Numbers {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        // serde_json writes a number that is not finite as null.
        serializer.collect_seq(&self.0)
    }
}

/// The schema of a column.
pub(crate) fn described(description: &'static str) -> ArrayBuilder {
    let item = ObjectBuilder::new().schema_type(SchemaType::Array(vec![Type::Number, Type::Null]));
    ArrayBuilder::new().items(item).description(Some(description))
}

impl PartialSchema for Numbers {
    fn schema() -> RefOr<Schema> {
        described("Numbers, or null where a value is not a number.").into()
    }
}

impl ToSchema for Numbers {
    fn name() -> Cow<'static, str> {
        Cow::Borrowed("Numbers")
    }
}
