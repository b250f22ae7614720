//! The fields of an object, declared once: [`object!`] makes the type, its reader, the query parameters
//! and the `OpenAPI` schema from one list.

use super::node::Node;
use super::reader::{Fields, Reader};
use super::wire::{Parameter, Schemas, Wire, mismatch};
use crate::http::problem::Code;
use utoipa::openapi::schema::{AdditionalProperties, Object, ObjectBuilder, Schema, Type};
use utoipa::openapi::{Ref, RefOr, Required, path};

/// An object with a fixed list of fields.
pub(crate) trait WireObject: Sized {
    /// Its name in the document.
    const NAME: &'static str;
    /// What it is.
    const DESCRIPTION: &'static str;

    /// Reads its fields.
    fn take(fields: &mut Fields, reader: &mut Reader) -> Option<Self>;

    /// The names of its fields.
    fn names() -> Vec<&'static str>;

    /// The names of its fields in a query, those of inner objects included.
    fn flat_names() -> Vec<&'static str> {
        Self::query_parameters(false).into_iter().map(|parameter| parameter.name).collect()
    }

    /// Adds its fields to a schema.
    fn properties(object: ObjectBuilder) -> ObjectBuilder;

    /// Gathers the named schemas of its fields.
    fn inner(schemas: &mut Schemas);

    /// The query parameters that carry it; `required` says whether it has to be given itself.
    fn query_parameters(required: bool) -> Vec<Parameter>;

    /// Reads it from a node.
    fn read_object(node: Node, reader: &mut Reader) -> Option<Self> {
        let Node::Object(object) = node else {
            let expected = format!("an object with {}", Self::names().join(", "));
            return reader.fail(Code::WrongType, mismatch(&node, &expected));
        };
        let mut fields = Fields::new(object);
        let value = Self::take(&mut fields, reader);
        fields.finish(reader, Self::names);
        value
    }

    /// Its schema, written out.
    fn object_schema() -> Object {
        Self::properties(ObjectBuilder::new())
            .schema_type(Type::Object)
            .description(Some(prose(Self::DESCRIPTION)))
            .additional_properties(Some(AdditionalProperties::<Schema>::FreeForm(false)))
            .build()
    }

    /// A reference to its schema.
    fn reference() -> RefOr<Schema> {
        Ref::from_schema_name(Self::NAME).into()
    }

    /// Gathers its schema and those of its fields.
    fn gather(schemas: &mut Schemas) {
        if schemas.iter().all(|(name, _)| name != Self::NAME) {
            schemas.push((Self::NAME.to_owned(), Self::object_schema().into()));
            Self::inner(schemas);
        }
    }
}

/// What the fields of an object make when they are checked against each other. It is read, documented and spelled as the object.
pub(crate) trait Checked: Sized {
    /// The object.
    type Fields: WireObject;

    /// Notes what is wrong with the whole.
    fn check(fields: Self::Fields, reader: &mut Reader) -> Option<Self>;
}

impl<C: Checked> WireObject for C {
    const NAME: &'static str = C::Fields::NAME;
    const DESCRIPTION: &'static str = C::Fields::DESCRIPTION;

    fn take(fields: &mut Fields, reader: &mut Reader) -> Option<Self> {
        let fields = C::Fields::take(fields, reader)?;
        C::check(fields, reader)
    }

    fn names() -> Vec<&'static str> {
        C::Fields::names()
    }

    fn properties(object: ObjectBuilder) -> ObjectBuilder {
        C::Fields::properties(object)
    }

    fn inner(schemas: &mut Schemas) {
        C::Fields::inner(schemas);
    }

    fn query_parameters(required: bool) -> Vec<Parameter> {
        C::Fields::query_parameters(required)
    }
}

/// The text of a doc comment as one paragraph.
pub(crate) fn prose(doc: &str) -> String {
    doc.lines().map(str::trim).collect::<Vec<_>>().join(" ").trim().to_owned()
}

