//! What a caller describes: surface, light, sensor, model. A [`Scene`] is checked as a whole when
//! it is made; evaluating one cannot fail.

use super::beckmann_spizzichino::RelativeRoughness;
use super::degrees::SinCos;
use super::fresnel::{Medium, Polarization, RefractiveIndex};
use super::fresnel_average::FresnelAverage;
use super::numeric::lobe_series::Method;
use super::outline::{Outline, SceneError};
use super::quantity::{
    Area, CorrelationLength, FacetSlope, Fraction, InvertibleFacetSlope, Irradiance, Length, OffAxis,
    Quantity as _, ReceiverHalfAngle, RmsHeight, SpecularScale, Tolerance, Wavelength,
};
use super::radiometry::Camera;
use super::roughness::{self, BeckmannWidth, Widths};
use super::shadowing::{Shadowing, ShadowingFunction};
use super::torrance_sparrow;
use core::hash::{Hash, Hasher};

pub use super::model::{Component, Model};

/// What the surface is made of and how rough it is.
#[derive(Clone, Copy, Debug, PartialEq, Hash)]
pub struct Surface {
    /// σ_h of the height density (4).
    pub rms_height: Option<RmsHeight>,
    /// T of the autocorrelation (5).
    pub correlation_length: Option<CorrelationLength>,
    /// σ_α of (58); by (79) from σ_h/T when absent.
    pub facet_slope: Option<FacetSlope>,
    /// Perfect conductor, or n − ik.
    pub medium: Medium,
    /// ρ; κ_diff = ρ/π.
    pub diffuse_albedo: Fraction,
    /// c·a_f; when absent, the value that tiles the mean plane (errata E31).
    pub specular_scale: Option<SpecularScale>,
    /// When absent: none for Beckmann-Spizzichino, V-groove for Torrance-Sparrow.
    pub shadowing: Option<Shadowing>,
    /// Over what F of the lobe is averaged; the half vector when absent.
    pub fresnel_average: Option<FresnelAverage>,
}

impl Surface {
    /// Beckmann's m of the facets that make the lobe, which Smith's Λ speaks of: 2σ_h/T where the lobe follows from the
    /// heights, tan √2σ_α by (79) where it has a σ_α of its own. None if neither is given, or σ_α is beyond (79). Relative
    /// error below 8 ε.
    pub fn slope(&self, model: Model) -> Option<BeckmannWidth> {
        let widths = match self.facet_slope {
            Some(slope) if model != Model::BeckmannSpizzichino => {
                Widths::from_facet_slope(InvertibleFacetSlope::new(slope.get()).ok()?)
            }
            _ => Widths::from_heights(self.rms_height?, self.correlation_length?),
        };
        Some(widths.beckmann_alpha)
    }
}

/// The light.
#[derive(Clone, Copy, Debug, PartialEq, Hash)]
pub struct Illumination {
    /// λ; needed by the height models only.
    pub wavelength: Option<Wavelength>,
    /// Of the beam on a plane normal to it: L_i dω_i of (57), S_a of (50).
    pub irradiance: Irradiance,
    /// h and v of (63) as energies (errata E35).
    pub polarization: Polarization,
}

/// What the sensor sees of the surface.
#[derive(Clone, Copy, Debug, PartialEq, Hash)]
pub enum Sensor {
    /// The quantities of (47) and (35) themselves.
    Patch {
        /// (z/f)² dA_im cos γ of (43).
        footprint: Area,
        /// X of (35).
        half_x: Length,
        /// Y of (35).
        half_y: Length,
    },
    /// A camera: footprint by (43), A = footprint/cos θ_r, X = Y = √A/2.
    Camera(CameraSensor),
}

/// The camera of figure 10.
#[derive(Clone, Copy, Debug, PartialEq, Hash)]
pub struct CameraSensor {
    /// dA_im
    pub pixel_area: Area,
    /// z
    pub distance: Length,
    /// f
    pub focal_length: Length,
    /// d, the diameter of the lens
    pub aperture: Length,
    /// γ
    pub off_axis: OffAxis,
}

impl CameraSensor {
    /// Its radiometry.
    pub fn optics(&self) -> Camera {
        Camera {
            pixel_area: self.pixel_area.get(),
            distance: self.distance.get(),
            focal_length: self.focal_length.get(),
            aperture: self.aperture.get(),
            cos_off_axis: SinCos::of_degrees(self.off_axis.get()).cos,
        }
    }
}

