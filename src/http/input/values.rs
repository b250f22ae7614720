//! How the core's own types are read.

use super::node::{BETWEEN_LOOKS, Node};
use super::object::{WireObject, object};
use super::reader::{ElementErrors, Fields, Reader};
use super::wire::{
    Parameter, Schemas, Wire, mismatch, named, named_schema, not_a_number, read_named, text_number,
};
use crate::http::compute::is_abandoned;
use crate::http::decode::OBJECT;
use crate::http::problem::Code;
use crate::reflectance::bounds::{Bounds, MAX_DIRECTIONS};
use crate::reflectance::directions::Angles;
use crate::reflectance::fresnel::Polarization;
use crate::reflectance::fresnel_average::FresnelAverage;
use crate::reflectance::numeric::lobe_series::Method;
use crate::reflectance::outline::Listed;
use crate::reflectance::quantity::{Fraction, Quantity};
use crate::reflectance::scene::{Component, Model};
use crate::reflectance::shadowing::Shadowing;
use utoipa::openapi::schema::{Array, ArrayBuilder, ObjectBuilder, Schema, Type};
use utoipa::openapi::{OneOfBuilder, RefOr};

named! {
    Model, "a model", Model::ALL;
    Component, "a component", Component::ALL;
    Method, "a method", Method::ALL;
    Shadowing, "a shadowing", Shadowing::ALL;
    FresnelAverage, "an average of F", FresnelAverage::ALL;
}

/// One angle for all directions or one for each, as far as it could be read.
#[derive(Clone, Debug)]
pub(crate) struct AnglesWire<Q> {
    /// How many there are, where it is an array of an accepted length.
    pub(crate) length: Option<usize>,
    /// The angles, if all were accepted.
    pub(crate) angles: Option<Angles<Q>>,
}

impl<Q: Quantity> Wire for AnglesWire<Q> {
    const RANGE: Option<&'static Bounds> = Some(Q::BOUNDS);
    fn read(node: Node, reader: &mut Reader) -> Option<Self> {
        match node {
            Node::Array(_) => {
                let numbers = many::<Q>(node, reader.most_directions(), reader)?;
                let length = Some(numbers.len());
                let each: Option<Vec<Q>> = numbers.into_iter().map(|number| Q::new(number).ok()).collect();
                Some(Self { length, angles: each.map(Angles::Each) })
            }
            Node::Number(_) | Node::Text(_) => {
                Some(Self { length: None, angles: Some(Angles::One(Q::read(node, reader)?)) })
            }
            other => {
                reader.fail(Code::WrongType, mismatch(&other, &format!("{}, or an array of such", Q::BOUNDS)))
            }
        }
    }

    /// A column of the body, or one number in the query.
    fn read_flat(name: &'static str, fields: &mut Fields, reader: &mut Reader) -> Option<Self> {
        let Some(column) = fields.columns().take(name) else {
            if fields.has_any(&[name]) {
                return fields.take_named(reader, name);
            }
            let detail = "required: a column of the body, or one number here";
            return reader.within(name, |reader| reader.fail(Code::Required, detail));
        };
        fields.exclude(reader, &[name], "the column of this name in the body");
        fields.forget(&[name]);
        let read = |reader: &mut Reader| {
            reader.within(OBJECT, |reader| {
                reader.within(name, |reader| Self::read(Node::Array(column), reader))
            })
        };
        reader.in_body(read)
    }

    fn is_given(name: &'static str, fields: &Fields) -> bool {
        fields.has_any_or_column(&[name])
    }

    fn schema() -> RefOr<Schema> {
        OneOfBuilder::new().item(Q::schema()).item(list_schema(Q::schema(), MAX_DIRECTIONS)).into()
    }

    fn parameters(name: &'static str, description: &str, _: bool) -> Vec<Parameter> {
        let description = format!("{description} Unless the body has a column of this name.");
        vec![Parameter { name, description, required: false, schema: Q::schema(), bounds: Some(Q::BOUNDS) }]
    }
}

/// The schema of an array with 1 to `most` elements.
fn list_schema(items: RefOr<Schema>, most: usize) -> Array {
    ArrayBuilder::new().items(items).min_items(Some(1)).max_items(Some(most)).build()
}

/// A list of numbers, None for those that were not accepted; in a query, separated by commas or given one by
/// one.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct List<Q, const MOST: usize>(pub(crate) Vec<Option<Q>>);

