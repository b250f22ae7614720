//! Answers as JSON text, in parts that can be written one by one: the names and numbers of one curve.

use super::work::Model;
use crate::http::api::answer::{DiagnosticAnswer, OmittedAnswer, WarningAnswer};
use crate::http::problem::Problem;
use crate::reflectance::evaluate::{EvaluatedBy, Tally};
use crate::reflectance::findings::{Diagnostic, Warning};
use serde::Serialize;
use std::ops::Range;

/// Bytes of a number with its comma: 17 digits, a point, a sign and an exponent at most.
const LONGEST_NUMBER: usize = 26;

/// Text that is being written.
#[derive(Default)]
pub(super) struct Text(pub(super) Vec<u8>);

impl Text {
    pub(super) fn with_capacity(bytes: usize) -> Self {
        Self(Vec::with_capacity(bytes))
    }

    pub(super) fn push(&mut self, text: &str) {
        self.0.extend_from_slice(text.as_bytes());
    }

    /// `,"name":`, where something stands before it.
    pub(super) fn name(&mut self, name: &str) {
        // Between two parts of an answer nothing is written: what stands before ends in a bracket then.
        if !matches!(self.0.last(), Some(b'{')) {
            self.0.push(b',');
        }
        self.0.push(b'"');
        self.push(name);
        self.push("\":");
    }

    /// What is written so far.
    pub(super) fn take(&mut self) -> Vec<u8> {
        std::mem::take(&mut self.0)
    }

    /// `"name":[…]`
    pub(super) fn list(&mut self, name: &str, elements: impl FnOnce(&mut Self)) {
        self.name(name);
        self.push("[");
        elements(self);
        self.push("]");
    }

    /// Numbers with commas between them, and one before them unless they are the first.
    pub(super) fn numbers(&mut self, numbers: &[f64], first: bool) {
        let mut buffer = zmij::Buffer::new();
        self.0.reserve(LONGEST_NUMBER * numbers.len());
        for (index, &number) in numbers.iter().enumerate() {
            if index > 0 || !first {
                self.0.push(b',');
            }
            // JSON has no infinities and no NaN: a diagnostic says why.
            self.push(if number.is_finite() { buffer.format_finite(number) } else { "null" });
        }
    }

    /// What was written from one place to another, once more.
    pub(super) fn repeat(&mut self, written: Range<usize>) {
        self.0.extend_from_within(written);
    }

    /// The names of methods, likewise.
    pub(super) fn methods(&mut self, methods: &[EvaluatedBy], first: bool) {
        for (index, method) in methods.iter().enumerate() {
            self.push(if index > 0 || !first { ",\"" } else { "\"" });
            self.push(method.name());
            self.push("\"");
        }
    }

    /// Diagnostics, likewise.
    pub(super) fn diagnostics(&mut self, diagnostics: &[Diagnostic], first: bool) -> Result<(), Problem> {
        for (index, diagnostic) in diagnostics.iter().enumerate() {
            if index > 0 || !first {
                self.0.push(b',');
            }
            self.value(&DiagnosticAnswer::from(*diagnostic))?;
        }
        Ok(())
    }

    /// Anything that is short.
    pub(super) fn value<T: Serialize>(&mut self, value: &T) -> Result<(), Problem> {
        serde_json::to_writer(&mut self.0, value).map_err(|error| Problem::unwritten(&error))
    }

    /// Booleans, likewise.
    pub(super) fn booleans(&mut self, booleans: &[bool], first: bool) {
        for (index, boolean) in booleans.iter().enumerate() {
            if index > 0 || !first {
                self.0.push(b',');
            }
            self.push(if *boolean { "true" } else { "false" });
        }
    }

    /// What is counted over a curve, up to its diagnostics.
    pub(super) fn findings(
        &mut self,
        model: &Model,
        warnings: Vec<Warning>,
        tally: Tally,
    ) -> Result<(), Problem> {
        // A linear model has one way to be evaluated, and leaves nothing out.
        let Model::Scene(prepared) = model else { return Ok(()) };
        self.name("methods");
        self.push("{");
        for (method, count) in tally.methods() {
            self.name(method.name());
            self.value(&count)?;
        }
        self.push("}");
        self.name("omitted");
        self.value(&prepared.omitted().iter().cloned().map(OmittedAnswer::from).collect::<Vec<_>>())?;
        self.name("warnings");
        let warnings = warnings.into_iter().chain(tally.warnings());
        self.value(&warnings.map(WarningAnswer::from).collect::<Vec<_>>())
    }
}

#[cfg(test)]
mod tests {
    use super::Text;

    #[test]
    fn numbers_are_written_as_the_json_library_writes_them() {
        let numbers = [
            0.0,
            -0.0,
            1.0,
            0.1,
            1e15,
            1e16,
            1e21,
            123456.789,
            1e-5,
            1e-7,
            5e-324,
            f64::MAX,
            -1.5e-300,
            f64::NAN,
        ];
        let mut text = Text::default();
        text.numbers(&numbers, true);
        let expected: Vec<_> = numbers.iter().map(|number| serde_json::to_string(number).unwrap()).collect();
        assert_eq!(String::from_utf8(text.0).unwrap(), expected.join(","));
    }
}
