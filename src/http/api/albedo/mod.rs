//! `POST /v1/albedo`: how much of a beam leaves the surface, by component and in all.

mod answer;
mod integrals;

use super::light::Light;
use super::responses::PostProblems;
use super::scene::{SceneWire, note};
use crate::http::app::App;
use crate::http::body::JsonBody;
use crate::http::edge::{Asked, Deadline};
use crate::http::encode::rows::Binary;
use crate::http::input::node::Node;
use crate::http::input::object::{Checked, object};
use crate::http::input::reader::Reader;
use crate::http::input::values::List;
use crate::http::input::wire::{Schemas, Wire, mismatch};
use crate::http::negotiate::{Tabular, VARY};
use crate::http::problem::{Code, FieldError, Problem};
use crate::reflectance::albedo::AlbedoScene;
use crate::reflectance::bounds::{Bounds, DEFAULT_ALBEDO_TOLERANCE, MAX_INCIDENCES};
use crate::reflectance::quantity::{Quantity as _, SourceZenith};
use answer::{AlbedoOrSpectrum, Table};
use axum::extract::State;
use axum::http::{HeaderValue, header};
use axum::response::Response;
use std::sync::Arc;
use utoipa::openapi::schema::Schema;
use utoipa::openapi::{OneOfBuilder, RefOr};

/// One incidence or several.
#[derive(Clone, Debug)]
pub(crate) struct Incidences(Vec<SourceZenith>);

type Listed = List<SourceZenith, MAX_INCIDENCES>;

impl Wire for Incidences {
    const RANGE: Option<&'static Bounds> = Some(SourceZenith::BOUNDS);

    fn read(node: Node, reader: &mut Reader) -> Option<Self> {
        match node {
            Node::Array(array) if array.length == 0 => {
                reader.fail(Code::Empty, "the array is empty: expected at least one incidence")
            }
            Node::Array(_) => Listed::read(node, reader)?.0.into_iter().collect::<Option<_>>().map(Self),
            Node::Number(_) => Some(Self(vec![SourceZenith::read(node, reader)?])),
            other => {
                let expected = format!("{}, or an array of such", SourceZenith::BOUNDS);
                reader.fail(Code::WrongType, mismatch(&other, &expected))
            }
        }
    }

    fn schema() -> RefOr<Schema> {
        OneOfBuilder::new().item(SourceZenith::schema()).item(Listed::schema()).into()
    }

    fn collect(_: &mut Schemas) {}
}

/// A scene for an albedo, which needs no sensor and has a tolerance of its own, and its light.
#[derive(Clone, Debug)]
pub(crate) struct CheckedAlbedoScene {
    scene: AlbedoScene,
    light: Light,
}

impl Checked for CheckedAlbedoScene {
    type Fields = SceneWire;

    fn check(wire: SceneWire, reader: &mut Reader) -> Option<Self> {
        for error in AlbedoScene::outline(wire.outline()).errors() {
            note(&error, reader);
        }
        let lit = wire.lit(reader)?;
        let scene = AlbedoScene::new(wire.into_parameters(&lit, DEFAULT_ALBEDO_TOLERANCE)?).ok()?;
        Some(Self { scene, light: lit.light })
    }
}

object! {
    /// A scene of `/v1/radiance` without its directions and `output`, and the incidences. A sensor and the irradiance are
    /// read and not used; `accuracy.relative_tolerance` is that of each total, 1e-6 when absent or null.
    AlbedoRequest as "AlbedoRequest" {
        /// θ_i, degrees: one number, or an array of up to 1000 unless the service is set to another limit.
        theta_i_deg: Incidences,
        ..scene: CheckedAlbedoScene,
    }
}

/// Directional-hemispherical reflectance by component.
///
/// The share of a beam that leaves the surface, ρ(θ_i) = ∫ f_r cos θ_r dω_r, for up to 1000 incidences. The specular lobe is
/// integrated over the hemisphere to the tolerance, spike and diffuse lobe are closed forms, and `excess` says how far the
/// models are from keeping energy. Where `wavelength_um` is an array there is an answer for each, in JSON as a `spectrum`, in tables
/// as more rows with the wavelength before them. CSV is sent row by row while the incidences are integrated.
#[utoipa::path(
    post,
    path = "/v1/albedo",
    tag = "reflection",
    request_body(content = AlbedoRequest, description = "The scene and the incidences."),
    responses(
        (status = 200, description = "The albedo of each incidence.", content(
            (AlbedoOrSpectrum = "application/json"),
            (String = "text/csv"),
            (Binary = "application/vnd.apache.arrow.stream"),
            (Binary = "application/x-npy")
        )),
        PostProblems
    )
)]
pub(crate) async fn albedo(
    State(app): State<App>,
    Tabular(format): Tabular,
    deadline: Deadline,
    JsonBody { value: request, turn }: JsonBody<AlbedoRequest>,
) -> Result<Response, Problem> {
    let AlbedoRequest { theta_i_deg: Incidences(incidences), scene } = request;
    let CheckedAlbedoScene { scene, light } = scene;
    let table = Arc::new(Table::new(scene, light, incidences));
    let (rows, limit) = (table.rows(), app.limits().incidences);
    if rows > limit {
        let detail = format!(
            "{rows} incidences, at all wavelengths together, in one request: at most {limit} are answered"
        );
        let pointer = "/theta_i_deg".to_owned();
        return Err(Problem::invalid(vec![FieldError { pointer, code: Code::TooMany, detail }]));
    }
    let mut response = integrals::respond(&app, deadline, turn, table, format).await?;
    response.headers_mut().insert(header::VARY, HeaderValue::from_static(VARY));
    response.headers_mut().insert(header::CONTENT_TYPE, HeaderValue::from_static(format.content_type()));
    response.extensions_mut().insert(Asked(rows));
    Ok(response)
}
