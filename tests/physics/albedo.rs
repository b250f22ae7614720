//! Albedos against the figures of errata E19, against a grid over the viewers, and against themselves.

use crate::random::{self, Random};
use reflectance::reflectance::albedo::{Albedo, AlbedoScene};
use reflectance::reflectance::directions::{Angles, Directions};
use reflectance::reflectance::evaluate::{Output, Quantity, evaluate};
use reflectance::reflectance::fresnel::{Medium, Polarization, RefractiveIndex};
use reflectance::reflectance::fresnel_average::FresnelAverage;
use reflectance::reflectance::numeric::lobe_series::Method;
use reflectance::reflectance::quantity::{
    Azimuth, Fraction, Irradiance, Quantity as InRange, SourceZenith, ViewerZenith,
};
use reflectance::reflectance::scene::{
    Accuracy, Component, Components, Illumination, Model, Scene, SceneParameters, Surface,
};
use reflectance::reflectance::shadowing::Shadowing;

fn in_range<Q: InRange>(value: f64) -> Q {
    Q::new(value).expect("in range")
}

/// Lengths in wavelengths, a perfect conductor without shadowing.
pub(crate) fn conductor(model: Model, height: f64, length: f64) -> SceneParameters {
    SceneParameters {
        model,
        surface: Surface {
            rms_height: Some(in_range(height)),
            correlation_length: Some(in_range(length)),
            facet_slope: None,
            medium: Medium::PerfectConductor,
            diffuse_albedo: Fraction::ZERO,
            specular_scale: None,
            shadowing: Some(Shadowing::None),
            fresnel_average: None,
        },
        illumination: Illumination {
            wavelength: Some(in_range(1.0)),
            irradiance: Irradiance::new(1.0).expect("in range"),
            polarization: Polarization::unpolarized(),
        },
        sensor: None,
        receiver: None,
        components: Components::Auto,
        accuracy: Accuracy { relative_tolerance: in_range(1e-6), method: Method::Auto },
    }
}

pub(crate) fn to_tolerance(parameters: &SceneParameters, tolerance: f64) -> AlbedoScene {
    let accuracy = Accuracy { relative_tolerance: in_range(tolerance), ..parameters.accuracy };
    AlbedoScene::new(SceneParameters { accuracy, ..parameters.clone() }).expect("a scene")
}

pub(crate) fn at(scene: &AlbedoScene, theta_i: f64) -> Albedo {
    scene.at(in_range(theta_i), || false).expect("nobody stops it")
}

pub(crate) fn total(albedo: &Albedo) -> (f64, f64) {
    (albedo.total.value.to_f64(), albedo.total.error.to_f64())
}

#[test]
fn spike_and_lobe_have_the_figures_of_erratum_e19() {
    // To half of the last digit printed there.
    for (height, length, degrees, printed, half_digit) in [
        (0.05, 5.0, 0.0, 1.0, 5e-6),
        (0.05, 10.0, 0.0, 1.0, 5e-6),
        (1.0, 10.0, 45.0, 0.998, 5e-4),
        (1.0, 10.0, 75.0, 0.964, 5e-4),
        (0.5, 1.5, 0.0, 0.88, 5e-3),
    ] {
        let albedo = at(&to_tolerance(&conductor(Model::BeckmannSpizzichino, height, length), 1e-8), degrees);
        let (value, error) = total(&albedo);
        assert!((value - printed).abs() < half_digit + error, "{height} {length} {degrees}: {value}");
        assert!(error <= 1e-8 * value, "{error}");
    }
}

#[test]
fn facets_without_shadowing_reach_the_figure_of_the_issue() {
    // m = 2σ_h/T = 0.3 at 85°: 1.53 of the lobe (49), and of (70) by (79) nearly as much.
    let heights = to_tolerance(&conductor(Model::BeckmannSpizzichino, 150.0, 1000.0), 1e-6);
    let (value, _) = total(&at(&heights, 85.0));
    assert!((value - 1.53).abs() < 5e-3, "{value}");
    let codes = |scene: &AlbedoScene, theta_i: f64| -> Vec<_> {
        let (source, albedo) = (in_range::<SourceZenith>(theta_i), at(scene, theta_i));
        scene.warnings(&[source], &[albedo]).iter().map(|warning| warning.code.name()).collect()
    };
    let facets = to_tolerance(&conductor(Model::TorranceSparrow, 150.0, 1000.0), 1e-6);
    assert!(codes(&heights, 85.0).contains(&"energy_above_one"));
    assert!(codes(&facets, 85.0).contains(&"energy_above_one"));
    assert!(!codes(&heights, 45.0).contains(&"energy_above_one"));
    // σ_h/T = 1/3 at normal incidence loses 12 %.
    let steep = to_tolerance(&conductor(Model::BeckmannSpizzichino, 0.5, 1.5), 1e-6);
    assert_eq!(codes(&steep, 0.0).iter().filter(|&&code| code == "energy_lost").count(), 1);
    assert!(!codes(&heights, 0.0).contains(&"energy_lost"));
}

