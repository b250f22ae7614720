//! The trade of speed for accuracy, measured on one scene: how far off each way to evaluate the lobe series is there,
//! what it says of that itself, and what it costs now.

use super::directions::Directions;
use super::evaluate::{EvaluatedBy, Evaluation, Output, Quantity, evaluate};
use super::numeric::lobe_series::Method;
use super::quantity::Tolerance;
use super::scene::{Accuracy, Scene};
use core::hint::black_box;
use core::time::Duration;

/// Directions that are measured; of more, as many are taken at even distances, the first and the last among them.
pub const MAX_DIRECTIONS: usize = 64;
/// Time after which no further repeat is begun, so that with what follows it is all done in 50 ms. What comes before
/// the repeats, one evaluation by each way, is bounded by the number of directions.
pub const BUDGET: Duration = Duration::from_millis(45);
/// Timings of each way that are enough for a median.
const MAX_REPEATS: usize = 31;
/// A timing evaluates as often as fits in here, at least once: a thousand ticks of a coarse clock.
const TIMING: Duration = Duration::from_micros(40);
/// A bound on how often.
const MAX_EVALUATIONS: u32 = 256;

/// What was measured.
#[derive(Clone, Debug, PartialEq)]
pub struct Tradeoff {
    /// Indices of the directions measured, ascending.
    pub used: Vec<usize>,
    /// How many of them have a finite total: the errors are those of these.
    pub compared: usize,
    /// The largest bound of the error of the reference itself, the series summed to convergence. No error below it can
    /// be told. None where no direction has a finite total.
    pub reference_error_bound: Option<f64>,
    /// One a way.
    pub rows: Vec<Row>,
}

/// One way to evaluate the scene.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    /// How the series is evaluated; none where the scene has no series.
    pub method: Option<Method>,
    /// The tolerance that the bounds have to keep.
    pub relative_tolerance: f64,
    /// Whether the scene asks for just this.
    pub as_requested: bool,
    /// How many directions each method evaluated: what `auto` took.
    pub methods: Vec<(EvaluatedBy, usize)>,
    /// None where no direction has a finite total.
    pub errors: Option<Errors>,
    /// Median over the repeats of the time a direction takes, everything included.
    pub seconds: f64,
    /// That time over the shortest of any row.
    pub time_ratio: f64,
    /// Timings that the median is of.
    pub repeats: usize,
}

/// Errors of the totals of one row, relative. An error below the reference's own bound for the direction is counted as
/// that bound: nothing smaller can be told.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Errors {
    /// The largest; infinite where a direction's total is.
    pub largest: f64,
    /// The median.
    pub median: f64,
    /// The largest bound stated.
    pub largest_bound: f64,
    /// Whether every bound keeps the tolerance.
    pub keeps_tolerance: bool,
}

/// Measures a scene; `now` is a clock that never goes backwards.
pub fn measure(
    scene: &Scene,
    directions: &Directions,
    output: Output,
    mut now: impl FnMut() -> Duration,
) -> Tradeoff {
    let start = now();
    let used = evenly(directions.count(), MAX_DIRECTIONS);
    let directions = directions.select(&used);
    let run = |scene: &Scene| evaluate(scene, &directions, Quantity::Radiance, output);

    let reference =
        run(&scene.with_accuracy(Accuracy { relative_tolerance: Tolerance::FINEST, method: Method::Series }));
    let in_series = reference.methods.iter().any(|(by, _)| *by != EvaluatedBy::ClosedForm);
    let requested = scene.parameters().accuracy;
    let mut candidates: Vec<Candidate> = ways(requested, in_series)
        .into_iter()
        .map(|accuracy| {
            let scene = scene.with_accuracy(accuracy);
            let begun = now();
            let evaluation = run(&scene);
            let first = now().saturating_sub(begun);
            Candidate { scene, evaluation, first, timings: Vec::new() }
        })
        .collect();
    repeat(&mut candidates, start, &mut now, |scene| {
        black_box(run(black_box(scene)));
    });

    let finite: Vec<usize> = (0..used.len()).filter(|&i| reference.total[i].is_finite()).collect();
    let seconds: Vec<f64> = candidates.iter().map(|c| c.median_seconds() / used.len() as f64).collect();
    let shortest = seconds.iter().copied().fold(f64::INFINITY, f64::min);
    let rows = candidates.into_iter().zip(seconds).map(|(candidate, seconds)| {
        let accuracy = candidate.scene.parameters().accuracy;
        Row {
            method: in_series.then_some(accuracy.method),
            relative_tolerance: accuracy.relative_tolerance.get(),
            as_requested: !in_series || accuracy == requested,
            errors: Errors::of(&candidate.evaluation, &reference, &finite, accuracy.relative_tolerance.get()),
            methods: candidate.evaluation.methods,
            seconds,
            time_ratio: if seconds > 0.0 { seconds / shortest } else { 1.0 },
            repeats: candidate.timings.len().max(1),
        }
    });
    let rows = rows.collect();
    let bounds = finite.iter().map(|&i| reference.relative_error_bound[i]);
    let reference_error_bound = bounds.reduce(f64::max);
    Tradeoff { compared: finite.len(), reference_error_bound, rows, used }
}