/// Adds one field to a schema.
pub(crate) fn property<T: Wire>(object: ObjectBuilder, name: &str, description: &str) -> ObjectBuilder {
    let schema = described(T::schema(), &prose(description));
    let object = object.property(name, schema);
    if T::OPTIONAL { object } else { object.required(name) }
}

/// A schema with a description of its own.
pub(crate) fn described(schema: RefOr<Schema>, description: &str) -> RefOr<Schema> {
    let text = || Some(description.to_owned());
    match schema {
        RefOr::Ref(mut reference) => {
            description.clone_into(&mut reference.description);
            RefOr::Ref(reference)
        }
        RefOr::T(Schema::Object(mut object)) => {
            object.description = text();
            object.into()
        }
        RefOr::T(Schema::Array(mut array)) => {
            array.description = text();
            array.into()
        }
        RefOr::T(Schema::OneOf(mut one_of)) => {
            one_of.description = text();
            RefOr::T(Schema::OneOf(one_of))
        }
        other @ RefOr::T(_) => other,
    }
}

/// Query parameters, for the document.
pub(crate) fn documented_parameters(parameters: Vec<Parameter>) -> Vec<path::Parameter> {
    parameters
        .into_iter()
        .map(|parameter| {
            let list = match &parameter.schema {
                RefOr::T(Schema::OneOf(one_of)) => one_of.items.iter().any(is_array),
                schema => is_array(schema),
            };
            let mut documented = path::ParameterBuilder::new()
                .name(parameter.name)
                .parameter_in(path::ParameterIn::Query)
                .description(Some(prose(&parameter.description)))
                .required(if parameter.required { Required::True } else { Required::False })
                .schema(Some(parameter.schema));
            if list {
                documented = documented.style(Some(path::ParameterStyle::Form)).explode(Some(false));
            }
            documented.build()
        })
        .collect()
}

fn is_array(schema: &RefOr<Schema>) -> bool {
    matches!(schema, RefOr::T(Schema::Array(_)))
}

/// What an object holds of a field: the value, or for a partial object None where it could not be read.
macro_rules! held {
    (whole $type:ty) => { $type };
    (partial $type:ty) => { Option<$type> };
}
pub(crate) use held;

/// What becomes of a reading: a whole object needs each of its fields.
macro_rules! hold {
    (whole $value:ident) => {
        $value?
    };
    (partial $value:ident) => {
        $value
    };
}
pub(crate) use hold;

