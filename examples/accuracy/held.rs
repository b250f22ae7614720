//! Whether docs/accuracy.md says what was measured.

use crate::page::{Column, Page, Table, rounded_up};

/// How far above the measurement an error on the page may lie.
const SLACK: f64 = 1.25;
/// Points of a percentage that may be missing or too many.
const SHARE_SLACK: f64 = 0.2;
/// Relative difference of a boundary: a step of the scan, 5 %, and two digits, 10 %.
const BOUNDARY_SLACK: f64 = 0.15;

impl Table {
    /// Everything in which the page differs from this measurement.
    pub(crate) fn differences(&self, page: &str) -> Vec<String> {
        let committed: Vec<Vec<_>> = page
            .lines()
            .skip(2)
            .map(|line| line.trim_matches('|').split('|').map(str::trim).collect())
            .collect();
        let mut found = Vec::new();
        if committed.len() != self.rows.len() {
            found.push(format!(
                "{}: {} rows on the page, {} measured",
                self.name,
                committed.len(),
                self.rows.len()
            ));
        }
        for (row, says) in self.rows.iter().zip(&committed) {
            for (((title, kind), cell), says) in self.columns.iter().zip(row).zip(says) {
                if !kind.holds(cell, says) {
                    let name = self.name;
                    found.push(format!("{name}, {}: {title} is {cell}, the page says {says}", row[0]));
                }
            }
        }
        found
    }
}

impl Column {
    fn holds(self, measured: &str, says: &str) -> bool {
        if measured == says {
            return true;
        }
        let numbers = measured.parse::<f64>().ok().zip(says.parse::<f64>().ok());
        match self {
            Self::Text => false,
            Self::Error => numbers.is_some_and(|(m, s)| m <= s && s <= SLACK * m),
            Self::Share => numbers.is_some_and(|(m, s)| (m - s).abs() <= SHARE_SLACK + 1e-9),
            Self::Boundaries => {
                let (measured, says): (Vec<_>, Vec<_>) =
                    (measured.split(' ').collect(), says.split(' ').collect());
                let holds = |(m, s): (&&str, &&str)| match (m.parse::<f64>(), s.parse::<f64>()) {
                    (Ok(m), Ok(s)) => (m / s - 1.0).abs() <= BOUNDARY_SLACK,
                    _ => m == s,
                };
                measured.len() == says.len() && measured.iter().zip(&says).all(holds)
            }
            Self::Time => true,
        }
    }
}

impl Page {
    /// What stands between the marks of this name.
    pub(crate) fn part(&self, name: &str) -> Result<&str, String> {
        Ok(&self.text[self.range(name)?])
    }
}

#[test]
fn errors_are_rounded_up_to_two_digits() {
    for (error, shown) in [
        (1.3e-9, "1.3e-9"),
        (1.301e-9, "1.4e-9"),
        (9.91e-3, "0.01"),
        (1.0, "1"),
        (0.0, "0"),
        (f64::INFINITY, "∞"),
    ] {
        assert_eq!(rounded_up(error), shown);
    }
    for exponent in -300..300 {
        let error = 1.2345 * 10f64.powi(exponent);
        let shown: f64 = rounded_up(error).parse().unwrap();
        assert!(error <= shown && shown <= 1.1 * error, "{error} {shown}");
    }
}

#[test]
fn a_table_is_held_both_ways() {
    let table = |cells: [&str; 5]| Table {
        name: "made_up",
        columns: [Column::Text, Column::Error, Column::Share, Column::Boundaries, Column::Time]
            .map(|kind| (format!("{kind:?}"), kind))
            .into(),
        rows: vec![cells.map(str::to_owned).into()],
    };
    let page = table(["a", "1.2e-9", "12.3", "`smooth` 0.01 `series`", "5"]).to_string();
    let fits = |cells| table(cells).differences(&page).is_empty();
    assert!(fits(["a", "1.2e-9", "12.3", "`smooth` 0.01 `series`", "5"]));
    assert!(fits(["a", "1e-9", "12.1", "`smooth` 0.0105 `series`", "50"]));
    for wrong in [
        ["b", "1.2e-9", "12.3", "`smooth` 0.01 `series`", "5"],
        ["a", "1.3e-9", "12.3", "`smooth` 0.01 `series`", "5"],
        ["a", "9e-10", "12.3", "`smooth` 0.01 `series`", "5"],
        ["a", "∞", "12.3", "`smooth` 0.01 `series`", "5"],
        ["a", "1.2e-9", "12.6", "`smooth` 0.01 `series`", "5"],
        ["a", "1.2e-9", "12.3", "`smooth` 0.02 `series`", "5"],
        ["a", "1.2e-9", "12.3", "`smooth` 0.01 `uniform`", "5"],
        ["a", "1.2e-9", "12.3", "`smooth`", "5"],
    ] {
        assert_eq!(table(wrong).differences(&page).len(), 1, "{wrong:?}");
    }
    let mut longer = table(["a", "1.2e-9", "12.3", "`smooth` 0.01 `series`", "5"]);
    longer.rows.push(longer.rows[0].clone());
    assert_eq!(longer.differences(&page).len(), 1);
}
