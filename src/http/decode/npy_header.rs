//! The header of a `.npy` file: a Python dictionary, of which just this form is read. A reader of all Python literals
//! can be kept busy for minutes, or led to the end of its stack, by a few brackets.

use crate::http::input::node::excerpt;

/// Field names, and where one is named twice or not at all.
#[derive(Debug, PartialEq, Eq)]
pub(super) struct Header {
    /// Name and type code of each field, `<f8`; or the type code of an array without fields.
    pub(super) layout: Layout,
    /// The lengths of its axes.
    pub(super) shape: Vec<usize>,
    /// How many bytes of the file it takes.
    pub(super) length: usize,
}

#[derive(Debug, PartialEq, Eq)]
pub(super) enum Layout {
    Plain(String),
    Fields(Vec<(String, String)>),
}

/// A header of three fields has about 150 bytes.
const LONGEST: usize = 16 << 10;

/// Reads the header of a file.
pub(super) fn read(bytes: &[u8]) -> Result<Header, String> {
    let short = || "it ends within the header".to_owned();
    let rest = bytes.strip_prefix(b"\x93NUMPY").ok_or("it does not begin with \\x93NUMPY")?;
    let (&[major, minor], rest) = rest.split_first_chunk().ok_or_else(short)?;
    let (length, rest) = match (major, minor) {
        (1, 0) => {
            let (length, rest) = rest.split_first_chunk().ok_or_else(short)?;
            (usize::from(u16::from_le_bytes(*length)), rest)
        }
        (2 | 3, 0) => {
            let (length, rest) = rest.split_first_chunk().ok_or_else(short)?;
            (usize::try_from(u32::from_le_bytes(*length)).unwrap_or(usize::MAX), rest)
        }
        _ => return Err(format!("its version is {major}.{minor}: expected 1.0, 2.0 or 3.0")),
    };
    if length > LONGEST {
        return Err(format!("its header has {length} bytes: expected at most {LONGEST}"));
    }
    let text = rest.get(..length).ok_or_else(short)?;
    let text = str::from_utf8(text).map_err(|_| "its header is not text".to_owned())?;
    let (layout, shape) = Parser { rest: text }.dictionary()?;
    Ok(Header { layout, shape, length: bytes.len() - rest.len() + length })
}

struct Parser<'a> {
    rest: &'a str,
}

impl Parser<'_> {
    /// `{'descr': …, 'fortran_order': False, 'shape': (3,), }` in any order.
    fn dictionary(mut self) -> Result<(Layout, Vec<usize>), String> {
        let (mut layout, mut order, mut shape) = (None, None, None);
        self.expect('{')?;
        while !self.takes('}') {
            let key = self.text()?;
            self.expect(':')?;
            match key.as_str() {
                "descr" if layout.is_none() => layout = Some(self.layout()?),
                "fortran_order" if order.is_none() => order = Some(self.boolean()?),
                "shape" if shape.is_none() => shape = Some(self.shape()?),
                _ => return Err(format!("its header has '{}' once too often", excerpt(&key))),
            }
            if !self.takes(',') {
                self.expect('}')?;
                break;
            }
        }
        if !self.rest.trim().is_empty() {
            return Err(self.unexpected("its end"));
        }
        match (layout, order, shape) {
            (Some(layout), Some(_), Some(shape)) => Ok((layout, shape)),
            _ => Err("its header lacks one of descr, fortran_order, shape".to_owned()),
        }
    }

    /// `'<f8'`, or `[('a', '<f8'), ('b', '<f4')]`.
    fn layout(&mut self) -> Result<Layout, String> {
        if !self.takes('[') {
            return self.text().map(Layout::Plain);
        }
        let mut fields = Vec::new();
        while !self.takes(']') {
            self.expect('(')?;
            let name = self.text()?;
            self.expect(',')?;
            fields.push((name, self.text()?));
            self.takes(',');
            self.expect(')')?;
            if !self.takes(',') {
                self.expect(']')?;
                break;
            }
        }
        Ok(Layout::Fields(fields))
    }

    /// `()`, `(3,)` or `(3, 4)`.
    fn shape(&mut self) -> Result<Vec<usize>, String> {
        let mut shape = Vec::new();
        self.expect('(')?;
        while !self.takes(')') {
            let text = self.rest.trim_start();
            let digits = text.len() - text.trim_start_matches(|c: char| c.is_ascii_digit()).len();
            let length = text[..digits].parse().map_err(|_| self.unexpected("a length"))?;
            self.rest = &text[digits..];
            shape.push(length);
            if !self.takes(',') {
                self.expect(')')?;
                break;
            }
        }
        Ok(shape)
    }

    fn boolean(&mut self) -> Result<bool, String> {
        let text = self.rest.trim_start();
        for (word, value) in [("False", false), ("True", true)] {
            if let Some(rest) = text.strip_prefix(word) {
                self.rest = rest;
                return Ok(value);
            }
        }
        Err(self.unexpected("True or False"))
    }

    /// A string without escapes: the names of the columns need none.
    fn text(&mut self) -> Result<String, String> {
        let text = self.rest.trim_start();
        let quote = text.chars().next().filter(|c| matches!(c, '\'' | '"'));
        let inner = quote.and_then(|quote| text[1..].split_once(quote));
        let (inner, rest) = inner.ok_or_else(|| self.unexpected("a string"))?;
        self.rest = rest;
        Ok(inner.to_owned())
    }

    fn takes(&mut self, token: char) -> bool {
        let rest = self.rest.trim_start().strip_prefix(token);
        self.rest = rest.unwrap_or(self.rest);
        rest.is_some()
    }

    fn expect(&mut self, token: char) -> Result<(), String> {
        if self.takes(token) { Ok(()) } else { Err(self.unexpected(&format!("'{token}'"))) }
    }

    fn unexpected(&self, expected: &str) -> String {
        format!("its header has \"{}\": expected {expected}", excerpt(self.rest.trim_start()))
    }
}
