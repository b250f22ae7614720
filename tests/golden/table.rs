//! Reads the tables of `data/`; README.md describes their cells.

use std::collections::HashMap;

/// A value of the oracle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Exact {
    /// The nearest double; 0 on underflow, infinite on overflow.
    pub(crate) nearest: f64,
    /// Exact value − nearest double, to a hundredth of an ulp.
    pub(crate) rest: f64,
    /// log10 |value|, given where the nearest double cannot tell.
    pub(crate) log: Option<f64>,
}

impl Exact {
    /// A double, exactly.
    pub(crate) fn of(value: f64) -> Self {
        Self { nearest: value, rest: 0.0, log: None }
    }

    /// log10 |value|; −∞ for an exact zero.
    pub(crate) fn log10(&self) -> f64 {
        // One more rounding than the oracle's own logarithm: below one unit of the measure.
        self.log.unwrap_or_else(|| libm::log10(self.nearest.abs()))
    }

    fn parse(cell: &str) -> Self {
        let (cell, log) = match cell.split_once('@') {
            Some((cell, log)) => (cell, Some(log.parse().expect("logarithm"))),
            None => (cell, None),
        };
        let (cell, hundredths) = match cell.split_once('~') {
            Some((cell, rest)) => (cell, rest.parse().expect("hundredths of an ulp")),
            None => (cell, 0.0),
        };
        let nearest: f64 = cell.parse().expect("nearest double");
        Self { nearest, rest: hundredths * (ulp(nearest) / 100.0), log }
    }
}

/// The spacing of doubles at `value`.
fn ulp(value: f64) -> f64 {
    let size = value.abs();
    if size.is_finite() { size.next_up() - size } else { 0.0 }
}

/// One cell of an `out.` column.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Value {
    /// A number.
    Number(Exact),
    /// A predicate.
    Truth(bool),
    /// Undefined.
    Undefined,
}

/// One file of `data/`.
pub(crate) struct Table {
    columns: HashMap<&'static str, usize>,
    names: Vec<&'static str>,
    rows: Vec<Vec<&'static str>>,
}

/// One line of a table.
#[derive(Clone, Copy)]
pub(crate) struct Row<'t> {
    table: &'t Table,
    cells: &'t [&'static str],
}

impl Table {
    pub(crate) fn parse(text: &'static str) -> Self {
        let mut lines = text.lines();
        let names: Vec<_> = lines.next().expect("header").split('\t').collect();
        let rows: Vec<Vec<_>> = lines.map(|line| line.split('\t').collect()).collect();
        assert!(rows.iter().all(|row| row.len() == names.len()), "ragged table");
        let columns = names.iter().enumerate().map(|(index, &name)| (name, index)).collect();
        Self { columns, names, rows }
    }

    pub(crate) fn rows(&self) -> impl Iterator<Item = Row<'_>> {
        self.rows.iter().map(|cells| Row { table: self, cells })
    }

    pub(crate) fn len(&self) -> usize {
        self.rows.len()
    }
}

impl<'t> Row<'t> {
    /// The text of a cell; `None` where this kind of line has none.
    pub(crate) fn cell(&self, column: &str) -> Option<&'static str> {
        self.table.columns.get(column).map(|&index| self.cells[index]).filter(|cell| !cell.is_empty())
    }

    pub(crate) fn id(&self) -> &'static str {
        self.cells[0]
    }

    /// An input that is a number.
    pub(crate) fn input(&self, name: &str) -> f64 {
        self.optional(name).unwrap_or_else(|| panic!("{}: {name} is null", self.id()))
    }

    /// An input that may be `null`.
    pub(crate) fn optional(&self, name: &str) -> Option<f64> {
        let cell =
            self.cell(&format!("in.{name}")).unwrap_or_else(|| panic!("{}: no input {name}", self.id()));
        (cell != "null").then(|| cell.parse().expect("number"))
    }

    /// An input that is a string.
    pub(crate) fn text(&self, name: &str) -> &'static str {
        self.cell(&format!("in.{name}")).expect("text").trim_matches('"')
    }

    /// The conditioning that goes into the measure, where the oracle gives one.
    pub(crate) fn cint(&self, name: &str) -> Option<f64> {
        self.cell(&format!("cint.{name}")).map(|cell| cell.parse().expect("cint"))
    }

    /// The sum of the condition numbers with respect to the inputs.
    pub(crate) fn cond(&self, name: &str) -> Option<f64> {
        self.cell(&format!("cond.{name}")).map(|cell| cell.parse().expect("cond"))
    }

    /// An output.
    pub(crate) fn output(&self, name: &str) -> Option<Value> {
        self.cell(&format!("out.{name}")).map(|cell| match cell {
            "null" => Value::Undefined,
            "true" => Value::Truth(true),
            "false" => Value::Truth(false),
            number => Value::Number(Exact::parse(number)),
        })
    }

    /// An output that is known to be a number.
    pub(crate) fn exact(&self, name: &str) -> Exact {
        match self.output(name) {
            Some(Value::Number(exact)) => exact,
            other => panic!("{}: {name} is {other:?}", self.id()),
        }
    }

    /// The names of the outputs this line has.
    pub(crate) fn outputs(&self) -> impl Iterator<Item = &'static str> + use<'t> {
        let cells = self.cells;
        self.table
            .names
            .iter()
            .enumerate()
            .filter_map(move |(index, name)| name.strip_prefix("out.").filter(|_| !cells[index].is_empty()))
    }

    /// The columns whose names are JSON Pointers, with their JSON.
    pub(crate) fn pointers(&self) -> impl Iterator<Item = (&'static str, &'static str)> + use<'t> {
        let cells = self.cells;
        let named = self.table.names.iter().copied().zip(cells.iter().copied());
        named.filter(|(name, cell)| name.starts_with('/') && !cell.is_empty())
    }
}

#[test]
fn cells_read_back() {
    assert_eq!(Exact::parse("1.5"), Exact::of(1.5));
    let exact = Exact::parse("1~-37");
    assert_eq!((exact.nearest, exact.log), (1.0, None));
    assert!((exact.rest + 0.37 * f64::EPSILON).abs() < 1e-30);
    assert_eq!(Exact::parse("0@-1234.5"), Exact { nearest: 0.0, rest: 0.0, log: Some(-1234.5) });
    assert_eq!(Exact::parse("inf@310").nearest, f64::INFINITY);
    // A hundredth of the smallest step is no double: the rest of a subnormal rounds away.
    assert_eq!(Exact::parse("5e-324~40@-323.2").nearest, 5e-324);
    assert_eq!(Exact::of(0.0).log10(), f64::NEG_INFINITY);
    assert_eq!(Exact::of(-100.0).log10(), 2.0);
}
