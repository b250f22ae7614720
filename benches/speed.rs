//! The trade of speed for accuracy in one run: whole radiances (geometry, g, x, lobe, bound) of 100,000
//! directions on one thread, for six bands of μ, against the paper's 100 terms and the plain series.
//! `cargo bench --bench speed`. Numbers are ratios to one vectorised exp() of the `wide` crate, measured
//! in the same round; each is the median of the rounds.

mod unit;

use rayon::ThreadPoolBuilder;
use reflectance::reflectance::directions::{Angles, Directions};
use reflectance::reflectance::evaluate::{EvaluatedBy, Output, Quantity, evaluate};
use reflectance::reflectance::fresnel::{Medium, Polarization, RefractiveIndex};
use reflectance::reflectance::geometry::Geometry;
use reflectance::reflectance::numeric::dispatch::InstructionSet;
use reflectance::reflectance::numeric::lobe_series::Method;
use reflectance::reflectance::quantity::{Quantity as InRange, ViewerZenith};
use reflectance::reflectance::scene::{
    Accuracy, Component, Components, Illumination, Model, Scene, SceneParameters, Surface,
};
use std::hint::black_box;
use std::time::Instant;
use unit::wide_exp;

const DIRECTIONS: usize = 100_000;
const ROUNDS: usize = 7;
/// In one round; the least is taken, since the machine does other things besides.
const REPEATS: usize = 5;
/// Lower ends of the bands of μ, and the σ_h/λ whose μ lies in the band for every direction of the bench.
const BANDS: [(&str, f64); 6] = [
    ("10-30", 0.40),
    ("30-100", 0.70),
    ("100-300", 1.25),
    ("300-1e3", 2.2),
    ("1e3-1e4", 5.0),
    ("> 1e4", 40.0),
];
const TOLERANCES: [f64; 6] = [1e-13, 1e-12, 1e-9, 1e-6, 1e-3, 1e-1];

fn main() {
    let pool = ThreadPoolBuilder::new().num_threads(1).build().expect("a thread");
    pool.install(report);
}

fn report() {
    let set = InstructionSet::widest();
    println!("{DIRECTIONS} directions, one thread, {}; medians of {ROUNDS} rounds", set.name());
    let directions = directions(30.0);
    let mut rows: Vec<(String, Vec<f64>)> = Vec::new();
    let mut chosen = Vec::new();
    let mut exps = Vec::new();
    for (number, (band, height)) in BANDS.iter().enumerate() {
        let mut samples: Vec<(String, Vec<f64>)> = Vec::new();
        for _ in 0..ROUNDS {
            let exp = wide_exp();
            exps.push(exp);
            let mut add = |name: String, nanoseconds: f64| {
                let ratio = nanoseconds / exp;
                match samples.iter_mut().find(|(known, _)| *known == name) {
                    Some((_, ratios)) => ratios.push(ratio),
                    None => samples.push((name, vec![ratio])),
                }
            };
            for tolerance in TOLERANCES {
                let scene = scene(*height, tolerance, Method::Auto);
                add(format!("auto, tolerance {tolerance:.0e}"), whole(&scene, &directions));
            }
            for method in [Method::Series, Method::Uniform, Method::Paper, Method::Smooth, Method::Rough] {
                add(method.name().to_owned(), whole(&scene(*height, 1e-9, method), &directions));
            }
            add("100 terms, plain".to_owned(), hundred_terms(&directions, *height));
            add("100 terms, in vector lanes".to_owned(), hundred_terms_in_lanes(&directions, *height));
        }
        for (name, ratios) in samples {
            let ratio = median(ratios);
            match rows.iter_mut().find(|(known, _)| *known == name) {
                Some((_, bands)) => bands.push(ratio),
                None => rows.push((name, vec![ratio])),
            }
        }
        for tolerance in [1e-13, 1e-9, 1e-3] {
            let evaluation = evaluate(
                &scene(*height, tolerance, Method::Auto),
                &directions,
                Quantity::Radiance,
                Output::default(),
            );
            chosen.push((number, band, tolerance, evaluation.methods));
        }
    }
    println!("1 = wide::f64x4::exp, {:.2} ns an element", median(exps));
    print!("\n| whole radiance |");
    for (band, _) in BANDS {
        print!(" {band} |");
    }
    println!(" typical | worst |\n| --- | --- | --- | --- | --- | --- | --- | --- | --- |");
    for (name, ratios) in &rows {
        print!("| {name} |");
        for ratio in ratios {
            print!(" {ratio:.1} |");
        }
        let worst = ratios.iter().copied().fold(0.0, f64::max);
        println!(" {:.1} | {worst:.1} |", median(ratios.clone()));
    }
    println!("\nmethods that auto takes:");
    for (_, band, tolerance, methods) in chosen {
        let shares: Vec<String> = methods
            .into_iter()
            .map(|(by, count): (EvaluatedBy, usize)| {
                format!("{} {:.1} %", by.name(), 100.0 * count as f64 / DIRECTIONS as f64)
            })
            .collect();
        println!("  {band} at {tolerance:.0e}: {}", shares.join(", "));
    }
    beyond(&directions);
}

