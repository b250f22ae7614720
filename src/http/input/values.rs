//! How the core's own types are read.

use super::node::Node;
use super::object::{WireObject, object};
use super::reader::{ElementErrors, Fields, Reader};
use super::wire::{Parameter, Schemas, Wire, mismatch, named, named_schema, number, read_named};
use crate::http::problem::Code;
use crate::reflectance::bounds::MAX_DIRECTIONS;
use crate::reflectance::fresnel::{Medium, Polarization, RefractiveIndex};
use crate::reflectance::quantity::{Fraction, IndexK, IndexN, Quantity};
use utoipa::openapi::schema::{ArrayBuilder, Schema};
use utoipa::openapi::{OneOfBuilder, RefOr};

/// One number for all directions, or one for each.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum OneOrMany<Q> {
    One(Q),
    Many(Vec<Q>),
}

impl<Q: Quantity> Wire for OneOrMany<Q> {
    fn read(node: Node, reader: &mut Reader) -> Option<Self> {
        match node {
            Node::Array(_) => many(node, reader).map(Self::Many),
            Node::Number(_) | Node::Text(_) => Q::read(node, reader).map(Self::One),
            other => reader.fail(Code::WrongType, mismatch(&other, &format!("{}, or an array of such", Q::BOUNDS))),
        }
    }

    fn schema() -> RefOr<Schema> {
        let list = ArrayBuilder::new().items(Q::schema()).min_items(Some(1)).max_items(Some(MAX_DIRECTIONS));
        OneOfBuilder::new().item(Q::schema()).item(list).into()
    }
}

/// An array of numbers. Elements that are not accepted are noted and replaced, so that its length can be
/// compared with that of others.
fn many<Q: Quantity>(node: Node, reader: &mut Reader) -> Option<Vec<Q>> {
    let Node::Array(array) = node else {
        return reader.fail(Code::WrongType, mismatch(&node, &format!("an array with {} in it", Q::BOUNDS)));
    };
    if array.length == 0 {
        return reader.fail(Code::Empty, format!("an empty array: expected from 1 to {MAX_DIRECTIONS} elements"));
    }
    if array.length > MAX_DIRECTIONS {
        let detail = format!("{} elements: expected from 1 to {MAX_DIRECTIONS}", array.length);
        return reader.fail(Code::TooMany, detail);
    }
    let mut numbers = array.numbers;
    let mut errors = ElementErrors::default();
    let mut others = array.others.into_iter().peekable();
    for (index, value) in numbers.iter_mut().enumerate() {
        if let Some((_, other)) = others.next_if(|(position, _)| *position == index) {
            errors.note(reader, index, Code::WrongType, || mismatch(&other, Q::BOUNDS));
        } else if let Err(error) = Q::new(*value) {
            errors.note(reader, index, Code::OutOfRange, || error.to_string());
        } else {
            continue;
        }
        *value = Q::BOUNDS.min;
    }
    errors.finish(reader);
    numbers.into_iter().map(|value| Q::new(value).ok()).collect()
}

object! {
    /// A complex index of refraction n − ik.
    IndexWire as "RefractiveIndex" {
        /// n.
        n: IndexN,
        /// k, not negative; 0 when absent.
        k: Option<IndexK>,
    }
}

object! {
    /// A material by name. No materials are offered yet.
    MaterialWire as "Material" {
        /// The name.
        material: String,
    }
}

impl Wire for String {
    fn read(node: Node, reader: &mut Reader) -> Option<Self> {
        match node {
            Node::Text(text) => Some(text),
            other => reader.fail(Code::WrongType, mismatch(&other, &"a string")),
        }
    }

    fn schema() -> RefOr<Schema> {
        utoipa::openapi::ObjectBuilder::new().schema_type(utoipa::openapi::Type::String).into()
    }
}