impl<Q: Quantity, const MOST: usize> Wire for List<Q, MOST> {
    const REPEATABLE: bool = true;
    const RANGE: Option<&'static Bounds> = Some(Q::BOUNDS);

    fn read(node: Node, reader: &mut Reader) -> Option<Self> {
        let node = if reader.is_flat() { split(node) } else { node };
        let numbers = many::<Q>(node, MOST, reader)?;
        Some(Self(numbers.into_iter().map(|number| Q::new(number).ok()).collect()))
    }

    fn schema() -> RefOr<Schema> {
        list_schema(Q::schema(), MOST).into()
    }
}

/// One number, or a list of them, None for those that were not accepted; in a query a list as that of [`List`].
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum OneOrMany<Q, const MOST: usize> {
    One(Q),
    Many(Vec<Option<Q>>),
}

impl<Q: Quantity, const MOST: usize> Wire for OneOrMany<Q, MOST> {
    const REPEATABLE: bool = true;
    const RANGE: Option<&'static Bounds> = Some(Q::BOUNDS);

    fn read(node: Node, reader: &mut Reader) -> Option<Self> {
        let is_list = match &node {
            Node::Array(_) => true,
            Node::Text(text) => reader.is_flat() && text.contains(','),
            _ => false,
        };
        if is_list {
            return List::<Q, MOST>::read(node, reader).map(|List(many)| Self::Many(many));
        }
        Q::read(node, reader).map(Self::One)
    }

    fn schema() -> RefOr<Schema> {
        OneOfBuilder::new().item(Q::schema()).item(list_schema(Q::schema(), MOST)).into()
    }
}

/// The texts of a query parameter, taken apart at their commas.
fn split(node: Node) -> Node {
    let texts = match node {
        Node::Array(array) => array.others.into_iter().map(|(_, text)| text).collect(),
        text => vec![text],
    };
    let parts: Vec<Node> = texts
        .iter()
        .filter_map(|text| if let Node::Text(text) = text { Some(text) } else { None })
        .flat_map(|text| text.split(','))
        .map(|part| Node::Text(part.to_owned()))
        .collect();
    Node::Array(super::node::Array {
        numbers: vec![f64::NAN; parts.len()],
        length: parts.len(),
        others: parts.into_iter().enumerate().collect(),
    })
}

/// An array of numbers, NaN where an element was not accepted.
fn many<Q: Quantity>(node: Node, most: usize, reader: &mut Reader) -> Option<Vec<f64>> {
    let Node::Array(array) = node else {
        return reader
            .fail(Code::WrongType, mismatch(&node, &format!("an array, each element {}", Q::BOUNDS)));
    };
    if array.length == 0 {
        return reader.fail(Code::Empty, format!("the array is empty: expected from 1 to {most} elements"));
    }
    if array.length > most {
        let detail = format!("the array has {} elements: expected from 1 to {most}", array.length);
        return reader.fail(Code::TooMany, detail);
    }
    let mut numbers = array.numbers;
    // Without a branch, so that the loop becomes vector instructions.
    if array.others.is_empty() && numbers.iter().fold(true, |all, &number| all & Q::BOUNDS.contains(number)) {
        return Some(numbers);
    }
    let mut errors = ElementErrors::default();
    // The elements that were noted already.
    let mut others = Vec::new();
    for (index, other) in array.others {
        if let (true, Node::Text(text)) = (reader.is_flat(), &other) {
            numbers[index] = text_number(text).unwrap_or(f64::NAN);
            if !numbers[index].is_nan() {
                continue;
            }
        }
        let (code, detail) = not_a_number(&other, Q::BOUNDS);
        errors.note(reader, index, code, || detail);
        others.push(index);
    }
    let mut others = others.into_iter().peekable();
    for (index, value) in numbers.iter_mut().enumerate() {
        if index.is_multiple_of(BETWEEN_LOOKS) && is_abandoned() {
            // Nobody reads what is said of it.
            return None;
        }
        if others.next_if_eq(&index).is_some() {
            continue;
        }
        if let Err(error) = Q::new(*value) {
            errors.note(reader, index, Code::OutOfRange, || error.to_string());
            *value = f64::NAN;
        }
    }
    errors.finish(reader);
    Some(numbers)
}

impl Wire for String {
    fn read(node: Node, reader: &mut Reader) -> Option<Self> {
        match node {
            Node::Text(text) => Some(text),
            other => reader.fail(Code::WrongType, mismatch(&other, &"a string")),
        }
    }