/// Which components to answer.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Components {
    /// Those that matter.
    Auto,
    /// These, whether they matter or not.
    Named(Vec<Component>),
}

/// By the components, in whatever order they are named: they are answered in the model's.
impl Hash for Components {
    fn hash<H: Hasher>(&self, state: &mut H) {
        match self {
            Self::Auto => None,
            Self::Named(named) => Some(Component::ALL.map(|component| named.contains(&component))),
        }
        .hash(state);
    }
}

/// Tolerance and method.
#[derive(Clone, Copy, Debug, PartialEq, Hash)]
pub struct Accuracy {
    /// Relative, of the total, per direction.
    pub relative_tolerance: Tolerance,
    /// How the lobe series is evaluated.
    pub method: Method,
}

/// Everything about a scene but the directions.
#[derive(Clone, Debug, PartialEq, Hash)]
pub struct SceneParameters {
    /// The model.
    pub model: Model,
    /// The surface.
    pub surface: Surface,
    /// The light.
    pub illumination: Illumination,
    /// The sensor, which only the spike needs.
    pub sensor: Option<Sensor>,
    /// The half angle of the cone of viewers that a receiver takes the mean over; a point when absent.
    pub receiver: Option<ReceiverHalfAngle>,
    /// The components asked for.
    pub components: Components,
    /// The accuracy asked for.
    pub accuracy: Accuracy,
}

/// A scene whose parameters fit together.
#[derive(Clone, Debug, PartialEq)]
pub struct Scene {
    pub(super) parameters: SceneParameters,
    /// Components to evaluate, in the model's order.
    pub(super) evaluated: Vec<Component>,
    /// Where the model has facets.
    pub(super) facets: Option<FacetParameters>,
}

/// By its parameters, from which all else follows.
impl Hash for Scene {
    fn hash<H: Hasher>(&self, state: &mut H) {
        self.parameters.hash(state);
    }
}

/// What the facet lobe (70) is made of.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct FacetParameters {
    /// σ_α in radians.
    pub(super) sigma_alpha: f64,
    /// The c·a_f of facets that tile the mean plane.
    pub(super) tiling_scale: f64,
    /// c·a_f
    pub(super) scale: f64,
}

impl FacetParameters {
    fn of(parameters: &SceneParameters) -> Option<Self> {
        if !matches!(parameters.model, Model::TorranceSparrow | Model::Unified) {
            return None;
        }
        let surface = &parameters.surface;
        let sigma_alpha = facet_slope_radians(surface)?;
        let tiling_scale = torrance_sparrow::normalized_scale(sigma_alpha);
        let scale = surface.specular_scale.map_or(tiling_scale, SpecularScale::get);
        Some(Self { sigma_alpha, tiling_scale, scale })
    }
}

impl Scene {
    /// Checks the parameters against each other; all that is wrong comes back at once.
    pub fn new(parameters: SceneParameters) -> Result<Self, Vec<SceneError>> {
        let outline = Outline::of(&parameters);
        let errors = outline.errors();
        if !errors.is_empty() {
            return Err(errors);
        }
        let evaluated = outline
            .components
            .as_ref()
            .map(|listed| outline.evaluated(parameters.model, listed))
            .unwrap_or_default();
        Ok(Self::of_parts(parameters, evaluated))
    }

    /// Parameters that were checked, and the components to evaluate of them.
    pub(super) fn of_parts(parameters: SceneParameters, evaluated: Vec<Component>) -> Self {
        let facets = FacetParameters::of(&parameters);
        Self { parameters, evaluated, facets }
    }

    /// A scene of this crate's own making, complete by construction.
    pub(super) fn preset(parameters: SceneParameters) -> Self {
        let evaluated = match &parameters.components {
            Components::Auto => parameters.model.components().to_vec(),
            Components::Named(named) => named.clone(),
        };
        let facets = FacetParameters::of(&parameters);
        Self { parameters, evaluated, facets }
    }

    /// The same scene to another accuracy, which is no part of what can be wrong.
    #[must_use]
    pub fn with_accuracy(&self, accuracy: Accuracy) -> Self {
        let parameters = SceneParameters { accuracy, ..self.parameters.clone() };
        Self { parameters, ..self.clone() }
    }

