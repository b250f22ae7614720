//! What `auto` takes where.

use crate::page::{Column, Table, two_digits};
use crate::plane::{self, FIRST, LAST, TOLERANCES};
use crate::scenes::Probe;
use reflectance::reflectance::numeric::lobe_series::Method;

/// x/g = tan²α/tan²α₀ of the lines along which the boundaries are looked for: the mirror direction, the slope at which
/// the lobe falls to 1/e, and the lobe's tail.
const LINES: [f64; 3] = [0.0, 1.0, 10.0];
/// Steps of a decade in the search for boundaries.
const STEPS: i32 = 50;

/// The methods in order of g, each with the g from which on it is taken.
pub(crate) type Sequence = Vec<(f64, Method)>;

/// The sequences along every line, by tolerance.
pub(crate) fn measured() -> Vec<(f64, Vec<Sequence>)> {
    let probe = Probe::new();
    TOLERANCES.map(|tolerance| (tolerance, LINES.map(|ratio| along(&probe, ratio, tolerance)).into())).into()
}

fn along(probe: &Probe, ratio: f64, tolerance: f64) -> Sequence {
    let mut found = Sequence::new();
    for step in FIRST * STEPS..=LAST * STEPS {
        let g = 10f64.powf(f64::from(step) / f64::from(STEPS));
        let (_, method) = probe.auto(g, ratio * g, tolerance);
        if found.last().is_none_or(|(_, last)| *last != method) {
            found.push((g, method));
        }
    }
    found
}

/// How much of the plane each method gets.
pub(crate) fn shares(map: &plane::Map) -> Table {
    let methods: Vec<_> = Method::ALL.into_iter().filter(|&method| method != Method::Auto).collect();
    let mut columns = vec![("tolerance".to_owned(), Column::Text)];
    columns.extend(methods.iter().map(|method| (format!("`{}`, %", method.name()), Column::Share)));
    let rows = map.auto().map(|(tolerance, layer)| {
        let cells: Vec<Method> = layer.cells.iter().flatten().flatten().map(|off| off.method).collect();
        let share = |method: &Method| {
            let taken = cells.iter().filter(|cell| *cell == method).count();
            format!("{:.1}", 100.0 * taken as f64 / cells.len() as f64)
        };
        let mut row = vec![format!("{tolerance:e}")];
        row.extend(methods.iter().map(share));
        row
    });
    Table { name: "shares", columns, rows: rows.collect() }
}

/// Along each line, the g at which the choice changes.
pub(crate) fn boundaries(sequences: &[(f64, Vec<Sequence>)]) -> Table {
    let mut columns = vec![("tolerance".to_owned(), Column::Text)];
    columns.extend(LINES.map(|ratio| {
        let title = match ratio {
            0.0 => "x = 0".to_owned(),
            1.0 => "x = g".to_owned(),
            _ => format!("x = {ratio} g"),
        };
        (title, Column::Boundaries)
    }));
    let rows = sequences.iter().map(|(tolerance, lines)| {
        let mut row = vec![format!("{tolerance:e}")];
        row.extend(lines.iter().map(|line| told(line)));
        row
    });
    Table { name: "boundaries", columns, rows: rows.collect() }
}

/// "`smooth` 0.001 `series` 60 `uniform`"
fn told(line: &[(f64, Method)]) -> String {
    let named = |method: Method| format!("`{}`", method.name());
    let first = line.first().map(|(_, method)| named(*method));
    let later = line.iter().skip(1).map(|(from, method)| format!("{} {}", two_digits(*from), named(*method)));
    first.into_iter().chain(later).collect::<Vec<_>>().join(" ")
}

#[cfg(test)]
#[test]
fn a_line_is_told_in_order_of_g() {
    let line = [(1e-4, Method::Smooth), (1.23e-3, Method::Series), (57.5, Method::Uniform)];
    assert_eq!(told(&line), "`smooth` 1.2e-3 `series` 58 `uniform`");
    assert_eq!(two_digits(20000.0), "2e4");
}
