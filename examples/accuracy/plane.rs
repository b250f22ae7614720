//! The true error of each method over the (g, x) plane, against the series summed to convergence.

use crate::page::{Column, Table, rounded_up};
use crate::scenes::{Probe, accuracy, finest};
use reflectance::reflectance::numeric::lobe_series::{self, Method};
use reflectance::reflectance::quantity::Tolerance;

/// Both axes run from 10^FIRST to 10^LAST.
pub(crate) const FIRST: i32 = -4;
pub(crate) const LAST: i32 = 8;
/// Cells of a decade.
const PER_DECADE: i32 = 8;
/// Below, a radiance soon underflows: that part of the plane is left out.
const SMALLEST_S: f64 = -300.0;

/// The middle of cell `index` of an axis.
fn middle(index: usize) -> f64 {
    10f64.powf(f64::from(FIRST) + (index as f64 + 0.5) / f64::from(PER_DECADE))
}

/// One number for each cell.
pub(crate) type Grid<T> = Vec<Vec<Option<T>>>;

/// Cells along an axis.
pub(crate) const CELLS: usize = ((LAST - FIRST) * PER_DECADE) as usize;

/// Evaluates something wherever the plane is not left out; rows by x, columns by g.
pub(crate) fn grid<T>(mut of: impl FnMut(f64, f64) -> T) -> Grid<T> {
    (0..CELLS)
        .map(|row| {
            let x = middle(row);
            (0..CELLS)
                .map(|column| {
                    let g = middle(column);
                    let s = lobe_series::evaluate(Method::Series, g, x);
                    (s.estimate.value.log10() >= SMALLEST_S).then(|| of(g, x))
                })
                .collect()
        })
        .collect()
}

/// log10 of the error made and of the bound stated.
#[derive(Clone, Copy)]
pub(crate) struct Off {
    pub(crate) error: f64,
    bound: f64,
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
        let named = [Method::Series, Method::Uniform, Method::Paper, Method::Smooth, Method::Rough];
        let named =
            named.map(|method| Layer { method, tolerance: None, cells: grid(|g, x| off(method, g, x)) });
        let probe = Probe::new();
        let auto = Tolerance::STEPS.map(|tolerance| {
            let tolerance = tolerance.get();
            let cells = grid(|g, x| off_auto(&probe, g, x, tolerance));
            Layer { method: Method::Auto, tolerance: Some(tolerance), cells }
        });
        Self { layers: named.into_iter().chain(auto).collect() }
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
fn off(method: Method, g: f64, x: f64) -> Off {
    let exact = lobe_series::evaluate(Method::Series, g, x).estimate;
    let by = lobe_series::evaluate(method, g, x).estimate;
    let error = (by.value.distance(exact.value) / exact.value).log10();
    let bound = (by.error / by.least).log10();
    Off { error: error.max(exact.relative_error().log10()), bound }
}

/// Of `auto`, as it answers a request to this tolerance.
fn off_auto(probe: &Probe, g: f64, x: f64, tolerance: f64) -> Off {
    let exact = probe.evaluate(g, x, accuracy(Method::Series, finest()));
    let by = probe.evaluate(g, x, accuracy(Method::Auto, tolerance));
    let error = ((by.total[0] - exact.total[0]) / exact.total[0]).abs();
    Off { error: error.max(exact.relative_error_bound[0]).log10(), bound: by.relative_error_bound[0].log10() }
}

#[cfg(test)]
#[test]
fn the_smooth_form_misses_the_second_term() {
    // S = g e^{-g-x} (1 + g e^{x/2}/4 + …)
    let measured = off(Method::Smooth, 1e-3, 1e-3).error;
    assert!((measured - (1e-3f64 / 4.0).log10()).abs() < 1e-2, "{measured}");
    let probe = Probe::new();
    let finest = off_auto(&probe, 30.0, 2.0, finest()).error;
    assert!((-14.5..-13.0).contains(&finest), "{finest}");
}