/// A way while it is measured.
struct Candidate {
    scene: Scene,
    evaluation: Evaluation,
    /// Time of the first evaluation, which also fills the caches.
    first: Duration,
    /// Seconds of an evaluation of all directions.
    timings: Vec<f64>,
}

impl Candidate {
    /// Evaluations in one timing.
    fn evaluations(&self) -> u32 {
        let fitting = TIMING.as_nanos() / self.first.as_nanos().max(1);
        u32::try_from(fitting).unwrap_or(MAX_EVALUATIONS).clamp(1, MAX_EVALUATIONS)
    }

    fn median_seconds(&self) -> f64 {
        median(self.timings.clone()).unwrap_or(self.first.as_secs_f64())
    }
}

/// Times all candidates in turn, so that whatever slows the machine for a while slows them all, until the repeats are
/// enough or the next timing would pass the budget.
fn repeat(
    candidates: &mut [Candidate],
    start: Duration,
    now: &mut impl FnMut() -> Duration,
    mut run: impl FnMut(&Scene),
) {
    for _ in 0..MAX_REPEATS {
        for candidate in &mut *candidates {
            let evaluations = candidate.evaluations();
            let begun = now();
            if begun.saturating_sub(start) + candidate.first * evaluations > BUDGET {
                return;
            }
            for _ in 0..evaluations {
                run(&candidate.scene);
            }
            let spent = now().saturating_sub(begun);
            candidate.timings.push(spent.as_secs_f64() / f64::from(evaluations));
        }
    }
}

/// The ways to compare: `auto` at each tolerance and at the requested one, and every named method.
fn ways(requested: Accuracy, in_series: bool) -> Vec<Accuracy> {
    if !in_series {
        return vec![requested];
    }
    let mut tolerances = Tolerance::STEPS.to_vec();
    tolerances.push(requested.relative_tolerance);
    tolerances.sort_by(|a, b| b.get().total_cmp(&a.get()));
    tolerances.dedup();
    let auto = tolerances
        .into_iter()
        .map(|relative_tolerance| Accuracy { relative_tolerance, method: Method::Auto });
    let named = Method::ALL
        .into_iter()
        .filter(|&method| method != Method::Auto)
        .map(|method| Accuracy { method, ..requested });
    auto.chain(named).collect()
}

impl Errors {
    /// Of the totals of `evaluation` in the directions `finite`, against those of `reference`.
    fn of(evaluation: &Evaluation, reference: &Evaluation, finite: &[usize], tolerance: f64) -> Option<Self> {
        let errors: Vec<f64> = finite
            .iter()
            .map(|&i| {
                let least = reference.relative_error_bound[i];
                relative_difference(evaluation.total[i], reference.total[i]).max(least)
            })
            .collect();
        let bounds = finite.iter().map(|&i| infinite_if_nan(evaluation.relative_error_bound[i]));
        let largest_bound = bounds.reduce(f64::max)?;
        Some(Self {
            largest: errors.iter().copied().reduce(f64::max)?,
            median: median(errors)?,
            largest_bound,
            keeps_tolerance: largest_bound <= tolerance,
        })
    }
}

/// |value − exact|/|exact|; 0 for two zeros, infinite where there is no value.
fn relative_difference(value: f64, exact: f64) -> f64 {
    if value == exact { 0.0 } else { infinite_if_nan(((value - exact) / exact).abs()) }
}

fn infinite_if_nan(value: f64) -> f64 {
    if value.is_nan() { f64::INFINITY } else { value }
}

/// The middle value, or the mean of the two in the middle.
fn median(mut values: Vec<f64>) -> Option<f64> {
    values.sort_by(f64::total_cmp);
    let upper = *values.get(values.len() / 2)?;
    let lower = values[(values.len() - 1) / 2];
    Some(if lower == upper { lower } else { 0.5 * (lower + upper) })
}

