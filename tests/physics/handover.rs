//! The unified model in absolute units on real numbers: aluminium at 633 nm, from a mirror to a rough surface. What the spike
//! loses the lobe gains, in step with e^{−g}, and together they reflect what aluminium does.

use reflectance::reflectance::degrees::SinCos;
use reflectance::reflectance::directions::{Angles, Directions};
use reflectance::reflectance::evaluate::{Evaluation, Output, Quantity, evaluate};
use reflectance::reflectance::fresnel::{Medium, Polarization, RefractiveIndex};
use reflectance::reflectance::numeric::lobe_series::Method;
use reflectance::reflectance::quantity::{
    Azimuth, IndexK, IndexN, Quantity as InRange, SourceZenith, ViewerZenith,
};
use reflectance::reflectance::roughness::facet_slope_radians;
use reflectance::reflectance::scene::{
    Accuracy, Component, Components, Illumination, Model, Scene, SceneParameters, Sensor, Surface,
};
use reflectance::reflectance::shadowing::Shadowing;
use reflectance::reflectance::torrance_sparrow::normalized_scale;
use std::f64::consts::{PI, TAU};

const WAVELENGTH: f64 = 0.633;
/// A. D. Rakić, Appl. Opt. 34 (1995) 4755, at 633 nm.
const ALUMINIUM: [f64; 2] = [1.3735, 7.6179];
/// σ_h/T of three surfaces.
const SLOPES: [f64; 3] = [0.02, 0.05, 0.1];
/// σ_h/λ.
const HEIGHTS: [f64; 9] = [0.01, 0.05, 0.1, 0.15, 0.2, 0.3, 0.5, 1.0, 2.0];
/// Sides of the patch seen, micrometres.
const SIDE: f64 = 1000.0;
const TOLERANCE: f64 = 1e-12;

fn in_range<Q: InRange>(value: f64) -> Q {
    Q::new(value).expect("a number in range")
}

fn aluminium() -> Medium {
    let [n, k] = ALUMINIUM;
    Medium::Index(RefractiveIndex { n: in_range::<IndexN>(n), k: in_range::<IndexK>(k) })
}

/// The component of a surface of σ_h/λ and σ_h/T; `footprint` is what the sensor sees across its line of sight.
fn scene(medium: Medium, component: Component, height: f64, slope: f64, footprint: f64) -> Scene {
    let height = height * WAVELENGTH;
    Scene::new(SceneParameters {
        model: Model::Unified,
        surface: Surface {
            rms_height: Some(in_range(height)),
            correlation_length: Some(in_range(height / slope)),
            facet_slope: None,
            medium,
            diffuse_albedo: in_range(0.0),
            specular_scale: None,
            shadowing: Some(Shadowing::None),
            fresnel_average: None,
        },
        illumination: Illumination {
            wavelength: Some(in_range(WAVELENGTH)),
            irradiance: in_range(1.0),
            polarization: Polarization::unpolarized(),
        },
        sensor: Some(Sensor::Patch {
            footprint: in_range(footprint),
            half_x: in_range(0.5 * SIDE),
            half_y: in_range(0.5 * SIDE),
        }),
        receiver: None,
        components: Components::Named(vec![component]),
        accuracy: Accuracy { relative_tolerance: in_range(TOLERANCE), method: Method::Auto },
    })
    .expect("a scene that fits together")
}

fn brdf(scene: &Scene, theta_i: f64, theta_r: Vec<f64>, phi_r: Vec<f64>) -> Evaluation {
    let directions = Directions::new(
        Angles::One(in_range::<SourceZenith>(theta_i)),
        Angles::Each(theta_r.into_iter().map(in_range::<ViewerZenith>).collect()),
        Angles::Each(phi_r.into_iter().map(in_range::<Azimuth>).collect()),
    )
    .expect("directions");
    evaluate(scene, &directions, Quantity::Brdf, Output::default())
}

fn share(height: f64, theta_i: f64) -> f64 {
    let phase = 4.0 * PI * height * SinCos::of_degrees(theta_i).cos;
    (-phase * phase).exp()
}

/// The spike's power over the incident one: its BRDF in the mirror direction times cos θ_r times the solid angle of the
/// patch's diffraction, λ²/(A cos θ_r), over which ∫ρ_o² adds up.
fn spike(medium: Medium, height: f64, theta_i: f64) -> f64 {
    let cos = SinCos::of_degrees(theta_i).cos;
    let area = SIDE * SIDE;
    let scene = scene(medium, Component::SpecularSpike, height, 0.1, area * cos);
    brdf(&scene, theta_i, vec![theta_i], vec![0.0]).total[0] * WAVELENGTH * WAVELENGTH / area
}

