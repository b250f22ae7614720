//! `GET /v1/materials` and `GET /v1/materials/{name}`: whose n and k can be looked up, and what they are.

use super::light::outside;
use super::responses::{GetProblems, list};
use crate::http::encode::json;
use crate::http::input::medium::{unknown_material, unknown_source};
use crate::http::input::object::object;
use crate::http::input::query::Query;
use crate::http::link::{Known, linked};
use crate::http::negotiate::JsonOnly;
use crate::http::problem::{Code, FieldError, Kind, Problem};
use crate::reflectance::fresnel::RefractiveIndex;
use crate::reflectance::material::{self, LICENCE, Material, Source, database};
use crate::reflectance::quantity::Wavelength;
use axum::extract::Path;
use axum::extract::rejection::PathRejection;
use axum::response::Response;
use serde::Serialize;
use std::collections::BTreeMap;
use utoipa::openapi::{RefOr, Response as Documented};
use utoipa::{IntoResponses, ToSchema};

/// The materials that can be looked up.
#[derive(Serialize, ToSchema)]
pub(crate) struct MaterialList {
    /// Where the numbers come from.
    #[schema(example = "refractiveindex.info v2026-05-24")]
    database: String,
    /// The materials.
    materials: Vec<MaterialAnswer>,
}

/// A material.
#[derive(Serialize, ToSchema)]
#[schema(as = Material)]
pub(crate) struct MaterialAnswer {
    /// Its name.
    #[schema(example = "Al")]
    name: &'static str,
    /// Other names that find it.
    #[schema(example = json!(["aluminium", "aluminum"]))]
    aliases: &'static [&'static str],
    /// Its link.
    #[schema(example = "/v1/materials/Al")]
    href: String,
    /// Publications that disagree, the default first.
    sources: Vec<SourceAnswer>,
}

/// One publication's n and k.
#[derive(Serialize, ToSchema)]
#[schema(as = MaterialSource)]
pub(crate) struct SourceAnswer {
    /// Its name, to be given as `source`.
    #[schema(example = "Rakic")]
    id: &'static str,
    /// Whether it is taken where no source is named.
    default: bool,
    /// Vacuum wavelengths at which n is known, and k unless it is nowhere.
    wavelength_um: WavelengthRange,
    /// Whether k is tabulated. Where it is not, it is taken as 0.
    k_tabulated: bool,
    /// Authors, title, journal, year.
    citation: &'static str,
    /// DOIs of the publications.
    dois: &'static [&'static str],
    /// Sample, temperature, method, as far as the database says.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schema(nullable = false, example = "Room temperature")]
    note: Option<&'static str>,
    /// Shelf, book and page of the database.
    #[schema(example = "main/Al/Rakic")]
    page: &'static str,
    /// Licence of the numbers.
    #[schema(example = "CC0-1.0")]
    licence: &'static str,
    /// n and k at the wavelength asked for; absent where none is, or the source does not reach it.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schema(nullable = false)]
    index: Option<IndexAnswer>,
}

/// The ends of a range, micrometres.
#[derive(Serialize, ToSchema)]
pub(crate) struct WavelengthRange {
    /// Least.
    #[schema(example = 0.000_123_99)]
    least: f64,
    /// Largest.
    #[schema(example = 200.0)]
    largest: f64,
}

/// An index of refraction n − ik: the very numbers with which the models are evaluated.
#[derive(Serialize, ToSchema)]
#[schema(as = LookedUpIndex)]
pub(crate) struct IndexAnswer {
    /// n.
    n: f64,
    /// k, not negative.
    k: f64,
}

impl From<RefractiveIndex> for IndexAnswer {
    fn from(index: RefractiveIndex) -> Self {
        Self { n: index.n.get(), k: index.k.get() }
    }
}

impl MaterialAnswer {
    fn new(material: &'static Material, only: Option<&str>, wavelength: Option<Wavelength>) -> Self {
        let wanted = |source: &&'static Source| only.is_none_or(|id| source.id == id);
        let sources = material.sources.iter().filter(wanted).map(|source| {
            let [least, largest] = source.range();
            SourceAnswer {
                id: source.id,
                default: material.default_source().is_some_and(|default| default.id == source.id),
                wavelength_um: WavelengthRange { least, largest },
                k_tabulated: source.has_k(),
                citation: source.citation,
                dois: &source.dois,
                note: source.note,
                page: source.page,
                licence: LICENCE,
                index: wavelength.and_then(|wavelength| source.at(wavelength)).map(IndexAnswer::from),
            }
        });
        Self {
            name: material.name,
            aliases: &material.aliases,
            href: format!("/v1/materials/{}", material.name),
            sources: sources.collect(),
        }
    }
}

