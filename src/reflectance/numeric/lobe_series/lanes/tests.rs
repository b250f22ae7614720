//! The batch against itself on other instruction sets and in other company, and against the series.

use super::super::patches::{self, Tier};
use super::super::{Method, evaluate as one};
use super::{Batch, LANES, evaluate};
use crate::reflectance::numeric::dispatch::InstructionSet;

/// g from 1e-18 to 1e18 and x/g from 1e-9 to 1e9, evenly spread in their logarithms (xorshift64).
fn points(seed: u64, count: usize) -> (Vec<f64>, Vec<f64>) {
    let mut state = seed | 1;
    let mut uniform = || {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        (state >> 11) as f64 / (1u64 << 53) as f64
    };
    let g: Vec<f64> = (0..count).map(|_| libm::exp10(36.0 * uniform() - 18.0)).collect();
    let x = g.iter().map(|g| g * libm::exp10(18.0 * uniform() - 9.0)).collect();
    (g, x)
}

fn same_bits(a: &Batch, b: &Batch, count: usize) -> bool {
    let bits = |batch: &Batch| {
        (0..count)
            .map(|place| {
                (
                    batch.significand[place].to_bits(),
                    batch.exponent[place].to_bits(),
                    batch.truncation[place].to_bits(),
                    batch.condition_g[place].to_bits(),
                    batch.condition_x[place].to_bits(),
                    batch.method[place],
                )
            })
            .filter(|parts| parts.5 != Method::Auto)
            .collect::<Vec<_>>()
    };
    bits(a) == bits(b)
}

#[test]
fn every_instruction_set_gives_the_same_bits() {
    let mut compared = 0;
    for (seed, tier) in (1..).zip(patches::ALL) {
        let (g, x) = points(seed, 1_000_000 / patches::ALL.len());
        for (g, x) in g.chunks(LANES).zip(x.chunks(LANES)) {
            let mut reference = Batch::new();
            evaluate(InstructionSet::Portable, tier, g, x, &mut reference);
            for set in InstructionSet::available() {
                let mut batch = Batch::new();
                evaluate(set, tier, g, x, &mut batch);
                assert!(same_bits(&batch, &reference, g.len()), "{} at {g:?}", set.name());
            }
            compared += g.len();
        }
    }
    assert!(compared > 999_000, "{compared}");
}

#[test]
fn a_point_has_one_value_in_any_company() {
    let (g, x) = points(99, 4 * LANES);
    let tier: &Tier = patches::within(1e-9);
    for (g, x) in g.chunks(LANES).zip(x.chunks(LANES)) {
        let mut together = Batch::new();
        evaluate(InstructionSet::widest(), tier, g, x, &mut together);
        for place in 0..g.len() {
            let mut alone = Batch::new();
            evaluate(InstructionSet::widest(), tier, &g[place..=place], &x[place..=place], &mut alone);
            assert_eq!(alone.get(0), together.get(place), "g = {}, x = {}", g[place], x[place]);
        }
    }
}

#[test]
fn every_tier_keeps_its_bound() {
    for (seed, tier) in (7..).zip(patches::ALL) {
        let (g, x) = points(seed, 20_000);
        for (g, x) in g.chunks(LANES).zip(x.chunks(LANES)) {
            let mut batch = Batch::new();
            evaluate(InstructionSet::widest(), tier, g, x, &mut batch);
            for place in 0..g.len() {
                let Some(value) = batch.get(place) else { continue };
                let series = one(Method::Series, g[place], x[place]);
                let distance = value.estimate.value.distance(series.estimate.value);
                let room = value.estimate.error + series.estimate.error;
                let agrees = distance.is_zero() || (distance / room).to_f64() <= 1.0;
                assert!(agrees, "{:?} at g = {:e}, x = {:e}", value.method, g[place], x[place]);
                assert!(batch.truncation[place] <= tier.truncation, "{}", batch.truncation[place]);
            }
        }
    }
}
