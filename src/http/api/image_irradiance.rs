//! `POST /v1/image-irradiance`: (51) through a camera, and the linear models (74) and (80).
#![allow(non_snake_case, reason = "the strengths keep the report's symbols on the wire")]

use super::answer::{Answer, DiagnosticAnswer, SpectrumAnswer};
use super::radiance::{CheckedDirections, OutputWire, RadianceRequest};
use super::responses::PostProblems;
use super::scene::CheckedScene;
use super::sensor::describes_patch;
use crate::http::answer::{self, Call, Over, Subject, Work};
use crate::http::body::JsonBody;
use crate::http::encode::numbers::Numbers;
use crate::http::input::node::{Node, Object};
use crate::http::input::object::{WireObject, object};
use crate::http::input::reader::{Fields, Reader};
use crate::http::input::wire::{Named, Schemas, Wire, mismatch, named, read_named};
use crate::http::problem::{Code, Problem};
use crate::reflectance::directions::Directions;
use crate::reflectance::evaluate::Quantity;
use crate::reflectance::linear_image::{LinearKind, LinearScene, SpikeShape};
use crate::reflectance::quantity::{FacetSlope, Strength};
use crate::reflectance::scene::{Model, Sensor};
use axum::response::Response;
use std::borrow::Cow;
use std::sync::Arc;
use utoipa::openapi::schema::Schema;
use utoipa::openapi::{OneOfBuilder, RefOr};
use utoipa::{PartialSchema, ToSchema};

named! {
    LinearKind, "a linear model", [LinearKind::FixedSource, LinearKind::FixedView];
}

object! {
    /// What the two linear models have in common.
    LinearWire as "LinearModel" {
        /// `fixed_source` (74) or `fixed_view` (80).
        model: LinearKind,
        /// σ_α, degrees.
        facet_slope_deg: FacetSlope,
        /// How the spike is drawn.
        spike: SpikeShape,
        /// The directions.
        geometry: CheckedDirections,
        /// What to add to the answer.
        output: Option<LinearOutput>,
    }
}

object! {
    /// What to add to the answer of a linear model.
    LinearOutput as "LinearOutput" {
        /// Adds the decimal logarithm of every value. False when absent or null.
        log10: Option<bool>,
    }
}

object! {
    /// Image irradiance for a fixed source, (74): C_dl + C_sl/cos θ_r · exp(−α²/2σ_α²) + C_ss · spike.
    FixedSourceWire as "FixedSource" {
        /// C_dl, W m^-2.
        C_dl: Strength,
        /// C_sl, W m^-2.
        C_sl: Strength,
        /// C_ss, W m^-2.
        C_ss: Strength,
        ..linear: LinearWire,
    }
}

object! {
    /// Image irradiance for a fixed view, (80): K_dl cos θ_i + K_sl exp(−α²/2σ_α²) + K_ss · spike.
    FixedViewWire as "FixedView" {
        /// K_dl, W m^-2.
        K_dl: Strength,
        /// K_sl, W m^-2.
        K_sl: Strength,
        /// K_ss, W m^-2.
        K_ss: Strength,
        ..linear: LinearWire,
    }
}

/// What the resource takes: a radiance request seen by a camera, or strengths.
#[derive(Clone, Debug)]
pub(crate) enum ImageRequest {
    /// (51)
    Camera { request: Box<RadianceRequest>, factor: f64 },
    /// (74) or (80)
    Linear { scene: LinearScene, directions: Directions, log10: bool },
}

impl Wire for ImageRequest {
    fn read(node: Node, reader: &mut Reader) -> Option<Self> {
        let Node::Object(object) = node else { return no_object(&node, reader) };
        let model = object.fields.iter().find(|(name, _)| name == "model").map(|(_, node)| node);
        let model = reader.within("model", |reader| match model {
            Some(node) => read_named::<ImageModel>(node, reader),
            None => reader.fail(Code::Required, "required"),
        });
        match model {
            Some(ImageModel::Linear(LinearKind::FixedSource)) => {
                let wire = FixedSourceWire::read(Node::Object(object), reader)?;
                Some(linear([wire.C_dl, wire.C_sl, wire.C_ss], wire.linear))
            }
            Some(ImageModel::Linear(LinearKind::FixedView)) => {
                let wire = FixedViewWire::read(Node::Object(object), reader)?;
                Some(linear([wire.K_dl, wire.K_sl, wire.K_ss], wire.linear))
            }
            Some(ImageModel::Of(_)) => camera(object, reader),
            None => {
                without_model(object, reader);
                None
            }
        }
    }

