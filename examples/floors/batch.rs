//! The batch that is measured: a scene, and angles that have nothing in common.

use super::Failure;
use reflectance::reflectance::directions::{Angles, Directions};
use reflectance::reflectance::fresnel::{Medium, Polarization};
use reflectance::reflectance::numeric::lobe_series::Method;
use reflectance::reflectance::quantity::{Fraction, OutOfBounds, Quantity};
use reflectance::reflectance::scene::{
    Accuracy, Component, Components, Illumination, Model, Scene, SceneParameters, Surface,
};

/// Angles of N directions in degrees.
pub(crate) struct AngleColumns {
    pub(crate) theta_i: Vec<f64>,
    pub(crate) theta_r: Vec<f64>,
    pub(crate) phi_r: Vec<f64>,
}

/// Drawn evenly, the same at every call.
pub(crate) fn angles(count: usize) -> AngleColumns {
    let mut state = 0x2545_f491_4f6c_dd1d_u64;
    let mut draw = |least: f64, largest: f64| {
        // Xorshift, whose upper 53 bits make a double.
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        least + (largest - least) * ((state >> 11) as f64 / (1_u64 << 53) as f64)
    };
    let mut columns = AngleColumns { theta_i: Vec::new(), theta_r: Vec::new(), phi_r: Vec::new() };
    for _ in 0..count {
        columns.theta_i.push(draw(0.0, 80.0));
        columns.theta_r.push(draw(-80.0, 80.0));
        columns.phi_r.push(draw(-180.0, 180.0));
    }
    columns
}

/// As the core takes them.
pub(crate) fn directions(angles: &AngleColumns) -> Result<Directions, Failure> {
    let directions = Directions::new(each(&angles.theta_i)?, each(&angles.theta_r)?, each(&angles.phi_r)?);
    directions.map_err(|errors| format!("{errors:?}").into())
}

fn each<Q: Quantity>(degrees: &[f64]) -> Result<Angles<Q>, OutOfBounds> {
    Ok(Angles::Each(degrees.iter().map(|&angle| Q::new(angle)).collect::<Result<_, _>>()?))
}

/// The scene as a request writes it in JSON, without braces.
pub(crate) const SCENE_JSON: &str = r#""model":"beckmann_spizzichino","surface":{"rms_height_um":0.2,"correlation_length_um":4.0},"illumination":{"wavelength_um":0.55},"components":["specular_lobe"]"#;

/// The same scene in the core's terms.
pub(crate) fn scene() -> Result<Scene, Failure> {
    Scene::new(SceneParameters {
        model: Model::BeckmannSpizzichino,
        surface: Surface {
            rms_height: Some(Quantity::new(0.2)?),
            correlation_length: Some(Quantity::new(4.0)?),
            facet_slope: None,
            medium: Medium::PerfectConductor,
            diffuse_albedo: Fraction::ZERO,
            specular_scale: None,
            shadowing: None,
            fresnel_average: None,
        },
        illumination: Illumination {
            wavelength: Some(Quantity::new(0.55)?),
            irradiance: Quantity::new(1.0)?,
            polarization: Polarization::unpolarized(),
        },
        sensor: None,
        receiver: None,
        components: Components::Named(vec![Component::SpecularLobe]),
        accuracy: Accuracy { relative_tolerance: Quantity::new(1e-9)?, method: Method::Auto },
    })
    .map_err(|errors| format!("{errors:?}").into())
}
