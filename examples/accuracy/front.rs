//! Error against time of every method and tolerance, by band of μ = g e^u: whole radiances of batches of directions.

use crate::page::{Column, Table, rounded_up};
use crate::scenes::{accuracy, directions, finest, lobe};
use crate::unit::wide_exp;
use reflectance::reflectance::beckmann_spizzichino::RelativeRoughness;
use reflectance::reflectance::directions::Directions;
use reflectance::reflectance::evaluate::{Evaluation, Output, Quantity, evaluate};
use reflectance::reflectance::numeric::lobe_series::Method;
use reflectance::reflectance::quantity::Tolerance;
use reflectance::reflectance::scene::Accuracy;
use std::hint::black_box;
use std::time::Instant;

/// Where μ lies in each band.
const BANDS: [(f64, f64); 6] =
    [(10.0, 30.0), (30.0, 100.0), (100.0, 300.0), (300.0, 1e3), (1e3, 1e4), (1e4, 1e6)];
/// Directions of a band.
const DIRECTIONS: usize = 1024;
/// σ_h/T of the surfaces.
const SLOPE: f64 = 0.1;
/// Repeats, of which the least is taken: what else runs on the machine only adds.
const REPEATS: usize = 41;

/// One method at one tolerance.
pub(crate) struct Point {
    pub(crate) accuracy: Accuracy,
    /// Largest and median relative error of the totals, no smaller than the reference's own bound.
    pub(crate) largest: f64,
    pub(crate) median: f64,
    bound: f64,
    /// Time of a direction over that of one exp(); 0 if it was not taken.
    pub(crate) time: f64,
    /// Whether no other is at once faster and better.
    pub(crate) on_front: bool,
}

/// Directions whose μ lies between these.
pub(crate) struct Band {
    pub(crate) from: f64,
    pub(crate) to: f64,
    pub(crate) points: Vec<Point>,
}

impl Band {
    /// "10 to 30"
    pub(crate) fn name(&self) -> String {
        format!("{} to {}", power(self.from), power(self.to))
    }
}

fn power(value: f64) -> String {
    if value < 1e3 { value.to_string() } else { format!("{value:e}") }
}

/// All bands; the times only if `timed`.
pub(crate) fn measured(timed: bool) -> Vec<Band> {
    let unit = if timed { 1e-9 * wide_exp() } else { 1.0 };
    BANDS.map(|(from, to)| band(from, to, timed.then_some(unit))).into()
}

fn band(from: f64, to: f64, unit: Option<f64>) -> Band {
    // At cos θ_i + cos θ_r = 3/2, and a little slope, μ is in the middle of the band.
    let height = (from * to).powf(0.25) / (3.0 * std::f64::consts::PI) / 1.1;
    let roughness = RelativeRoughness { height, correlation_length: height / SLOPE };
    let directions = within(&roughness, from, to);
    let run = |accuracy: Accuracy| {
        evaluate(&lobe(roughness, accuracy), &directions, Quantity::Radiance, Output::default())
    };
    let exact = run(accuracy(Method::Series, finest()));
    let ways: Vec<Accuracy> = Tolerance::STEPS
        .iter()
        .map(|tolerance| accuracy(Method::Auto, tolerance.get()))
        .chain(
            [Method::Series, Method::Paper, Method::Uniform, Method::Smooth, Method::Rough]
                .map(|method| accuracy(method, finest())),
        )
        .collect();
    let times =
        unit.map_or(vec![0.0; ways.len()], |unit| times(&ways, unit, |way| drop(black_box(run(way)))));
    let mut points: Vec<Point> =
        ways.iter().zip(times).map(|(&way, time)| Point::of(way, &run(way), &exact, time)).collect();
    for index in 0..points.len() {
        let here = &points[index];
        let beaten = points.iter().any(|other| {
            other.time <= here.time
                && other.largest <= here.largest
                && (other.time < here.time || other.largest < here.largest)
        });
        points[index].on_front = !beaten;
    }
    Band { from, to, points }
}

impl Point {
    fn of(accuracy: Accuracy, by: &Evaluation, exact: &Evaluation, time: f64) -> Self {
        let mut errors: Vec<f64> = by
            .total
            .iter()
            .zip(&exact.total)
            .zip(&exact.relative_error_bound)
            .map(|((value, exact), floor)| ((value - exact) / exact).abs().max(*floor))
            .collect();
        errors.sort_by(f64::total_cmp);
        Self {
            accuracy,
            largest: errors[errors.len() - 1],
            median: errors[errors.len() / 2],
            bound: by.relative_error_bound.iter().copied().fold(0.0, f64::max),
            time,
            on_front: false,
        }
    }

