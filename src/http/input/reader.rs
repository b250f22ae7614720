//! Collects what is wrong with a request while it is being read.

use super::node::{Node, Object};
use super::wire::Wire;
use crate::http::decode::Columns;
use crate::http::problem::{Code, FieldError};
use crate::reflectance::bounds::MAX_DIRECTIONS;
use std::borrow::Cow;

/// Errors of one array that are listed one by one.
const LISTED_PER_ARRAY: usize = 20;
/// Errors of one request that are listed one by one.
const LISTED: usize = 200;

/// A step from a value to a part of it.
#[derive(Clone, Debug)]
enum Step {
    Key(Cow<'static, str>),
    Index(usize),
}

/// Where in the request the reading is, and what was wrong so far.
#[derive(Debug)]
pub(crate) struct Reader {
    path: Vec<Step>,
    errors: Vec<FieldError>,
    unlisted: usize,
    flat: bool,
    most_directions: usize,
}

impl Reader {
    /// For a JSON body.
    pub(crate) fn json() -> Self {
        Self {
            path: Vec::new(),
            errors: Vec::new(),
            unlisted: 0,
            flat: false,
            most_directions: MAX_DIRECTIONS,
        }
    }

    /// For a query, where every value is a text and objects are flattened.
    pub(crate) fn query() -> Self {
        Self { flat: true, ..Self::json() }
    }

    /// With the service's own limit of directions.
    pub(crate) fn with_most_directions(self, most_directions: usize) -> Self {
        Self { most_directions, ..self }
    }

    /// How many directions the request may have.
    pub(crate) const fn most_directions(&self) -> usize {
        self.most_directions
    }

    /// Whether this is a query.
    pub(crate) const fn is_flat(&self) -> bool {
        self.flat
    }

    /// Reads what a request whose fields stand in the query has in its body: values have types there, and pointers
    /// begin at the object.
    pub(crate) fn in_body<T>(&mut self, read: impl FnOnce(&mut Self) -> T) -> T {
        let flat = std::mem::replace(&mut self.flat, false);
        let value = read(self);
        self.flat = flat;
        value
    }

    /// Reads inside a field.
    pub(crate) fn within<T>(
        &mut self,
        name: impl Into<Cow<'static, str>>,
        read: impl FnOnce(&mut Self) -> T,
    ) -> T {
        self.path.push(Step::Key(name.into()));
        let value = read(self);
        self.path.pop();
        value
    }

    /// Reads inside an element.
    pub(crate) fn at<T>(&mut self, index: usize, read: impl FnOnce(&mut Self) -> T) -> T {
        self.path.push(Step::Index(index));
        let value = read(self);
        self.path.pop();
        value
    }

    /// Notes an error at the present place.
    pub(crate) fn error(&mut self, code: Code, detail: impl Into<String>) {
        if self.errors.len() < LISTED {
            let error = FieldError { pointer: self.pointer(), code, detail: detail.into() };
            self.errors.push(error);
        } else {
            self.unlisted += 1;
        }
    }

    /// [`Self::error`] as the value of a failed reading.
    pub(crate) fn fail<T>(&mut self, code: Code, detail: impl Into<String>) -> Option<T> {
        self.error(code, detail);
        None
    }

    /// Whether something was noted at this very pointer.
    pub(crate) fn has_noted(&self, pointer: &str) -> bool {
        self.errors.iter().any(|error| error.pointer == pointer)
    }

    /// JSON Pointer of the present place.
    fn pointer(&self) -> String {
        // A query has no objects: its pointers begin at the parameter.
        let begin = if self.flat {
            self.path.iter().rposition(|step| matches!(step, Step::Key(_))).unwrap_or(0)
        } else {
            0
        };
        let mut pointer = String::new();
        for step in &self.path[begin..] {
            pointer.push('/');
            match step {
                Step::Key(key) => pointer.push_str(&key.replace('~', "~0").replace('/', "~1")),
                Step::Index(index) => pointer.push_str(&index.to_string()),
            }
        }
        pointer
    }