/// The lobe's: its BRDF times cos θ_r over the views, each the mirror direction of a facet, dω_r = 4 cos θ′ dω.
fn lobe(medium: Medium, height: f64, slope: f64, theta_i: f64) -> f64 {
    const RINGS: u32 = 96;
    const AROUND: u32 = 48;
    let source = SinCos::of_degrees(theta_i);
    let sigma = facet_slope_radians(slope);
    let end = (9.0 * sigma).min(0.5 * PI);
    let (mut theta_r, mut phi_r, mut weights) = (Vec::new(), Vec::new(), Vec::new());
    for ring in 0..RINGS {
        // tanh spreads the midpoints so that both ends count for nothing, and the rule converges like one without ends.
        let t = (f64::from(ring) + 0.5) / f64::from(RINGS) * 6.4 - 3.2;
        let u = 0.5 * PI * t.sinh();
        let alpha = 0.5 * end * (1.0 + u.tanh());
        let step = 6.4 / f64::from(RINGS) * 0.25 * PI * end * t.cosh() / u.cosh().powi(2);
        let (sin, cos) = alpha.sin_cos();
        for place in 0..AROUND {
            let (sin_psi, cos_psi) = (TAU * (f64::from(place) + 0.5) / f64::from(AROUND)).sin_cos();
            let local = source.cos * cos + source.sin * sin * cos_psi;
            let up = 2.0 * local * cos - source.cos;
            if local <= 0.0 || up <= 0.0 {
                continue;
            }
            // The source lies at −x.
            let along = source.sin - 2.0 * local * sin * cos_psi;
            let across = 2.0 * local * sin * sin_psi;
            theta_r.push(across.hypot(along).atan2(up).to_degrees().min(90.0));
            phi_r.push(across.atan2(along).to_degrees());
            weights.push(4.0 * local * up * sin * step * TAU / f64::from(AROUND));
        }
    }
    let scene = scene(medium, Component::SpecularLobe, height, slope, SIDE * SIDE);
    let found = brdf(&scene, theta_i, theta_r, phi_r).total;
    found.iter().zip(&weights).map(|(brdf, weight)| brdf * weight).sum()
}

/// What facets that do not send the light up are of all, and those beyond the rule's end: theirs is the tail of
/// exp(−α²/2σ_α²) from where a facet mirrors the source to the horizon, times 1/cos θ_i at most.
fn lost(slope: f64, theta_i: f64) -> f64 {
    let last = (45.0 - 0.5 * theta_i).to_radians() / facet_slope_radians(slope);
    2.0 * (-0.5 * last * last).exp()
}

/// What the rule over the facets is off by: measured below 1e-12.
const RULE: f64 = 1e-11;

#[test]
fn of_a_perfect_conductor_spike_and_lobe_share_all_the_light() {
    for slope in SLOPES {
        for theta_i in [0.0, 20.0, 40.0] {
            for height in HEIGHTS {
                let e = share(height, theta_i);
                let spike = spike(Medium::PerfectConductor, height, theta_i);
                // The bound, and of e^{−g} the condition g on a few roundings.
                let g = -e.ln();
                assert!(
                    (spike - e).abs() <= e * (2.0 * TOLERANCE + 8.0 * g * f64::EPSILON),
                    "{height} {spike} {e}"
                );
                let lobe = lobe(Medium::PerfectConductor, height, slope, theta_i);
                let slack = (1.0 - e) * (lost(slope, theta_i) + RULE);
                assert!((lobe - (1.0 - e)).abs() <= slack, "{slope} {theta_i} {height}: {lobe} {}", 1.0 - e);
            }
        }
    }
}

