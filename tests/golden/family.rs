//! One file of the oracle against the core: every output of every line has to be checked, and
//! the worst error of each quantity is kept.

use crate::measure;
use crate::table::{Exact, Row, Table, Value};
use reflectance::reflectance::numeric::scaled::Scaled;
use std::cell::RefCell;
use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write as _;

/// The gate, in units of the measure.
pub(crate) const GATE: f64 = 64.0;

/// The errors of one quantity.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Errors {
    /// Values checked.
    pub(crate) count: usize,
    /// Largest error, in units.
    pub(crate) units: f64,
    /// The line it is at.
    pub(crate) line: &'static str,
    /// Every error, in units.
    pub(crate) every: Vec<f64>,
}

impl Errors {
    /// The error that half of the values stay within.
    pub(crate) fn median(&self) -> f64 {
        let mut every = self.every.clone();
        every.sort_by(f64::total_cmp);
        every.get(every.len() / 2).copied().unwrap_or(0.0)
    }

    fn add(&mut self, line: &'static str, units: f64) {
        self.count += 1;
        // A NaN would lose every comparison: it counts as infinitely wrong.
        let units = if units.is_nan() { f64::INFINITY } else { units };
        if units > self.units || self.line.is_empty() {
            (self.units, self.line) = (units, line);
        }
        self.every.push(units);
    }
}

/// What a family measured.
#[derive(Debug, Default)]
pub(crate) struct Measured {
    /// Name of the family.
    pub(crate) name: &'static str,
    /// Lines read.
    pub(crate) lines: usize,
    /// Errors by quantity; logarithms under `log10 …`.
    pub(crate) worst: BTreeMap<String, Errors>,
    /// Everything that is wrong, one sentence each.
    pub(crate) failures: Vec<String>,
}

/// A line being checked.
pub(crate) struct Line<'f> {
    /// Its inputs and outputs.
    pub(crate) row: Row<'f>,
    seen: RefCell<BTreeSet<&'static str>>,
    measured: RefCell<&'f mut Measured>,
}

impl Measured {
    /// Runs `check` on every line of `table` and sees that it left out no output.
    pub(crate) fn run(name: &'static str, table: &Table, check: impl Fn(&Line<'_>)) -> Self {
        let mut measured = Self { name, lines: table.len(), ..Self::default() };
        for row in table.rows() {
            let line = Line { row, seen: RefCell::default(), measured: RefCell::new(&mut measured) };
            check(&line);
            for output in row.outputs() {
                if !line.seen.borrow().contains(output) {
                    line.fail(output, "was not checked");
                }
            }
        }
        measured
    }

    /// Fails with all that is wrong: what lies beyond the gate, and every predicate missed.
    pub(crate) fn assert_passes(&self, lines: usize, values: usize) {
        println!("{}", self.report());
        let shown: Vec<_> = self.failures.iter().take(40).map(String::as_str).collect();
        assert!(
            self.failures.is_empty(),
            "{}: {} failures, the first of them:\n{}",
            self.name,
            self.failures.len(),
            shown.join("\n")
        );
        assert_eq!(self.lines, lines, "{}: lines", self.name);
        assert_eq!(self.values(), values, "{}: values", self.name);
    }

    /// Values compared: numbers, logarithms, predicates.
    pub(crate) fn values(&self) -> usize {
        self.worst.values().map(|worst| worst.count).sum()
    }

    fn report(&self) -> String {
        let mut text = format!("{}: {} lines, {} values\n", self.name, self.lines, self.values());
        for (quantity, worst) in &self.worst {
            let Errors { count, units, line, .. } = worst;
            let median = worst.median();
            writeln!(
                text,
                "  {quantity:32} {count:6} values, median {median:6.3}, worst {units:8.3} units at {line}"
            )
            .expect("string");
        }
        text
    }
}

