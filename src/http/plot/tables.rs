//! What the report's figures show, out of their tables.

use super::options::{Options, Scale, Shown};
use super::words::{direction, name, symbol};
use super::{Columns, Curve, Plot, TOTAL};
use crate::reflectance::figures::{Figure, Panel};
use crate::reflectance::table::{self, Table};

/// The components and what they are called, as the columns are.
const COMPONENTS: [(&str, &str, &str); 4] = [
    ("total", "log10_total", TOTAL),
    ("diffuse_lobe", "log10_diffuse_lobe", "diffuse lobe"),
    ("specular_lobe", "log10_specular_lobe", "specular lobe"),
    ("specular_spike", "log10_specular_spike", "specular spike"),
];

/// The plot of a figure, whose tables have logarithms where the scale asks for them.
pub(crate) fn of_figure(figure: &Figure, panels: &[Panel], options: &Options) -> Plot {
    let mut plot = Plot {
        title: format!("Figure {}: {}", figure.id, figure.title),
        parameters: parameters(figure),
        ..Plot::default()
    };
    let Some(first) = panels.first().map(|panel| &panel.table) else { return plot };
    plot.quantity = name(first.quantity);
    plot.unit = super::ticks::unit(first.unit);
    plot.axis = symbol(first.axis.name);
    plot.ends = ends(first);
    let curves = first.curves.len();
    if let (Some(fixed), [only]) = (first.fixed, first.curves.as_slice()) {
        plot.fixed = only.at_deg.map(|at| (direction(fixed), at));
    }
    let columns = Columns::new(plot.ends, options.width, COMPONENTS.len() * curves * panels.len());
    for (panel_index, panel) in panels.iter().enumerate() {
        for (index, curve) in panel.table.curves.iter().enumerate() {
            let drawn = drawn(curve, curves * panels.len(), options);
            for (kind, column, is_log) in drawn {
                let points = panel.table.axis.values.iter().copied().zip(column.values.iter().copied());
                let points = points.map(|(x, y)| (x, if is_log { y.log10() } else { y }));
                // Where there is one curve, its parts have colours; otherwise the curves have, and their parts are dashed.
                let parts = if curves > 1 {
                    (index, if panels.len() > 1 { panel_index } else { kind })
                } else {
                    (kind, 0)
                };
                plot.curves.push(Curve { colour: parts.0, dash: parts.1, points: columns.thin(points) });
            }
        }
    }
    let kinds = COMPONENTS.map(|(_, _, name)| name.to_owned());
    if curves > 1 {
        plot.colours = first.curves.iter().map(|curve| label(first, curve)).collect();
        if panels.len() > 1 {
            plot.dashes = panels.iter().map(|panel| panel.label.to_owned()).collect();
        } else if plot.curves.iter().any(|curve| curve.dash > 0) {
            plot.dashes = kinds.to_vec();
        }
    } else {
        plot.colours = kinds.to_vec();
    }
    plot.without_unused();
    plot
}

fn parameters(figure: &Figure) -> String {
    let unit = if figure.parameters.contains('λ') { "; lengths in µm" } else { "" };
    format!("{}{unit}", figure.parameters)
}

fn ends(table: &Table) -> (f64, f64) {
    let values = &table.axis.values;
    (values.first().copied().unwrap_or_default(), values.last().copied().unwrap_or_default())
}

fn label(table: &Table, curve: &table::Curve) -> String {
    match (table.fixed, curve.at_deg) {
        (Some(fixed), Some(at)) => format!("{} = {at}°", symbol(fixed).0),
        _ => curve.label.clone(),
    }
}

/// The columns of a curve that are drawn: which kind, the numbers, and whether their logarithms are still to be taken.
fn drawn<'a>(curve: &'a table::Curve, of: usize, options: &Options) -> Vec<(usize, &'a table::Column, bool)> {
    let find = |name: &str| curve.columns.iter().find(|column| column.name == name);
    let is_log = options.scale == Scale::Log10;
    let mut columns: Vec<_> = COMPONENTS
        .iter()
        .enumerate()
        .filter_map(|(kind, (plain, log10, _))| {
            find(if is_log { log10 } else { plain }).map(|column| (kind, column, false))
        })
        .collect();
    if columns.is_empty() {
        // Figures 18 and 19 have one column of their own.
        return curve.columns.first().map(|column| (0, column, is_log)).into_iter().collect();
    }
    super::keep_shown(&mut columns, |column| column.0, options.shown.unwrap_or(Shown::natural(of)));
    columns
}