#[test]
fn aluminium_hands_over_from_spike_to_lobe_in_step_with_e_to_the_minus_g() {
    let mix = Polarization::unpolarized();
    for slope in SLOPES {
        for theta_i in [0.0, 20.0, 40.0] {
            let mean_plane = aluminium().reflectance(SinCos::of_degrees(theta_i), mix).value;
            // F′ of all facets that count: those within the slopes that are not lost.
            let sigma = facet_slope_radians(slope).to_degrees();
            let within = (6.0 * sigma).min(45.0 - 0.5 * theta_i);
            let between = |from: f64, to: f64| {
                (0..=100).map(move |i| from + (to - from) * 0.01 * f64::from(i)).map(|angle| {
                    aluminium().reflectance(SinCos::of_degrees(angle.clamp(0.0, 90.0)), mix).value
                })
            };
            let (from, to) = ((theta_i - within).max(0.0), theta_i + within);
            let least = between(from, to).fold(f64::INFINITY, f64::min);
            let most = between(from, to).fold(0.0, f64::max);
            // e^{−18} of them are steeper than six deviations.
            let slack = lost(slope, theta_i) + 2.0 * (-18f64).exp() + RULE;
            let mut before = 1.0;
            for height in HEIGHTS {
                let e = share(height, theta_i);
                let (spike, lobe) =
                    (spike(aluminium(), height, theta_i), lobe(aluminium(), height, slope, theta_i));
                assert!((spike / mean_plane - e).abs() <= e * 1e-10, "{height} {spike} {e}");
                let of_lobe = lobe / (1.0 - e);
                assert!(
                    least - slack <= of_lobe && of_lobe <= most + slack,
                    "{slope} {theta_i} {height}: {least} {of_lobe} {most}"
                );
                // The share of the spike in what is reflected follows e^{−g} as far as F′ is the same for both.
                let of_spike = spike / (spike + lobe);
                let apart = (most - least) / least + slack;
                assert!(
                    (of_spike - e).abs() <= apart * e * (1.0 - e) * (1.0 + 2.0 * apart) + 1e-10,
                    "{of_spike} {e}"
                );
                assert!(of_spike < before || of_spike == 0.0);
                before = of_spike;
            }
        }
    }
}

#[test]
fn the_mirror_reflects_what_aluminium_does() {
    // |(1 − Y)/(1 + Y)|² of 1.3735 − 7.6179i: ((n − 1)² + k²)/((n + 1)² + k²).
    let [n, k] = ALUMINIUM;
    let expected = ((n - 1.0).powi(2) + k * k) / ((n + 1.0).powi(2) + k * k);
    let found = spike(aluminium(), 1e-6, 0.0);
    // 1 − e^{−g} is 1.6e-10.
    assert!((found / expected - 1.0).abs() < 1e-9, "{found} {expected}");
    assert!((expected - 0.9137).abs() < 5e-4, "{expected}");
}

#[test]
fn the_spike_has_the_mean_planes_fresnel_coefficient_and_the_lobe_the_facets() {
    // Around the mirror direction of 60°, where parallel light tells the angles apart.
    let viewers = [59.6, 60.0, 60.4];
    let of = |component: Component, medium: Medium| -> Vec<f64> {
        let mut parameters = scene(medium, component, 0.05, 0.02, 400.0).parameters().clone();
        parameters.illumination.polarization = Polarization::parallel();
        let small =
            Sensor::Patch { footprint: in_range(400.0), half_x: in_range(10.0), half_y: in_range(10.0) };
        parameters.sensor = Some(small);
        let scene = Scene::new(parameters).expect("a scene");
        brdf(&scene, 60.0, viewers.to_vec(), vec![0.0; 3]).total
    };
    let reflectance = |component| -> Vec<f64> {
        let (finite, perfect) = (of(component, aluminium()), of(component, Medium::PerfectConductor));
        finite.iter().zip(&perfect).map(|(finite, perfect)| finite / perfect).collect()
    };
    let at =
        |degrees: f64| aluminium().reflectance(SinCos::of_degrees(degrees), Polarization::parallel()).value;
    let (spike, lobe) = (reflectance(Component::SpecularSpike), reflectance(Component::SpecularLobe));
    for (place, viewer) in viewers.iter().enumerate() {
        // Both bounds are of the tolerance.
        assert!((spike[place] / at(60.0) - 1.0).abs() < 4.0 * TOLERANCE, "{spike:?}");
        assert!((lobe[place] / at(0.5 * (60.0 + viewer)) - 1.0).abs() < 4.0 * TOLERANCE, "{lobe:?}");
    }
    // And they do differ.
    assert!((at(59.8) / at(60.0) - 1.0).abs() > 1e-5);
}

#[test]
fn the_tiling_scale_is_what_makes_units_absolute() {
    // Without it the lobe would have no more than a shape: c·a_f is that of facets whose projections add up to the plane.
    let height = 0.3;
    let scene = scene(Medium::PerfectConductor, Component::SpecularLobe, height, 0.05, SIDE * SIDE);
    let found = brdf(&scene, 30.0, vec![30.0], vec![0.0]).total[0];
    let cos = SinCos::of_degrees(30.0).cos;
    let expected =
        0.25 * normalized_scale(facet_slope_radians(0.05)) / (cos * cos) * (1.0 - share(height, 30.0));
    assert!((found / expected - 1.0).abs() < 2.0 * TOLERANCE, "{found} {expected}");
}
