//! The description of a scene as requests carry it: model, surface, light, sensor, accuracy.

use crate::http::input::node::Node;
use crate::http::input::object::{WireObject, object};
use crate::http::input::reader::{Fields, Reader};
use crate::http::input::wire::{Parameter, Schemas, Wire, mismatch};
use crate::http::problem::Code;
use crate::reflectance::bounds::DEFAULT_TOLERANCE;
use crate::reflectance::fresnel::{Medium, Polarization};
use crate::reflectance::numeric::lobe_series::Method;
use crate::reflectance::quantity::{
    Area, CorrelationLength, FacetSlope, Fraction, Irradiance, Length, OffAxis, Quantity, RmsHeight,
    SpecularScale, Tolerance, Wavelength,
};
use crate::reflectance::scene::{
    self, Accuracy, CameraSensor, Components, Model, Scene, SceneError, SceneParameters, Sensor,
};
use crate::reflectance::shadowing::Shadowing;
use utoipa::openapi::schema::{ObjectBuilder, Schema};
use utoipa::openapi::{OneOfBuilder, RefOr};

object! {
    /// The surface. Which of its fields are needed depends on the model and the components.
    SurfaceWire as "Surface" {
        /// σ_h, micrometres: the standard deviation of the Gaussian height density (4).
        rms_height_um: Option<RmsHeight>,
        /// T, micrometres: the distance at which the autocorrelation (5) falls to 1/e.
        correlation_length_um: Option<CorrelationLength>,
        /// σ_α of (58), degrees: the width of the density exp(−α²/2σ_α²) of facet slope angles. Absent or null:
        /// by (79) from σ_h/T where a Torrance-Sparrow lobe needs it.
        facet_slope_deg: Option<FacetSlope>,
        /// What the surface is made of; a perfect conductor when absent or null.
        medium: Option<Medium>,
        /// ρ; κ_diff of (57) is ρ/π. 0 when absent or null.
        diffuse_albedo: Option<Fraction>,
        /// c·a_f of (71), per steradian. Absent or null: the value with which the projected areas of all facets
        /// add up to the mean plane's.
        specular_scale: Option<SpecularScale>,
        /// How facets hide each other. Absent or null: `none` for Beckmann-Spizzichino, `v_groove` (65) for
        /// Torrance-Sparrow and the unified model.
        shadowing: Option<Shadowing>,
    }
}

object! {
    /// The light: a collimated beam.
    IlluminationWire as "Illumination" {
        /// λ, micrometres. Needed by the models that rest on the height statistics.
        wavelength_um: Option<Wavelength>,
        /// Of the beam on a plane normal to it, W m^-2 or W m^-2 nm^-1; the answer carries the same. 1 when
        /// absent or null.
        irradiance: Option<Irradiance>,
        /// Polarization with respect to the facet's plane of incidence; unpolarized when absent or null.
        polarization: Option<Polarization>,
    }
}

object! {
    /// What the sensor sees: the quantities of (47) and (35) themselves.
    PatchWire as "Patch" {
        /// (z/f)² dA_im cos γ of (43), square micrometres.
        footprint_um2: Area,
        /// X of (35), micrometres.
        patch_half_x_um: Length,
        /// Y of (35), micrometres.
        patch_half_y_um: Length,
    }
}

object! {
    /// A camera as in figure 10: its footprint follows by (43), A = footprint/cos θ_r and X = Y = √A/2.
    CameraWire as "Camera" {
        /// dA_im, square micrometres.
        pixel_area_um2: Area,
        /// z, micrometres.
        distance_um: Length,
        /// f, micrometres.
        focal_length_um: Length,
        /// d, micrometres: the diameter of the lens.
        aperture_um: Length,
        /// γ, degrees; 0 when absent or null.
        off_axis_deg: Option<OffAxis>,
    }
}

