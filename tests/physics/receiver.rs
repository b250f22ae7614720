//! What a receiver of finite size reads, against sums over the viewers in its cone.

use crate::random::{Random, scene};
use reflectance::reflectance::directions::{Angles, Directions};
use reflectance::reflectance::evaluate::{Output, Quantity, evaluate};
use reflectance::reflectance::quantity::{
    Azimuth, Fraction, Quantity as InRange, ReceiverHalfAngle, SourceZenith, ViewerZenith,
};
use reflectance::reflectance::scene::{Component, Components, Model, Scene, SceneParameters};
use std::f64::consts::{FRAC_PI_2, PI, TAU};

fn in_range<Q: InRange>(value: f64) -> Q {
    Q::new(value.clamp(Q::BOUNDS.min, Q::BOUNDS.max)).unwrap()
}

fn one(theta_i: f64, theta_r: f64, phi_r: f64) -> Directions {
    let (i, r, phi) = (in_range(theta_i), in_range(theta_r), in_range(phi_r));
    Directions::new(Angles::One(i), Angles::One(r), Angles::One(phi)).unwrap()
}

/// Means over the cone, weighted with cos θ_r: rings at the middles of equal parts of sin² ρ, `n` of them with 2`n` viewers each,
/// and what is below the horizon left out.
fn summed(scene: &Scene, [theta_i, theta_r, phi_r]: [f64; 3], beta: f64, n: u32) -> f64 {
    let (theta, phi) = (theta_r.to_radians(), phi_r.to_radians());
    let (mut weights, mut zeniths, mut azimuths) = (Vec::new(), Vec::new(), Vec::new());
    for ring in 0..n {
        let share = (f64::from(ring) + 0.5) / f64::from(n);
        // sin² (ρ/2) evenly: equal solid angles.
        let rho = 2.0 * ((beta.to_radians() / 2.0).sin() * share.sqrt()).asin();
        for spoke in 0..2 * n {
            let omega = TAU * (f64::from(spoke) + 0.5 * f64::from(ring % 2)) / f64::from(2 * n);
            let (level, across) = (rho.sin() * omega.cos(), rho.sin() * omega.sin());
            let outwards = theta.sin() * rho.cos() + theta.cos() * level;
            let cos = theta.cos() * rho.cos() - theta.sin() * level;
            if cos <= 0.0 {
                continue;
            }
            weights.push(cos);
            zeniths.push(in_range::<ViewerZenith>(
                outwards.hypot(across).atan2(cos).min(FRAC_PI_2).to_degrees(),
            ));
            azimuths.push(in_range::<Azimuth>((phi + across.atan2(outwards)).to_degrees()));
        }
    }
    let source = Angles::One(in_range::<SourceZenith>(theta_i));
    let directions = Directions::new(source, Angles::Each(zeniths), Angles::Each(azimuths)).unwrap();
    let found = evaluate(scene, &directions, Quantity::Brdf, Output::default());
    let sum: f64 = found.total.iter().zip(&weights).map(|(value, weight)| value * weight).sum();
    sum / weights.iter().sum::<f64>()
}

#[test]
fn a_mean_over_a_cone_is_a_sum_over_its_viewers() {
    let mut random = Random::new(41);
    for case in 0..24 {
        let mut p = scene(&mut random);
        p.sensor = None;
        p.accuracy.relative_tolerance = in_range(1e-5);
        let lobes = p.model.components().iter().copied().filter(|&c| c != Component::SpecularSpike);
        p.components = Components::Named(lobes.collect());
        // A lobe as wide as the rings are apart, at least.
        let height = p.surface.rms_height.unwrap().get();
        p.surface.correlation_length = Some(in_range(height.min(1.0) * 5.0));
        p.surface.facet_slope = Some(in_range(10.0));
        let theta_i = [0.0, 20.0, 50.0, 75.0][random.index(4)];
        let theta_r = [0.0, 30.0, -40.0, 75.0, 88.0][random.index(5)];
        let phi = [0.0, 25.0, 170.0][random.index(3)];
        let beta = [0.5, 3.0, 15.0][random.index(3)];
        let point = Scene::new(p.clone()).unwrap();
        let [coarse, fine] = [60, 120].map(|n| summed(&point, [theta_i, theta_r, phi], beta, n));
        p.receiver = Some(ReceiverHalfAngle::new(beta).unwrap());
        let found = evaluate(
            &Scene::new(p.clone()).unwrap(),
            &one(theta_i, theta_r, phi),
            Quantity::Brdf,
            Output::default(),
        );
        let (value, bound) = (found.total[0], found.relative_error_bound[0] * found.total[0]);
        // The sum errs by less than twice what it changed by, and by the tolerance of its viewers.
        let slack = 2.0 * (coarse - fine).abs() + bound + 1e-5 * fine;
        assert!(
            (value - fine).abs() <= slack && slack < 0.03 * fine + 1e-300,
            "{case}: {value} against {fine} to {slack:e}: {p:?} at {theta_i} {theta_r} {phi} in {beta}"
        );
    }
}

#[test]
fn the_spike_is_read_whole_or_not_at_all() {
    let mut random = Random::new(5);
    let mut p: SceneParameters = scene(&mut random);
    p.model = Model::Unified;
    p.sensor = None;
    p.surface.specular_scale = None;
    p.surface.diffuse_albedo = Fraction::ZERO;
    p.surface.rms_height = Some(in_range(0.05 * p.illumination.wavelength.unwrap().get()));
    p.components = Components::Named(vec![Component::SpecularSpike]);
    let mut plate = Vec::new();
    for beta in [1e-9, 0.01, 1.0, 30.0] {
        p.receiver = Some(ReceiverHalfAngle::new(beta).unwrap());
        let scene = Scene::new(p.clone()).unwrap();
        let read = |theta_r: f64, phi: f64| {
            let found = evaluate(&scene, &one(40.0, theta_r, phi), Quantity::Brdf, Output::default());
            assert!(found.relative_error_bound[0] < 1e-13);
            found.total[0]
        };
        let sin = beta.to_radians().sin();
        // F′ e^{−g} over π sin²β cos θ_r, whatever the patch and wherever in the cone the mirror direction is.
        let whole = read(40.0, 0.0) * PI * sin * sin * 40f64.to_radians().cos();
        plate.push(whole);
        assert!((whole / plate[0] - 1.0).abs() < 1e-13, "{plate:?}");
        let inside = 40.0 - 0.5 * beta;
        let shifted = read(inside, 0.0) * PI * sin * sin * inside.to_radians().cos();
        assert!((shifted / plate[0] - 1.0).abs() < 1e-13, "{beta}: {shifted} {plate:?}");
        assert_eq!(read(40.0 - 1.0001 * beta, 0.0), 0.0);
        assert_eq!(read(40.0, 2.0 * beta), 0.0);
    }
}
