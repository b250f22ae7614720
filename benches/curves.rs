//! One curve of the report's figures, radiance with geometry, series and error bound: time for its
//! 359 directions by the methods that serve there. `cargo bench --bench curves`; criterion's `thrpt`
//! line gives directions a second.

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use reflectance::reflectance::diagram::{Division, Sweep, SweepAxis};
use reflectance::reflectance::evaluate::{Output, Quantity};
use reflectance::reflectance::figures;
use reflectance::reflectance::numeric::lobe_series::Method;
use reflectance::reflectance::quantity::Quantity as InRange;
use reflectance::reflectance::scene::Scene;
use std::hint::black_box;

const DIRECTIONS: u64 = 359;

fn curves(criterion: &mut Criterion) {
    for (id, axis) in [("11f", SweepAxis::ThetaR), ("13a", SweepAxis::ThetaR), ("23c", SweepAxis::ThetaI)] {
        let sweep = Sweep::new(
            axis,
            (in_range(-89.5), in_range(89.5)),
            Division::Step(in_range(0.5)),
            vec![in_range(30.0)],
            in_range(0.0),
        )
        .expect("a sweep that fits together");
        let mut panels = figures::find(id).expect("a figure").evaluate(false).expect("a preset");
        let scene = panels.remove(0).scene.expect("a scene");
        let mut group = criterion.benchmark_group(format!("figure {id}"));
        group.throughput(Throughput::Elements(DIRECTIONS));
        for method in [Method::Auto, Method::Series, Method::Paper, Method::Uniform, Method::Smooth] {
            let scene = by(&scene, method);
            group.bench_function(method.name(), |bencher| {
                bencher.iter(|| {
                    black_box(&sweep).evaluate(black_box(&scene), Quantity::Radiance, Output::default(), "")
                });
            });
        }
        group.finish();
    }
}

fn in_range<Q: InRange>(value: f64) -> Q {
    Q::new(value).expect("a number in range")
}

fn by(scene: &Scene, method: Method) -> Scene {
    let mut parameters = scene.parameters().clone();
    parameters.accuracy.method = method;
    Scene::new(parameters).expect("the method is no part of what can be wrong")
}

criterion_group!(benches, curves);
criterion_main!(benches);
