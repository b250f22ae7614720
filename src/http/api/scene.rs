//! The description of a scene as requests carry it: model, surface, light, sensor, accuracy.

use super::light::{self, IlluminationWire, Light, Lit};
use super::sensor::{SensorWire, sensor_needs};
use crate::http::input::medium::MediumWire;
use crate::http::input::object::{Checked, object};
use crate::http::input::reader::Reader;
use crate::http::input::wire::is_given;
use crate::http::problem::{Code, Problem};
use crate::reflectance::bounds::DEFAULT_TOLERANCE;
use crate::reflectance::fresnel::Polarization;
use crate::reflectance::fresnel_average::FresnelAverage;
use crate::reflectance::material::Lookup;
use crate::reflectance::numeric::lobe_series::Method;
use crate::reflectance::outline::{Listed, Outline, Parameter, SceneError, Slopes};
use crate::reflectance::quantity::{
    CorrelationLength, FacetSlope, Fraction, Irradiance, Quantity, RmsHeight, SpecularScale, Tolerance,
};
use crate::reflectance::scene::{self, Accuracy, Components, Model, Scene, SceneParameters};
use crate::reflectance::shadowing::Shadowing;

object! {
    partial
    /// The surface. Which of its fields are needed depends on the model and the components.
    SurfaceWire as "Surface" {
        /// σ_h, micrometres: the standard deviation of the Gaussian height density (4).
        rms_height_um: Option<RmsHeight>,
        /// T, micrometres: the distance at which the autocorrelation (5) falls to 1/e.
        correlation_length_um: Option<CorrelationLength>,
        /// σ_α of (58), degrees: the width of the density exp(−α²/2σ_α²) of facet slope angles. Absent or null:
        /// by (79) from σ_h/T where a Torrance-Sparrow lobe needs it.
        facet_slope_deg: Option<FacetSlope>,
        /// What the surface is made of: n and k, or a material that is looked up at the wavelength; a perfect conductor
        /// when absent or null.
        medium: Option<MediumWire>,
        /// ρ; κ_diff of (57) is ρ/π. 0 when absent or null.
        diffuse_albedo: Option<Fraction>,
        /// c·a_f of (71), per steradian. Absent or null: the value with which the projected areas of all facets
        /// add up to the mean plane's.
        specular_scale: Option<SpecularScale>,
        /// How facets hide each other. Absent or null: `none` for Beckmann-Spizzichino, `v_groove` (65) for
        /// Torrance-Sparrow and the unified model. `smith` is a surface of Gaussian slopes, 1/(1 + Λ_i + Λ_r),
        /// `smith_uncorrelated` 1/((1 + Λ_i)(1 + Λ_r)); their m is 2σ_h/T, or tan √2σ_α (79) where the lobe has a
        /// `facet_slope_deg` of its own.
        shadowing: Option<Shadowing>,
        /// Over what the F of a finite conductor's lobe is averaged, (41): the facets that mirror the source to the
        /// viewer (`half_vector`, when absent or null), the mean plane (`mean_plane`), or all facets that face the source
        /// (`slope_average`, for σ_h/T up to 4). The spike always has the mean plane's.
        fresnel_average: Option<FresnelAverage>,
    }
}

object! {
    partial
    /// How exactly, and by which method.
    AccuracyWire as "Accuracy" {
        /// Of the total, per direction; 1e-9 when absent or null (1e-6 of an albedo).
        relative_tolerance: Option<Tolerance>,
        /// How the lobe series is evaluated: `series` sums to convergence, `paper` the first 100 terms as the
        /// authors did, `uniform` is a saddle-point expansion, `smooth` is (48) corrected, `rough` is (49). A named
        /// method is used as asked, with its true error bound; `auto` (when absent or null) takes the cheapest
        /// that is as accurate as 64-bit floats allow.
        method: Option<Method>,
    }
}

