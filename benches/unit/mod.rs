//! The unit of the benches: one vectorised exp() of the `wide` crate as the program was compiled, over an array in the nearest
//! cache.

use std::hint::black_box;
use std::time::Instant;
use wide::f64x4;

const ARGUMENTS: usize = 1024;
const PASSES: usize = 200;
/// Of which the least is taken: what else runs on the machine only adds.
const REPEATS: usize = 9;

/// ns of one element.
pub(crate) fn wide_exp() -> f64 {
    let arguments: Vec<f64x4> = (0..ARGUMENTS / 4)
        .map(|i| f64x4::new([0.0, 0.25, 0.5, 0.75].map(|part| -0.05 * (i as f64 + part))))
        .collect();
    let mut results = vec![f64x4::ZERO; arguments.len()];
    let mut time = || {
        let start = Instant::now();
        for _ in 0..PASSES {
            for (result, argument) in results.iter_mut().zip(black_box(&arguments)) {
                *result = argument.exp();
            }
            black_box(&mut results);
        }
        start.elapsed().as_secs_f64() * 1e9 / (PASSES * ARGUMENTS) as f64
    };
    (0..REPEATS).map(|_| time()).fold(f64::INFINITY, f64::min)
}