    fn schema() -> RefOr<Schema> {
        OneOfBuilder::new()
            .item(RadianceRequest::reference())
            .item(FixedSourceWire::reference())
            .item(FixedViewWire::reference())
            .into()
    }

    fn collect(schemas: &mut Schemas) {
        RadianceRequest::gather(schemas);
        FixedSourceWire::gather(schemas);
        FixedViewWire::gather(schemas);
    }
}

impl PartialSchema for ImageRequest {
    fn schema() -> RefOr<Schema> {
        <Self as Wire>::schema()
    }
}

impl ToSchema for ImageRequest {
    fn name() -> Cow<'static, str> {
        Cow::Borrowed("ImageIrradianceRequest")
    }

    fn schemas(schemas: &mut Schemas) {
        Self::collect(schemas);
    }
}

/// The models that the resource takes.
#[derive(Clone, Copy)]
enum ImageModel {
    Linear(LinearKind),
    Of(Model),
}

impl Named for ImageModel {
    const WHAT: &'static str = "a model";
    const ALL: &'static [Self] = &[
        Self::Linear(LinearKind::FixedSource),
        Self::Linear(LinearKind::FixedView),
        Self::Of(Model::BeckmannSpizzichino),
        Self::Of(Model::TorranceSparrow),
        Self::Of(Model::Lambertian),
        Self::Of(Model::Unified),
    ];

    fn wire_name(self) -> &'static str {
        match self {
            Self::Linear(kind) => kind.name(),
            Self::Of(model) => model.name(),
        }
    }
}

fn no_object(node: &Node, reader: &mut Reader) -> Option<ImageRequest> {
    let expected = "an object: a radiance request with a camera, or a linear model";
    reader.fail(Code::WrongType, mismatch(node, &expected))
}

/// Reads what does not depend on the model.
fn without_model(object: Object, reader: &mut Reader) {
    let mut fields = Fields::new(object);
    fields.take_named::<CheckedDirections>(reader, "geometry");
    let mut accepted = RadianceRequest::names();
    for name in FixedSourceWire::names().into_iter().chain(FixedViewWire::names()) {
        if !accepted.contains(&name) {
            accepted.push(name);
        }
    }
    fields.forget(&accepted);
    fields.finish(reader, || accepted);
}

/// Reads a radiance request whose sensor has to be a camera.
fn camera(object: Object, reader: &mut Reader) -> Option<ImageRequest> {
    let sensor = object.fields.iter().find(|(name, _)| name == "sensor").map(|(_, node)| node);
    let needed = "a camera with pixel_area_um2, distance_um, focal_length_um and aperture_um";
    let fault = match sensor {
        None | Some(Node::Null) => Some((Code::Required, format!("required: {needed}"))),
        Some(Node::Object(sensor)) if describes_patch(sensor) => {
            Some((Code::Inconsistent, format!("a patch has no lens: expected {needed}")))
        }
        Some(_) => None,
    };
    let request = RadianceRequest::read(Node::Object(object), reader);
    if let Some((code, detail)) = fault
        && !reader.has_noted("/sensor")
    {
        reader.within("sensor", |reader| reader.error(code, detail));
    }
    let request = Box::new(request?);
    let Some(Sensor::Camera(camera)) = request.scene.scene.parameters().sensor else { return None };
    Some(ImageRequest::Camera { request, factor: camera.optics().image_irradiance_factor() })
}

