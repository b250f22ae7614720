//! How each type of value is read from a request, and the schema that says so.

use super::node::Node;
use super::reader::{Fields, Reader};
use crate::http::problem::Code;
use crate::reflectance::bounds::Bounds;
use crate::reflectance::quantity::Quantity;
use utoipa::openapi::schema::{ObjectBuilder, Schema, SchemaType, Type};
use utoipa::openapi::{OneOfBuilder, RefOr};

/// Named schemas, gathered for the document.
pub(crate) type Schemas = Vec<(String, RefOr<Schema>)>;

/// A value that a request can carry.
pub(crate) trait Wire: Sized {
    /// Reads it, noting what is wrong. Some value may come back beside an error, with what could be read, so that
    /// what does not depend on the error can be checked too: [`Reader::finish`] lets none of them pass.
    fn read(node: Node, reader: &mut Reader) -> Option<Self>;

    /// What stands for it where it is not given.
    fn absent(reader: &mut Reader) -> Option<Self> {
        reader.fail(Code::Required, "required")
    }

    /// Reads it from a query, whose parameters are the fields of all objects together.
    fn read_flat(name: &'static str, fields: &mut Fields, reader: &mut Reader) -> Option<Self> {
        fields.take_named(reader, name)
    }

    /// Whether a query carries any part of it.
    fn is_given(name: &'static str, fields: &Fields) -> bool {
        fields.has_any(&[name])
    }

    /// Whether it may be left out.
    const OPTIONAL: bool = false;

    /// Whether a query may give it more than once.
    const REPEATABLE: bool = false;

    /// The range of the number that it is, or that its elements are.
    const RANGE: Option<&'static Bounds> = None;

    /// Its schema: inline, or a reference to one that [`Self::collect`] gathers.
    fn schema() -> RefOr<Schema>;

    /// Gathers the named schemas it refers to.
    fn collect(_: &mut Schemas) {}

    /// The parameters that carry it in a query: itself unless it is an object.
    fn parameters(name: &'static str, description: &str, required: bool) -> Vec<Parameter> {
        vec![Parameter {
            name,
            description: description.to_owned(),
            required,
            schema: Self::schema(),
            bounds: Self::RANGE,
        }]
    }
}

/// A query parameter.
pub(crate) struct Parameter {
    pub(crate) name: &'static str,
    pub(crate) description: String,
    pub(crate) required: bool,
    pub(crate) schema: RefOr<Schema>,
    pub(crate) bounds: Option<&'static Bounds>,
}

impl<T: Wire> Wire for Option<T> {
    const OPTIONAL: bool = true;
    const REPEATABLE: bool = T::REPEATABLE;
    const RANGE: Option<&'static Bounds> = T::RANGE;

    fn read(node: Node, reader: &mut Reader) -> Option<Self> {
        match node {
            Node::Null => Some(None),
            node => T::read(node, reader).map(Some),
        }
    }

    fn absent(_: &mut Reader) -> Option<Self> {
        Some(None)
    }

    fn read_flat(name: &'static str, fields: &mut Fields, reader: &mut Reader) -> Option<Self> {
        if T::is_given(name, fields) { T::read_flat(name, fields, reader).map(Some) } else { Some(None) }
    }

    fn is_given(name: &'static str, fields: &Fields) -> bool {
        T::is_given(name, fields)
    }

    fn schema() -> RefOr<Schema> {
        match T::schema() {
            RefOr::T(Schema::Object(mut object)) => {
                if let SchemaType::Type(only) = &object.schema_type {
                    object.schema_type = SchemaType::Array(vec![only.clone(), Type::Null]);
                }
                if let Some(values) = &mut object.enum_values {
                    values.push(serde_json::Value::Null);
                }
                object.into()
            }
            RefOr::T(Schema::OneOf(mut one_of)) => {
                one_of.items.push(null());
                RefOr::T(Schema::OneOf(one_of))
            }
            other => OneOfBuilder::new().item(other).item(null()).into(),
        }
    }

    fn collect(schemas: &mut Schemas) {
        T::collect(schemas);
    }

    fn parameters(name: &'static str, description: &str, _: bool) -> Vec<Parameter> {
        T::parameters(name, description, false)
    }
}

fn null() -> RefOr<Schema> {
    ObjectBuilder::new().schema_type(Type::Null).into()
}

/// Whether a field that may be left out is given, readable or not.
#[expect(
    clippy::option_option,
    clippy::ref_option,
    reason = "what a partial object holds of an optional field"
)]
pub(crate) const fn is_given<T>(field: &Option<Option<T>>) -> bool {
    !matches!(field, Some(None))
}

/// The number of a JSON number, or of a query's text.
pub(crate) fn number(node: &Node, reader: &mut Reader, expected: &dyn std::fmt::Display) -> Option<f64> {
    let number = match node {
        Node::Number(number) => Some(*number),
        Node::Text(text) if reader.is_flat() => text_number(text),
        _ => None,
    };
    number.or_else(|| {
        let (code, detail) = not_a_number(node, expected);
        reader.fail(code, detail)
    })
}

