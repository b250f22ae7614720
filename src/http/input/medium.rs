//! What the surface is made of: a perfect conductor, n and k, or a material to be looked up.

use super::node::{Node, excerpt};
use super::object::{WireObject, object};
use super::reader::{Fields, Reader};
use super::wire::{Parameter, Schemas, Wire, mismatch};
use crate::http::problem::Code;
use crate::reflectance::fresnel::{Medium, RefractiveIndex};
use crate::reflectance::material::{self, Material, Source};
use crate::reflectance::quantity::{IndexK, IndexN, Quantity as _};
use utoipa::openapi::schema::{ObjectBuilder, Schema, Type};
use utoipa::openapi::{OneOfBuilder, RefOr};

object! {
    partial
    /// A complex index of refraction n − ik.
    IndexWire as "RefractiveIndex" {
        /// n.
        n: IndexN,
        /// k, not negative; 0 when absent.
        k: Option<IndexK>,
    }
}

object! {
    partial
    /// A material, whose n and k are looked up at the vacuum wavelength of the light.
    MaterialWire as "MaterialName" {
        /// Its name or another that it goes by, in whatever case: `GET /v1/materials` lists them.
        material: String,
        /// Which publication's n and k; the material's default when absent or null.
        source: Option<String>,
    }
}

/// The names that a medium can have.
const MEDIA: [&str; 1] = ["perfect_conductor"];
/// How many near names a message lists.
const NEAREST: usize = 3;

/// A medium, before it is known at which wavelength.
#[derive(Clone, Copy, Debug)]
pub(crate) enum MediumWire {
    /// The same at every wavelength.
    Given(Medium),
    /// In one of its sources.
    Material(&'static Material, &'static Source),
}

impl Wire for MediumWire {
    fn read(node: Node, reader: &mut Reader) -> Option<Self> {
        let expected = if reader.is_flat() {
            "\"perfect_conductor\", or n and k in its place, or material"
        } else {
            "\"perfect_conductor\" or an object with n and k, or with material"
        };
        match node {
            Node::Text(text) if MEDIA.contains(&text.as_str()) => Some(Self::Given(Medium::PerfectConductor)),
            Node::Text(text) => {
                let is_material = material::find(&text).is_some();
                let hint = match (is_material, reader.is_flat()) {
                    (false, _) => "",
                    (true, false) => " (a material is an object: {\"material\": …})",
                    (true, true) => " (a material is named by the parameter material)",
                };
                let detail = format!("\"{}\" is not a medium: expected {expected}{hint}", excerpt(&text));
                reader.fail(Code::UnknownValue, detail)
            }
            Node::Object(object)
                if object.fields.iter().any(|(name, _)| MATERIAL.contains(&name.as_str())) =>
            {
                let mut fields = Fields::new(object);
                exclude(&mut fields, reader, &["n", "k"], "material");
                let medium = MaterialWire::take(&mut fields, reader);
                fields.finish(reader, MaterialWire::names);
                medium?.find(reader)
            }
            Node::Object(_) => IndexWire::read_object(node, reader).and_then(|wire| wire.index()),
            other => reader.fail(Code::WrongType, mismatch(&other, &expected)),
        }
    }

    fn read_flat(name: &'static str, fields: &mut Fields, reader: &mut Reader) -> Option<Self> {
        if fields.has_any(&MATERIAL) {
            exclude(fields, reader, &[name, "n", "k"], "material");
            fields.forget(&[name]);
            MaterialWire::take(fields, reader)?.find(reader)
        } else if fields.has_any(&[name]) {
            exclude(fields, reader, &["n", "k"], name);
            fields.take_named(reader, name)
        } else {
            IndexWire::take(fields, reader).and_then(|wire| wire.index())
        }
    }

    fn is_given(name: &'static str, fields: &Fields) -> bool {
        fields.has_any(&[name, "n", "k"]) || fields.has_any(&MATERIAL)
    }

    fn schema() -> RefOr<Schema> {
        let names = ObjectBuilder::new().schema_type(Type::String).enum_values(Some(MEDIA));
        OneOfBuilder::new().item(names).item(IndexWire::reference()).item(MaterialWire::reference()).into()
    }

    fn collect(schemas: &mut Schemas) {
        IndexWire::gather(schemas);
        MaterialWire::gather(schemas);
    }

    fn parameters(name: &'static str, description: &str, required: bool) -> Vec<Parameter> {
        let schema = ObjectBuilder::new().schema_type(Type::String).enum_values(Some(MEDIA)).into();
        let description = format!("{description} Or n and k, or material.");
        let mut parameters = vec![Parameter { name, description, required, schema, bounds: None }];
        parameters.extend(IndexWire::query_parameters(false));
        parameters.extend(MaterialWire::query_parameters(false));
        parameters
    }
}

/// The fields of a [`MaterialWire`].
const MATERIAL: [&str; 2] = ["material", "source"];

/// Notes fields that have no place beside another; n and k are still read, for their own errors.
fn exclude(fields: &mut Fields, reader: &mut Reader, names: &[&'static str], by: &str) {
    fields.exclude(reader, names, by);
    fields.take_named::<Option<IndexN>>(reader, "n");
    fields.take_named::<Option<IndexK>>(reader, "k");
}

impl IndexWire {
    fn index(&self) -> Option<MediumWire> {
        let k = self.k?.or_else(|| IndexK::new(0.0).ok())?;
        Some(MediumWire::Given(Medium::Index(RefractiveIndex { n: self.n?, k })))
    }
}

impl MaterialWire {
    /// What it names.
    fn find(self, reader: &mut Reader) -> Option<MediumWire> {
        let name = self.material?;
        let Some(material) = material::find(&name) else {
            let detail = unknown_material(&name);
            return reader.within("material", |reader| reader.fail(Code::UnknownValue, detail));
        };
        let source = match self.source? {
            None => material.default_source(),
            Some(id) => material.source(&id).or_else(|| {
                let detail = unknown_source(material, &id);
                reader.within("source", |reader| reader.fail(Code::UnknownValue, detail))
            }),
        };
        source.map(|source| MediumWire::Material(material, source))
    }
}

/// What to say of a name that no material has.
pub(crate) fn unknown_material(name: &str) -> String {
    let near = |material: &&'static Material| match material.aliases.first() {
        Some(alias) => format!("{} ({alias})", material.name),
        None => material.name.to_owned(),
    };
    let nearest: Vec<_> = material::nearest(name, NEAREST).iter().map(near).collect();
    let (name, nearest) = (excerpt(name), nearest.join(", "));
    format!("\"{name}\" is not a material: the nearest names are {nearest}; GET /v1/materials lists all")
}

/// What to say of a source that a material does not have.
pub(crate) fn unknown_source(material: &Material, id: &str) -> String {
    let ids = material.sources.iter().map(|source| source.id).collect::<Vec<_>>().join(", ");
    let (id, name) = (excerpt(id), material.name);
    format!("\"{id}\" is not a source of {name}: expected one of {ids}")
}
