//! What must not change an answer: the unit of length, and the side of the plane of incidence.

use reflectance::reflectance::directions::{Angles, Directions};
use reflectance::reflectance::evaluate::{Evaluation, Output, Quantity as Asked, evaluate};
use reflectance::reflectance::fresnel::{Medium, Polarization, RefractiveIndex};
use reflectance::reflectance::numeric::lobe_series::Method;
use reflectance::reflectance::quantity::{
    Area, Azimuth, CorrelationLength, Fraction, IndexK, IndexN, Irradiance, Length, Quantity, RmsHeight,
    SourceZenith, Tolerance, ViewerZenith, Wavelength,
};
use reflectance::reflectance::scene::{
    Accuracy, Components, Illumination, Model, Scene, SceneParameters, Sensor, Surface,
};

/// A scene of every component that the model has, its lengths times `unit`.
fn scene(model: Model, unit: f64) -> Scene {
    let length = |value: f64| value * unit;
    Scene::new(SceneParameters {
        model,
        surface: Surface {
            rms_height: Some(RmsHeight::new(length(0.11)).unwrap()),
            correlation_length: Some(CorrelationLength::new(length(2.0)).unwrap()),
            facet_slope: None,
            medium: Medium::Index(RefractiveIndex {
                n: IndexN::new(0.2).unwrap(),
                k: IndexK::new(3.4).unwrap(),
            }),
            diffuse_albedo: Fraction::new(0.3).unwrap(),
            specular_scale: None,
            shadowing: None,
            fresnel_average: None,
        },
        illumination: Illumination {
            wavelength: Some(Wavelength::new(length(0.55)).unwrap()),
            irradiance: Irradiance::new(2.0).unwrap(),
            polarization: Polarization::unpolarized(),
        },
        sensor: Some(Sensor::Patch {
            footprint: Area::new(length(20.0) * unit).unwrap(),
            half_x: Length::new(length(2.3)).unwrap(),
            half_y: Length::new(length(2.3)).unwrap(),
        }),
        receiver: None,
        components: Components::Named(model.components().to_vec()),
        accuracy: Accuracy { relative_tolerance: Tolerance::new(1e-12).unwrap(), method: Method::Series },
    })
    .unwrap()
}

/// Over the hemisphere, off the mirror direction's own symmetries.
fn around(sign: f64) -> Directions {
    let mut theta_r = Vec::new();
    let mut phi_r = Vec::new();
    for zenith in [0.0, 12.0, 33.0, 33.1, 70.0, 89.5] {
        for azimuth in [0.0, 0.5, 20.0, 90.0, 135.0, 180.0, 300.0] {
            theta_r.push(ViewerZenith::new(zenith).unwrap());
            phi_r.push(Azimuth::new(sign * azimuth).unwrap());
        }
    }
    let theta_i = Angles::One(SourceZenith::new(33.0).unwrap());
    Directions::new(theta_i, Angles::Each(theta_r), Angles::Each(phi_r)).unwrap()
}

fn answer(model: Model, unit: f64, sign: f64) -> Evaluation {
    let output = Output { log10: true, per_direction: false };
    evaluate(&scene(model, unit), &around(sign), Asked::Radiance, output)
}

#[test]
fn both_sides_of_the_plane_of_incidence_are_alike() {
    for model in Model::ALL {
        let (left, right) = (answer(model, 1.0, 1.0), answer(model, 1.0, -1.0));
        // To the bit: the azimuth enters by its cosine and squares only.
        assert_eq!(left.total, right.total, "{model:?}");
        for (a, b) in left.components.iter().zip(&right.components) {
            assert_eq!(a.values, b.values, "{model:?} {:?}", a.component);
        }
    }
}

#[test]
fn only_ratios_of_lengths_matter() {
    for model in Model::ALL {
        let plain = answer(model, 1.0, 1.0);
        // A power of two changes no digit.
        assert_eq!(plain.total, answer(model, 2f64.powi(100), 1.0).total, "{model:?}");
        // Any other factor rounds the inputs: each of six lengths by ε, which g, x and the phases of the spike multiply.
        let scaled = answer(model, 7.3, 1.0);
        for (index, (a, b)) in plain.total.iter().zip(&scaled.total).enumerate() {
            // The bound holds G_UNITS = 16 ε of g and more of x and phase: at least four times what the six roundings do.
            let slack = (plain.relative_error_bound[index] + scaled.relative_error_bound[index]) * a;
            assert!((a - b).abs() <= slack, "{model:?} {index}: {a} {b} {slack}");
        }
    }
}