/// What is wrong with a value that is not a number: a string may spell NaN, an infinity or 1e400.
pub(crate) fn not_a_number(node: &Node, expected: &dyn std::fmt::Display) -> (Code, String) {
    match node {
        Node::Text(text) if text.parse::<f64>().is_ok_and(|number| !number.is_finite()) => {
            let text = super::node::excerpt(text);
            (Code::OutOfRange, format!("{text} is not a finite 64-bit number: expected {expected}"))
        }
        other => (Code::WrongType, mismatch(other, expected)),
    }
}

/// The number that a text in a query spells. "+" means a blank there: 1e+3 arrives as "1e 3".
pub(crate) fn text_number(text: &str) -> Option<f64> {
    text.trim().replace(' ', "+").parse().ok()
}

/// What was found instead of what was expected.
pub(crate) fn mismatch(found: &Node, expected: &dyn std::fmt::Display) -> String {
    format!("found {}: expected {expected}", found.describe())
}

impl<Q: Quantity> Wire for Q {
    const RANGE: Option<&'static Bounds> = Some(Q::BOUNDS);

    fn read(node: Node, reader: &mut Reader) -> Option<Self> {
        let number = number(&node, reader, Q::BOUNDS)?;
        Q::new(number).map_err(|error| reader.error(Code::OutOfRange, error.to_string())).ok()
    }

    fn schema() -> RefOr<Schema> {
        ObjectBuilder::new()
            .schema_type(Type::Number)
            .minimum(Some(Q::BOUNDS.min))
            .maximum(Some(Q::BOUNDS.max))
            .into()
    }
}

impl Wire for bool {
    fn read(node: Node, reader: &mut Reader) -> Option<Self> {
        match node {
            Node::Bool(value) => Some(value),
            Node::Text(text) if reader.is_flat() && text == "true" => Some(true),
            Node::Text(text) if reader.is_flat() && text == "false" => Some(false),
            other => reader.fail(Code::WrongType, mismatch(&other, &"true or false")),
        }
    }

    fn schema() -> RefOr<Schema> {
        ObjectBuilder::new().schema_type(Type::Boolean).into()
    }
}

/// A whole number from 1 to `MOST`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Count<const LEAST: usize, const MOST: usize>(pub(crate) usize);

impl<const LEAST: usize, const MOST: usize> Wire for Count<LEAST, MOST> {
    fn read(node: Node, reader: &mut Reader) -> Option<Self> {
        let expected = format!("a whole number from {LEAST} to {MOST}");
        let number = number(&node, reader, &expected)?;
        if number.fract() == 0.0 && (LEAST as f64..=MOST as f64).contains(&number) {
            #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "just checked")]
            return Some(Self(number as usize));
        }
        reader.fail(Code::OutOfRange, format!("{number} is outside: expected {expected}"))
    }

    fn schema() -> RefOr<Schema> {
        ObjectBuilder::new()
            .schema_type(Type::Integer)
            .minimum(Some(LEAST as f64))
            .maximum(Some(MOST as f64))
            .into()
    }
}

/// A value with a name, out of a short list.
pub(crate) trait Named: Copy + 'static {
    /// What it is, for messages: "a model".
    const WHAT: &'static str;
    /// Every value.
    const ALL: &'static [Self];
    /// The name in requests.
    fn wire_name(self) -> &'static str;
}

/// Reads a [`Named`] value.
pub(crate) fn read_named<N: Named>(node: &Node, reader: &mut Reader) -> Option<N> {
    let names = || N::ALL.iter().map(|value| value.wire_name()).collect::<Vec<_>>().join(", ");
    let Node::Text(text) = node else {
        return reader.fail(Code::WrongType, mismatch(node, &format!("one of {}", names())));
    };
    N::ALL.iter().copied().find(|value| value.wire_name() == text).or_else(|| {
        let detail =
            format!("\"{}\" is not {}: expected one of {}", super::node::excerpt(text), N::WHAT, names());
        reader.fail(Code::UnknownValue, detail)
    })
}

/// The schema of a [`Named`] value.
pub(crate) fn named_schema<N: Named>() -> RefOr<Schema> {
    ObjectBuilder::new()
        .schema_type(Type::String)
        .enum_values(Some(N::ALL.iter().map(|value| value.wire_name())))
        .into()
}

/// Makes [`Named`] values of these types [`Wire`] values.
macro_rules! named {
    ($($name:ty, $what:literal, $all:expr;)*) => {$(
        impl $crate::http::input::wire::Named for $name {
            const WHAT: &'static str = $what;
            const ALL: &'static [Self] = &$all;
            fn wire_name(self) -> &'static str {
                self.name()
            }
        }

        impl $crate::http::input::wire::Wire for $name {
            fn read(node: $crate::http::input::node::Node, reader: &mut $crate::http::input::reader::Reader) -> Option<Self> {
                $crate::http::input::wire::read_named(&node, reader)
            }

            fn schema() -> utoipa::openapi::RefOr<utoipa::openapi::Schema> {
                $crate::http::input::wire::named_schema::<Self>()
            }
        }
    )*};
}
pub(crate) use named;
