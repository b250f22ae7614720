//! `POST /v1/radiance` and `POST /v1/brdf`: (47), (57), (72) and section 5.1 in given directions.

use super::answer::AnswerOrSpectrum;
use super::responses::PostProblems;
use super::scene::CheckedScene;
use crate::http::answer::{self, Call, Over, Subject, Work};
use crate::http::body::JsonOrColumns;
use crate::http::decode::OBJECT;
use crate::http::encode::rows::Binary;
use crate::http::input::node::Node;
use crate::http::input::object::{WireObject, documented_parameters, object};
use crate::http::input::reader::{Fields, Reader};
use crate::http::input::values::AnglesWire;
use crate::http::input::wire::{Parameter, Schemas, Wire};
use crate::http::negotiate::Format;
use crate::http::problem::{Code, Problem};
use crate::reflectance::directions::{Angles, DirectionAngle, Directions, DirectionsError};
use crate::reflectance::evaluate::{Output, Quantity};
use crate::reflectance::quantity::{Azimuth, Quantity as _, SourceZenith, ViewerZenith};
use axum::response::Response;
use utoipa::IntoParams;
use utoipa::openapi::RefOr;
use utoipa::openapi::path::{Parameter as DocumentedParameter, ParameterIn};
use utoipa::openapi::schema::Schema;

object! {
    partial
    /// The directions: each angle one number, or an array with one number a direction. All arrays have one
    /// length; numbers hold for every direction.
    GeometryWire as "Geometry" {
        /// θ_i, degrees.
        theta_i_deg: AnglesWire<SourceZenith>,
        /// θ_r, degrees. Negative means the same zenith at φ_r + 180.
        theta_r_deg: AnglesWire<ViewerZenith>,
        /// φ_r, degrees; 0 when absent or null: the half plane that holds the mirror direction.
        phi_r_deg: Option<AnglesWire<Azimuth>>,
    }
}

object! {
    /// What to add to the answer.
    OutputWire as "Output" {
        /// Adds the decimal logarithm of every value, right also where the value itself underflows to 0. False
        /// when absent or null.
        log10: Option<bool>,
        /// Adds the method and the roughness g of each direction. False when absent or null.
        per_direction: Option<bool>,
        /// Whether a table (CSV, Arrow, npy) has the columns of angles. When absent or null: true, but for directions that
        /// came as columns of Arrow or npy: the answer's rows are theirs, and repeating them would take longer than
        /// evaluating them.
        angles: Option<bool>,
    }
}

impl OutputWire {
    /// What was asked for, or the defaults.
    pub(crate) fn chosen(wire: Option<Self>) -> Output {
        let (log10, per_direction) = wire.map_or((None, None), |wire| (wire.log10, wire.per_direction));
        Output { log10: log10.unwrap_or(false), per_direction: per_direction.unwrap_or(false) }
    }

    /// Whether tables have the columns of angles, if it was said.
    pub(crate) fn angles(wire: Option<&Self>) -> Option<bool> {
        wire.and_then(|wire| wire.angles)
    }
}

/// Directions whose arrays have one length.
#[derive(Clone, Debug)]
pub(crate) struct CheckedDirections(pub(crate) Directions);

impl Wire for CheckedDirections {
    fn read(node: Node, reader: &mut Reader) -> Option<Self> {
        GeometryWire::read(node, reader)?.check(reader)
    }

    fn read_flat(_: &'static str, fields: &mut Fields, reader: &mut Reader) -> Option<Self> {
        let wire = GeometryWire::take(fields, reader)?;
        // All that has a length is a column.
        reader.in_body(|reader| reader.within(OBJECT, |reader| wire.check(reader)))
    }

    fn schema() -> RefOr<Schema> {
        GeometryWire::reference()
    }

    fn collect(schemas: &mut Schemas) {
        GeometryWire::gather(schemas);
    }

    fn parameters(_: &'static str, _: &str, required: bool) -> Vec<Parameter> {
        GeometryWire::query_parameters(required)
    }
}

impl GeometryWire {
    /// The directions, if the arrays have one length.
    fn check(self, reader: &mut Reader) -> Option<CheckedDirections> {
        let wire = self;
        let lengths = [
            wire.theta_i_deg.as_ref().and_then(|angles| angles.length),
            wire.theta_r_deg.as_ref().and_then(|angles| angles.length),
            wire.phi_r_deg.iter().flatten().find_map(|angles| angles.length),
        ];
        for error in Directions::length_errors(lengths) {
            note(error, reader);
        }
        let phi_r = match wire.phi_r_deg? {
            Some(phi_r) => phi_r.angles?,
            None => Angles::One(Azimuth::new(0.0).ok()?),
        };
        // What is wrong with the lengths was just noted.
        let directions = Directions::new(wire.theta_i_deg?.angles?, wire.theta_r_deg?.angles?, phi_r);
        directions.ok().map(CheckedDirections)
    }
}

