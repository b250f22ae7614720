//! `docs/accuracy.md` commits the worst and the median error measured of every quantity. They are held both ways:
//! an error that grows fails, and so does a committed value that has become slack.
//! `UPDATE_ACCURACY=1 cargo test --test golden` rewrites it.

use crate::family::{GATE, Measured};
use crate::measure::exceeds;
use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::PathBuf;

const BEGIN: &str = "<!-- golden: begin -->\n";
const END: &str = "<!-- golden: end -->\n";
/// How far above the measurement a committed value may lie.
const SLACK: f64 = 1.25;
/// Below this many units a difference is not worth a change of the table.
const NEGLIGIBLE: f64 = 0.1;

/// Rounded up to two significant digits, so that a last digit does not change the table.
fn rounded_up(units: f64) -> f64 {
    if units < NEGLIGIBLE {
        return if units == 0.0 { 0.0 } else { NEGLIGIBLE };
    }
    let step = 10f64.powf(units.log10().floor() - 1.0);
    let up = (units / step).ceil() * step;
    format!("{up:.2}").parse().expect("two decimals")
}

fn table(families: &[&Measured]) -> String {
    let mut text = String::from(
        "| family | quantity | values | median, units | worst, units | at |\n| --- | --- | --- | --- | --- | --- |\n",
    );
    for family in families {
        for (quantity, worst) in &family.worst {
            let (name, median, units) = (family.name, rounded_up(worst.median()), rounded_up(worst.units));
            // A quantity that is exact, and a predicate, have no worst line.
            let line = if units == 0.0 { "" } else { worst.line };
            writeln!(text, "| {name} | {quantity} | {} | {median} | {units} | {line} |", worst.count)
                .expect("string");
        }
    }
    text
}

/// A row of the committed table.
struct Row {
    count: usize,
    median: f64,
    worst: f64,
}

fn committed(text: &str) -> BTreeMap<(String, String), Row> {
    let rows = text.lines().filter(|line| line.starts_with('|')).skip(2);
    rows.map(|line| {
        let cells: Vec<_> = line.trim_matches('|').split('|').map(str::trim).collect();
        let units = |cell: usize| cells[cell].parse().expect("units");
        let row = Row { count: cells[2].parse().expect("count"), median: units(3), worst: units(4) };
        ((cells[0].to_owned(), cells[1].to_owned()), row)
    })
    .collect()
}

/// Everything in which the committed table differs from what was measured.
fn differences(families: &[&Measured], text: &str) -> Vec<String> {
    let mut committed = committed(text);
    let mut found = Vec::new();
    for family in families {
        for (quantity, worst) in &family.worst {
            let name = format!("{} {quantity}", family.name);
            let Some(row) = committed.remove(&(family.name.to_owned(), quantity.clone())) else {
                found.push(format!("{name}: not in the table"));
                continue;
            };
            if row.count != worst.count {
                found.push(format!("{name}: {} values, the table says {}", worst.count, row.count));
            }
            let median = worst.median();
            for (what, units, says) in [("median", median, row.median), ("worst", worst.units, row.worst)] {
                if exceeds(units, says) {
                    let at = worst.line;
                    found.push(format!("{name}: {what} {units} units, worst at {at}, the table says {says}"));
                }
                if says > SLACK * units + NEGLIGIBLE {
                    found.push(format!("{name}: {what} only {units} units, the table says {says}"));
                }
            }
        }
    }
    found.extend(
        committed.keys().map(|(family, quantity)| format!("{family} {quantity}: no longer measured")),
    );
    found
}

/// Compares with, or rewrites, the part of docs/accuracy.md between the two marks.
pub(crate) fn hold(families: &[&Measured]) {
    let path = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("docs/accuracy.md");
    let document = std::fs::read_to_string(&path).expect("docs/accuracy.md");
    let (before, rest) = document.split_once(BEGIN).expect("begin mark");
    let (text, after) = rest.split_once(END).expect("end mark");
    if std::env::var_os("UPDATE_ACCURACY").is_some() {
        std::fs::write(&path, [before, BEGIN, &table(families), END, after].concat())
            .expect("docs/accuracy.md");
        return;
    }
    let found = differences(families, text);
    assert!(
        found.is_empty(),
        "docs/accuracy.md is out of date (UPDATE_ACCURACY=1 rewrites it):\n{}",
        found.join("\n")
    );
}

#[test]
fn the_table_holds_both_ways() {
    let measured = |median: f64, units: f64| {
        let mut family = Measured { name: "family", ..Measured::default() };
        let every = vec![0.0, median, units];
        let worst = crate::family::Errors { count: 3, units, line: "line", every };
        family.worst.insert("quantity".to_owned(), worst);
        family
    };
    let text = table(&[&measured(1.11, 8.02)]);
    assert!(text.contains("| family | quantity | 3 | 1.2 | 8.1 | line |"), "{text}");
    for (median, units, fits) in [
        (1.11, 8.02, true),
        (1.2, 8.1, true),
        (0.9, 6.7, true),
        (1.11, 8.11, false),
        (1.21, 8.02, false),
        (0.8, 8.02, false),
        (1.11, 6.0, false),
        (1.11, f64::NAN, false),
    ] {
        assert_eq!(differences(&[&measured(median, units)], &text).is_empty(), fits, "{median} {units}");
    }
    assert_eq!(differences(&[], &text).len(), 1);
    assert_eq!(differences(&[&measured(1.0, 1.0)], &table(&[])).len(), 1);
}

#[test]
fn rounding_up_never_passes_the_slack() {
    for units in [0.0, 1e-9, 0.101, 0.5, 1.0, 1.01, 9.91, 10.1, 15.2, GATE] {
        let up = rounded_up(units);
        assert!(units <= up && up <= SLACK * units + NEGLIGIBLE, "{units} {up}");
    }
}