    /// The same scene in light of another wavelength, at which its medium may have another index: no part of what can be
    /// wrong where a wavelength is given.
    #[must_use]
    pub fn with_light(&self, wavelength: Wavelength, index: Option<RefractiveIndex>) -> Self {
        let mut scene = self.clone();
        let SceneParameters { illumination, surface, .. } = &mut scene.parameters;
        illumination.wavelength = Some(wavelength);
        surface.medium = index.map_or(surface.medium, Medium::Index);
        scene
    }

    /// The parameters it was made of.
    pub fn parameters(&self) -> &SceneParameters {
        &self.parameters
    }

    /// The components that an evaluation answers, in the model's order.
    pub fn evaluated(&self) -> &[Component] {
        &self.evaluated
    }

    /// The same scene with these of its components only.
    pub(super) fn with_only(&self, evaluated: &[Component]) -> Self {
        Self { evaluated: evaluated.to_vec(), ..self.clone() }
    }

    /// The parameters that were given and that no evaluated component reads, as clients know them.
    pub(super) fn unused(&self) -> Vec<&'static str> {
        let p = &self.parameters;
        let diffuse = self.evaluated.contains(&Component::DiffuseLobe);
        let lobe = self.evaluated.contains(&Component::SpecularLobe);
        let height_lobe = lobe && p.model == Model::BeckmannSpizzichino;
        let facet_lobe = lobe && !height_lobe;
        [
            ("surface.diffuse_albedo", p.surface.diffuse_albedo.get() > 0.0 && !diffuse),
            ("surface.facet_slope_deg", p.surface.facet_slope.is_some() && !facet_lobe),
            ("surface.specular_scale", p.surface.specular_scale.is_some() && !facet_lobe),
            ("surface.shadowing", p.surface.shadowing.is_some_and(|given| given != Shadowing::None) && !lobe),
            (
                "surface.fresnel_average",
                p.surface.fresnel_average.is_some_and(|given| given != FresnelAverage::HalfVector)
                    && (!lobe || p.surface.medium == Medium::PerfectConductor),
            ),
            ("accuracy.method", p.accuracy.method != Method::Auto && !height_lobe),
        ]
        .into_iter()
        .filter_map(|(name, unused)| unused.then_some(name))
        .collect()
    }

    /// σ_h/λ and T/λ, where the scene has heights and a wavelength.
    pub(super) fn relative_roughness(&self) -> Option<RelativeRoughness> {
        let surface = &self.parameters.surface;
        let (height, wavelength) = surface.rms_height.zip(self.parameters.illumination.wavelength)?;
        Some(RelativeRoughness {
            height: height.get() / wavelength.get(),
            // Only the height lobe reads it, and a scene with one has a correlation length.
            correlation_length: surface.correlation_length.map_or(0.0, |t| t.get() / wavelength.get()),
        })
    }

    /// The shadowing in force: the caller's, or the model's default.
    pub fn shadowing(&self) -> Shadowing {
        self.parameters.surface.shadowing.unwrap_or(match self.parameters.model {
            Model::BeckmannSpizzichino | Model::Lambertian => Shadowing::None,
            Model::TorranceSparrow | Model::Unified => Shadowing::VGroove,
        })
    }

    /// Over what F of the lobe is averaged: the caller's choice, or the half vector.
    pub fn fresnel_average(&self) -> FresnelAverage {
        self.parameters.surface.fresnel_average.unwrap_or(FresnelAverage::HalfVector)
    }

    /// Whether F has to be averaged over the slopes, which takes long.
    pub fn averages_slopes(&self) -> bool {
        self.fresnel_average() == FresnelAverage::SlopeAverage
            && self.parameters.surface.medium != Medium::PerfectConductor
            && self.evaluated.contains(&Component::SpecularLobe)
    }

    /// Beckmann's m of the facets of the lobe.
    pub(super) fn slope(&self) -> Option<BeckmannWidth> {
        self.parameters.surface.slope(self.parameters.model)
    }

    /// G of this surface.
    pub(super) fn shadowing_function(&self) -> ShadowingFunction {
        let shadowing = self.shadowing();
        let slope = if shadowing.needs_slope() { self.slope() } else { None };
        // A scene without a slope that its shadowing needs is none, or has no lobe that is shadowed.
        shadowing.of_slope(slope).unwrap_or(ShadowingFunction::None)
    }
}

fn facet_slope_radians(surface: &Surface) -> Option<f64> {
    if let Some(slope) = surface.facet_slope {
        return Some(super::degrees::to_radians(slope.get()));
    }
    let (height, length) = (surface.rms_height?, surface.correlation_length?);
    Some(roughness::facet_slope_radians(height.get() / length.get()))
}
