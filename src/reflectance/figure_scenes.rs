//! The scenes behind the presets of [`super::figures`].

use super::bounds::DEFAULT_TOLERANCE;
use super::fresnel::{Medium, Polarization};
use super::numeric::lobe_series::Method;
use super::quantity::{
    Area, CorrelationLength, FacetSlope, Fraction, Irradiance, Length, OutOfBounds, Quantity, RmsHeight,
    SpecularScale, Tolerance, Wavelength,
};
use super::scene::{
    Accuracy, Component, Components, Illumination, Model, Scene, SceneParameters, Sensor, Surface,
};
use super::shadowing::Shadowing;

/// A Beckmann-Spizzichino scene of σ_h, T, λ in µm, with X = Y = 10 and footprint 400.
pub(super) fn beckmann_spizzichino(
    [sigma_h, t, lambda]: [f64; 3],
    components: &[Component],
    method: Method,
) -> Result<Scene, OutOfBounds> {
    Ok(Scene::preset(SceneParameters {
        model: Model::BeckmannSpizzichino,
        surface: Surface {
            rms_height: Some(RmsHeight::new(sigma_h)?),
            correlation_length: Some(CorrelationLength::new(t)?),
            ..bare()?
        },
        illumination: light(Some(Wavelength::new(lambda)?))?,
        sensor: Some(sensor()?),
        receiver: None,
        components: Components::Named(components.to_vec()),
        accuracy: Accuracy { relative_tolerance: Tolerance::new(DEFAULT_TOLERANCE)?, method },
    }))
}

/// A Torrance-Sparrow lobe with F = 1 and G = 1; without a c·a_f its facets tile the mean plane.
pub(super) fn torrance_sparrow(
    facet_slope: FacetSlope,
    specular_scale: Option<SpecularScale>,
) -> Result<Scene, OutOfBounds> {
    Ok(Scene::preset(SceneParameters {
        model: Model::TorranceSparrow,
        surface: Surface {
            facet_slope: Some(facet_slope),
            specular_scale,
            shadowing: Some(Shadowing::None),
            fresnel_average: None,
            ..bare()?
        },
        illumination: light(None)?,
        sensor: None,
        receiver: None,
        components: Components::Named(vec![Component::SpecularLobe]),
        accuracy: Accuracy { relative_tolerance: Tolerance::new(DEFAULT_TOLERANCE)?, method: Method::Auto },
    }))
}

fn bare() -> Result<Surface, OutOfBounds> {
    Ok(Surface {
        rms_height: None,
        correlation_length: None,
        facet_slope: None,
        medium: Medium::PerfectConductor,
        diffuse_albedo: Fraction::new(0.0)?,
        specular_scale: None,
        shadowing: None,
        fresnel_average: None,
    })
}

fn light(wavelength: Option<Wavelength>) -> Result<Illumination, OutOfBounds> {
    Ok(Illumination {
        wavelength,
        irradiance: Irradiance::new(1.0)?,
        polarization: Polarization::unpolarized(),
    })
}

fn sensor() -> Result<Sensor, OutOfBounds> {
    Ok(Sensor::Patch { footprint: Area::new(400.0)?, half_x: Length::new(10.0)?, half_y: Length::new(10.0)? })
}

/// Figures 22 and 24: the report draws the components without numbers. Chosen so that all three
/// show: e^{-g} is 3 % at 30°, the lobe 9° wide, and half of the light is scattered diffusely.
pub(super) mod components_of_section_5 {
    use super::{
        Accuracy, Area, Components, CorrelationLength, DEFAULT_TOLERANCE, Fraction, Length, Method, Model,
        OutOfBounds, Quantity, RmsHeight, Scene, SceneParameters, Sensor, Surface, Tolerance, Wavelength,
        bare, light,
    };

    /// The parameters in words.
    pub(in super::super) const PARAMETERS: &str = "σ_h = 0.086, T = 0.7, λ = 0.5, ρ = 0.5, X = Y = 2, footprint 16, θ = 30°: chosen here, the report names none";
    /// The fixed angle, degrees.
    pub(in super::super) const FIXED_ANGLE: f64 = 30.0;

    /// The scene.
    pub(in super::super) fn scene() -> Result<Scene, OutOfBounds> {
        Ok(Scene::preset(SceneParameters {
            model: Model::Unified,
            surface: Surface {
                rms_height: Some(RmsHeight::new(0.086)?),
                correlation_length: Some(CorrelationLength::new(0.7)?),
                diffuse_albedo: Fraction::new(0.5)?,
                ..bare()?
            },
            illumination: light(Some(Wavelength::new(0.5)?))?,
            receiver: None,
            sensor: Some(Sensor::Patch {
                footprint: Area::new(16.0)?,
                half_x: Length::new(2.0)?,
                half_y: Length::new(2.0)?,
            }),
            components: Components::Auto,
            accuracy: Accuracy {
                relative_tolerance: Tolerance::new(DEFAULT_TOLERANCE)?,
                method: Method::Auto,
            },
        }))
    }
}
