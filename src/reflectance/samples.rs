//! A scene that tests begin with.

use super::fresnel::{Medium, Polarization};
use super::numeric::lobe_series::Method;
use super::quantity::{
    CorrelationLength, Fraction, Irradiance, Quantity as _, RmsHeight, Tolerance, Wavelength,
};
use super::scene::{Accuracy, Components, Illumination, Model, SceneParameters, Surface};
use super::shadowing::Shadowing;

/// A perfect conductor of this σ_h/λ and T/λ, without shadowing.
pub(super) fn conductor(model: Model, lengths: [f64; 2], tolerance: f64) -> SceneParameters {
    SceneParameters {
        model,
        surface: Surface {
            rms_height: Some(RmsHeight::new(lengths[0]).unwrap()),
            correlation_length: Some(CorrelationLength::new(lengths[1]).unwrap()),
            facet_slope: None,
            medium: Medium::PerfectConductor,
            diffuse_albedo: Fraction::ZERO,
            specular_scale: None,
            shadowing: Some(Shadowing::None),
            fresnel_average: None,
        },
        illumination: Illumination {
            wavelength: Some(Wavelength::new(1.0).unwrap()),
            irradiance: Irradiance::new(1.0).unwrap(),
            polarization: Polarization::unpolarized(),
        },
        sensor: None,
        receiver: None,
        components: Components::Auto,
        accuracy: Accuracy { relative_tolerance: Tolerance::new(tolerance).unwrap(), method: Method::Auto },
    }
}