object! {
    partial
    /// All about a scene but its directions.
    SceneWire as "Scene" {
        /// Which model: `beckmann_spizzichino` (47), `torrance_sparrow` (72), `lambertian` (57), or `unified`
        /// (section 5.1).
        model: Model,
        /// The surface.
        surface: SurfaceWire,
        /// The light: a unit beam when absent or null. The height models need its wavelength.
        illumination: Option<IlluminationWire>,
        /// The sensor; only the specular spike needs it. With a `receiver_half_angle_deg` answers are means over a cone.
        sensor: Option<SensorWire>,
        /// Which components: `auto` (when absent or null) leaves out what changes no total of the request by more than a
        /// quarter of the tolerance, and says so; or a list of names, each of which is answered.
        components: Option<Listed>,
        /// Tolerance and method.
        accuracy: Option<AccuracyWire>,
    }
}

impl SceneWire {
    /// What is known, for the checks of the parts against each other.
    pub(super) fn outline(&self) -> Outline {
        let surface = self.surface.as_ref();
        let light = self.illumination.as_ref();
        let absences = [
            (surface.is_some_and(|s| !is_given(&s.rms_height_um)), Parameter::RmsHeight),
            (surface.is_some_and(|s| !is_given(&s.correlation_length_um)), Parameter::CorrelationLength),
            (surface.is_some_and(|s| !is_given(&s.facet_slope_deg)), Parameter::FacetSlope),
            (surface.is_some_and(|s| !is_given(&s.specular_scale)), Parameter::SpecularScale),
            (
                light.is_some_and(|l| l.as_ref().is_none_or(|l| !is_given(&l.wavelength_um))),
                Parameter::Wavelength,
            ),
            (self.sensor.is_some_and(|sensor| !sensor.is_some_and(SensorWire::sees)), Parameter::Sensor),
        ];
        Outline {
            model: self.model,
            components: self.components.as_ref().map(|listed| listed.clone().unwrap_or(Listed::Auto)),
            absent: absences.into_iter().filter_map(|(absent, which)| absent.then_some(which)).collect(),
            slopes: surface.map_or_else(Slopes::default, |s| Slopes {
                rms_height: s.rms_height_um.flatten(),
                correlation_length: s.correlation_length_um.flatten(),
                facet_slope: s.facet_slope_deg.flatten(),
                shadowing: s.shadowing.flatten(),
                fresnel_average: s.fresnel_average.flatten(),
            }),
        }
    }

    /// The light with what is looked up in it, as far as it could be read.
    pub(super) fn lit(&self, reader: &mut Reader) -> Option<Lit> {
        let wavelengths = match self.illumination.as_ref()? {
            Some(light) => light.wavelength_um.as_ref().map(Option::as_ref),
            None => Some(None),
        };
        light::lit(wavelengths, self.surface.as_ref()?.medium, reader)
    }

    /// The parameters in a light, if all could be read.
    pub(super) fn into_parameters(self, lit: &Lit, default_tolerance: f64) -> Option<SceneParameters> {
        let (surface, accuracy) = (self.surface?, self.accuracy?);
        let (irradiance, polarization) = match self.illumination? {
            Some(light) => (light.irradiance?, light.polarization?),
            None => (None, None),
        };
        let (tolerance, method) = match accuracy {
            Some(accuracy) => (accuracy.relative_tolerance?, accuracy.method?),
            None => (None, None),
        };
        Some(SceneParameters {
            model: self.model?,
            surface: scene::Surface {
                rms_height: surface.rms_height_um?,
                correlation_length: surface.correlation_length_um?,
                facet_slope: surface.facet_slope_deg?,
                medium: lit.medium,
                diffuse_albedo: surface.diffuse_albedo?.unwrap_or(Fraction::ZERO),
                specular_scale: surface.specular_scale?,
                shadowing: surface.shadowing?,
                fresnel_average: surface.fresnel_average?,
            },
            illumination: scene::Illumination {
                wavelength: lit.wavelength,
                irradiance: irradiance.or_else(|| Irradiance::new(1.0).ok())?,
                polarization: polarization.unwrap_or_else(Polarization::unpolarized),
            },
            sensor: self.sensor?.and_then(|sensor| sensor.seen),
            receiver: self.sensor?.and_then(|sensor| sensor.receiver),
            components: match self.components? {
                None | Some(Listed::Auto) => Components::Auto,
                Some(Listed::Named(named)) => Components::Named(named.into_iter().collect::<Option<_>>()?),
            },
            accuracy: Accuracy {
                relative_tolerance: tolerance.or_else(|| Tolerance::new(default_tolerance).ok())?,
                method: method.unwrap_or(Method::Auto),
            },
        })
    }
}

