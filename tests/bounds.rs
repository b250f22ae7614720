//! No bound is exceeded and none is idle, on points drawn densely where methods end. The same over
//! millions of points: `cargo run --release --example bounds -- 10000000`.

#[path = "../examples/bounds/census.rs"]
mod census;
#[path = "../examples/bounds/points.rs"]
mod points;

use census::Census;

#[test]
fn no_bound_is_exceeded_and_none_is_idle() {
    let mut census = Census::take(100_000, 7);
    census.merge(&Census::take(100_000, 8));
    assert_eq!(census.methods.len(), 5);
    for seen in census.all() {
        assert_eq!(seen.violations, 0, "{:?}", seen.examples);
    }
    for name in ["paper", "uniform", "smooth", "rough", "between"] {
        let seen = census.all().find(|seen| seen.name == name).expect("a method");
        assert!(seen.useful > 10_000, "{name}: {}", seen.useful);
        // Measured: 1.01 to 1.2 (the two ends of `between`: 1.01).
        assert!(seen.median() <= 2.0, "{name}: {}", seen.median());
    }
    assert!(census.between.most_idle.0 <= 1.1, "{:?}", census.between.most_idle);
}