impl Wire for Sensor {
    fn read(node: Node, reader: &mut Reader) -> Option<Self> {
        let Node::Object(object) = node else {
            return reader
                .fail(Code::WrongType, mismatch(&node, &"an object that describes a patch or a camera"));
        };
        let mut fields = Fields::new(object);
        let camera = is_camera(&fields);
        let sensor = take_sensor(camera, &mut fields, reader);
        fields.finish(reader, &if camera { CameraWire::names() } else { PatchWire::names() });
        sensor
    }

    fn read_flat(_: &'static str, fields: &mut Fields, reader: &mut Reader) -> Option<Self> {
        take_sensor(is_camera(fields), fields, reader)
    }

    fn is_given(_: &'static str, fields: &Fields) -> bool {
        fields.has_any(&PatchWire::names()) || fields.has_any(&CameraWire::names())
    }

    fn schema() -> RefOr<Schema> {
        OneOfBuilder::new().item(PatchWire::reference()).item(CameraWire::reference()).into()
    }

    fn collect(schemas: &mut Schemas) {
        PatchWire::gather(schemas);
        CameraWire::gather(schemas);
    }

    fn parameters(_: &'static str, _: &str, _: bool) -> Vec<Parameter> {
        let mut parameters = PatchWire::query_parameters(false);
        parameters.extend(CameraWire::query_parameters(false));
        parameters
    }
}

/// Whether the fields describe a camera rather than a patch.
fn is_camera(fields: &Fields) -> bool {
    fields.has_any(&CameraWire::names()) && !fields.has_any(&PatchWire::names())
}

fn take_sensor(camera: bool, fields: &mut Fields, reader: &mut Reader) -> Option<Sensor> {
    if camera {
        let camera = CameraWire::take(fields, reader)?;
        Some(Sensor::Camera(CameraSensor {
            pixel_area: camera.pixel_area_um2,
            distance: camera.distance_um,
            focal_length: camera.focal_length_um,
            aperture: camera.aperture_um,
            off_axis: camera.off_axis_deg.or_else(|| OffAxis::new(0.0).ok())?,
        }))
    } else {
        let patch = PatchWire::take(fields, reader)?;
        Some(Sensor::Patch {
            footprint: patch.footprint_um2,
            half_x: patch.patch_half_x_um,
            half_y: patch.patch_half_y_um,
        })
    }
}

object! {
    /// How exactly, and by which method.
    AccuracyWire as "Accuracy" {
        /// Of the total, per direction; 1e-9 when absent or null.
        relative_tolerance: Option<Tolerance>,
        /// How the lobe series is evaluated: `series` sums to convergence, `paper` the first 100 terms as the
        /// authors did, `uniform` is a saddle-point expansion, `smooth` is (48) corrected, `rough` is (49). A named
        /// method is used as asked, with its true error bound; `auto` (when absent or null) takes the cheapest
        /// that is as accurate as 64-bit floats allow.
        method: Option<Method>,
    }
}

object! {
    /// All about a scene but its directions.
    SceneWire as "Scene" {
        /// Which model: `beckmann_spizzichino` (47), `torrance_sparrow` (72), `lambertian` (57), or `unified`
        /// (section 5.1).
        model: Model,
        /// The surface.
        surface: SurfaceWire,
        /// The light: a unit beam when absent or null. The height models need its wavelength.
        illumination: Option<IlluminationWire>,
        /// The sensor; only the specular spike needs it.
        sensor: Option<Sensor>,
        /// Which components: `auto` (when absent or null) or a list of names.
        components: Option<Components>,
        /// Tolerance and method.
        accuracy: Option<AccuracyWire>,
    }
}

