//! The query of a link as an object whose values are texts.

use super::node::{Array, Node, Object, excerpt};
use super::object::WireObject;
use super::reader::{Fields, Reader};
use crate::http::app::App;
use crate::http::decode::Columns;
use crate::http::problem::{Code, Kind, Problem};
use axum::extract::FromRequestParts;
use axum::http::request::Parts;

/// Twice the parameters there are, with a thousand wavelengths and a hundred fixed angles one by one.
pub(crate) const MOST_PARAMETERS: usize = 2048;
/// As many as most links have.
const USUAL_PARAMETERS: usize = 16;

/// A value read from the query.
pub(crate) struct Query<T>(pub(crate) T);

impl<T: WireObject + Send> FromRequestParts<App> for Query<T> {
    type Rejection = Problem;

    async fn from_request_parts(parts: &mut Parts, _: &App) -> Result<Self, Problem> {
        let query = parts.uri.query().unwrap_or_default();
        read_beside(query, Columns::default(), Reader::query()).map(Self)
    }
}

/// A query without parameters.
pub(crate) struct NoQuery;

impl<S: Sync> FromRequestParts<S> for NoQuery {
    type Rejection = Problem;

    async fn from_request_parts(parts: &mut Parts, _: &S) -> Result<Self, Problem> {
        let mut reader = Reader::query();
        Fields::new(object(parts.uri.query().unwrap_or_default())?).finish(&mut reader, Vec::new);
        reader.finish(Some(Self)).map_err(Problem::invalid)
    }
}

/// Reads the query of a request whose body has columns; the reader has noted already what is wrong with them.
pub(crate) fn read_beside<T: WireObject>(
    query: &str,
    columns: Columns,
    mut reader: Reader,
) -> Result<T, Problem> {
    let mut fields = Fields::with_columns(object(query)?, columns);
    let value = T::take(&mut fields, &mut reader);
    fields.finish(&mut reader, T::flat_names);
    reader.finish(value).map_err(Problem::invalid)
}

/// Refuses every parameter, each of which belongs elsewhere.
pub(crate) fn refuse(query: &str, elsewhere: &str) -> Result<(), Problem> {
    let mut reader = Reader::query();
    for (name, _) in object(query)?.fields {
        let detail = format!("this belongs {elsewhere}");
        reader.within(excerpt(&name), |reader| reader.error(Code::Inconsistent, detail));
    }
    reader.finish(Some(())).map_err(Problem::invalid)
}

/// Names and values; a name given several times has an array of texts.
fn object(query: &str) -> Result<Object, Problem> {
    let mut object = Object::default();
    object.fields.reserve(USUAL_PARAMETERS);
    for (index, pair) in query.split('&').enumerate() {
        if index >= MOST_PARAMETERS {
            let detail = format!("the query has more than {MOST_PARAMETERS} parameters");
            return Err(Problem::new(Kind::MalformedQuery, detail));
        }
        if pair.is_empty() {
            continue;
        }
        let (name, value) = pair.split_once('=').unwrap_or((pair, ""));
        let (name, value) = (decode(name)?, Node::Text(decode(value)?));
        match object.fields.iter_mut().find(|(known, _)| *known == name) {
            None => object.fields.push((name, value)),
            Some((_, Node::Array(array))) => append(array, value),
            Some((_, first)) => {
                let mut array = Array::default();
                append(&mut array, std::mem::replace(first, Node::Null));
                append(&mut array, value);
                *first = Node::Array(array);
            }
        }
    }
    Ok(object)
}

fn append(array: &mut Array, value: Node) {
    array.others.push((array.length, value));
    array.numbers.push(f64::NAN);
    array.length += 1;
}

/// Percent-decoding of `application/x-www-form-urlencoded`: "+" is a blank.
fn decode(text: &str) -> Result<String, Problem> {
    if !text.bytes().any(|byte| byte == b'%' || byte == b'+') {
        return Ok(text.to_owned());
    }
    let malformed = |what: &str| Problem::new(Kind::MalformedQuery, format!("the query has {what}"));
    let mut bytes = Vec::with_capacity(text.len());
    let mut rest = text.bytes();
    while let Some(byte) = rest.next() {
        bytes.push(match byte {
            b'+' => b' ',
            b'%' => {
                let digit = |byte: Option<u8>| char::from(byte?).to_digit(16);
                let value = digit(rest.next()).zip(digit(rest.next())).map(|(high, low)| high * 16 + low);
                value
                    .and_then(|value| u8::try_from(value).ok())
                    .ok_or_else(|| malformed("a % that two hexadecimal digits do not follow"))?
            }
            other => other,
        });
    }
    String::from_utf8(bytes).map_err(|_| malformed("bytes that are not UTF-8"))
}

#[cfg(test)]
mod tests {
    use super::{Node, decode, object};

    #[test]
    fn decodes_as_forms_do() {
        assert_eq!(decode("a+b%2Bc%C3%A9").unwrap(), "a b+cé");
        for wrong in ["%", "%4", "%zz", "%ff"] {
            assert!(decode(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn repeated_names_become_an_array() {
        let object = object("a=1&b=2&a=3&&c").unwrap();
        let Node::Array(array) = &object.fields[0].1 else { panic!("not an array") };
        assert_eq!(array.others, [(0, Node::Text("1".into())), (1, Node::Text("3".into()))]);
        assert_eq!(object.fields[2], ("c".into(), Node::Text(String::new())));
    }
}