object! {
    /// Which materials.
    MaterialsQuery as "MaterialsQuery" {
        /// Part of a name or alias, in whatever case. All materials when absent.
        search: Option<String>,
        /// The one material of this name or alias.
        name: Option<String>,
    }
}

object! {
    /// What of a material.
    MaterialQuery as "MaterialQuery" {
        /// λ in vacuum, micrometres: adds n and k at it.
        wavelength_um: Option<Wavelength>,
        /// One source instead of all.
        source: Option<String>,
    }
}

/// Materials whose n and k can be looked up.
///
/// From the refractiveindex.info database, which is in the public domain (CC0 1.0): each source with its citation and its
/// range of wavelengths. Where sources disagree, the default is marked.
#[utoipa::path(
    get,
    operation_id = "materials",
    path = "/v1/materials",
    tag = "materials",
    params(MaterialsQuery),
    responses(
        (status = 200, description = "The materials.", body = MaterialList),
        (status = 304, description = "The client has this answer already."),
        GetProblems
    )
)]
pub(crate) async fn index(
    _: JsonOnly,
    known: Known,
    Query(MaterialsQuery { search, name }): Query<MaterialsQuery>,
) -> Result<Response, Problem> {
    let named = match &name {
        None => None,
        Some(name) => Some(
            material::find(name)
                .ok_or_else(|| invalid("/name", Code::UnknownValue, unknown_material(name)))?,
        ),
    };
    let search = search.unwrap_or_default();
    let key = ("/v1/materials", &search, named.map(|material| material.name), database().version);
    linked(&known, &key, async {
        let materials = material::search(&search)
            .filter(|found| named.is_none_or(|named| named.name == found.name))
            .map(|material| MaterialAnswer::new(material, None, None))
            .collect();
        let database = format!("refractiveindex.info {}", database().version);
        json::response(&MaterialList { database, materials }, 64 << 10)
    })
    .await
}

/// No material of that name.
pub(crate) struct NoMaterial;

impl IntoResponses for NoMaterial {
    fn responses() -> BTreeMap<String, RefOr<Documented>> {
        list(&[(Kind::NotFound, "There is no such material; the detail lists the nearest names.")])
    }
}

/// One material, and its n and k at a wavelength.
///
/// Samples are interpolated linearly in the wavelength, formulas evaluated: n and k are the numbers with which
/// `{"material": …}` is evaluated at that wavelength.
#[utoipa::path(
    get,
    path = "/v1/materials/{name}",
    tag = "materials",
    params(
        ("name" = String, Path, description = "The material's name or an alias, in whatever case.", example = "Al"),
        MaterialQuery
    ),
    responses(
        (status = 200, description = "The material.", body = MaterialAnswer),
        (status = 304, description = "The client has this answer already."),
        NoMaterial,
        GetProblems
    )
)]
pub(crate) async fn material(
    _: JsonOnly,
    known: Known,
    name: Result<Path<String>, PathRejection>,
    Query(MaterialQuery { wavelength_um, source }): Query<MaterialQuery>,
) -> Result<Response, Problem> {
    // A name that is not UTF-8 is the name of no material.
    let name = name.map(|Path(name)| name).unwrap_or_default();
    let material =
        material::find(&name).ok_or_else(|| Problem::new(Kind::NotFound, unknown_material(&name)))?;
    let only = match &source {
        None => None,
        Some(id) => Some(
            material
                .source(id)
                .ok_or_else(|| invalid("/source", Code::UnknownValue, unknown_source(material, id)))?,
        ),
    };
    if let Some(wavelength) = wavelength_um {
        let reached =
            only.map_or_else(|| material.sources_at(wavelength).next().is_some(), |s| s.covers(wavelength));
        if let (false, Some(source)) = (reached, only.or_else(|| material.default_source())) {
            return Err(invalid("/wavelength_um", Code::OutOfRange, outside(material, source, wavelength)));
        }
    }
    let only = only.map(|source| source.id);
    let key = ("/v1/materials/", material.name, only, wavelength_um, database().version);
    linked(&known, &key, async {
        json::response(&MaterialAnswer::new(material, only, wavelength_um), 4 << 10)
    })
    .await
}

fn invalid(pointer: &str, code: Code, detail: String) -> Problem {
    Problem::invalid(vec![FieldError { pointer: pointer.to_owned(), code, detail }])
}
