//! Columns as clients send them, and what is said of bodies that are none.

use super::columns;
use crate::http::input::node::{Array, Node};
use crate::http::input::reader::Reader;
use crate::http::negotiate::Format;
use crate::http::problem::{Code, FieldError};
use arrow_array::{Array as _, ArrayRef, Float32Array, Float64Array, Int16Array, RecordBatch, StringArray};
use arrow_ipc::writer::StreamWriter;
use arrow_schema::Schema;
use std::sync::Arc;

/// The columns of a body, or what is wrong with the body.
type Read = Result<Vec<(&'static str, Array)>, String>;

/// What was read, and what was wrong with the columns.
fn read(format: Format, bytes: &[u8], most: usize) -> (Read, Vec<FieldError>) {
    let mut reader = Reader::query().with_most_directions(most);
    let read = columns(format, bytes, &mut reader);
    let read = read.map(|columns| columns.0.into_iter().map(|column| (column.name, column.array)).collect());
    let errors = reader.finish(None::<()>).unwrap_err();
    (read.map_err(|problem| problem.detail), errors)
}

fn accepted(format: Format, bytes: &[u8]) -> Vec<(&'static str, Vec<f64>)> {
    let (columns, errors) = read(format, bytes, 100);
    assert_eq!(errors.len(), 0, "{errors:?}");
    columns.unwrap().into_iter().map(|(name, array)| (name, array.numbers)).collect()
}

fn malformed(format: Format, bytes: &[u8]) -> String {
    read(format, bytes, 100).0.unwrap_err()
}

fn refused(format: Format, bytes: &[u8]) -> Vec<(String, Code, String)> {
    let (columns, errors) = read(format, bytes, 100);
    columns.unwrap();
    errors.into_iter().map(|error| (error.pointer, error.code, error.detail)).collect()
}

/// A stream with a batch for each set of columns.
fn stream(batches: &[Vec<(&str, ArrayRef)>]) -> Vec<u8> {
    let batches: Vec<RecordBatch> =
        batches.iter().map(|columns| RecordBatch::try_from_iter(columns.clone()).unwrap()).collect();
    let schema = batches.first().map_or_else(|| Arc::new(Schema::empty()), RecordBatch::schema);
    let mut writer = StreamWriter::try_new(Vec::new(), &schema).unwrap();
    for batch in &batches {
        writer.write(batch).unwrap();
    }
    writer.into_inner().unwrap()
}

fn doubles(numbers: &[f64]) -> ArrayRef {
    Arc::new(Float64Array::from(numbers.to_vec()))
}

/// A version 1.0 file.
fn npy(header: &str, records: &[u8]) -> Vec<u8> {
    let mut bytes = b"\x93NUMPY\x01\x00".to_vec();
    bytes.extend(u16::try_from(header.len()).unwrap().to_le_bytes());
    bytes.extend(header.as_bytes());
    bytes.extend(records);
    bytes
}

#[test]
fn csv_is_read_by_names() {
    let text = b"\xef\xbb\xbftheta_r_deg, theta_i_deg\r\n1e1,\"20\"\r\n -5 ,.5\n";
    let read = accepted(Format::Csv, text);
    assert_eq!(read, [("theta_r_deg", vec![10.0, -5.0]), ("theta_i_deg", vec![20.0, 0.5])]);
    assert_eq!(accepted(Format::Csv, b"phi_r_deg"), [("phi_r_deg", vec![])]);
}

#[test]
fn csv_cells_without_a_number_are_kept_for_their_message() {
    let (columns, _) = read(Format::Csv, b"theta_i_deg\n1\nabc\n1e400\nnan\n\"\"\n", 100);
    let (_, array) = &columns.unwrap()[0];
    assert_eq!((array.length, array.numbers.len()), (5, 5));
    let texts = ["abc", "1e400", "nan", ""];
    let expected: Vec<_> =
        texts.iter().enumerate().map(|(index, text)| (index + 1, Node::Text((*text).to_owned()))).collect();
    assert_eq!(array.others, expected);
}

#[test]
fn what_is_longer_than_the_limit_is_counted() {
    let text = format!("theta_i_deg\n{}", "1\n".repeat(150));
    let batch = || vec![("theta_i_deg", doubles(&[1.0; 75]))];
    let ones: Vec<u8> = std::iter::repeat_n(1.0f64.to_le_bytes(), 150).flatten().collect();
    let array = npy("{'descr': [('theta_i_deg', '<f8')], 'fortran_order': False, 'shape': (150,), }", &ones);
    for (format, bytes) in
        [(Format::Csv, text.into_bytes()), (Format::Arrow, stream(&[batch(), batch()])), (Format::Npy, array)]
    {
        let (columns, _) = read(format, &bytes, 100);
        let (_, array) = &columns.unwrap()[0];
        assert_eq!((array.length, array.numbers.len()), (150, 0), "{format:?}");
        let (columns, _) = read(format, &bytes, 150);
        assert_eq!(columns.unwrap()[0].1.numbers, [1.0; 150], "{format:?}");
    }
}

#[test]
fn batches_follow_each_other() {
    let shorts: ArrayRef = Arc::new(Int16Array::from(vec![-3, 4]));
    let singles: ArrayRef = Arc::new(Float32Array::from(vec![0.1, 2.0]));
    let first = vec![("theta_i_deg", doubles(&[0.1, 2.0])), ("theta_r_deg", shorts), ("phi_r_deg", singles)];
    let second: Vec<_> = first.iter().map(|(name, column)| (*name, column.slice(1, 1))).collect();
    let read = accepted(Format::Arrow, &stream(&[first, second]));
    let expected = [
        ("theta_i_deg", vec![0.1, 2.0, 2.0]),
        ("theta_r_deg", vec![-3.0, 4.0, 4.0]),
        ("phi_r_deg", vec![f64::from(0.1f32), 2.0, 2.0]),
    ];
    assert_eq!(read, expected);
}

#[test]
fn nulls_are_kept_for_their_message() {
    let mut numbers: Vec<Option<f64>> = (0..20).map(|n| Some(f64::from(n))).collect();
    numbers[9] = None;
    numbers[17] = None;
    let column: ArrayRef = Arc::new(Float64Array::from(numbers));
    let (columns, _) = read(Format::Arrow, &stream(&[vec![("theta_i_deg", column)]]), 100);
    let (_, array) = &columns.unwrap()[0];
    assert_eq!(array.others, [(9, Node::Null), (17, Node::Null)]);
    assert_eq!((array.length, array.numbers[10]), (20, 10.0));
}

#[test]
fn columns_of_other_names_or_types_are_all_named() {
    let names: ArrayRef = Arc::new(StringArray::from(vec!["a"]));
    let one = || doubles(&[1.0]);
    let batch = vec![("theta_r_deg", names), ("theta_i_deg", one()), ("weight", one())];
    let expected = [
        (
            "/geometry/theta_r_deg".to_owned(),
            Code::WrongType,
            "found Utf8: expected 64- or 32-bit floats, or integers",
        ),
        (
            "/geometry/weight".to_owned(),
            Code::UnknownField,
            "an unknown column; accepted: theta_i_deg, theta_r_deg, phi_r_deg",
        ),
    ];
    let expected = expected.map(|(pointer, code, detail)| (pointer, code, detail.to_owned()));
    assert_eq!(refused(Format::Arrow, &stream(&[batch])), expected);
    let header = "{'descr': [('theta_r_deg', '<U4'), ('theta_i_deg', '<f8'), ('weight', '<f8')], \
        'fortran_order': False, 'shape': (0,), }";
    let found = refused(Format::Npy, &npy(header, &[]));
    assert!(found[0].2.contains("'<U4'"), "{found:?}");
    assert_eq!(found[1], expected[1]);
    let found = refused(Format::Csv, b"theta_i_deg,theta_i_deg,weight\n1,2,3\n");
    assert_eq!((found[0].0.as_str(), found[0].1), ("/geometry/theta_i_deg", Code::Duplicate));
    assert_eq!(found[1], expected[1]);
}

#[test]
fn arrays_without_fields_or_of_more_dimensions_are_refused() {
    let plain = npy("{'descr': '<f8', 'fortran_order': False, 'shape': (1,), }", &[0; 8]);
    let table = npy("{'descr': [('theta_i_deg', '<f8')], 'fortran_order': True, 'shape': (1, 1), }", &[0; 8]);
    for (bytes, what) in [(plain, "no fields"), (table, "2 dimensions")] {
        let found = refused(Format::Npy, &bytes);
        assert_eq!((found[0].0.as_str(), found[0].1), ("/geometry", Code::WrongType));
        assert!(found[0].2.contains(what), "{found:?}");
    }
}

#[test]
fn records_may_be_big_endian_and_padded() {
    let header = "{\"shape\": (2,), 'fortran_order': False, \
        'descr': [('theta_r_deg', '>f4'), ('', '|V4'), ('theta_i_deg', '<f8')]}\n";
    let mut records = Vec::new();
    for (r, i) in [(1.5f32, 0.1f64), (-2.0, 3.0)] {
        records.extend(r.to_be_bytes());
        records.extend([9; 4]);
        records.extend(i.to_le_bytes());
    }
    let read = accepted(Format::Npy, &npy(header, &records));
    assert_eq!(read, [("theta_r_deg", vec![1.5, -2.0]), ("theta_i_deg", vec![0.1, 3.0])]);
}

#[test]
fn bodies_that_are_not_what_they_say_are_malformed() {
    let field = "'descr': [('theta_i_deg', '<f8')], 'fortran_order': False";
    for (format, bytes, expected) in [
        (Format::Csv, b"".to_vec(), "empty"),
        (Format::Csv, b"theta_i_deg,theta_r_deg\n1,2\n3\n".to_vec(), "line 3 has 1 fields"),
        (Format::Npy, b"PK\x03\x04".to_vec(), "does not begin"),
        (Format::Npy, b"\x93NUMPY\x01".to_vec(), "ends within"),
        (Format::Npy, b"\x93NUMPY\x09\x00\x00\x00".to_vec(), "version is 9.0"),
        (Format::Npy, b"\x93NUMPY\x02\x00\xff\xff\xff\xff".to_vec(), "4294967295 bytes"),
        (
            Format::Npy,
            npy(&format!("{{{field}, 'shape': (3,), }}"), &[0; 16]),
            "expected 3 records of 8 bytes",
        ),
        (Format::Npy, npy(&format!("{{{field}, 'shape': (2305843009213693952,), }}"), &[]), "expected 23058"),
        (Format::Npy, npy(&format!("{{{field}, 'shape': (99999999999999999999,), }}"), &[]), "a length"),
        (Format::Npy, npy(&format!("{{{field}, {field}, 'shape': (3,), }}"), &[]), "once too often"),
        (Format::Npy, npy(&format!("{{{field}}}"), &[]), "lacks one of"),
        (Format::Npy, npy(&"{".repeat(5000), &[]), "expected a string"),
        (Format::Npy, npy(&format!("{{{field}, 'shape': (0,)}} + 1"), &[]), "expected its end"),
        (
            Format::Npy,
            npy("{'descr': [('theta_i_deg', '<f8', (1000000000, 1000000000))]}", &[]),
            "expected ')'",
        ),
        (Format::Arrow, b"".to_vec(), "is empty"),
        (Format::Arrow, b"ARROW1\0\0".to_vec(), "expected a stream"),
        (Format::Arrow, b"theta_i_deg\n1\n".to_vec(), "bytes: expected at most"),
        (Format::Arrow, [[255; 4], [255, 255, 255, 127]].concat(), "2147483647 bytes"),
        (Format::Arrow, [[255; 4], [128, 0, 0, 0]].concat(), "ends within a message"),
        (Format::Arrow, [vec![255; 4], vec![8, 0, 0, 0], vec![1; 8]].concat(), "no flatbuffer"),
    ] {
        let detail = malformed(format, &bytes);
        assert!(detail.contains(expected), "{expected}: {detail}");
    }
}

/// Every byte of a stream matters or does not, but none breaks the reader; and a stream cut anywhere within a message is
/// not taken for a whole one.
#[test]
fn damaged_streams_are_refused_or_read_but_break_nothing() {
    let whole = stream(&[vec![("theta_i_deg", doubles(&[1.0, 2.0])), ("theta_r_deg", doubles(&[3.0, 4.0]))]]);
    let mut refusals = 0;
    for index in 0..whole.len() {
        for bit in 0..8 {
            let mut damaged = whole.clone();
            damaged[index] ^= 1 << bit;
            let (columns, errors) = read(Format::Arrow, &damaged, 100);
            refusals += usize::from(columns.is_err() || !errors.is_empty());
        }
        for value in [0, 0x7f, 0x80, 0xff] {
            let mut damaged = whole.clone();
            damaged[index] = value;
            let (columns, _) = read(Format::Arrow, &damaged, 100);
            let columns = columns.unwrap_or_default();
            assert!(columns.iter().all(|(_, array)| array.length <= 100 || array.numbers.is_empty()));
        }
    }
    assert!(refusals > whole.len(), "{refusals} of {} flips", 8 * whole.len());
    let cuts = (1..whole.len()).filter(|&end| read(Format::Arrow, &whole[..end], 100).0.is_ok()).count();
    // After the schema, before the first batch; after the batch; and after the mark of the end.
    assert!(cuts <= 3, "{cuts}");
}
