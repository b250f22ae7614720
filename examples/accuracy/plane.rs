//! The true error of each method over the (g, x) plane, against the series summed to convergence, and what `auto`
//! takes there.

use crate::page::{Column, Table, rounded_up};
use crate::scenes::{Probe, accuracy, finest};
use reflectance::reflectance::estimate::Estimate;
use reflectance::reflectance::numeric::lobe_series::{self, Method};
use reflectance::reflectance::quantity::Tolerance;

/// Both axes run from 10^FIRST to 10^LAST.
pub(crate) const FIRST: i32 = -4;
pub(crate) const LAST: i32 = 8;
/// Cells of a decade.
const PER_DECADE: i32 = 8;
/// Tolerances of `auto`: those of the service's trade, and the finest that the whole plane can keep but for rounding.
pub(crate) const TOLERANCES: [f64; 6] = [1e-1, 1e-3, 1e-6, 1e-9, 1e-12, 1e-13];
/// Below, a radiance soon underflows: that part of the plane is left out.
const SMALLEST_S: f64 = -300.0;

/// The middle of cell `index` of an axis.
fn middle(index: usize) -> f64 {
    10f64.powf(f64::from(FIRST) + (index as f64 + 0.5) / f64::from(PER_DECADE))
}

/// Something for each cell, except where the plane is left out; rows by x, columns by g.
pub(crate) type Grid<T> = Vec<Vec<Option<T>>>;

/// Cells along an axis.
pub(crate) const CELLS: usize = ((LAST - FIRST) * PER_DECADE) as usize;

/// A point of the plane with the converged S there, and the lobe of which it is a part.
struct Point {
    g: f64,
    x: f64,
    exact: Estimate,
    total: f64,
    total_bound: f64,
}

impl Point {
    fn at(probe: &Probe, row: usize, column: usize) -> Option<Self> {
        let (x, g) = (middle(row), middle(column));
        let exact = lobe_series::evaluate(Method::Series, g, x).estimate;
        if exact.value.log10() < SMALLEST_S {
            return None;
        }
        let lobe = probe.evaluate(g, x, accuracy(Method::Series, finest()));
        Some(Self { g, x, exact, total: lobe.total[0], total_bound: lobe.relative_error_bound[0] })
    }
}

fn map<T, U>(grid: &Grid<T>, of: impl Fn(&T) -> U) -> Grid<U> {
    grid.iter().map(|row| row.iter().map(|cell| cell.as_ref().map(&of)).collect()).collect()
}

/// log10 of the error made and of the bound stated, and the method that evaluated.
#[derive(Clone, Copy)]
pub(crate) struct Off {
    pub(crate) error: f64,
    bound: f64,
    pub(crate) method: Method,
}

/// One way to evaluate S, over the plane.
pub(crate) struct Layer {
    pub(crate) method: Method,
    /// For `auto`.
    pub(crate) tolerance: Option<f64>,
    pub(crate) cells: Grid<Off>,
}

/// All of them.
pub(crate) struct Map {
    pub(crate) layers: Vec<Layer>,
}

impl Map {
    pub(crate) fn measured() -> Self {
        let probe = Probe::new();
        let points: Grid<Point> =
            (0..CELLS).map(|row| (0..CELLS).map(|column| Point::at(&probe, row, column)).collect()).collect();
        let named = [Method::Series, Method::Uniform, Method::Paper, Method::Smooth, Method::Rough];
        let named = named.map(|method| Layer {
            method,
            tolerance: None,
            cells: map(&points, |point| off(method, point)),
        });
        let auto = TOLERANCES.map(|tolerance| Layer {
            method: Method::Auto,
            tolerance: Some(tolerance),
            cells: map(&points, |point| off_auto(&probe, point, tolerance)),
        });
        Self { layers: named.into_iter().chain(auto).collect() }
    }

