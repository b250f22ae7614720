//! The tables of docs/accuracy.md: written between marks, and held both ways.

use std::error::Error;
use std::fmt;
use std::path::{Path, PathBuf};

/// What is in a column, and how far the page may be from the measurement.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Column {
    /// Names and counts: equal.
    Text,
    /// Rounded up to two digits: not below what is measured, and not more than a quarter above.
    Error,
    /// Percent: a cell on an edge may fall to either side of it where the platform's functions round differently.
    Share,
    /// Names between numbers: the names equal, the numbers within a step of the scan that found them.
    Boundaries,
    /// Times, and what follows from them: as they were when the page was written.
    Time,
}

/// A table of the page.
pub(crate) struct Table {
    /// Its marks are named so.
    pub(crate) name: &'static str,
    /// Title and kind of each column.
    pub(crate) columns: Vec<(String, Column)>,
    pub(crate) rows: Vec<Vec<String>>,
}

impl fmt::Display for Table {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let titles: Vec<_> = self.columns.iter().map(|(title, _)| title.as_str()).collect();
        writeln!(f, "| {} |\n|{}", titles.join(" | "), " --- |".repeat(titles.len()))?;
        self.rows.iter().try_for_each(|row| writeln!(f, "| {} |", row.join(" | ")))
    }
}

/// An error as the page shows it: two digits, rounded up.
pub(crate) fn rounded_up(error: f64) -> String {
    if error == 0.0 || !error.is_finite() {
        return format!("{error}").replace("inf", "∞");
    }
    let step = 10f64.powf(error.log10().floor() - 1.0);
    // The quotient of what has two digits already may come out just above them.
    let digits = (error / step - 1e-9).ceil();
    two_digits(digits * step)
}

/// Two digits, with an exponent where that is shorter.
pub(crate) fn two_digits(value: f64) -> String {
    let number = format!("{value:.1e}").parse().unwrap_or(value);
    if (1e-2..1e4).contains(&number) { number.to_string() } else { format!("{number:e}") }
}

/// docs/accuracy.md.
pub(crate) struct Page {
    path: PathBuf,
    pub(crate) text: String,
}

impl Page {
    pub(crate) fn read(path: &Path) -> Result<Self, Box<dyn Error>> {
        Ok(Self { path: path.to_owned(), text: std::fs::read_to_string(path)? })
    }

    /// Where the part of this name begins and ends.
    pub(crate) fn range(&self, name: &str) -> Result<std::ops::Range<usize>, String> {
        let find = |mark: &str| {
            let mark = format!("<!-- {name}: {mark} -->\n");
            self.text.find(&mark).map(|at| (at, at + mark.len())).ok_or(format!("no mark {mark}"))
        };
        Ok(find("begin")?.1..find("end")?.0)
    }

    pub(crate) fn replace(&mut self, name: &str, text: &str) -> Result<(), String> {
        let range = self.range(name)?;
        self.text.replace_range(range, text);
        Ok(())
    }

    pub(crate) fn write(&self) -> std::io::Result<()> {
        std::fs::write(&self.path, &self.text)
    }
}