impl SceneWire {
    fn into_parameters(self) -> Option<SceneParameters> {
        let Self { model, surface, illumination, sensor, components, accuracy } = self;
        let (wavelength, irradiance, polarization) = illumination
            .map_or((None, None, None), |light| (light.wavelength_um, light.irradiance, light.polarization));
        let (tolerance, method) = accuracy.map_or((None, None), |a| (a.relative_tolerance, a.method));
        Some(SceneParameters {
            model,
            surface: scene::Surface {
                rms_height: surface.rms_height_um,
                correlation_length: surface.correlation_length_um,
                facet_slope: surface.facet_slope_deg,
                medium: surface.medium.unwrap_or(Medium::PerfectConductor),
                diffuse_albedo: surface.diffuse_albedo.unwrap_or(Fraction::ZERO),
                specular_scale: surface.specular_scale,
                shadowing: surface.shadowing,
            },
            illumination: scene::Illumination {
                wavelength,
                irradiance: irradiance.or_else(|| Irradiance::new(1.0).ok())?,
                polarization: polarization.unwrap_or_else(Polarization::unpolarized),
            },
            sensor,
            components: components.unwrap_or(Components::Auto),
            accuracy: Accuracy {
                relative_tolerance: tolerance.or_else(|| Tolerance::new(DEFAULT_TOLERANCE).ok())?,
                method: method.unwrap_or(Method::Auto),
            },
        })
    }
}

/// A scene whose parameters fit together, read in one go with the checks of [`Scene::new`].
#[derive(Clone, Debug)]
pub(crate) struct CheckedScene(pub(crate) Scene);

impl WireObject for CheckedScene {
    const NAME: &'static str = SceneWire::NAME;
    const DESCRIPTION: &'static str = SceneWire::DESCRIPTION;

    fn take(fields: &mut Fields, reader: &mut Reader) -> Option<Self> {
        let parameters = SceneWire::take(fields, reader)?.into_parameters()?;
        match Scene::new(parameters) {
            Ok(scene) => Some(Self(scene)),
            Err(errors) => {
                for error in &errors {
                    note(error, reader);
                }
                None
            }
        }
    }

    fn names() -> Vec<&'static str> {
        SceneWire::names()
    }

    fn properties(object: ObjectBuilder) -> ObjectBuilder {
        SceneWire::properties(object)
    }

    fn inner(schemas: &mut Schemas) {
        SceneWire::inner(schemas);
    }

    fn query_parameters(required: bool) -> Vec<Parameter> {
        SceneWire::query_parameters(required)
    }
}

/// Notes what the core found at the field that a client knows.
fn note(error: &SceneError, reader: &mut Reader) {
    match error {
        SceneError::Missing { parameter, needed_by } => {
            let (object, field) = place(*parameter);
            let detail = format!("required: {needed_by} needs it");
            reader.within(object, |reader| match field {
                Some(field) => reader.within(field, |reader| reader.error(Code::Required, detail)),
                None => reader.error(Code::Required, detail),
            });
        }
        SceneError::NotInModel { position, component, model } => {
            let has = model.components().iter().map(|c| c.name()).collect::<Vec<_>>().join(", ");
            let detail = format!("{} has no {}: expected of {has}", model.name(), component.name());
            at_component(*position, Code::Inconsistent, detail, reader);
        }
        SceneError::Repeated { position, component } => {
            at_component(*position, Code::Duplicate, format!("{} is named twice", component.name()), reader);
        }
        SceneError::NoComponents => reader.within("components", |reader| {
            reader.error(Code::Empty, "the array is empty: expected \"auto\" or at least one component");
        }),
    }
}

fn at_component(position: usize, code: Code, detail: String, reader: &mut Reader) {
    reader.within("components", |reader| reader.at(position, |reader| reader.error(code, detail)));
}

/// Where a parameter of the core stands in a request.
const fn place(parameter: scene::Parameter) -> (&'static str, Option<&'static str>) {
    use scene::Parameter as P;
    match parameter {
        P::RmsHeight => ("surface", Some("rms_height_um")),
        P::CorrelationLength => ("surface", Some("correlation_length_um")),
        P::FacetSlope => ("surface", Some("facet_slope_deg")),
        P::Wavelength => ("illumination", Some("wavelength_um")),
        P::Sensor => ("sensor", None),
        P::Components => ("components", None),
    }
}
