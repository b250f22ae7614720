//! No bound is exceeded and none is idle, on points drawn densely where methods end. The same over
//! millions of points: `cargo run --release --example bounds -- 10000000`.

#[path = "../examples/bounds/census.rs"]
mod census;
#[path = "../examples/bounds/points.rs"]
mod points;

use census::Census;
use reflectance::reflectance::numeric::lobe_series::Method;

#[test]
fn no_bound_is_exceeded_and_none_is_idle() {
    let mut census = Census::take(100_000, 7);
    census.merge(&Census::take(100_000, 8));
    for seen in census.all() {
        assert_eq!(seen.violations, 0, "{:?}", seen.examples);
    }
    let named = census.methods.iter().filter(|(method, _)| *method != Method::Auto).map(|(_, seen)| seen);
    for seen in named.chain([&census.between]) {
        assert!(seen.useful > 10_000, "{}: {}", seen.name, seen.useful);
        // Measured: 1.01, and 2.7 for `uniform`.
        assert!(seen.median() <= 5.0, "{}: {}", seen.name, seen.median());
    }
    for (tier, seen) in &census.tiers {
        // The finest leaves out no more than rounding.
        assert!(seen.useful > 10_000 || tier.is_full(), "{}: {}", seen.name, seen.useful);
        assert!(seen.median() <= 100.0 || tier.is_full(), "{}: {}", seen.name, seen.median());
    }
    assert!(census.between.most_idle.0 <= 1.1, "{:?}", census.between.most_idle);
}