    fn schema() -> RefOr<Schema> {
        ObjectBuilder::new().schema_type(Type::String).into()
    }
}

object! {
    partial
    /// Shares of the incident energy polarized parallel and perpendicular to the facet's plane of incidence,
    /// which add up to 1.
    MixWire as "PolarizationMix" {
        /// h of (63).
        parallel: Fraction,
        /// v of (63).
        perpendicular: Fraction,
    }
}

impl MixWire {
    fn check(&self, reader: &mut Reader) -> Option<Polarization> {
        Polarization::mix(self.parallel?, self.perpendicular?)
            .map_err(|error| reader.error(Code::Inconsistent, error.to_string()))
            .ok()
    }
}

/// The polarizations that have a name.
#[derive(Clone, Copy)]
enum NamedPolarization {
    Unpolarized,
    Parallel,
    Perpendicular,
}

impl NamedPolarization {
    const ALL: [Self; 3] = [Self::Unpolarized, Self::Parallel, Self::Perpendicular];

    const fn name(self) -> &'static str {
        match self {
            Self::Unpolarized => "unpolarized",
            Self::Parallel => "parallel",
            Self::Perpendicular => "perpendicular",
        }
    }

    fn value(self) -> Polarization {
        match self {
            Self::Unpolarized => Polarization::unpolarized(),
            Self::Parallel => Polarization::parallel(),
            Self::Perpendicular => Polarization::perpendicular(),
        }
    }
}

named! {
    NamedPolarization, "a polarization", NamedPolarization::ALL;
}

impl Wire for Polarization {
    fn read(node: Node, reader: &mut Reader) -> Option<Self> {
        match node {
            Node::Object(_) => MixWire::read_object(node, reader)?.check(reader),
            node => read_named::<NamedPolarization>(&node, reader).map(NamedPolarization::value),
        }
    }

    fn read_flat(name: &'static str, fields: &mut Fields, reader: &mut Reader) -> Option<Self> {
        if fields.has_any(&[name]) {
            let shares = ["parallel", "perpendicular"];
            fields.exclude(reader, &shares, name);
            for share in shares {
                fields.take_named::<Option<Fraction>>(reader, share);
            }
            fields.take_named(reader, name)
        } else {
            let mix = MixWire::take(fields, reader)?;
            reader.within("parallel", |reader| mix.check(reader))
        }
    }

    fn is_given(name: &'static str, fields: &Fields) -> bool {
        fields.has_any(&[name, "parallel", "perpendicular"])
    }

    fn schema() -> RefOr<Schema> {
        OneOfBuilder::new().item(named_schema::<NamedPolarization>()).item(MixWire::reference()).into()
    }

    fn collect(schemas: &mut Schemas) {
        MixWire::gather(schemas);
    }

    fn parameters(name: &'static str, description: &str, required: bool) -> Vec<Parameter> {
        let schema = named_schema::<NamedPolarization>();
        let description =
            format!("{description} Or `parallel` and `perpendicular`, two shares that add up to 1.");
        let mut parameters = vec![Parameter { name, description, required, schema, bounds: None }];
        parameters.extend(MixWire::query_parameters(false));
        parameters
    }
}

impl Wire for Listed {
    const REPEATABLE: bool = true;

    fn read(node: Node, reader: &mut Reader) -> Option<Self> {
        let node = match node {
            Node::Text(text) if text == "auto" => return Some(Self::Auto),
            node if reader.is_flat() => split(node),
            node => node,
        };
        let Node::Array(array) = node else {
            let expected = "\"auto\" or an array of diffuse_lobe, specular_lobe, specular_spike";
            return reader.fail(Code::WrongType, mismatch(&node, &expected));
        };
        if array.others.len() < array.length {
            let expected = "an array of diffuse_lobe, specular_lobe, specular_spike";
            reader.error(Code::WrongType, format!("found an array with numbers: expected {expected}"));
        }
        let mut named = vec![None; array.numbers.len()];
        for (position, node) in array.others {
            named[position] = reader.at(position, |reader| read_named::<Component>(&node, reader));
        }
        Some(Self::Named(named))
    }

    fn schema() -> RefOr<Schema> {
        let auto = ObjectBuilder::new().schema_type(Type::String).enum_values(Some(["auto"]));
        let list = ArrayBuilder::new()
            .items(named_schema::<Component>())
            .min_items(Some(1))
            .max_items(Some(Component::ALL.len()))
            .unique_items(true);
        OneOfBuilder::new().item(auto).item(list).into()
    }
}