/// Notes what the core found at the field that a client knows.
fn note(error: DirectionsError, reader: &mut Reader) {
    let (angle, code, detail) = match error {
        DirectionsError::Empty { angle } => (angle, Code::Empty, "the array is empty".to_owned()),
        DirectionsError::UnequalLength { angle, length, expected } => {
            let detail =
                format!("the array has {length} elements, another has {expected}: expected one length");
            (angle, Code::UnequalLengths, detail)
        }
        DirectionsError::TooMany { angle, length } => {
            (angle, Code::TooMany, format!("the array has {length} elements: more than a request may have"))
        }
    };
    let name = match angle {
        DirectionAngle::ThetaI => "theta_i_deg",
        DirectionAngle::ThetaR => "theta_r_deg",
        DirectionAngle::PhiR => "phi_r_deg",
    };
    reader.within(name, |reader| reader.error(code, detail));
}

object! {
    /// A scene, directions, and what to answer.
    RadianceRequest as "RadianceRequest" {
        /// The directions.
        geometry: CheckedDirections,
        /// What to add to the answer.
        output: Option<OutputWire>,
        ..scene: CheckedScene,
    }
}

/// The query parameters of a request with columns. A JSON body has none of them, so that none is required of all
/// requests.
pub(crate) struct BesideColumns;

impl IntoParams for BesideColumns {
    fn into_params(_: impl Fn() -> Option<ParameterIn>) -> Vec<DocumentedParameter> {
        documented_parameters(RadianceRequest::query_parameters(false))
    }
}

/// Radiance L_r (2) by component.
///
/// Up to 1,000,000 directions in one request. The unit is that of `irradiance` per steradian. Where `wavelength_um` is an
/// array there is an answer for each, in JSON as a `spectrum`, in tables as more rows with the wavelength before them.
///
/// The directions can also come as columns `theta_i_deg`, `theta_r_deg`, `phi_r_deg` (in any order) of CSV with a line
/// of names, of an Arrow IPC stream (floats or integers, uncompressed, without nulls), or of a structured `.npy` array of
/// one dimension. The rest of the request then stands in the query, flattened as for `GET /v1/diagrams`, and so does an
/// angle that is the same in all directions.
#[utoipa::path(
    post,
    path = "/v1/radiance",
    tag = "reflection",
    params(BesideColumns),
    request_body(
        content(
            (RadianceRequest = "application/json"),
            (String = "text/csv"),
            (Binary = "application/vnd.apache.arrow.stream"),
            (Binary = "application/x-npy")
        ),
        description = "The scene and the directions; or directions alone, as columns."
    ),
    responses(
        (status = 200, description = "The radiance in each direction.", content(
            (AnswerOrSpectrum = "application/json"),
            (String = "text/csv"),
            (Binary = "application/vnd.apache.arrow.stream"),
            (Binary = "application/x-npy")
        )),
        PostProblems
    )
)]
pub(crate) async fn radiance(
    call: Call,
    request: JsonOrColumns<RadianceRequest>,
) -> Result<Response, Problem> {
    answer(call, Quantity::Radiance, request).await
}

/// BRDF f_r = L_r/I_s (3) by component.
///
/// The same request as `/v1/radiance`, as JSON or as columns; I_s = irradiance · cos θ_i is the irradiance of the surface.
#[utoipa::path(
    post,
    path = "/v1/brdf",
    tag = "reflection",
    params(BesideColumns),
    request_body(
        content(
            (RadianceRequest = "application/json"),
            (String = "text/csv"),
            (Binary = "application/vnd.apache.arrow.stream"),
            (Binary = "application/x-npy")
        ),
        description = "The scene and the directions; or directions alone, as columns."
    ),
    responses(
        (status = 200, description = "The BRDF in each direction.", content(
            (AnswerOrSpectrum = "application/json"),
            (String = "text/csv"),
            (Binary = "application/vnd.apache.arrow.stream"),
            (Binary = "application/x-npy")
        )),
        PostProblems
    )
)]
pub(crate) async fn brdf(call: Call, request: JsonOrColumns<RadianceRequest>) -> Result<Response, Problem> {
    answer(call, Quantity::Brdf, request).await
}

async fn answer(
    call: Call,
    quantity: Quantity,
    JsonOrColumns { value: request, format, turn }: JsonOrColumns<RadianceRequest>,
) -> Result<Response, Problem> {
    let RadianceRequest { geometry: CheckedDirections(directions), output, scene } = request;
    let CheckedScene { scene, light } = scene;
    let scene = Box::new(scene);
    let angles = OutputWire::angles(output.as_ref());
    let subject = Subject::Scene { scene, light, quantity, output: OutputWire::chosen(output) };
    let mut work = Work::new(subject, Over::Directions(Box::new(directions)));
    work.has_angles = angles.unwrap_or(!matches!(format, Format::Arrow | Format::Npy));
    answer::respond(call, turn, work).await
}