    /// The method, and the tolerance of `auto`.
    pub(crate) fn name(&self) -> String {
        match self.accuracy.method {
            Method::Auto => format!("`auto`, {:e}", self.accuracy.relative_tolerance.get()),
            method => format!("`{}`", method.name()),
        }
    }
}

/// Least seconds of a direction by each way over `unit`; in turn, so that what slows the machine slows all of them.
fn times(ways: &[Accuracy], unit: f64, mut run: impl FnMut(Accuracy)) -> Vec<f64> {
    let mut least = vec![f64::INFINITY; ways.len()];
    for _ in 0..REPEATS {
        for (way, least) in ways.iter().zip(&mut least) {
            let started = Instant::now();
            run(*way);
            *least = least.min(started.elapsed().as_secs_f64());
        }
    }
    least.into_iter().map(|least| least / DIRECTIONS as f64 / unit).collect()
}

/// What the times were taken on, as far as it says of itself.
pub(crate) fn machine() -> String {
    let cpu = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let model = cpu.lines().find_map(|line| line.strip_prefix("model name")?.split(": ").nth(1));
    format!(
        "The times are those of one thread of a machine that calls itself {} ({}), where one exp() took {:.1} ns.\n",
        model.unwrap_or("nothing"),
        std::env::consts::ARCH,
        wide_exp()
    )
}

/// Directions of that surface whose μ lies in a band, from a sequence that fills the hemisphere evenly.
fn within(roughness: &RelativeRoughness, from: f64, to: f64) -> Directions {
    let candidates = (1..).map(|n| {
        let part = |base| van_der_corput(n, base);
        [75.0 * part(2), 150.0 * part(3) - 75.0, 360.0 * part(5) - 180.0]
    });
    let fits = |&direction: &[f64; 3]| {
        let geometry = directions(&[direction]).geometry(0);
        (from..to).contains(&saddle(roughness.g(&geometry), roughness.x(&geometry)))
    };
    directions(&candidates.filter(fits).take(DIRECTIONS).collect::<Vec<_>>())
}

/// The digits of n behind the point, in reverse.
fn van_der_corput(mut n: u32, base: u32) -> f64 {
    let (mut value, mut place) = (0.0, 1.0);
    while n > 0 {
        place /= f64::from(base);
        value += f64::from(n % base) * place;
        n /= base;
    }
    value
}

/// μ = g e^u of ln(μ/g) = x/μ², where the terms of the series are largest, by bisection of ln μ.
fn saddle(g: f64, x: f64) -> f64 {
    let (mut low, mut high) = (g.ln(), (g + x.sqrt()).max(g + x / g).ln());
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if middle - g.ln() < x * (-2.0 * middle).exp() { low = middle } else { high = middle }
    }
    low.exp()
}

/// Every point.
pub(crate) fn table(bands: &[Band]) -> Table {
    let columns = [
        ("μ", Column::Text),
        ("method", Column::Text),
        ("largest error", Column::Error),
        ("median error", Column::Error),
        ("largest bound", Column::Error),
        ("time, exp()", Column::Time),
        ("on the front", Column::Time),
    ];
    let rows = bands.iter().flat_map(|band| {
        band.points.iter().map(|point| {
            vec![
                band.name(),
                point.name(),
                rounded_up(point.largest),
                rounded_up(point.median),
                rounded_up(point.bound),
                format!("{:.0}", point.time),
                if point.on_front { "yes" } else { "" }.to_owned(),
            ]
        })
    });
    Table {
        name: "front",
        columns: columns.map(|(title, kind)| (title.to_owned(), kind)).into(),
        rows: rows.collect(),
    }
}

#[cfg(test)]
#[test]
fn the_saddle_solves_its_equation() {
    for (g, x) in [(20.0, 0.0), (20.0, 300.0), (1.0, 1e4), (1e5, 1e6)] {
        let mu = saddle(g, x);
        assert!(((mu / g).ln() - x / mu / mu).abs() < 1e-12, "{g} {x}: {mu}");
    }
}
