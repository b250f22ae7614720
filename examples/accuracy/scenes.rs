//! Scenes and directions that have a given g and x.

use reflectance::reflectance::beckmann_spizzichino::RelativeRoughness;
use reflectance::reflectance::directions::{Angles, Directions};
use reflectance::reflectance::evaluate::{EvaluatedBy, Evaluation, Output, Quantity, evaluate};
use reflectance::reflectance::fresnel::{Medium, Polarization};
use reflectance::reflectance::numeric::lobe_series::Method;
use reflectance::reflectance::quantity::{
    Azimuth, CorrelationLength, Fraction, Irradiance, Quantity as InRange, RmsHeight, SourceZenith,
    Tolerance, ViewerZenith, Wavelength,
};
use reflectance::reflectance::scene::{
    Accuracy, Component, Components, Illumination, Model, Scene, SceneParameters, Surface,
};

/// A number in its range.
pub(crate) fn number<Q: InRange>(value: f64) -> Q {
    Q::new(value).unwrap_or_else(|_| panic!("{value} is outside of {}", Q::BOUNDS))
}

pub(crate) fn accuracy(method: Method, tolerance: f64) -> Accuracy {
    Accuracy { relative_tolerance: number(tolerance), method }
}

/// The lobe of (47) alone, wavelength 1.
pub(crate) fn lobe(roughness: RelativeRoughness, accuracy: Accuracy) -> Scene {
    Scene::new(SceneParameters {
        model: Model::BeckmannSpizzichino,
        surface: Surface {
            rms_height: Some(number::<RmsHeight>(roughness.height)),
            correlation_length: Some(number::<CorrelationLength>(roughness.correlation_length)),
            facet_slope: None,
            medium: Medium::PerfectConductor,
            diffuse_albedo: Fraction::ZERO,
            specular_scale: None,
            shadowing: None,
            fresnel_average: None,
        },
        illumination: Illumination {
            wavelength: Some(number::<Wavelength>(1.0)),
            irradiance: number::<Irradiance>(1.0),
            polarization: Polarization::unpolarized(),
        },
        sensor: None,
        receiver: None,
        components: Components::Named(vec![Component::SpecularLobe]),
        accuracy,
    })
    .unwrap_or_else(|errors| panic!("{errors:?}"))
}

/// Directions, each (θ_i, θ_r, φ_r).
pub(crate) fn directions(each: &[[f64; 3]]) -> Directions {
    Directions::new(
        Angles::Each(each.iter().map(|d| number::<SourceZenith>(d[0])).collect()),
        Angles::Each(each.iter().map(|d| number::<ViewerZenith>(d[1])).collect()),
        Angles::Each(each.iter().map(|d| number::<Azimuth>(d[2])).collect()),
    )
    .unwrap_or_else(|errors| panic!("{errors:?}"))
}

/// One direction in which height and length over the wavelength decide on g and x.
pub(crate) struct Probe {
    directions: Directions,
    /// g and x of σ_h = T = λ.
    unit: [f64; 2],
}

/// The shortest length.
const SHORTEST: f64 = 1e-60;

impl Probe {
    pub(crate) fn new() -> Self {
        let directions = directions(&[[0.0, 60.0, 0.0]]);
        let (geometry, one) =
            (directions.geometry(0), RelativeRoughness { height: 1.0, correlation_length: 1.0 });
        Self { unit: [one.g(&geometry), one.x(&geometry)], directions }
    }

    /// The lobe's radiance at (g, x); x = 0 is met to 1e-119.
    pub(crate) fn evaluate(&self, g: f64, x: f64, accuracy: Accuracy) -> Evaluation {
        let roughness = RelativeRoughness {
            height: (g / self.unit[0]).sqrt(),
            correlation_length: (x / self.unit[1]).sqrt().max(SHORTEST),
        };
        let output = Output { log10: false, per_direction: true };
        evaluate(&lobe(roughness, accuracy), &self.directions, Quantity::Radiance, output)
    }

    /// The same by `auto`, with what it takes.
    pub(crate) fn auto(&self, g: f64, x: f64, tolerance: f64) -> (Evaluation, Method) {
        let evaluation = self.evaluate(g, x, accuracy(Method::Auto, tolerance));
        let method = match evaluation.method.as_deref() {
            Some([EvaluatedBy::Lobe(method)]) => *method,
            other => panic!("one direction with a lobe was evaluated by {other:?}"),
        };
        (evaluation, method)
    }
}

/// The finest tolerance there is.
pub(crate) fn finest() -> f64 {
    Tolerance::FINEST.get()
}
