//! JSON as nearly all requests are, in one pass: numbers, names and short texts as they stand.
//!
//! Reading the numbers of a large request with the library costs as much as evaluating it. What is read here is what
//! [`super::node`] reads, to the same bits; where a text has anything else (an escape, a name twice, a number beyond f64,
//! an error), nothing is said of it, and the library reads it from the start.

use super::node::{Array, BETWEEN_LOOKS, Node, Object};
use crate::http::compute::is_abandoned;
use crate::reflectance::bounds::MAX_DIRECTIONS;

/// Objects and arrays within each other: a request has four.
const DEEPEST: usize = 16;

/// Elements of an array after which memory is reserved for those that are likely to follow.
const LONG: usize = 64;

/// The value of a text, if it is plain and has no more than `nodes` values outside arrays of numbers.
pub(super) fn parse(text: &[u8], nodes: usize) -> Option<Node> {
    let mut plain = Plain { text, at: 0, nodes };
    let node = plain.value(0)?;
    plain.space();
    (plain.at == text.len()).then_some(node)
}

struct Plain<'a> {
    text: &'a [u8],
    at: usize,
    nodes: usize,
}

impl Plain<'_> {
    fn peek(&self) -> Option<u8> {
        self.text.get(self.at).copied()
    }

    fn space(&mut self) {
        while matches!(self.peek(), Some(b' ' | b'\n' | b'\r' | b'\t')) {
            self.at += 1;
        }
    }

    /// What comes after spaces, which is not taken.
    fn next(&mut self) -> Option<u8> {
        self.space();
        self.peek()
    }

    fn take(&mut self, expected: &[u8]) -> Option<()> {
        self.text[self.at..].starts_with(expected).then(|| self.at += expected.len())
    }

    fn value(&mut self, depth: usize) -> Option<Node> {
        Some(match self.next()? {
            b'-' | b'0'..=b'9' => Node::Number(self.number()?),
            b'"' => Node::Text(self.string()?),
            b'[' if depth < DEEPEST => Node::Array(self.array(depth)?),
            b'{' if depth < DEEPEST => Node::Object(self.object(depth)?),
            b'n' => self.take(b"null").map(|()| Node::Null)?,
            b't' => self.take(b"true").map(|()| Node::Bool(true))?,
            b'f' => self.take(b"false").map(|()| Node::Bool(false))?,
            _ => return None,
        })
    }

    /// The nearest double. The library for numbers takes more than JSON allows: 01, 1. and .5 among them.
    #[inline]
    fn number(&mut self) -> Option<f64> {
        let rest = &self.text[self.at..];
        let first = usize::from(rest.first() == Some(&b'-'));
        let digits = rest[first..].iter().take_while(|byte| byte.is_ascii_digit()).count();
        if digits == 0 || digits > 1 && rest[first] == b'0' {
            return None;
        }
        let point = first + digits;
        if rest.get(point) == Some(&b'.') && !rest.get(point + 1).is_some_and(u8::is_ascii_digit) {
            return None;
        }
        let (number, length) = fast_float2::parse_partial::<f64, _>(rest).ok()?;
        self.at += length;
        number.is_finite().then_some(number)
    }

    /// A text without escapes.
    fn string(&mut self) -> Option<String> {
        let rest = &self.text[self.at + 1..];
        let length = rest.iter().position(|&byte| byte == b'"' || byte == b'\\' || byte < b' ')?;
        self.at += length + 2;
        (rest[length] == b'"').then(|| str::from_utf8(&rest[..length]).ok().map(str::to_owned))?
    }

    fn array(&mut self, depth: usize) -> Option<Array> {
        let begin = self.at;
        self.at += 1;
        let mut array = Array::default();
        if self.next()? == b']' {
            self.at += 1;
            return Some(array);
        }
        loop {
            let other = match self.next()? {
                b'-' | b'0'..=b'9' => Err(self.number()?),
                _ => Ok(self.value(depth + 1)?),
            };
            if array.length <= MAX_DIRECTIONS {
                array.numbers.push(match other {
                    Err(number) => number,
                    Ok(other) => {
                        self.pay()?;
                        array.others.push((array.length, other));
                        f64::NAN
                    }
                });
            }
            array.length += 1;
            if array.length == LONG {
                self.reserve(begin, &mut array.numbers);
            }
            if array.length.is_multiple_of(BETWEEN_LOOKS) && is_abandoned() {
                return None;
            }
            let separator = self.next()?;
            self.at += 1;
            match separator {
                b',' => {}
                b']' => return Some(array),
                _ => return None,
            }
        }
    }

    /// Room for the numbers up to the array's end, if they are as long as those so far.
    fn reserve(&self, begin: usize, numbers: &mut Vec<f64>) {
        let rest = &self.text[self.at..];
        let length = memchr::memchr(b']', rest).unwrap_or(0);
        let a_number = (self.at - begin) / LONG;
        numbers.reserve((length / a_number.max(1) + LONG).min(MAX_DIRECTIONS));
    }

    fn object(&mut self, depth: usize) -> Option<Object> {
        self.at += 1;
        let mut object = Object::default();
        if self.next()? == b'}' {
            self.at += 1;
            return Some(object);
        }
        loop {
            if self.next()? != b'"' {
                return None;
            }
            let name = self.string()?;
            self.pay()?;
            if object.fields.iter().any(|(known, _)| *known == name) || self.next()? != b':' {
                return None;
            }
            self.at += 1;
            let value = self.value(depth + 1)?;
            object.fields.push((name, value));
            let separator = self.next()?;
            self.at += 1;
            match separator {
                b',' => {}
                b'}' => return Some(object),
                _ => return None,
            }
        }
    }

    /// As many values are left to be read.
    fn pay(&mut self) -> Option<()> {
        self.nodes = self.nodes.checked_sub(1)?;
        Some(())
    }
}

