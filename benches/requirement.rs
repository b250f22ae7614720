//! What finding out what a scene requires costs and saves: batches of 20,000 directions of six realistic surfaces on one thread,
//! by component, all of them, and left to the tolerance. `cargo bench --bench requirement`. Numbers are ratios to one vectorised
//! exp() of the `wide` crate, measured in the same run, per direction; each is the least of the rounds.

#[path = "../tests/physics/realistic.rs"]
mod realistic;
mod unit;

use rayon::ThreadPoolBuilder;
use realistic::{SCENES, in_range};
use reflectance::reflectance::directions::{Angles, Directions};
use reflectance::reflectance::evaluate::{self, Output, evaluate};
use reflectance::reflectance::plan::Plan;
use reflectance::reflectance::quantity::Quantity;
use reflectance::reflectance::scene::{Component, Components, Scene};
use std::hint::black_box;
use std::time::Instant;
use unit::wide_exp;

const DIRECTIONS: usize = 20_000;
const ROUNDS: usize = 9;

fn main() {
    let pool = ThreadPoolBuilder::new().num_threads(1).build().expect("a thread");
    pool.install(report);
}

fn report() {
    let exp = wide_exp();
    println!("1 = wide::f64x4::exp, {exp:.2} ns an element");
    let paired = Directions::new(
        Angles::Each(between(0.0, 80.0)),
        Angles::Each(between(0.0, 80.0)),
        Angles::One(in_range(0.0)),
    )
    .expect("one length");
    let swept = |from: f64, to: f64| {
        Directions::new(
            Angles::One(in_range(30.0)),
            Angles::Each(between(from, to)),
            Angles::One(in_range(0.0)),
        )
        .expect("one length")
    };
    println!("\none direction, θ_i = 60°, θ_r = 40°, everything that an answer says included, µs:\n");
    let one =
        Directions::new(Angles::One(in_range(60.0)), Angles::One(in_range(40.0)), Angles::One(in_range(0.0)))
            .expect("one direction");
    for realistic in &SCENES {
        let scene = realistic.scene(1e-9);
        let time = |scene: &Scene| {
            least(|| {
                let start = Instant::now();
                for _ in 0..200 {
                    black_box(evaluate(
                        black_box(scene),
                        &one,
                        evaluate::Quantity::Radiance,
                        Output::default(),
                    ));
                }
                start.elapsed().as_secs_f64() * 1e6 / 200.0
            })
        };
        println!("  {}: {:.2}", realistic.name, time(&scene));
    }
    // The same views in no order, as a measured data set has them.
    let shuffled = {
        let mut state = 1u64;
        let mut random = move |from: f64, to: f64| {
            state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            from + (to - from) * (state >> 11) as f64 / 9007199254740992.0
        };
        let (mut theta_i, mut theta_r, mut phi) = (Vec::new(), Vec::new(), Vec::new());
        for _ in 0..DIRECTIONS {
            theta_i.push(in_range(random(0.0, 60.0)));
            theta_r.push(in_range(random(0.0, 60.0)));
            phi.push(in_range(random(-180.0, 180.0)));
        }
        Directions::new(Angles::Each(theta_i), Angles::Each(theta_r), Angles::Each(phi)).expect("one length")
    };
    for (kind, directions) in [
        ("highlight", swept(25.0, 35.0)),
        ("curve", swept(-89.5, 89.5)),
        ("mirror directions", paired),
        ("hemisphere in no order", shuffled),
    ] {
        println!(
            "\n{kind}:\n\n| scene | tolerance | diffuse | lobe | spike | all | by tolerance | left out | plan | predicted |"
        );
        println!("| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |");
        for realistic in &SCENES {
            for tolerance in [1e-9, 1e-3] {
                row(realistic.name, &realistic.scene(tolerance), &directions, tolerance, exp);
            }
        }
    }
}

/// Angles at equal steps.
fn between<Q: Quantity>(from: f64, to: f64) -> Vec<Q> {
    (0..DIRECTIONS).map(|step| in_range(from + (to - from) * step as f64 / DIRECTIONS as f64)).collect()
}

fn row(name: &str, scene: &Scene, directions: &Directions, tolerance: f64, exp: f64) {
    let time = |components: Components| {
        let mut parameters = scene.parameters().clone();
        parameters.components = components;
        let scene = Scene::new(parameters).expect("a scene that fits together");
        least(|| {
            let start = Instant::now();
            black_box(evaluate(
                black_box(&scene),
                black_box(directions),
                evaluate::Quantity::Radiance,
                Output::default(),
            ));
            start.elapsed().as_secs_f64() * 1e9 / DIRECTIONS as f64
        }) / exp
    };
    print!("| {name} | {tolerance:.0e} |");
    for component in Component::ALL {
        if scene.evaluated().contains(&component) {
            print!(" {:.0} |", time(Components::Named(vec![component])));
        } else {
            print!(" |");
        }
    }
    let auto = evaluate(scene, directions, evaluate::Quantity::Radiance, Output::default());
    let left_out: Vec<_> = auto.omitted.iter().map(|omitted| omitted.component.name()).collect();
    let plan = Plan::of(scene, directions);
    let planned = least(|| {
        let start = Instant::now();
        black_box(Plan::of(black_box(scene), black_box(directions)));
        start.elapsed().as_secs_f64() * 1e9 / DIRECTIONS as f64
    }) / exp;
    println!(
        " {:.0} | {:.0} | {} | {planned:.0} | {:.0} of {:.0} |",
        time(Components::Named(scene.evaluated().to_vec())),
        time(Components::Auto),
        left_out.join(", "),
        plan.cost.per_direction,
        plan.cost.full
    );
}

/// The least of the rounds: what disturbs a measurement only adds to it.
fn least(mut measure: impl FnMut() -> f64) -> f64 {
    (0..ROUNDS).map(|_| measure()).fold(f64::INFINITY, f64::min)
}