    /// The value if nothing was wrong, or all that was.
    pub(crate) fn finish<T>(mut self, value: Option<T>) -> Result<T, Vec<FieldError>> {
        if self.unlisted > 0 {
            let detail = format!("and {} errors more", self.unlisted);
            self.errors.push(FieldError { pointer: String::new(), code: Code::More, detail });
        }
        match value {
            Some(value) if self.errors.is_empty() => Ok(value),
            _ => Err(self.errors),
        }
    }
}

/// Errors of one array's elements: the first twenty one by one, the rest as a count.
#[derive(Debug, Default)]
pub(crate) struct ElementErrors {
    found: usize,
}

impl ElementErrors {
    /// Notes one.
    pub(crate) fn note(
        &mut self,
        reader: &mut Reader,
        index: usize,
        code: Code,
        detail: impl FnOnce() -> String,
    ) {
        self.found += 1;
        if self.found <= LISTED_PER_ARRAY {
            reader.at(index, |reader| reader.error(code, detail()));
        }
    }

    /// Says how many there were, where not all were listed.
    pub(crate) fn finish(self, reader: &mut Reader) {
        if self.found > LISTED_PER_ARRAY {
            let more = self.found - LISTED_PER_ARRAY;
            reader.error(Code::More, format!("and {more} elements more that are not accepted"));
        }
    }
}

/// The fields of an object that is being read.
#[derive(Debug)]
pub(crate) struct Fields {
    object: Object,
    columns: Columns,
}

impl Fields {
    pub(crate) fn new(object: Object) -> Self {
        Self::with_columns(object, Columns::default())
    }

    /// Of a query, with what the body has beside it.
    pub(crate) const fn with_columns(object: Object, columns: Columns) -> Self {
        Self { object, columns }
    }

    /// The columns of the body.
    pub(crate) const fn columns(&mut self) -> &mut Columns {
        &mut self.columns
    }

    /// Whether any of these is given, as a column or otherwise.
    pub(crate) fn has_any_or_column(&self, names: &[&str]) -> bool {
        self.has_any(names) || names.iter().any(|name| self.columns.has(name))
    }

    /// Whether any of these is given.
    pub(crate) fn has_any(&self, names: &[&str]) -> bool {
        self.object.fields.iter().any(|(name, _)| names.contains(&name.as_str()))
    }

    /// Those of these names that are given.
    pub(crate) fn given(&self, names: &[&'static str]) -> Vec<&'static str> {
        names.iter().copied().filter(|name| self.has_any(&[name])).collect()
    }

    /// Notes that fields are given beside one that leaves no place for them.
    pub(crate) fn exclude(&self, reader: &mut Reader, names: &[&'static str], by: &str) {
        for name in self.given(names) {
            let detail = format!("excluded by {by}: give one or the other");
            reader.within(name, |reader| reader.error(Code::Inconsistent, detail));
        }
    }

    /// Drops fields that nothing can be said of.
    pub(crate) fn forget(&mut self, names: &[&str]) {
        self.object.fields.retain(|(name, _)| !names.contains(&name.as_str()));
    }

    /// Takes a field out and reads it.
    pub(crate) fn take<T: Wire>(&mut self, reader: &mut Reader, name: &'static str) -> Option<T> {
        if reader.is_flat() {
            return T::read_flat(name, self, reader);
        }
        self.take_named(reader, name)
    }

    /// Takes a field of just this name.
    pub(crate) fn take_named<T: Wire>(&mut self, reader: &mut Reader, name: &'static str) -> Option<T> {
        let position = self.object.fields.iter().position(|(given, _)| given == name);
        let node = position.map(|position| self.object.fields.swap_remove(position).1);
        reader.within(name, |reader| match node {
            Some(Node::Array(_)) if reader.is_flat() && !T::REPEATABLE => {
                reader.fail(Code::Duplicate, "given more than once")
            }
            Some(node) => T::read(node, reader),
            None => T::absent(reader),
        })
    }

    /// Refuses what is left, and what was given twice.
    pub(crate) fn finish(self, reader: &mut Reader, accepted: impl FnOnce() -> Vec<&'static str>) {
        for name in self.object.duplicates {
            reader.within(name, |reader| reader.error(Code::Duplicate, "given more than once"));
        }
        if self.object.fields.is_empty() {
            return;
        }
        let accepted = accepted();
        for (name, _) in self.object.fields {
            let accepted = if accepted.is_empty() { "none".to_owned() } else { accepted.join(", ") };
            let detail = format!("unknown; accepted here: {accepted}");
            reader.within(name, |reader| reader.error(Code::UnknownField, detail));
        }
    }
}
