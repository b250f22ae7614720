//! What a caller asks for is what he gets: over random scenes of every model, at tolerances from 1e-1 to 1e-12, `auto` stays
//! within the tolerance and within the bound that it states; and nothing at the ends of all ranges is a NaN without
//! a reason.

use crate::random::{Random, directions, extreme, scene, whole};
use reflectance::reflectance::directions::Directions;
use reflectance::reflectance::evaluate::{Evaluation, Output, Quantity, evaluate};
use reflectance::reflectance::findings::WarningCode;
use reflectance::reflectance::numeric::lobe_series::Method;
use reflectance::reflectance::quantity::{Quantity as _, Tolerance};
use reflectance::reflectance::scene::{Accuracy, Scene, SceneParameters};
use std::f64::consts::LN_10;

const TOLERANCES: [f64; 5] = [1e-1, 1e-3, 1e-6, 1e-9, 1e-12];

fn with(parameters: &SceneParameters, tolerance: f64, method: Method) -> SceneParameters {
    let accuracy = Accuracy { relative_tolerance: Tolerance::new(tolerance).unwrap(), method };
    SceneParameters { accuracy, ..parameters.clone() }
}

/// |a/b − 1|, by the logarithms where the doubles run out; a logarithm shows no less than its own rounding.
fn distance(a: &Evaluation, b: &Evaluation, index: usize) -> f64 {
    let (value, reference) = (a.total[index], b.total[index]);
    if value == reference || value.is_nan() && reference.is_nan() {
        return 0.0;
    }
    if value > 1e-290 && reference > 1e-290 {
        return (value - reference).abs() / reference;
    }
    let logarithm = |answer: &Evaluation| answer.log10_total.as_ref().unwrap()[index];
    let (value, reference) = (logarithm(a), logarithm(b));
    (((value - reference).abs() - 4.0 * f64::EPSILON * (1.0 + value.abs())) * LN_10).max(0.0).exp_m1()
}

/// Whether the directions of which the answer says that they miss the tolerance are those whose bound does.
fn says_what_it_misses(answer: &Evaluation, tolerance: f64) -> bool {
    let missed = (0..answer.total.len())
        .filter(|&index| answer.total[index].is_finite() && answer.relative_error_bound[index] > tolerance)
        .count();
    let warned = answer
        .warnings
        .iter()
        .find(|warning| warning.code == WarningCode::ToleranceNotMet)
        .map_or(0, |warning| warning.count);
    warned == missed
}

/// How many scenes to try; `TOLERANCE_SCENES=100000` for a long run.
fn scenes() -> u32 {
    std::env::var("TOLERANCE_SCENES").map_or(4_000, |count| count.parse().expect("a number of scenes"))
}

#[test]
fn every_tolerance_is_kept_and_no_bound_exceeded() {
    let mut random = Random::new(1989);
    let (mut directions_checked, mut used) = (0, 0);
    for round in 0..scenes() {
        let parameters = scene(&mut random);
        let Ok(reference) = Scene::new(with(&parameters, 1e-15, Method::Series)) else { continue };
        let directions = directions(&mut random);
        let quantity = [Quantity::Radiance, Quantity::Brdf][random.index(2)];
        let output = Output { log10: true, per_direction: false };
        // Every component, by the sum: what can be told of the exact value.
        let exact = evaluate(&whole(reference.parameters()), &directions, quantity, output);
        for tolerance in TOLERANCES {
            let auto = Scene::new(with(&parameters, tolerance, Method::Auto)).unwrap();
            let answer = evaluate(&auto, &directions, quantity, output);
            for index in 0..directions.count() {
                let (bound, known) = (answer.relative_error_bound[index], exact.relative_error_bound[index]);
                let off = distance(&answer, &exact, index);
                let room = bound + 1.001 * known + 4.0 * f64::EPSILON;
                assert!(
                    off <= room || known > 0.5 || !exact.total[index].is_finite(),
                    "round {round}, direction {index}, {tolerance:e}: off {off:e}, bounds {bound:e} {known:e}\n{:?}\n{parameters:#?}",
                    directions.angles(index),
                );
                // Only what the sum cannot do either misses the tolerance. A method knows the conditions to a few per cent,
                // and a quarter of the tolerance may have been left out.
                let best = 1.1 * known + 0.25 * tolerance;
                assert!(
                    bound <= tolerance.max(best) || !exact.total[index].is_finite(),
                    "round {round}, direction {index}: {bound:e} misses {tolerance:e}, {known:e} is to be had\n{parameters:#?}",
                );
                used += usize::from(bound <= tolerance && bound > 0.01 * tolerance);
            }
            assert!(says_what_it_misses(&answer, tolerance), "round {round}: {:?}", answer.warnings);
            directions_checked += directions.count();
        }
    }
    assert!(directions_checked > 500_000, "{directions_checked}");
    // Tolerances are made use of, not just kept.
    assert!(used > directions_checked / 20, "{used} of {directions_checked}");
}