/// Declares an object. `..field: Type` at the end takes in the fields of another. A `partial` object is read
/// also where some of its fields cannot be, so that the others can still be checked against each other.
macro_rules! object {
    (partial $($object:tt)*) => { $crate::http::input::object::object!(@ partial $($object)*); };
    (
        @ $kind:ident
        $(#[doc = $doc:literal])*
        $name:ident as $wire_name:literal {
            $( $(#[doc = $field_doc:literal])* $field:ident: $type:ty, )*
            $( ..$base:ident: $base_type:ty, )*
        }
    ) => {
        $(#[doc = $doc])*
        #[derive(Clone, Debug)]
        #[allow(clippy::struct_field_names, reason = "the names on the wire end in their units")]
        pub(crate) struct $name {
            $( $(#[doc = $field_doc])* pub(crate) $field: $crate::http::input::object::held!($kind $type), )*
            $( pub(crate) $base: $crate::http::input::object::held!($kind $base_type), )*
        }

        impl $crate::http::input::object::WireObject for $name {
            const NAME: &'static str = $wire_name;
            const DESCRIPTION: &'static str = concat!($($doc, "\n"),*);

            fn take(
                fields: &mut $crate::http::input::reader::Fields,
                reader: &mut $crate::http::input::reader::Reader,
            ) -> Option<Self> {
                $( let $field = fields.take::<$type>(reader, stringify!($field)); )*
                $( let $base = <$base_type as $crate::http::input::object::WireObject>::take(fields, reader); )*
                Some(Self {
                    $( $field: $crate::http::input::object::hold!($kind $field), )*
                    $( $base: $crate::http::input::object::hold!($kind $base), )*
                })
            }

            fn names() -> Vec<&'static str> {
                #[allow(unused_mut, reason = "only a base adds to it")]
                let mut names = vec![$(stringify!($field)),*];
                $( names.extend(<$base_type as $crate::http::input::object::WireObject>::names()); )*
                names
            }

            fn properties(
                object: utoipa::openapi::schema::ObjectBuilder,
            ) -> utoipa::openapi::schema::ObjectBuilder {
                $( let object = $crate::http::input::object::property::<$type>(
                    object, stringify!($field), concat!($($field_doc, "\n"),*),
                ); )*
                $( let object = <$base_type as $crate::http::input::object::WireObject>::properties(object); )*
                object
            }

            fn inner(schemas: &mut $crate::http::input::wire::Schemas) {
                $( <$type as $crate::http::input::wire::Wire>::collect(schemas); )*
                $( <$base_type as $crate::http::input::object::WireObject>::inner(schemas); )*
            }

            fn query_parameters(required: bool) -> Vec<$crate::http::input::wire::Parameter> {
                let mut parameters = Vec::new();
                $( parameters.extend(<$type as $crate::http::input::wire::Wire>::parameters(
                    stringify!($field),
                    concat!($($field_doc, "\n"),*),
                    required && !<$type as $crate::http::input::wire::Wire>::OPTIONAL,
                )); )*
                $( parameters.extend(
                    <$base_type as $crate::http::input::object::WireObject>::query_parameters(required),
                ); )*
                parameters
            }
        }

        impl $crate::http::input::wire::Wire for $name {
            fn read(
                node: $crate::http::input::node::Node,
                reader: &mut $crate::http::input::reader::Reader,
            ) -> Option<Self> {
                <Self as $crate::http::input::object::WireObject>::read_object(node, reader)
            }

            fn read_flat(
                _: &'static str,
                fields: &mut $crate::http::input::reader::Fields,
                reader: &mut $crate::http::input::reader::Reader,
            ) -> Option<Self> {
                <Self as $crate::http::input::object::WireObject>::take(fields, reader)
            }

            fn is_given(_: &'static str, fields: &$crate::http::input::reader::Fields) -> bool {
                // Each query asks for them, and what makes them makes their schemas too.
                static NAMES: std::sync::OnceLock<Vec<&'static str>> = std::sync::OnceLock::new();
                fields.has_any(NAMES.get_or_init(<Self as $crate::http::input::object::WireObject>::flat_names))
            }

            fn schema() -> utoipa::openapi::RefOr<utoipa::openapi::Schema> {
                <Self as $crate::http::input::object::WireObject>::reference()
            }

            fn collect(schemas: &mut $crate::http::input::wire::Schemas) {
                <Self as $crate::http::input::object::WireObject>::gather(schemas);
            }

            fn parameters(_: &'static str, _: &str, required: bool) -> Vec<$crate::http::input::wire::Parameter> {
                <Self as $crate::http::input::object::WireObject>::query_parameters(required)
            }
        }

        impl utoipa::PartialSchema for $name {
            fn schema() -> utoipa::openapi::RefOr<utoipa::openapi::Schema> {
                <Self as $crate::http::input::object::WireObject>::object_schema().into()
            }
        }

        impl utoipa::IntoParams for $name {
            fn into_params(
                _: impl Fn() -> Option<utoipa::openapi::path::ParameterIn>,
            ) -> Vec<utoipa::openapi::path::Parameter> {
                let parameters = <Self as $crate::http::input::object::WireObject>::query_parameters(true);
                $crate::http::input::object::documented_parameters(parameters)
            }
        }

        impl utoipa::ToSchema for $name {
            fn name() -> std::borrow::Cow<'static, str> {
                std::borrow::Cow::Borrowed(<Self as $crate::http::input::object::WireObject>::NAME)
            }

            fn schemas(schemas: &mut $crate::http::input::wire::Schemas) {
                <Self as $crate::http::input::object::WireObject>::inner(schemas);
            }
        }
    };
    ($($object:tt)*) => { $crate::http::input::object::object!(@ whole $($object)*); };
}
pub(crate) use object;
