//! Tables as CSV: RFC 4180, tidy, units in the header. A value that is not a number is an empty field.

use super::rows::{Cells, Head, Rows, unfit};
use crate::http::problem::Problem;

/// Bytes that a number takes at most: sign, 17 digits, point, exponent; and its comma.
const WIDEST: usize = 25;

/// The line of names: `total_W_m-2_sr-1`.
pub(super) fn head(head: &Head) -> Vec<u8> {
    let mut line = Vec::new();
    for heading in &head.columns {
        let unit = heading.unit.replace(' ', "_").replace('^', "");
        // The name of an angle or a length says its unit.
        let name = if unit.is_empty() || heading.name.ends_with("_deg") || heading.name.ends_with("_um") {
            heading.name.to_owned()
        } else {
            format!("{}_{unit}", heading.name)
        };
        text(&name, &mut line);
        line.push(b',');
    }
    end(&mut line);
    line
}

/// A column whose repeated cell is written once.
enum Column<'a> {
    Numbers(&'a [f64]),
    Names(&'a [&'static str]),
    Same(Vec<u8>),
}

pub(super) fn rows(rows: &Rows, out: &mut Vec<u8>) -> Result<(), Problem> {
    let mut columns = Vec::with_capacity(rows.columns.len());
    for cells in &rows.columns {
        let mut same = Vec::new();
        columns.push(match cells {
            Cells::Numbers(numbers) if numbers.len() == rows.count => Column::Numbers(numbers),
            Cells::Names(names) if names.len() == rows.count => Column::Names(names),
            Cells::Numbers(_) | Cells::Names(_) => return Err(unfit()),
            Cells::Number(value) => {
                number(*value, &mut same);
                Column::Same(same)
            }
            Cells::Name(name) => {
                text(name, &mut same);
                Column::Same(same)
            }
            Cells::Absent => Column::Same(same),
        });
    }
    out.reserve(rows.count * (columns.len() * WIDEST + 1));
    for row in 0..rows.count {
        for column in &columns {
            match column {
                Column::Numbers(numbers) => number(numbers[row], out),
                Column::Names(names) => text(names[row], out),
                Column::Same(bytes) => out.extend_from_slice(bytes),
            }
            out.push(b',');
        }
        end(out);
    }
    Ok(())
}

/// Ends a line in the place of its last comma.
fn end(line: &mut Vec<u8>) {
    if line.last() == Some(&b',') {
        line.pop();
    }
    line.extend_from_slice(b"\r\n");
}

/// The shortest digits that read back as the same number, as in JSON.
fn number(value: f64, out: &mut Vec<u8>) {
    if value.is_finite() {
        out.extend_from_slice(zmij::Buffer::new().format_finite(value).as_bytes());
    }
}

/// A text, in quotes where it needs them.
fn text(text: &str, out: &mut Vec<u8>) {
    if text.contains([',', '"', '\r', '\n']) {
        out.push(b'"');
        out.extend_from_slice(text.replace('"', "\"\"").as_bytes());
        out.push(b'"');
    } else {
        out.extend_from_slice(text.as_bytes());
    }
}

#[cfg(test)]
mod tests {
    use super::{head, rows};
    use crate::http::encode::rows::{Cells, Head, Heading, Kind, Rows};

    #[test]
    fn rows_are_what_rfc_4180_says() {
        let columns = vec![
            Heading { name: "label", unit: "", kind: Kind::Text { longest: 10 } },
            Heading { name: "total", unit: "W m^-2 sr^-1", kind: Kind::Number },
            Heading { name: "bound", unit: "", kind: Kind::Number },
            Heading { name: "method", unit: "", kind: Kind::Text { longest: 7 } },
        ];
        let table = Head { columns, rows: 3, notes: Vec::new() };
        assert_eq!(head(&table), b"label,total_W_m-2_sr-1,bound,method\r\n");
        let mut out = b"before".to_vec();
        let columns = vec![
            Cells::Name("a \"b\", c"),
            Cells::Numbers(vec![0.1, f64::NAN, -1e-300].into()),
            Cells::Absent,
            Cells::Names(&["uniform", "", "series"]),
        ];
        rows(&Rows { count: 3, columns }, &mut out).unwrap();
        let expected = "before\"a \"\"b\"\", c\",0.1,,uniform\r\n\
            \"a \"\"b\"\", c\",,,\r\n\
            \"a \"\"b\"\", c\",-1e-300,,series\r\n";
        assert_eq!(str::from_utf8(&out).unwrap(), expected);
        let short = Rows { count: 2, columns: vec![Cells::Numbers(vec![1.0].into())] };
        assert!(rows(&short, &mut out).is_err());
        // Of a line of one empty field nothing is left but its end.
        out.clear();
        rows(&Rows { count: 2, columns: vec![Cells::Number(f64::INFINITY)] }, &mut out).unwrap();
        assert_eq!(out, b"\r\n\r\n");
    }
}