/// Cost must not grow with g; and what more general requests cost.
fn beyond(constant_source: &Directions) {
    println!("\nother batches at tolerance 1e-9:");
    let exp = wide_exp();
    let time = |scene: &Scene, directions: &Directions| {
        median((0..ROUNDS).map(|_| whole(scene, directions)).collect()) / exp
    };
    let g = |exponent: i32| (10f64.powi(exponent) / 3.0).sqrt() / (2.0 * core::f64::consts::PI);
    let (small, large) = (scene(g(3), 1e-9, Method::Auto), scene(g(10), 1e-9, Method::Auto));
    let (small, large) = (time(&small, constant_source), time(&large, constant_source));
    println!("  g about 1e3: {small:.1}, g about 1e10: {large:.1}, ratio {:.2}", large / small);
    let all_vary = Directions::new(
        Angles::Each(random(1, 0.0, 60.0).into_iter().map(in_range).collect()),
        Angles::Each(random(2, 0.0, 60.0).into_iter().map(in_range).collect()),
        Angles::Each(random(3, 0.0, 360.0).into_iter().map(in_range).collect()),
    )
    .expect("equal lengths");
    println!("  every angle of its own: {:.1}", time(&scene(2.2, 1e-9, Method::Auto), &all_vary));
    let aluminium = with(2.2, 1e-9, Method::Auto, |parameters| {
        let index = RefractiveIndex { n: in_range(0.96), k: in_range(6.69) };
        parameters.surface.medium = Medium::Index(index);
    });
    println!("  n - ik = 0.96 - 6.69i: {:.1}", time(&aluminium, constant_source));
    let facets = with(2.2, 1e-9, Method::Auto, |parameters| parameters.model = Model::TorranceSparrow);
    println!("  torrance_sparrow: {:.1}", time(&facets, constant_source));
}

/// ns of one direction of a whole evaluation.
fn whole(scene: &Scene, directions: &Directions) -> f64 {
    // A named method that is slow says enough in one run.
    let repeats = if scene.parameters().accuracy.method == Method::Auto { REPEATS } else { 1 };
    let time = || {
        let start = Instant::now();
        black_box(evaluate(black_box(scene), black_box(directions), Quantity::Radiance, Output::default()));
        start.elapsed().as_secs_f64() * 1e9 / DIRECTIONS as f64
    };
    least(std::iter::repeat_with(time).take(repeats))
}

/// As the authors evaluated (47): e^{-g} Σ_{m=1}^{100} g^m/(m! m) e^{-x/m}, one direction after the other.
fn hundred_terms(directions: &Directions, height: f64) -> f64 {
    // A tenth of the directions: it is slow.
    let some = DIRECTIONS / 10;
    let start = Instant::now();
    let mut total = 0.0;
    for index in 0..some {
        let (g, x, factor) = arguments(&directions.geometry(index), height);
        let (mut power, mut sum) = (1.0, 0.0);
        for m in 1..=100 {
            let m = f64::from(m);
            power *= g / m;
            sum += power / m * (-x / m).exp();
        }
        total += factor * (-g).exp() * sum;
    }
    black_box(total);
    start.elapsed().as_secs_f64() * 1e9 / some as f64
}

