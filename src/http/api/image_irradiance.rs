//! `POST /v1/image-irradiance`: (51) through a camera, and the linear models (74) and (80).
#![allow(non_snake_case, reason = "the strengths keep the report's symbols on the wire")]

use super::answer::{Answer, DiagnosticAnswer, by_component};
use super::radiance::{CheckedDirections, OutputWire, RadianceRequest};
use super::responses::PostProblems;
use super::scene::describes_patch;
use crate::http::body::JsonBody;
use crate::http::compute;
use crate::http::encode::json;
use crate::http::encode::numbers::Numbers;
use crate::http::input::node::{Node, Object};
use crate::http::input::object::{WireObject, object};
use crate::http::input::reader::{Fields, Reader};
use crate::http::input::wire::{Named, Schemas, Wire, mismatch, named, read_named};
use crate::http::negotiate::JsonOnly;
use crate::http::problem::{Code, Problem};
use crate::http::track::Deadline;
use crate::reflectance::directions::Directions;
use crate::reflectance::evaluate::{Quantity, evaluate};
use crate::reflectance::linear_image::{LinearEvaluation, LinearKind, LinearScene, SpikeShape};
use crate::reflectance::quantity::{FacetSlope, Strength};
use crate::reflectance::scene::{Model, Sensor};
use axum::response::Response;
use serde::Serialize;
use std::borrow::Cow;
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
    fields.finish(reader, &accepted);
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
    let Some(Sensor::Camera(camera)) = request.scene.0.parameters().sensor else { return None };
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
#[derive(Serialize, ToSchema)]
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
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schema(nullable = false)]
    log10_total: Option<Numbers>,
    /// Decimal logarithm of `diffuse_lobe`.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schema(nullable = false)]
    log10_diffuse_lobe: Option<Numbers>,
    /// Decimal logarithm of `specular_lobe`.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schema(nullable = false)]
    log10_specular_lobe: Option<Numbers>,
    /// Decimal logarithm of `specular_spike`.
    #[serde(skip_serializing_if = "Option::is_none")]
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

impl LinearAnswer {
    fn new(evaluation: LinearEvaluation) -> Self {
        // The linear models always have all three.
        let [diffuse, lobe, spike] = by_component(evaluation.components);
        Self {
            quantity: "image_irradiance",
            unit: "W m^-2",
            total: Numbers(evaluation.total),
            diffuse_lobe: diffuse.0.unwrap_or_default(),
            specular_lobe: lobe.0.unwrap_or_default(),
            specular_spike: spike.0.unwrap_or_default(),
            log10_total: evaluation.log10_total.map(Numbers),
            log10_diffuse_lobe: diffuse.1,
            log10_specular_lobe: lobe.1,
            log10_specular_spike: spike.1,
            relative_error_bound: Numbers(evaluation.relative_error_bound),
            delta_on: evaluation.delta_on,
            diagnostics: evaluation.diagnostics.into_iter().map(DiagnosticAnswer::from).collect(),
        }
    }

    fn size_hint(&self) -> usize {
        let columns = if self.log10_total.is_some() { 9 } else { 5 };
        1024 + (24 * columns + 6) * self.total.0.len() + 160 * self.diagnostics.len()
    }
}

/// Either answer.
#[derive(Serialize, ToSchema)]
#[serde(untagged)]
pub(crate) enum ImageAnswer {
    /// Of a camera.
    #[schema(title = "Camera")]
    Camera(Answer),
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
    _: JsonOnly,
    deadline: Deadline,
    JsonBody { value: request, .. }: JsonBody<ImageRequest>,
) -> Result<Response, Problem> {
    let count = match &request {
        ImageRequest::Camera { request, .. } => request.geometry.0.count(),
        ImageRequest::Linear { directions, .. } => directions.count(),
    };
    compute::run(deadline, count, move || match request {
        ImageRequest::Camera { request, factor } => {
            let quantity = Quantity::ImageIrradiance { factor };
            let output = OutputWire::chosen(request.output);
            let answer =
                Answer::new(quantity, evaluate(&request.scene.0, &request.geometry.0, quantity, output));
            let size_hint = answer.size_hint();
            json::response(&ImageAnswer::Camera(answer), size_hint)
        }
        ImageRequest::Linear { scene, directions, log10 } => {
            let answer = LinearAnswer::new(scene.evaluate(&directions, log10));
            let size_hint = answer.size_hint();
            json::response(&ImageAnswer::Linear(answer), size_hint)
        }
    })
    .await?
}