    /// What `auto` does, from the coarsest tolerance to the finest.
    pub(crate) fn auto(&self) -> impl Iterator<Item = (f64, &Layer)> {
        self.layers.iter().filter_map(|layer| layer.tolerance.map(|tolerance| (tolerance, layer)))
    }

    /// `auto` at this tolerance, or a named method.
    pub(crate) fn layer(&self, method: Method, tolerance: Option<f64>) -> Option<&Layer> {
        self.layers.iter().find(|layer| layer.method == method && layer.tolerance == tolerance)
    }

    /// How much of the plane each method serves to which error.
    pub(crate) fn table(&self) -> Table {
        let limits = Tolerance::STEPS.map(Tolerance::get);
        let mut columns = vec![("method".to_owned(), Column::Text)];
        columns.extend(limits.map(|limit| (format!("error ≤ {limit:e}, %"), Column::Share)));
        columns.push(("largest error".to_owned(), Column::Error));
        columns.push(("median bound ÷ error".to_owned(), Column::Error));
        let rows = self.layers.iter().map(|layer| layer.row(&limits)).collect();
        Table { name: "methods", columns, rows }
    }
}

impl Layer {
    fn row(&self, limits: &[f64]) -> Vec<String> {
        let cells: Vec<Off> = self.cells.iter().flatten().flatten().copied().collect();
        let name = match self.tolerance {
            Some(tolerance) => format!("`auto`, {tolerance:e}"),
            None => format!("`{}`", self.method.name()),
        };
        let share = |limit: &f64| {
            let within = cells.iter().filter(|cell| cell.error <= limit.log10()).count();
            format!("{:.1}", 100.0 * within as f64 / cells.len() as f64)
        };
        let largest = cells.iter().map(|cell| cell.error).fold(f64::NEG_INFINITY, f64::max);
        let mut row = vec![name];
        row.extend(limits.iter().map(share));
        row.extend([rounded_up(10f64.powf(largest)), idleness(&cells)]);
        row
    }
}

/// Median of bound over error, where there is an error to speak of and the bound says that the method serves.
fn idleness(cells: &[Off]) -> String {
    let speaks = |cell: &&Off| cell.error > -11.0 && cell.bound < 0.5f64.log10();
    let mut ratios: Vec<f64> =
        cells.iter().filter(speaks).map(|cell| 10f64.powf(cell.bound - cell.error)).collect();
    ratios.sort_by(f64::total_cmp);
    ratios.get(ratios.len() / 2).map_or("–".to_owned(), |&ratio| rounded_up(ratio))
}

/// Of a named method. No error below the reference's own bound can be told.
fn off(method: Method, Point { g, x, exact, .. }: &Point) -> Off {
    let by = lobe_series::evaluate(method, *g, *x).estimate;
    let error = (by.value.distance(exact.value) / exact.value).log10();
    let bound = (by.error / by.least).log10();
    Off { error: error.max(exact.relative_error().log10()), bound, method }
}

/// Of `auto`, as it answers a request to this tolerance.
fn off_auto(probe: &Probe, Point { g, x, total, total_bound, .. }: &Point, tolerance: f64) -> Off {
    let (by, method) = probe.auto(*g, *x, tolerance);
    let error = ((by.total[0] - total) / total).abs();
    Off { error: error.max(*total_bound).log10(), bound: by.relative_error_bound[0].log10(), method }
}

#[cfg(test)]
#[test]
fn the_smooth_form_misses_the_second_term() {
    let probe = Probe::new();
    let low = Point::at(&probe, 8, 8).unwrap();
    // S = g e^{-g-x} (1 + g e^{x/2}/4 + …)
    let expected = (low.g * (0.5 * low.x).exp() / 4.0).log10();
    let measured = off(Method::Smooth, &low).error;
    assert!((measured - expected).abs() < 1e-2, "{measured} {expected}");
    let finest = off_auto(&probe, &low, finest()).error;
    assert!((-14.5..-13.0).contains(&finest), "{finest}");
}
