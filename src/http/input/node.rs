//! JSON as a tree, arrays of numbers packed.

use super::plain;
use crate::http::compute::is_abandoned;
use crate::reflectance::bounds;
use serde::de::{DeserializeSeed, Deserializer, IgnoredAny, MapAccess, SeqAccess, Visitor};
use std::cell::Cell;
use std::fmt;

/// A JSON value.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Node {
    Null,
    Bool(bool),
    Number(f64),
    Text(String),
    Array(Array),
    Object(Object),
}

impl Node {
    /// What kind of value it is, with its text where that is short: for messages.
    pub(crate) fn describe(&self) -> String {
        match self {
            Self::Null => "null".to_owned(),
            Self::Bool(value) => value.to_string(),
            Self::Number(value) => format!("the number {value}"),
            Self::Text(text) => format!("the string \"{}\"", excerpt(text)),
            Self::Array(_) => "an array".to_owned(),
            Self::Object(_) => "an object".to_owned(),
        }
    }
}

/// At most 40 characters of what a client sent, for messages.
pub(crate) fn excerpt(text: &str) -> String {
    const LONGEST: usize = 40;
    let mut short: String = text.chars().take(LONGEST).filter(|c| !c.is_control()).collect();
    if text.chars().nth(LONGEST).is_some() {
        short.push('…');
    }
    short
}

/// An array. Elements beyond the largest accepted array are counted, not kept.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Array {
    /// The elements, NaN (which JSON cannot spell) where an element is not a number.
    pub(crate) numbers: Vec<f64>,
    /// The elements that are not numbers, with their positions.
    pub(crate) others: Vec<(usize, Node)>,
    /// How many elements there are.
    pub(crate) length: usize,
}

/// An object.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Object {
    /// Names and values, the first of each name.
    pub(crate) fields: Vec<(String, Node)>,
    /// Names given more than once.
    pub(crate) duplicates: Vec<String>,
}

/// Why a text is no JSON.
#[derive(Debug)]
pub(crate) struct Malformed {
    /// Whether the text was JSON, but with more values than any request has.
    pub(crate) oversized: bool,
    /// What and where.
    pub(crate) detail: String,
}

/// Values that are not numbers in an array, in one body: a request needs a few dozen; each costs fifty times its bytes.
pub(super) const MOST_NODES: usize = 4096;

/// Elements of an array between two looks at whether anybody still waits.
pub(super) const BETWEEN_LOOKS: usize = 4096;

/// Reads JSON. A number beyond f64 (1e400) arrives as the string of its digits, so that it is reported as
/// the error of a field like any other.
pub(crate) fn parse(text: &[u8]) -> Result<Node, Malformed> {
    if let Some(node) = plain::parse(text, MOST_NODES) {
        return Ok(node);
    }
    match parse_strictly(text) {
        Err(error) if error.is_syntax() && error.to_string().starts_with("number out of range") => {
            // First with numbers of the same length in their places: whatever else is wrong with the text has
            // to be told with its place in the text as sent.
            let same_length = replace_unrepresentable(text, |literal, out| {
                out.extend_from_slice(b"0.");
                out.resize(out.len() + literal.len() - 2, b'0');
            });
            parse_strictly(&same_length).map_err(|error| malformed(&same_length, &error))?;
            let quoted = replace_unrepresentable(text, |literal, out| {
                out.push(b'"');
                out.extend_from_slice(literal);
                out.push(b'"');
            });
            parse_strictly(&quoted).map_err(|error| malformed(&quoted, &error))
        }
        other => other.map_err(|error| malformed(text, &error)),
    }
}

pub(super) fn parse_strictly(text: &[u8]) -> Result<Node, serde_json::Error> {
    let budget = Cell::new(MOST_NODES);
    let mut deserializer = serde_json::Deserializer::from_slice(text);
    let node = Seed(&budget).deserialize(&mut deserializer)?;
    deserializer.end()?;
    Ok(node)
}

fn malformed(text: &[u8], error: &serde_json::Error) -> Malformed {
    if error.is_data() {
        return Malformed {
            oversized: true,
            detail: format!("the body has more than {MOST_NODES} values outside arrays of numbers"),
        };
    }
    if text.is_empty() {
        return Malformed { oversized: false, detail: "the body is empty".to_owned() };
    }
    let hint = if spells_non_number(text, error.line(), error.column()) {
        "; JSON has no NaN or Infinity: every number has to be finite"
    } else {
        ""
    };
    Malformed { oversized: false, detail: format!("{error}{hint}") }
}

/// Whether the word at this place is NaN, Infinity or the like.
fn spells_non_number(text: &[u8], line: usize, column: usize) -> bool {
    let Some(line) = text.split(|&byte| byte == b'\n').nth(line.saturating_sub(1)) else { return false };
    let part = |byte: &u8| byte.is_ascii_alphabetic() || *byte == b'-' || *byte == b'+';
    let at = column.min(line.len());
    let start = line[..at].iter().rposition(|byte| !part(byte)).map_or(0, |before| before + 1);
    let end = line[at..].iter().position(|byte| !part(byte)).map_or(line.len(), |after| at + after);
    let word = String::from_utf8_lossy(&line[start..end.max(start)]).to_ascii_lowercase();
    matches!(word.trim_start_matches(['-', '+']), "nan" | "inf" | "infinity")
}