/// ∫ f_r cos θ_r dω_r of the specular lobe by the midpoint rule, `fineness` points a side of the hemisphere, and its BRDF
/// as radiance requests answer it.
fn on_a_grid(scene: &Scene, theta_i: f64, fineness: u32) -> f64 {
    let step = 90.0 / f64::from(fineness);
    let zeniths: Vec<f64> = (0..fineness).map(|i| step * (f64::from(i) + 0.5)).collect();
    let azimuths: Vec<f64> =
        (0..fineness).map(|i| 180.0 * (f64::from(i) + 0.5) / f64::from(fineness)).collect();
    let (mut theta_r, mut phi_r) = (Vec::new(), Vec::new());
    for &zenith in &zeniths {
        for &azimuth in &azimuths {
            theta_r.push(in_range::<ViewerZenith>(zenith));
            phi_r.push(in_range::<Azimuth>(azimuth));
        }
    }
    let source = Angles::One(in_range::<SourceZenith>(theta_i));
    let directions = Directions::new(source, Angles::Each(theta_r), Angles::Each(phi_r)).expect("directions");
    let brdf = evaluate(scene, &directions, Quantity::Brdf, Output::default()).total;
    let area = 2.0 * step.to_radians() * core::f64::consts::PI / f64::from(fineness);
    let mut sum = 0.0;
    for (row, zenith) in brdf.chunks(azimuths.len()).zip(&zeniths) {
        let (sin, cos) = zenith.to_radians().sin_cos();
        sum += row.iter().sum::<f64>() * sin * cos;
    }
    sum * area
}

#[test]
fn a_grid_over_the_viewers_finds_the_same() {
    let mut random = Random::new(7);
    let mut compared = 0;
    while compared < 16 {
        let mut parameters = random::scene(&mut random);
        parameters.sensor = None;
        parameters.components = Components::Named(vec![Component::SpecularLobe]);
        let theta_i = [0.0, 20.0, 50.0, 70.0, 80.0][random.index(5)];
        let Ok(scene) = Scene::new(parameters.clone()) else { continue };
        let (coarse, fine) = (on_a_grid(&scene, theta_i, 120), on_a_grid(&scene, theta_i, 240));
        // Where the grid resolves the lobe; a factor of four a halving, and kinks somewhat less.
        let slack = (fine - coarse).abs();
        if !fine.is_normal() || slack > 0.02 * fine {
            continue;
        }
        compared += 1;
        let (value, error) = total(&at(&to_tolerance(&parameters, 1e-6), theta_i));
        assert!(
            (value - fine).abs() <= slack + error + 1e-5 * fine,
            "{parameters:?} {theta_i}: {value} {fine} {slack}"
        );
    }
}

#[test]
fn no_bound_is_exceeded() {
    let mut random = Random::new(11);
    let (mut worst, mut met, mut count): (f64, _, _) = (0.0, 0, 0);
    for round in 0..60 {
        let mut parameters = random::scene(&mut random);
        parameters.sensor = None;
        if round % 3 == 0 {
            random::extreme(&mut parameters, &mut random);
        }
        let theta_i = match random.index(5) {
            0 => 90.0 - 10f64.powi(-i32::try_from(random.index(14)).expect("small")),
            1 => [0.0, 90.0, 45.0, 30.0, 60.0][random.index(5)],
            _ => 0.09 * random.index(1000) as f64,
        };
        let exact = at(&to_tolerance(&parameters, 1e-9), theta_i);
        let (best, best_error) = total(&exact);
        if !best.is_finite() {
            assert_eq!(theta_i, 90.0, "{parameters:?}");
            continue;
        }
        for tolerance in [1e-2, 1e-5] {
            let albedo = at(&to_tolerance(&parameters, tolerance), theta_i);
            let (value, error) = total(&albedo);
            let off = (value - best).abs();
            assert!(
                off <= error + best_error,
                "{parameters:?} {theta_i} {tolerance}: {value} {best} {error}"
            );
            count += 1;
            met += usize::from(albedo.total.relative_error() <= tolerance);
            if error > 100.0 * best_error {
                worst = worst.max(off / error);
            }
        }
    }
    // Nearly all keep the tolerance; the bound is no idle one, nor near its end.
    println!("{met} of {count} keep the tolerance, the worst error is {worst} of its bound");
    assert!(met * 100 >= count * 98, "{met} of {count}");
    assert!(worst > 1e-3 && worst < 0.9, "{worst}");
}

#[test]
fn smiths_shadowing_keeps_the_energy_below_one() {
    // Where facets are seen only by what is left of them, no source gets more back than it sent: the coherent part takes
    // e^{−g} of it, and near grazing the lobe of the rough part is what the facets have.
    for shadowing in [Shadowing::Smith, Shadowing::SmithUncorrelated] {
        for (height, length) in [(150.0, 1000.0), (50.0, 1000.0), (500.0, 1000.0)] {
            let mut parameters = conductor(Model::BeckmannSpizzichino, height, length);
            parameters.surface.shadowing = Some(shadowing);
            parameters.components = Components::Named(vec![Component::SpecularLobe]);
            let scene = to_tolerance(&parameters, 1e-6);
            let values = [0.0, 45.0, 75.0, 85.0, 89.0, 90.0].map(|theta_i| total(&at(&scene, theta_i)).0);
            // (49) is off by the order of 1/g, which is above 10³ up to 89°.
            assert!(values.iter().all(|&value| value > 0.4 && value < 1.001), "{shadowing:?} {values:?}");
        }
    }
}

