//! A component that was left out changes no total by more than the bound stated.

use crate::random::{Random, directions, scene, whole};
use reflectance::reflectance::directions::{Angles, Directions};
use reflectance::reflectance::evaluate::{Evaluation, Output, Quantity, evaluate};
use reflectance::reflectance::quantity::{
    Azimuth, FacetSlope, Fraction, Quantity as _, SourceZenith, SpecularScale, ViewerZenith,
};
use reflectance::reflectance::scene::{Components, Model, Scene};

/// What differs by more than both bounds, the two answers' logarithms compared where the values underflow.
fn disagreement(part: &Evaluation, whole: &Evaluation) -> Option<String> {
    for index in 0..part.total.len() {
        let (a, b) = (part.total[index], whole.total[index]);
        if a.is_nan() && b.is_nan() || a == b {
            continue;
        }
        let bound = part.relative_error_bound[index] + whole.relative_error_bound[index];
        let (log_a, log_b) =
            (part.log10_total.as_ref().unwrap()[index], whole.log10_total.as_ref().unwrap()[index]);
        let off = if a.abs() > 1e-290 && b.abs() > 1e-290 {
            (a - b).abs() / b.abs()
        } else {
            // A logarithm shows no less than its own rounding.
            ((log_a - log_b).abs() * std::f64::consts::LN_10 - 1e-15 * (1.0 + log_a.abs())).max(0.0)
        };
        // Relative to the exact total, which is not far from b; bounds above 1 say nothing.
        if !(off <= bound * 1.001 + 1e-15 || bound > 0.5) {
            return Some(format!(
                "direction {index}: {a:e} {b:e} ({log_a} {log_b}) off {off:e}, bounds {bound:e}"
            ));
        }
    }
    None
}

#[test]
fn what_is_left_out_changes_no_total_by_more_than_its_bound() {
    let mut random = Random::new(2026);
    let (mut omitted, mut together) = ([0; 3], 0);
    for round in 0..20_000 {
        let parameters = scene(&mut random);
        let directions = directions(&mut random);
        let quantity = [Quantity::Radiance, Quantity::Brdf][random.index(2)];
        let Ok(auto) = Scene::new(parameters.clone()) else { continue };
        let output = Output { log10: true, per_direction: false };
        let part = evaluate(&auto, &directions, quantity, output);
        let known: Vec<_> =
            part.omitted.iter().filter(|o| !o.reason.contains("sensor's footprint")).collect();
        assert!(!part.components.is_empty());
        if known.is_empty() {
            continue;
        }
        for left_out in &known {
            let bound = left_out.bound.expect("a bound");
            assert!(bound <= 0.25 * parameters.accuracy.relative_tolerance.get(), "{bound}");
            omitted[left_out.component as usize] += usize::from(bound > 0.0);
        }
        together += usize::from(known.len() == 2);
        let all = evaluate(&whole(&parameters), &directions, quantity, output);
        if let Some(what) = disagreement(&part, &all) {
            panic!("round {round}: {what}\n{parameters:#?}\n{:?}", part.omitted);
        }
    }
    // The test has something to say on each of them.
    assert!(omitted.iter().all(|&count| count > 200) && together > 200, "{omitted:?} {together}");
}

#[test]
fn the_faintest_component_is_not_taken_for_nothing() {
    let directions = Directions::new(
        Angles::One(SourceZenith::new(10.0).unwrap()),
        Angles::One(ViewerZenith::new(60.0).unwrap()),
        Angles::One(Azimuth::new(0.0).unwrap()),
    )
    .unwrap();
    let smallest = f64::from_bits(1);
    let mut random = Random::new(3);
    // The diffuse lobe is albedo cos θ_i/π; the facet lobe e^{-α²/2σ²} of α = 25°: e^{-31250}, e^{-3472} or e^{-0.09}.
    for (slope, albedo, scale) in [
        (0.1, smallest, 1.0),
        (0.1, 3.0 * smallest, smallest),
        (0.3, 0.0, smallest),
        (60.0, smallest, smallest),
    ] {
        let mut parameters = scene(&mut random);
        parameters.model = Model::TorranceSparrow;
        parameters.components = Components::Auto;
        parameters.surface.facet_slope = Some(FacetSlope::new(slope).unwrap());
        parameters.surface.diffuse_albedo = Fraction::new(albedo).unwrap();
        parameters.surface.specular_scale = Some(SpecularScale::new(scale).unwrap());
        let output = Output { log10: true, per_direction: false };
        let [part, all] = [Scene::new(parameters.clone()).unwrap(), whole(&parameters)]
            .map(|scene| evaluate(&scene, &directions, Quantity::Radiance, output));
        assert_eq!(part.log10_total, all.log10_total, "{:?}", part.omitted);
        assert!(part.log10_total.unwrap()[0].is_finite());
    }
}