/// What has to be said of numbers, however they came about.
fn is_explained(answer: &Evaluation, directions: &Directions) -> Result<(), String> {
    let explained = |index: usize| answer.diagnostics.iter().any(|diagnostic| diagnostic.index == index);
    for index in 0..directions.count() {
        let columns = answer.components.iter().map(|column| column.values[index]);
        let bound = answer.relative_error_bound[index];
        let whole = columns.chain([answer.total[index], bound]).all(f64::is_finite);
        if !whole && !explained(index) {
            return Err(format!("direction {index}: {:?}", directions.angles(index)));
        }
        if bound < 0.0 || answer.total[index] < 0.0 {
            return Err(format!("direction {index} is negative: {} {bound}", answer.total[index]));
        }
    }
    Ok(())
}

#[test]
fn the_ends_of_all_ranges_are_numbers_or_explained() {
    let mut random = Random::new(7);
    for round in 0..6_000 {
        let mut parameters = scene(&mut random);
        extreme(&mut parameters, &mut random);
        let directions = directions(&mut random);
        let method = Method::ALL[random.index(Method::ALL.len())];
        let tolerance = [1e-15, 1e-12, 1e-9, 1e-6, 1e-3, 1e-1][random.index(6)];
        let Ok(scene) = Scene::new(with(&parameters, tolerance, method)) else { continue };
        for quantity in [Quantity::Radiance, Quantity::Brdf] {
            let output = Output { log10: random.index(2) == 0, per_direction: random.index(2) == 0 };
            let answer = evaluate(&scene, &directions, quantity, output);
            if let Err(what) = is_explained(&answer, &directions) {
                panic!("round {round}, {} at {tolerance:e}: {what}\n{parameters:#?}", method.name());
            }
        }
    }
}

#[test]
fn the_logarithm_of_what_underflows_has_all_digits_at_every_tolerance() {
    let mut random = Random::new(308);
    let mut underflows = 0;
    let output = Output { log10: true, per_direction: false };
    for _ in 0..2_000 {
        let parameters = scene(&mut random);
        let Ok(finest) = Scene::new(with(&parameters, 1e-15, Method::Auto)) else { continue };
        let finest = whole(finest.parameters());
        let directions = directions(&mut random);
        let exact = evaluate(&finest, &directions, Quantity::Radiance, output);
        for tolerance in TOLERANCES {
            let scene = Scene::new(with(finest.parameters(), tolerance, Method::Auto)).unwrap();
            let answer = evaluate(&scene, &directions, Quantity::Radiance, output);
            for (column, exact) in answer.components.iter().zip(&exact.components) {
                for index in 0..directions.count() {
                    if column.values[index].abs() < f64::MIN_POSITIVE {
                        underflows += 1;
                        let [got, expected] = [column, exact].map(|of| of.log10.as_ref().unwrap()[index]);
                        assert_eq!(got.to_bits(), expected.to_bits(), "{tolerance:e}: {parameters:#?}");
                    }
                }
            }
        }
    }
    assert!(underflows > 10_000, "{underflows}");
}