#[test]
fn readings_of_the_fresnel_average_factor_out() {
    let mut parameters = conductor(Model::BeckmannSpizzichino, 2.0, 20.0);
    parameters.components = Components::Named(vec![Component::SpecularLobe]);
    let bare = total(&at(&to_tolerance(&parameters, 1e-9), 60.0));
    parameters.surface.medium = Medium::Index(RefractiveIndex { n: in_range(1.37), k: in_range(7.62) });
    let of = |average: FresnelAverage| {
        let mut parameters = parameters.clone();
        parameters.surface.fresnel_average = Some(average);
        at(&to_tolerance(&parameters, 1e-9), 60.0)
    };
    let plane = of(FresnelAverage::MeanPlane);
    let (value, error) = total(&plane);
    assert!((value - bare.0 * plane.fresnel).abs() <= error + bare.1, "{value} {bare:?}");
    // Aluminium reflects so evenly that the readings differ by less than a hundredth.
    for average in [FresnelAverage::HalfVector, FresnelAverage::SlopeAverage] {
        let (other, _) = total(&of(average));
        assert!(other != value && (other / value - 1.0).abs() < 0.01, "{average:?} {other} {value}");
    }
}

#[test]
fn shares_are_those_of_the_closed_forms() {
    // A unified surface with every part: ρ, F′(1 − e^{−g}) of facets so gentle that F′ and cos are those of the plate, F′ e^{−g}.
    let mut parameters = conductor(Model::Unified, 0.05, 50_000.0);
    parameters.surface.diffuse_albedo = in_range(0.2);
    let albedo = at(&to_tolerance(&parameters, 1e-9), 40.0);
    let g = (4.0 * core::f64::consts::PI * 0.05 * 40f64.to_radians().cos()).powi(2);
    let part = |component: Component| albedo.components[component as usize].expect("there").value.to_f64();
    assert!((part(Component::DiffuseLobe) - 0.2).abs() < 1e-15);
    assert!((part(Component::SpecularSpike) - (-g).exp()).abs() < 1e-14);
    // Facets of width 2e-6 change it by the square of that.
    assert!((part(Component::SpecularLobe) + (-g).exp_m1()).abs() < 1e-9);
    assert!((albedo.scattered.expect("g is known") + (-g).exp_m1()).abs() < 1e-14);
    let scene = to_tolerance(&parameters, 1e-9);
    assert!(scene.excess(&albedo).expect("both are there").abs() < 1e-9);
    let [spike, lobe] = AlbedoScene::shares_of(&albedo).expect("both are there");
    assert!((spike - (-g).exp()).abs() < 1e-9 && (spike + lobe - 1.0).abs() < 1e-15);
}

#[test]
fn radiance_requests_are_warned_where_the_albedo_is_above_one() {
    // Of directions near a mirror direction, whatever the regime: the coarse albedo of warnings against the integral.
    let mut random = Random::new(3);
    let (mut warned, mut calm) = (0, 0);
    for _ in 0..150 {
        let length = 10f64.powf(0.5 + 0.01 * random.index(200) as f64);
        let height = length * 0.01 * (1 + random.index(30)) as f64;
        let shadowing = [Shadowing::None, Shadowing::VGroove, Shadowing::Smith][random.index(3)];
        let model = [Model::BeckmannSpizzichino, Model::TorranceSparrow][random.index(2)];
        let theta_i = random.index(86) as f64;
        let mut parameters = conductor(model, height, length);
        parameters.surface.shadowing = Some(shadowing);
        let (albedo, _) = total(&at(&to_tolerance(&parameters, 1e-3), theta_i));
        let scene = Scene::new(parameters.clone()).expect("a scene");
        let one = |theta: f64| Angles::One(in_range(theta));
        let directions =
            Directions::new(one(theta_i), Angles::One(in_range(theta_i)), Angles::One(in_range(0.0)));
        let directions = directions.expect("directions");
        let evaluation = evaluate(&scene, &directions, Quantity::Radiance, Output::default());
        let is_warned = evaluation.warnings.iter().any(|warning| warning.code.name() == "energy_above_one");
        // 1.05, and what the coarse albedo may be off by.
        if albedo > 1.11 {
            assert!(is_warned, "{parameters:?} {theta_i}: {albedo}");
            warned += 1;
        } else if albedo < 1.0 {
            assert!(!is_warned, "{parameters:?} {theta_i}: {albedo}");
            calm += 1;
        }
    }
    assert!(warned > 5 && calm > 50, "{warned} {calm}");
}