/// A scene whose parameters fit together, read in one go with the checks of [`Outline::errors`], and its light. The scene
/// is that of the first wavelength.
#[derive(Clone, Debug, Hash)]
pub(crate) struct CheckedScene {
    pub(crate) scene: Scene,
    pub(crate) light: Light,
}

impl CheckedScene {
    /// The scene of a resource that answers one wavelength, and what was looked up for its medium.
    pub(crate) fn single(self) -> Result<(Scene, Option<Lookup>), Problem> {
        Ok((self.scene, self.light.single()?))
    }
}

impl Checked for CheckedScene {
    type Fields = SceneWire;

    fn check(wire: SceneWire, reader: &mut Reader) -> Option<Self> {
        for error in wire.outline().errors() {
            note(&error, reader);
        }
        let lit = wire.lit(reader)?;
        // What is wrong with the whole was just noted.
        let scene = Scene::new(wire.into_parameters(&lit, DEFAULT_TOLERANCE)?).ok()?;
        Some(Self { scene, light: lit.light })
    }
}

/// Notes what the core found at the field that a client knows.
pub(super) fn note(error: &SceneError, reader: &mut Reader) {
    match error {
        SceneError::Missing { parameter, needed_by, unless } => {
            let unless = unless.map(|other| format!(", unless {} is given", place(other).1));
            let mut detail = format!("required: {needed_by} needs it{}", unless.unwrap_or_default());
            let (object, mut field) = place(*parameter);
            if *parameter == Parameter::Sensor {
                detail = format!("required: {needed_by} needs a sensor with {}", sensor_needs());
                // A query has no parameter for the sensor as a whole.
                field = if reader.is_flat() { "footprint_um2" } else { "" };
            }
            reader.within(object, |reader| {
                if field.is_empty() {
                    reader.error(Code::Required, detail);
                } else {
                    reader.within(field, |reader| reader.error(Code::Required, detail));
                }
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
        SceneError::Slope { parameter, value, needed_by, accepted } => {
            let detail = format!("{} {value} is outside: {needed_by} needs {accepted}", accepted.name);
            let (object, field) = place(*parameter);
            reader.within(object, |reader| {
                reader.within(field, |reader| reader.error(Code::OutOfRange, detail));
            });
        }
        SceneError::NoComponents => reader.within("components", |reader| {
            reader.error(Code::Empty, "the array is empty: expected \"auto\" or at least one component");
        }),
    }
}

fn at_component(position: usize, code: Code, detail: String, reader: &mut Reader) {
    reader.within("components", |reader| reader.at(position, |reader| reader.error(code, detail)));
}

/// Where a parameter of the core stands in a request: an object, and a field in it or nothing.
const fn place(parameter: Parameter) -> (&'static str, &'static str) {
    match parameter {
        Parameter::RmsHeight => ("surface", "rms_height_um"),
        Parameter::CorrelationLength => ("surface", "correlation_length_um"),
        Parameter::FacetSlope => ("surface", "facet_slope_deg"),
        Parameter::SpecularScale => ("surface", "specular_scale"),
        Parameter::Wavelength => ("illumination", "wavelength_um"),
        Parameter::Sensor => ("sensor", ""),
    }
}
