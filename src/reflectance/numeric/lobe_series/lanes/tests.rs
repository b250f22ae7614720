//! The batch against itself on other instruction sets and in other company, and against the series.

use super::super::patches;
use super::super::{Method, evaluate as one};
use super::{Batch, Choice, LANES, evaluate};
use crate::reflectance::numeric::dispatch::InstructionSet;

/// g from 1e-32 to 1e18 and x/g from 1e-9 to 1e9 or x from 1e-3 to 1e3, evenly spread in their logarithms
/// (xorshift64).
fn points(seed: u64, count: usize) -> (Vec<f64>, Vec<f64>) {
    let mut state = seed | 1;
    let mut uniform = || {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        (state >> 11) as f64 / (1u64 << 53) as f64
    };
    let log_uniform = |from: f64, to: f64, share: f64| 10f64.powf(from + (to - from) * share);
    let point = |_| {
        let g = log_uniform(-32.0, 18.0, uniform());
        let of_g = uniform() < 0.5;
        let share = uniform();
        (g, if of_g { g * log_uniform(-9.0, 9.0, share) } else { log_uniform(-3.0, 3.0, share) })
    };
    (0..count).map(point).unzip()
}

/// All that is said of each point; NaN where it is left.
fn bits(batch: &Batch, count: usize) -> Vec<(Method, [u64; 5])> {
    let at = |place: usize| {
        let numbers = [
            batch.significand[place],
            batch.exponent[place],
            batch.truncation[place],
            batch.condition_g[place],
            batch.condition_x[place],
        ];
        let left = batch.method[place] == Method::Auto;
        (batch.method[place], numbers.map(|number| if left { 0 } else { number.to_bits() }))
    };
    (0..count).map(at).collect()
}

#[test]
fn every_instruction_set_gives_the_same_bits() {
    let mut compared = 0;
    for (seed, tier) in (1..).zip(patches::ALL) {
        let (g, x) = points(seed, 1_000_000 / patches::ALL.len());
        for (g, x) in g.chunks(LANES).zip(x.chunks(LANES)) {
            let mut reference = Batch::new();
            evaluate(InstructionSet::Portable, Choice::auto(tier), g, x, &mut reference);
            for set in InstructionSet::available() {
                let mut batch = Batch::new();
                evaluate(set, Choice::auto(tier), g, x, &mut batch);
                assert!(bits(&batch, g.len()) == bits(&reference, g.len()), "{} at {g:?}", set.name());
            }
            compared += g.len();
        }
    }
    assert!(compared > 999_000, "{compared}");
}

#[test]
fn a_point_has_one_value_in_any_company() {
    let (g, x) = points(99, 16 * LANES);
    let choice = Choice::auto(patches::within(1e-9));
    for (g, x) in g.chunks(LANES).zip(x.chunks(LANES)) {
        let mut together = Batch::new();
        evaluate(InstructionSet::widest(), choice, g, x, &mut together);
        for place in 0..g.len() {
            let mut alone = Batch::new();
            evaluate(InstructionSet::widest(), choice, &g[place..=place], &x[place..=place], &mut alone);
            assert_eq!(alone.get(0), together.get(place), "g = {}, x = {}", g[place], x[place]);
        }
    }
}

#[test]
fn every_tier_keeps_its_bound() {
    let mut seen = [0; Method::ALL.len()];
    for (seed, tier) in (7..).zip(patches::ALL) {
        let (g, x) = points(seed, 20_000);
        for (g, x) in g.chunks(LANES).zip(x.chunks(LANES)) {
            let mut batch = Batch::new();
            evaluate(InstructionSet::widest(), Choice::auto(tier), g, x, &mut batch);
            for place in 0..g.len() {
                let Some(value) = batch.get(place) else { continue };
                let series = one(Method::Series, g[place], x[place]);
                let distance = value.estimate.value.distance(series.estimate.value);
                let room = value.estimate.error + series.estimate.error;
                let agrees = distance.is_zero() || (distance / room).to_f64() <= 1.0;
                assert!(agrees, "{:?} at g = {:e}, x = {:e}", value.method, g[place], x[place]);
                assert!(batch.truncation[place] <= tier.truncation, "{}", batch.truncation[place]);
                seen[value.method as usize] += 1;
            }
        }
    }
    for method in [Method::Series, Method::Uniform, Method::Smooth, Method::Rough] {
        assert!(seen[method as usize] > 1000, "{}: {seen:?}", method.name());
    }
}