/// The same four directions at a time.
fn hundred_terms_in_lanes(directions: &Directions, height: f64) -> f64 {
    let some = DIRECTIONS / 10;
    let start = Instant::now();
    let mut total = wide::f64x4::from(0.0);
    for first in (0..some).step_by(4) {
        let points: [(f64, f64, f64); 4] =
            std::array::from_fn(|lane| arguments(&directions.geometry(first + lane), height));
        let lanes = |of: fn((f64, f64, f64)) -> f64| wide::f64x4::from(points.map(of));
        let (g, x, factor) = (lanes(|point| point.0), lanes(|point| point.1), lanes(|point| point.2));
        let (mut power, mut sum) = (wide::f64x4::from(1.0), wide::f64x4::from(0.0));
        for m in 1..=100 {
            let inverse = wide::f64x4::from(1.0 / f64::from(m));
            power *= g * inverse;
            sum += power * inverse * (-x * inverse).exp();
        }
        total += factor * (-g).exp() * sum;
    }
    black_box(total);
    start.elapsed().as_secs_f64() * 1e9 / some as f64
}

/// g, x and what multiplies S for T = 10 σ_h.
fn arguments(geometry: &Geometry, height: f64) -> (f64, f64, f64) {
    let root = 2.0 * core::f64::consts::PI * height * geometry.cos_sum;
    let spread = core::f64::consts::PI * 10.0 * height * geometry.horizontal;
    let patch = 10.0 * height * geometry.facet_factor();
    (root * root, spread * spread, 0.25 * core::f64::consts::PI * patch * patch / geometry.cos_r)
}

/// One source, viewers all over the cap of 60° around the normal.
fn directions(theta_i: f64) -> Directions {
    let viewers: Vec<ViewerZenith> = random(4, 0.0, 60.0).into_iter().map(in_range).collect();
    let azimuths = random(5, 0.0, 360.0).into_iter().map(in_range).collect();
    Directions::new(Angles::One(in_range(theta_i)), Angles::Each(viewers), Angles::Each(azimuths))
        .expect("equal lengths")
}

/// σ_h = `height` λ, T = 10 σ_h.
fn scene(height: f64, tolerance: f64, method: Method) -> Scene {
    with(height, tolerance, method, |_| ())
}

fn with(height: f64, tolerance: f64, method: Method, change: impl FnOnce(&mut SceneParameters)) -> Scene {
    let mut parameters = SceneParameters {
        model: Model::BeckmannSpizzichino,
        surface: Surface {
            rms_height: Some(in_range(height)),
            correlation_length: Some(in_range(10.0 * height)),
            facet_slope: None,
            medium: Medium::PerfectConductor,
            diffuse_albedo: in_range(0.0),
            specular_scale: None,
            shadowing: None,
            fresnel_average: None,
        },
        illumination: Illumination {
            wavelength: Some(in_range(1.0)),
            irradiance: in_range(1.0),
            polarization: Polarization::unpolarized(),
        },
        sensor: None,
        receiver: None,
        components: Components::Named(vec![Component::SpecularLobe]),
        accuracy: Accuracy { relative_tolerance: in_range(tolerance), method },
    };
    change(&mut parameters);
    Scene::new(parameters).expect("a scene")
}

fn in_range<Q: InRange>(value: f64) -> Q {
    Q::new(value).expect("a number in range")
}

fn least(values: impl Iterator<Item = f64>) -> f64 {
    values.fold(f64::INFINITY, f64::min)
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}

/// As many numbers as directions, evenly spread from `from` to `to` (xorshift64).
fn random(seed: u64, from: f64, to: f64) -> Vec<f64> {
    let mut state = seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1;
    (0..DIRECTIONS)
        .map(|_| {
            state ^= state << 13;
            state ^= state >> 7;
            state ^= state << 17;
            from + (to - from) * ((state >> 11) as f64 / (1u64 << 53) as f64)
        })
        .collect()
}