impl Line<'_> {
    /// A number known with its logarithm: both are judged, at every magnitude.
    pub(crate) fn scaled(&self, output: &'static str, computed: Scaled, cint: f64) {
        self.pair(output, computed.to_f64(), computed.log10(), cint);
    }

    /// A value and the logarithm answered beside it.
    pub(crate) fn pair(&self, output: &'static str, computed: f64, log10: f64, cint: f64) {
        self.value(output, computed, cint);
        if let Some(Value::Number(exact)) = self.row.output(output) {
            let size = if computed < 0.0 { f64::NAN } else { log10 };
            self.add(format!("log10 {output}"), log10, measure::log_units(size, &exact, cint));
        }
    }

    /// The same output once more, made in another way: a row of its own.
    pub(crate) fn pair_by(&self, way: &str, output: &'static str, computed: f64, log10: f64, cint: f64) {
        if let Some(Value::Number(exact)) = self.row.output(output) {
            self.add(format!("{output} {way}"), computed, measure::units(computed, &exact, cint));
            self.add(format!("log10 {output} {way}"), log10, measure::log_units(log10, &exact, cint));
        }
    }

    /// A number against a reference that takes the place of the oracle's.
    pub(crate) fn instead(&self, output: &'static str, computed: Scaled, reference: &Exact, cint: f64) {
        self.seen.borrow_mut().insert(output);
        let (value, log10) = (computed.to_f64(), computed.log10());
        self.add(output.to_owned(), value, measure::units(value, reference, cint));
        self.add(format!("log10 {output}"), log10, measure::log_units(log10, reference, cint));
    }

    /// A number that the core offers as a plain double. Undefined has to come as NaN.
    pub(crate) fn value(&self, output: &'static str, computed: f64, cint: f64) {
        self.seen.borrow_mut().insert(output);
        match self.row.output(output) {
            Some(Value::Number(exact)) => {
                self.add(output.to_owned(), computed, measure::units(computed, &exact, cint));
            }
            Some(Value::Undefined) => {
                self.add(output.to_owned(), computed, if computed.is_nan() { 0.0 } else { f64::INFINITY });
            }
            other => self.fail(output, &format!("is {other:?}, computed {computed}")),
        }
    }

    /// A value that the oracle leaves undefined and for which the core answers a limit.
    pub(crate) fn instead_of_undefined(&self, output: &'static str, computed: f64, limit: f64) {
        self.seen.borrow_mut().insert(output);
        let right = self.row.output(output) == Some(Value::Undefined) && computed == limit;
        self.add(output.to_owned(), computed, if right { 0.0 } else { f64::INFINITY });
    }

    /// A difference of two terms, judged by the size of the terms; `step` is forgiven.
    pub(crate) fn absolute(&self, output: &'static str, computed: f64, scale: f64, step: f64) {
        self.seen.borrow_mut().insert(output);
        let exact = self.row.exact(output);
        self.add(output.to_owned(), computed, measure::absolute_units(computed, &exact, scale, step));
    }

    /// A number made of one that is subnormal: its last steps, `step` in this one, are forgiven.
    pub(crate) fn stepped(&self, output: &'static str, computed: f64, cint: f64, step: f64) {
        if measure::difference(computed, &self.row.exact(output)).abs() <= step {
            self.absolute(output, computed, 0.0, step);
        } else {
            self.value(output, computed, cint);
        }
    }

    /// A bound stated beside a value: |computed − exact| must not exceed it.
    pub(crate) fn bound(&self, output: &'static str, computed: f64, bound: f64) {
        let error = measure::difference(computed, &self.row.exact(output)).abs();
        if measure::exceeds(error, bound) {
            self.fail(output, &format!("= {computed:e} is {error:e} off, stated {bound:e}"));
        }
    }

    /// A predicate, or `None` where it is undefined.
    pub(crate) fn truth(&self, output: &'static str, computed: Option<bool>) {
        self.seen.borrow_mut().insert(output);
        let right = match self.row.output(output) {
            Some(Value::Truth(truth)) => computed == Some(truth),
            Some(Value::Undefined) => computed.is_none(),
            _ => false,
        };
        self.measured.borrow_mut().worst.entry(output.to_owned()).or_default().add(self.row.id(), 0.0);
        if !right {
            self.fail(output, &format!("is not {computed:?}"));
        }
    }

    /// Records what is wrong with this line.
    pub(crate) fn fail(&self, output: &str, what: &str) {
        let failure = format!("{} {output} {what}", self.row.id());
        self.measured.borrow_mut().failures.push(failure);
    }

    fn add(&self, quantity: String, computed: f64, units: f64) {
        if measure::exceeds(units, GATE) {
            self.fail(&quantity, &format!("= {computed:e} is {units:.1} units off"));
        }
        self.measured.borrow_mut().worst.entry(quantity).or_default().add(self.row.id(), units);
    }
}

#[test]
fn what_is_wrong_or_left_out_is_found() {
    const TEXT: &str = "id\tcat\tout.a\tout.b\tout.c\nx\to\t1\ttrue\t\ny\to\t2~-10\tfalse\tnull\n";
    let run = |a: f64, b: bool, all: bool| {
        Measured::run("made_up", &Table::parse(TEXT), move |line| {
            let second = line.row.id() == "y";
            line.scaled("a", Scaled::new(if second { 2.0 * a } else { a }), 0.0);
            line.truth("b", Some(b != second));
            if second && all {
                line.value("c", f64::NAN, 0.0);
            }
        })
    };
    let right = run(1.0, true, true);
    assert_eq!(right.failures, Vec::<String>::new());
    right.assert_passes(2, 7);
    assert_eq!(right.worst["a"].line, "y");
    // 63 ulps, 126 units, wrong in the value on both lines and in the logarithm on the first.
    assert!(run(1.0 + 63.0 * f64::EPSILON, true, true).failures.len() >= 2);
    assert_eq!(run(1.0, false, true).failures.len(), 2);
    assert_eq!(run(1.0, true, false).failures, ["y c was not checked"]);
}