#[cfg(test)]
mod tests {
    use super::super::node::{MOST_NODES, Node, parse_strictly};
    use super::parse;
    use proptest::prelude::{
        Just, ProptestConfig, Strategy, any, prop, prop_assert_eq, prop_oneof, proptest,
    };

    /// What both readers make of a text, to the bit; none where the plain one leaves it to the other.
    fn both(text: &str) -> Option<(String, String)> {
        let plain = parse(text.as_bytes(), MOST_NODES)?;
        let node = parse_strictly(text.as_bytes());
        Some((bits(&plain), node.map_or_else(|error| error.to_string(), |node| bits(&node))))
    }

    /// The value with its numbers as bits: 0 is not −0, and NaN is NaN.
    fn bits(node: &Node) -> String {
        match node {
            Node::Number(number) => format!("{:x}", number.to_bits()),
            Node::Array(array) => {
                let numbers: Vec<_> = array.numbers.iter().map(|number| number.to_bits()).collect();
                let others: Vec<_> =
                    array.others.iter().map(|(place, other)| (*place, bits(other))).collect();
                format!("[{} {numbers:x?} {others:?}]", array.length)
            }
            Node::Object(object) => {
                let fields = object.fields.iter().map(|(name, value)| (name, bits(value)));
                format!("{{{:?} {:?}}}", fields.collect::<Vec<_>>(), object.duplicates)
            }
            other => format!("{other:?}"),
        }
    }

    #[test]
    fn plain_requests_are_read_as_the_library_reads_them() {
        let long =
            format!("[{}]", (0..5000).map(|i| format!("{}e-3", i * 17)).collect::<Vec<_>>().join(", "));
        let texts = [
            r#"{"model":"x","surface":{"a":0.2,"b":null,"c":[true,1,"é"]},"d":[],"e":{}}"#,
            " [ 1 , -0, -0.0,0.1, 12345678901234567890, 1e-400, 4.9e-324, 9007199254740993.00000001 ] \n",
            "-1.5E+3",
            "[[1],[\"2\",3],{\"a\":[null]}]",
            &long,
        ];
        for text in texts {
            let (plain, library) = both(text).unwrap();
            assert_eq!(plain, library, "{text}");
        }
    }

    #[test]
    fn what_is_not_plain_is_left_to_the_library() {
        let odd = [
            "",
            "01",
            "1.",
            "-",
            "-.5",
            ".5",
            "+1",
            "1e",
            "1e400",
            "[1,]",
            "[,1]",
            "[1 2]",
            "{\"a\":1,}",
            "{\"a\":1,\"a\":2}",
            "{\"a\" 1}",
            "\"a\\n\"",
            "\"a\nb\"",
            "nul",
            "inf",
            "nan",
            "[1e5x]",
            "1 2",
            "{a:1}",
            "\"",
        ];
        for text in odd {
            assert!(parse(text.as_bytes(), MOST_NODES).is_none(), "{text}");
        }
        assert!(parse(b"\"\xff\"", MOST_NODES).is_none());
        assert!(parse("[".repeat(100_000).as_bytes(), MOST_NODES).is_none());
        assert!(parse(br#"{"a":1,"b":2}"#, 1).is_none());
    }

    fn json() -> impl Strategy<Value = String> {
        let space = || prop_oneof![4 => Just(""), 1 => Just(" "), 1 => Just("\n\t")];
        let number = prop_oneof![
            any::<f64>().prop_map(|number| format!("{number}")),
            any::<f64>().prop_map(|number| format!("{number:e}")),
            any::<i64>().prop_map(|number| number.to_string()),
            "-?[0-9]{1,3}(\\.[0-9]{0,25})?([eE][-+]?[0-9]{0,3})?",
        ];
        let leaf = prop_oneof![
            8 => number,
            1 => Just("null".to_owned()),
            1 => Just("true".to_owned()),
            2 => "\"[a-z\\\\é]{0,3}\"",
        ];
        leaf.prop_recursive(4, 40, 6, move |inner| {
            let spaced = (space(), inner, space()).prop_map(|(before, value, after)| format!("{before}{value}{after}"));
            let field = ("[a-c]", spaced.clone()).prop_map(|(name, value)| format!("\"{name}\":{value}"));
            prop_oneof![
                2 => prop::collection::vec(spaced, 0..6).prop_map(|values| format!("[{}]", values.join(","))),
                1 => prop::collection::vec(field, 0..4).prop_map(|fields| format!("{{{}}}", fields.join(","))),
            ]
        })
    }

    proptest! {
        #![proptest_config(ProptestConfig { cases: 2000, failure_persistence: None, ..ProptestConfig::default() })]

        #[test]
        fn whatever_both_read_is_the_same(text in json(), cut in any::<prop::sample::Index>(), byte in "[]\\[{}:,\" 0.e-]") {
            if let Some((plain, library)) = both(&text) {
                prop_assert_eq!(plain, library);
            }
            // And with a byte more somewhere.
            let mut changed = text;
            let at = (0..=cut.index(changed.len() + 1)).rev().find(|at| changed.is_char_boundary(*at)).unwrap_or(0);
            changed.insert_str(at, &byte);
            if let Some((plain, library)) = both(&changed) {
                prop_assert_eq!(plain, library);
            }
        }
    }
}
