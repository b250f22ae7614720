//! The seeds: real requests, from the examples of the service's own document and from real writers.

use crate::targets::{ENCODINGS, OF_DIRECTIONS, SCENE};
use arrow_array::{ArrayRef, Float64Array, RecordBatch};
use arrow_ipc::writer::StreamWriter;
use serde_json::Value;
use std::error::Error;
use std::fs;
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Writes all of them, each into the folder of its target.
pub(crate) fn write_all(seeds: &Path) -> Result<(), Box<dyn Error>> {
    let document: Value = serde_json::from_str(&reflectance::http::openapi_json())?;
    let write = |target: &str, name: &str, bytes: &[u8]| -> std::io::Result<()> {
        let folder: PathBuf = seeds.join(target);
        fs::create_dir_all(&folder)?;
        fs::write(folder.join(name), bytes)
    };
    for (index, path) in OF_DIRECTIONS.iter().enumerate() {
        for (name, body) in examples(&document, path) {
            let file = format!("{}_{name}", path.trim_start_matches("/v1/"));
            write("json_directions", &file, &[&[u8::try_from(index)?], body.as_bytes()].concat())?;
        }
    }
    for (target, path) in
        [("json_diagrams", "/v1/diagrams"), ("json_image_irradiance", "/v1/image-irradiance")]
    {
        for (name, body) in examples(&document, path) {
            write(target, &name, body.as_bytes())?;
        }
    }

    write("columns_arrow", "one_batch", &arrow(1)?)?;
    write("columns_arrow", "three_batches", &arrow(3)?)?;
    write("columns_npy", "two_columns", &npy("('theta_i_deg', '<f8'), ('theta_r_deg', '<f8')", 2))?;
    write("columns_npy", "one_column", &npy("('theta_r_deg', '<f8')", 1))?;
    write("columns_csv", "three_columns", b"theta_i_deg,theta_r_deg,phi_r_deg\r\n30,30,0\r\n10,-20,1e1\r\n")?;
    write("columns_csv", "quoted", b"\"theta_r_deg\",theta_i_deg\n\"30\",30\n0.5,89.9\n")?;

    let body = examples(&document, "/v1/radiance").into_iter().next().ok_or("no example")?.1;
    for (index, encoding) in ENCODINGS.iter().enumerate() {
        write(
            "packed",
            encoding,
            &[&[u8::try_from(index)?], packed(encoding, body.as_bytes())?.as_slice()].concat(),
        )?;
    }

    let sweep = "sweep=theta_r_deg&from_deg=-80&to_deg=80&step_deg=5&at_deg=10,30,45,60";
    write("query", "diagram", format!("\0{SCENE}&{sweep}").as_bytes())?;
    write("query", "camera", format!("\0{SCENE}&{sweep}&n=1.44&k=5.23&pixel_area_um2=25&distance_um=5e5&focal_length_um=5e4&aperture_um=2.5e4&log10=true").as_bytes())?;
    write(
        "query",
        "roughness",
        b"\x01rms_height_um=0.2&correlation_length_um=4&wavelength_um=0.55&theta_i_deg=30",
    )?;
    write("query", "slope", b"\x01facet_slope_deg=13")?;
    write("query", "figure", b"\x02log10=true")?;
    write(
        "query",
        "columns",
        format!("\x03{SCENE}&relative_tolerance=1e-6&method=auto&components=specular_lobe").as_bytes(),
    )?;

    let trace = "00-0af7651916cd43dd8448eb211c80319c-b7ad6b7169203331-01";
    write("headers", "browser", format!("get\ntext/html,application/xhtml+xml;q=0.9,*/*;q=0.8\ngzip, deflate, br, zstd\n\"abc\", W/\"def\"\n{trace}\nvendor=1\nid-1").as_bytes())?;
    write("headers", "tool", b"get\ntext/csv;q=0.5, application/vnd.apache.arrow.stream\nidentity;q=0, *;q=0.1\n*\n\n\n\nBearer key")?;
    write(
        "headers",
        "post",
        b"post\napplication/json\nzstd\n\n\n\n\n\nhttps://example.org\napplication/json; charset=utf-8\ngzip",
    )?;
    write("headers", "options", b"options\n*/*\n\n\n\n\n\n\nhttps://example.org")?;

    write("keys", "two", b"# who may ask\nalice 0123456789abcdef\n\n bob\t\"fedcba9876543210\"\r\n")?;
    write("keys", "wrong", b"alice 0123456789abcdef\nalice 0123456789abcdeg\nbob short\nbob\n")?;
    Ok(())
}

/// The examples of a POST body, by name.
fn examples(document: &Value, path: &str) -> Vec<(String, String)> {
    let content = &document["paths"][path]["post"]["requestBody"]["content"]["application/json"]["examples"];
    let examples = content.as_object().into_iter().flatten();
    examples.map(|(name, example)| (name.clone(), example["value"].to_string())).collect()
}

/// A stream of directions.
fn arrow(batches: usize) -> Result<Vec<u8>, Box<dyn Error>> {
    let column =
        |step: f64| Arc::new(Float64Array::from_iter_values((0..5).map(|i| f64::from(i) * step))) as ArrayRef;
    let columns = [("theta_i_deg", column(10.0)), ("theta_r_deg", column(15.0)), ("phi_r_deg", column(30.0))];
    let batch = RecordBatch::try_from_iter(columns)?;
    let mut writer = StreamWriter::try_new(Vec::new(), &batch.schema())?;
    for _ in 0..batches {
        writer.write(&batch)?;
    }
    writer.finish()?;
    Ok(writer.into_inner()?)
}

/// A file of directions.
fn npy(fields: &str, columns: u8) -> Vec<u8> {
    let head = format!("{{'descr': [{fields}], 'fortran_order': False, 'shape': (3,), }}");
    // With the ten bytes before it and the line's end, a multiple of 64.
    let padded = (head.len() + 11).next_multiple_of(64) - 11;
    let mut file = b"\x93NUMPY\x01\x00".to_vec();
    file.extend(u16::try_from(padded + 1).unwrap_or(u16::MAX).to_le_bytes());
    file.extend(format!("{head:padded$}\n").as_bytes());
    for number in 0..3 * columns {
        file.extend((f64::from(number) * 10.0).to_le_bytes());
    }
    file
}

fn packed(encoding: &str, body: &[u8]) -> Result<Vec<u8>, Box<dyn Error>> {
    let mut packed = Vec::new();
    match encoding {
        "gzip" => {
            let mut encoder = flate2::write::GzEncoder::new(&mut packed, flate2::Compression::fast());
            encoder.write_all(body)?;
            encoder.finish()?;
        }
        "br" => brotli::CompressorWriter::new(&mut packed, 4096, 5, 22).write_all(body)?,
        _ => zstd::stream::copy_encode(body, &mut packed, 1)?,
    }
    Ok(packed)
}