fn linear([diffuse_lobe, specular_lobe, specular_spike]: [Strength; 3], wire: LinearWire) -> ImageRequest {
    ImageRequest::Linear {
        scene: LinearScene {
            kind: wire.model,
            diffuse_lobe,
            specular_lobe,
            specular_spike,
            facet_slope: wire.facet_slope_deg,
            spike: wire.spike,
        },
        directions: wire.geometry.0,
        log10: wire.output.and_then(|output| output.log10).unwrap_or(false),
    }
}

/// Image irradiance by a linear model.
#[derive(ToSchema)]
#[expect(dead_code, reason = "for the document: answers are written column by column")]
pub(crate) struct LinearAnswer {
    /// Always `image_irradiance`.
    #[schema(example = "image_irradiance")]
    quantity: &'static str,
    /// The unit of the strengths.
    #[schema(example = "W m^-2")]
    unit: &'static str,
    /// The sum of the three terms; without the spike if it is a delta.
    total: Numbers,
    /// First term.
    diffuse_lobe: Numbers,
    /// Second term.
    specular_lobe: Numbers,
    /// Third term; 0 for a delta.
    specular_spike: Numbers,
    /// Decimal logarithm of `total`, if asked for.
    #[schema(nullable = false)]
    log10_total: Option<Numbers>,
    /// Decimal logarithm of `diffuse_lobe`.
    #[schema(nullable = false)]
    log10_diffuse_lobe: Option<Numbers>,
    /// Decimal logarithm of `specular_lobe`.
    #[schema(nullable = false)]
    log10_specular_lobe: Option<Numbers>,
    /// Decimal logarithm of `specular_spike`.
    #[schema(nullable = false)]
    log10_specular_spike: Option<Numbers>,
    /// Bound of the relative error of `total`; null where none is known.
    relative_error_bound: Numbers,
    /// Whether the viewer meets the spike exactly, θ_r = θ_i and φ_r = 0. There a delta adds its strength times
    /// δ(θ_i − θ_r) δ(φ_r) to `total`.
    delta_on: Vec<bool>,
    /// Why values are null.
    diagnostics: Vec<DiagnosticAnswer>,
}

/// Either answer.
#[derive(ToSchema)]
#[serde(untagged)]
#[expect(dead_code, reason = "for the document: answers are written column by column")]
pub(crate) enum ImageAnswer {
    /// Of a camera.
    #[schema(title = "Camera")]
    Camera(Answer),
    /// Of a camera at several wavelengths.
    #[schema(title = "Camera, spectrum")]
    Spectrum(SpectrumAnswer),
    /// Of a linear model.
    #[schema(title = "Linear model")]
    Linear(LinearAnswer),
}

/// Image irradiance, (51), (74) and (80).
///
/// With a model of `/v1/radiance` and a camera as `sensor`: (51), the irradiance of the pixel. With `fixed_source` or
/// `fixed_view`: the linear models of section 5 from given strengths.
#[utoipa::path(
    post,
    path = "/v1/image-irradiance",
    tag = "reflection",
    request_body(content = ImageRequest, description = "A radiance request with a camera, or a linear model."),
    responses(
        (status = 200, description = "The image irradiance in each direction.", body = ImageAnswer),
        PostProblems
    )
)]
pub(crate) async fn image_irradiance(
    call: Call,
    JsonBody { value: request, turn }: JsonBody<ImageRequest>,
) -> Result<Response, Problem> {
    let work = match request {
        ImageRequest::Camera { request, factor } => {
            let RadianceRequest { geometry, output, scene } = *request;
            let CheckedScene { scene, light } = scene;
            let angles = OutputWire::angles(output.as_ref());
            let subject = Subject::Scene {
                scene: Box::new(scene),
                light,
                quantity: Quantity::ImageIrradiance { factor },
                output: OutputWire::chosen(output),
            };
            let mut work = Work::new(subject, Over::Directions(Box::new(geometry.0)));
            work.has_angles = angles.unwrap_or(true);
            work
        }
        ImageRequest::Linear { scene, directions, log10 } => {
            let subject = Subject::Linear { scene: Arc::new(scene), log10 };
            Work::new(subject, Over::Directions(Box::new(directions)))
        }
    };
    answer::respond(call, turn, work).await
}