/// Puts something else in the place of each number literal that f64 cannot hold, which has at least the
/// five characters of `1e309`. Only called for such texts.
fn replace_unrepresentable(text: &[u8], replace: impl Fn(&[u8], &mut Vec<u8>)) -> Vec<u8> {
    let mut replaced = Vec::with_capacity(text.len() + 64);
    let mut at = 0;
    while at < text.len() {
        let start = at;
        match text[at] {
            b'"' => {
                at += 1;
                while at < text.len() && text[at] != b'"' {
                    at += if text[at] == b'\\' { 2 } else { 1 };
                }
                at = (at + 1).min(text.len());
                replaced.extend_from_slice(&text[start..at]);
            }
            b'-' | b'0'..=b'9' => {
                while at < text.len() && matches!(text[at], b'-' | b'+' | b'.' | b'e' | b'E' | b'0'..=b'9') {
                    at += 1;
                }
                let literal = &text[start..at];
                let infinite = str::from_utf8(literal)
                    .ok()
                    .and_then(|s| s.parse::<f64>().ok())
                    .is_some_and(f64::is_infinite);
                if infinite {
                    replace(literal, &mut replaced);
                } else {
                    replaced.extend_from_slice(literal);
                }
            }
            other => {
                replaced.push(other);
                at += 1;
            }
        }
    }
    replaced
}

/// Reads one value, and pays for it.
#[derive(Clone, Copy)]
struct Seed<'a>(&'a Cell<usize>);

impl<'de> DeserializeSeed<'de> for Seed<'_> {
    type Value = Node;

    fn deserialize<D: Deserializer<'de>>(self, deserializer: D) -> Result<Node, D::Error> {
        deserializer.deserialize_any(self)
    }
}

impl Seed<'_> {
    fn pay<E: serde::de::Error>(self) -> Result<(), E> {
        let left = self.0.get().checked_sub(1).ok_or_else(|| E::custom("too many values"))?;
        self.0.set(left);
        Ok(())
    }
}

impl<'de> Visitor<'de> for Seed<'_> {
    type Value = Node;

    fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str("a JSON value")
    }

    fn visit_unit<E>(self) -> Result<Node, E> {
        Ok(Node::Null)
    }

    fn visit_bool<E>(self, value: bool) -> Result<Node, E> {
        Ok(Node::Bool(value))
    }

    fn visit_f64<E>(self, value: f64) -> Result<Node, E> {
        Ok(Node::Number(value))
    }

    fn visit_i64<E>(self, value: i64) -> Result<Node, E> {
        Ok(Node::Number(value as f64))
    }

    fn visit_u64<E>(self, value: u64) -> Result<Node, E> {
        Ok(Node::Number(value as f64))
    }

    fn visit_str<E: serde::de::Error>(self, value: &str) -> Result<Node, E> {
        Ok(Node::Text(value.to_owned()))
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut elements: A) -> Result<Node, A::Error> {
        let mut array = Array::default();
        while let Some(element) = elements.next_element_seed(ElementSeed(self))? {
            if array.length <= bounds::MAX_DIRECTIONS {
                array.numbers.push(match element {
                    Element::Number(number) => number,
                    Element::Other(other) => {
                        self.pay()?;
                        array.others.push((array.length, *other));
                        f64::NAN
                    }
                });
            }
            array.length += 1;
            if array.length.is_multiple_of(BETWEEN_LOOKS) && is_abandoned() {
                return Err(serde::de::Error::custom("nobody waits for it"));
            }
        }
        Ok(Node::Array(array))
    }

    fn visit_map<A: MapAccess<'de>>(self, mut entries: A) -> Result<Node, A::Error> {
        let mut object = Object::default();
        while let Some(name) = entries.next_key::<String>()? {
            self.pay()?;
            if object.fields.iter().any(|(known, _)| *known == name) {
                entries.next_value::<IgnoredAny>()?;
                object.duplicates.push(name);
            } else {
                let value = entries.next_value_seed(self)?;
                object.fields.push((name, value));
            }
        }
        Ok(Node::Object(object))
    }
}

/// An element of an array: small where it is a number, as nearly all are.
enum Element {
    Number(f64),
    Other(Box<Node>),
}

impl From<Node> for Element {
    fn from(node: Node) -> Self {
        match node {
            Node::Number(number) => Self::Number(number),
            other => Self::Other(Box::new(other)),
        }
    }
}

/// Reads one element.
#[derive(Clone, Copy)]
struct ElementSeed<'a>(Seed<'a>);

impl<'de> DeserializeSeed<'de> for ElementSeed<'_> {
    type Value = Element;

    fn deserialize<D: Deserializer<'de>>(self, deserializer: D) -> Result<Element, D::Error> {
        deserializer.deserialize_any(self)
    }
}

impl<'de> Visitor<'de> for ElementSeed<'_> {
    type Value = Element;

    fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
        self.0.expecting(f)
    }

    fn visit_unit<E>(self) -> Result<Element, E> {
        Ok(Node::Null.into())
    }

    fn visit_bool<E>(self, value: bool) -> Result<Element, E> {
        Ok(Node::Bool(value).into())
    }

    fn visit_f64<E>(self, value: f64) -> Result<Element, E> {
        Ok(Element::Number(value))
    }

    fn visit_i64<E>(self, value: i64) -> Result<Element, E> {
        Ok(Element::Number(value as f64))
    }

    fn visit_u64<E>(self, value: u64) -> Result<Element, E> {
        Ok(Element::Number(value as f64))
    }

    fn visit_str<E: serde::de::Error>(self, value: &str) -> Result<Element, E> {
        self.0.visit_str(value).map(Element::from)
    }

    fn visit_seq<A: SeqAccess<'de>>(self, elements: A) -> Result<Element, A::Error> {
        self.0.visit_seq(elements).map(Element::from)
    }

    fn visit_map<A: MapAccess<'de>>(self, entries: A) -> Result<Element, A::Error> {
        self.0.visit_map(entries).map(Element::from)
    }
}

#[cfg(test)]
mod tests;