/// `count` indices, or `most` of them at even distances with both ends.
fn evenly(count: usize, most: usize) -> Vec<usize> {
    if count <= most {
        (0..count).collect()
    } else {
        (0..most).map(|i| i * (count - 1) / (most - 1)).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::{
        BUDGET, Directions, MAX_DIRECTIONS, Method, Output, Scene, Tradeoff, evenly, measure, median,
    };
    use crate::reflectance::directions::Angles;
    use crate::reflectance::quantity::Quantity as _;
    use crate::reflectance::quantity::{Azimuth, SourceZenith, ViewerZenith};
    use core::time::Duration;

    fn directions(count: usize) -> Directions {
        let theta_r =
            (0..count).map(|i| ViewerZenith::new(80.0 * i as f64 / count as f64).unwrap()).collect();
        let (theta_i, phi_r) = (SourceZenith::new(10.0).unwrap(), Azimuth::new(20.0).unwrap());
        Directions::new(Angles::One(theta_i), Angles::Each(theta_r), Angles::One(phi_r)).unwrap()
    }

    fn scene(figure: &str) -> Scene {
        let mut panels = crate::reflectance::figures::find(figure).unwrap().evaluate(false).unwrap();
        panels.remove(0).scene.unwrap()
    }

    /// Measured by a clock that goes on by `step` whenever it is read.
    fn measured(figure: &str, count: usize, step: Duration) -> (Tradeoff, Duration) {
        let mut time = Duration::ZERO;
        let clock = || {
            time += step;
            time
        };
        let trade = measure(&scene(figure), &directions(count), Output::default(), clock);
        (trade, time)
    }

    #[test]
    fn of_many_directions_some_at_even_distances_are_used() {
        assert_eq!(evenly(3, 64), [0, 1, 2]);
        assert_eq!(evenly(64, 64), (0..64).collect::<Vec<_>>());
        for count in [65, 100, 1_000_000] {
            let used = evenly(count, 64);
            assert_eq!((used.len(), used[0], used[63]), (64, 0, count - 1));
            assert!(used.windows(2).all(|pair| pair[0] < pair[1]), "{count}");
        }
        let (trade, _) = measured("11f", 1000, Duration::from_micros(1));
        assert_eq!((trade.used.len(), trade.compared), (MAX_DIRECTIONS, MAX_DIRECTIONS));
    }

    #[test]
    fn no_repeat_is_begun_that_would_pass_the_budget() {
        for micros in [1, 70, 900, 30_000] {
            let step = Duration::from_micros(micros);
            let (trade, time) = measured("11f", 8, step);
            // What cannot be left out: both ends of the first evaluation of each row.
            let first = step.mul_f64(2.0 * trade.rows.len() as f64);
            // The clock is at one step when it is first read, and is read once more to see that no time is left.
            assert!(time <= BUDGET.max(first) + 2 * step, "{micros}: {time:?}");
            assert!(trade.rows.iter().all(|row| (1..=31).contains(&row.repeats)), "{micros}");
            // By this clock everything takes one step.
            assert!(trade.rows.iter().all(|row| (row.time_ratio - 1.0).abs() < 1.0), "{micros}");
        }
    }

    #[test]
    fn the_hundred_terms_are_off_where_the_surface_is_rough_and_say_so() {
        let (trade, _) = measured("13a", 20, Duration::from_micros(5));
        let row = |method| trade.rows.iter().find(|row| row.method == Some(method)).unwrap();
        let (paper, series) = (row(Method::Paper).errors.unwrap(), row(Method::Series).errors.unwrap());
        assert!(paper.largest > 0.99 && !paper.keeps_tolerance, "{paper:?}");
        assert!(series.keeps_tolerance, "{series:?}");
        // Nothing below the reference's own error is shown.
        assert_eq!(Some(series.largest), trade.reference_error_bound);
        for row in &trade.rows {
            let errors = row.errors.unwrap();
            assert!(errors.median <= errors.largest);
            // The true error is within the bound; the one shown may be the reference's.
            assert!(errors.largest <= errors.largest_bound.max(2.0 * series.largest_bound), "{row:?}");
        }
        assert_eq!(trade.rows.iter().filter(|row| row.as_requested).count(), 1);
    }

    #[test]
    fn a_scene_without_a_series_has_one_row() {
        let (trade, _) = measured("20a", 5, Duration::from_micros(5));
        assert_eq!((trade.rows.len(), trade.rows[0].method), (1, None));
        assert!(trade.rows[0].as_requested);
    }

    #[test]
    fn the_median_is_in_the_middle() {
        assert_eq!(median(vec![]), None);
        assert_eq!(median(vec![3.0, 1.0, 2.0]), Some(2.0));
        assert_eq!(median(vec![4.0, 1.0, 2.0, 3.0]), Some(2.5));
        assert_eq!(median(vec![f64::INFINITY; 2]), Some(f64::INFINITY));
    }
}
