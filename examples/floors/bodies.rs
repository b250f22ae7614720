//! One request in every format that a body may have.

use super::Failure;
use super::batch::{AngleColumns, SCENE_JSON};
use arrow_array::{ArrayRef, Float64Array, RecordBatch};
use arrow_ipc::writer::StreamWriter;
use std::fmt::Write as _;
use std::fs::{self, File};
use std::io::Write as _;
use std::path::Path;
use std::sync::Arc;

/// Names of the columns, in order.
const NAMES: [&str; 3] = ["theta_i_deg", "theta_r_deg", "phi_r_deg"];

/// Writes `COUNT.json` with all digits, `COUNT.short.json` with six decimals, and columns as `COUNT.arrow`,
/// `COUNT.npy`, `COUNT.csv` and `COUNT.f64` (raw, one column after the other).
pub(crate) fn write(directory: &Path, angles: &AngleColumns) -> Result<(), Failure> {
    fs::create_dir_all(directory)?;
    let count = angles.theta_i.len();
    let path = |end: &str| directory.join(format!("{count}.{end}"));
    let columns = [&angles.theta_i, &angles.theta_r, &angles.phi_r];

    fs::write(path("json"), json(columns, |text, angle| write!(text, "{angle}"))?)?;
    fs::write(path("short.json"), json(columns, |text, angle| write!(text, "{angle:.6}"))?)?;

    let arrays = NAMES.iter().zip(columns).map(|(name, column)| {
        let array: ArrayRef = Arc::new(Float64Array::from(column.clone()));
        (*name, array)
    });
    let batch = RecordBatch::try_from_iter(arrays)?;
    let mut stream = StreamWriter::try_new(File::create(path("arrow"))?, &batch.schema())?;
    stream.write(&batch)?;
    stream.finish()?;

    fs::write(
        path("f64"),
        columns.iter().flat_map(|column| column.iter()).flat_map(|v| v.to_le_bytes()).collect::<Vec<_>>(),
    )?;

    let rows = || (0..count).map(|row| columns.map(|column| column[row]));
    let mut npy = npy_header(count)?;
    npy.extend(rows().flatten().flat_map(f64::to_le_bytes));
    fs::write(path("npy"), npy)?;

    let mut csv = std::io::BufWriter::new(File::create(path("csv"))?);
    writeln!(csv, "{}", NAMES.join(","))?;
    for [theta_i, theta_r, phi_r] in rows() {
        writeln!(csv, "{theta_i},{theta_r},{phi_r}")?;
    }
    csv.flush()?;
    Ok(())
}

fn json(
    columns: [&Vec<f64>; 3],
    number: impl Fn(&mut String, f64) -> std::fmt::Result,
) -> Result<String, std::fmt::Error> {
    let mut text = format!("{{{SCENE_JSON},\"geometry\":{{");
    for (place, (name, column)) in NAMES.iter().zip(columns).enumerate() {
        let separator = if place == 0 { "" } else { "," };
        write!(text, "{separator}\"{name}\":[")?;
        for (place, &angle) in column.iter().enumerate() {
            if place > 0 {
                text.push(',');
            }
            number(&mut text, angle)?;
        }
        text.push(']');
    }
    text.push_str("}}");
    Ok(text)
}

/// Bytes before the dictionary: magic, version, length.
const NPY_PREFIX: usize = 10;

/// Version 1.0 of the format: a structured array of little-endian doubles, one record a direction. Padded so that the
/// data begin at a multiple of 64 bytes.
fn npy_header(count: usize) -> Result<Vec<u8>, Failure> {
    let fields = NAMES.map(|name| format!("('{name}', '<f8')")).join(", ");
    let mut dictionary = format!("{{'descr': [{fields}], 'fortran_order': False, 'shape': ({count},), }}");
    while !(NPY_PREFIX + dictionary.len() + 1).is_multiple_of(64) {
        dictionary.push(' ');
    }
    dictionary.push('\n');
    let mut header = b"\x93NUMPY\x01\x00".to_vec();
    header.extend(u16::try_from(dictionary.len())?.to_le_bytes());
    header.extend(dictionary.as_bytes());
    Ok(header)
}
