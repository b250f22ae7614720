//! Answers and requests in every format: the same numbers, and what is said of bodies and wishes that no format fits.

use crate::server::{Server, errors, problem};
use arrow_array::cast::AsArray as _;
use arrow_array::types::Float64Type;
use arrow_array::{Array as _, ArrayRef, Float64Array, RecordBatch};
use arrow_ipc::reader::StreamReader;
use arrow_ipc::writer::StreamWriter;
use reqwest::blocking::Response;
use serde_json::{Value, json};
use std::io::{Read as _, Write as _};
use std::net::TcpStream;
use std::sync::Arc;

const ARROW: &str = "application/vnd.apache.arrow.stream";
const NPY: &str = "application/x-npy";
const CSV: &str = "text/csv";

/// What stands in the query beside columns; the same as [`body`] says.
const QUERY: &str = "model=unified&rms_height_um=0.2&correlation_length_um=4&n=1.5&diffuse_albedo=0.25\
    &wavelength_um=0.55&footprint_um2=1e6&patch_half_x_um=500&patch_half_y_um=500&log10=true";

/// Enough that the answer takes several stretches.
const COUNT: usize = 20_000;

/// Source and viewer of direction `index`.
fn angles(index: usize) -> [f64; 2] {
    let share = index as f64 / COUNT as f64;
    [90.0 * share, 180.0 * (0.37 * index as f64).fract() - 90.0]
}

fn column(of: usize) -> Vec<f64> {
    (0..COUNT).map(|index| angles(index)[of]).collect()
}

fn body() -> Value {
    json!({
        "model": "unified",
        "surface": {"rms_height_um": 0.2, "correlation_length_um": 4, "medium": {"n": 1.5}, "diffuse_albedo": 0.25},
        "illumination": {"wavelength_um": 0.55},
        "sensor": {"footprint_um2": 1e6, "patch_half_x_um": 500, "patch_half_y_um": 500},
        "geometry": {"theta_i_deg": column(0), "theta_r_deg": column(1), "phi_r_deg": 20},
        "output": {"log10": true}
    })
}

fn post(server: &Server, path: &str, kind: &str, accept: &str, body: Vec<u8>) -> Response {
    server
        .request("POST", path)
        .header("content-type", kind)
        .header("accept", accept)
        .body(body)
        .send()
        .unwrap()
}

fn stream(batches: &[Vec<(&str, Vec<f64>)>]) -> Vec<u8> {
    let array = |numbers: &Vec<f64>| -> ArrayRef { Arc::new(Float64Array::from(numbers.clone())) };
    let batches: Vec<_> = batches
        .iter()
        .map(|batch| {
            let columns = batch.iter().map(|(name, numbers)| (*name, array(numbers)));
            RecordBatch::try_from_iter(columns).unwrap()
        })
        .collect();
    let mut writer = StreamWriter::try_new(Vec::new(), &batches[0].schema()).unwrap();
    for batch in batches {
        writer.write(&batch).unwrap();
    }
    writer.into_inner().unwrap()
}

/// Columns of an Arrow stream by name, NaN and null alike.
fn arrow_columns(bytes: &[u8]) -> Vec<(String, Vec<f64>)> {
    let reader = StreamReader::try_new(bytes, None).unwrap();
    let schema = reader.schema();
    let mut columns: Vec<(String, Vec<f64>)> =
        schema.fields().iter().map(|field| (field.name().clone(), Vec::new())).collect();
    for batch in reader {
        for (column, (_, numbers)) in batch.unwrap().columns().iter().zip(&mut columns) {
            let array = column.as_primitive::<Float64Type>();
            numbers.extend(array.iter().map(|number| number.unwrap_or(f64::NAN)));
        }
    }
    columns
}

/// The same of an array of records of numbers.
fn npy_columns(bytes: &[u8]) -> Vec<(String, Vec<f64>)> {
    let file = npyz::NpyFile::new(bytes).unwrap();
    let npyz::DType::Record(fields) = file.dtype() else { panic!("not a structured array") };
    assert!(fields.iter().all(|field| field.dtype.descr() == "'<f8'"), "{fields:?}");
    assert_eq!(file.shape().len(), 1);
    let count = file.len();
    let records = file.into_inner();
    assert_eq!(records.len() as u64, count * 8 * fields.len() as u64);
    let cells: Vec<f64> =
        records.chunks_exact(8).map(|cell| f64::from_le_bytes(cell.try_into().unwrap())).collect();
    let of = |at: usize| cells.iter().skip(at).step_by(fields.len()).copied().collect();
    fields.iter().enumerate().map(|(at, field)| (field.name.clone(), of(at))).collect()
}

/// The same of CSV, units cut off the names.
fn csv_columns(bytes: &[u8]) -> Vec<(String, Vec<f64>)> {
    let mut reader = csv::Reader::from_reader(bytes);
    let names = reader.headers().unwrap().clone();
    let mut columns: Vec<(String, Vec<f64>)> =
        names.iter().map(|name| (unitless(name).to_owned(), Vec::new())).collect();
    for record in reader.records() {
        for (cell, (_, numbers)) in record.unwrap().iter().zip(&mut columns) {
            numbers.push(if cell.is_empty() { f64::NAN } else { cell.parse().unwrap() });
        }
    }
    columns
}

/// A name of a column as JSON has it.
fn unitless(name: &str) -> &str {
    ["_W_m-2_sr-1", "_sr-1"].iter().find_map(|unit| name.strip_suffix(unit)).unwrap_or(name)
}

fn bits(numbers: &[f64]) -> Vec<u64> {
    // JSON and CSV have one absence for NaN and both infinities.
    numbers.iter().map(|number| if number.is_finite() { number.to_bits() } else { 1 }).collect()
}

#[test]
fn every_format_has_the_same_numbers() {
    let server = Server::start();
    let sent = body();
    for path in ["/v1/radiance", "/v1/brdf"] {
        let json = server.answer(path, &sent);
        let ask = |accept: &str| {
            let response = post(&server, path, "application/json", accept, sent.to_string().into_bytes());
            assert_eq!(response.status(), 200);
            assert!(response.headers()["content-type"].to_str().unwrap().starts_with(accept));
            response.bytes().unwrap()
        };
        let tables = [csv_columns(&ask(CSV)), arrow_columns(&ask(ARROW)), npy_columns(&ask(NPY))];
        for table in tables {
            let mut compared = 0;
            for (name, numbers) in &table {
                let expected: Vec<f64> = match name.as_str() {
                    "theta_i_deg" => column(0),
                    "theta_r_deg" => column(1),
                    "phi_r_deg" => vec![20.0; COUNT],
                    name => {
                        let values = json[name].as_array().unwrap_or_else(|| panic!("no {name} in JSON"));
                        compared += 1;
                        values.iter().map(|value| value.as_f64().unwrap_or(f64::NAN)).collect()
                    }
                };
                assert_eq!(bits(numbers), bits(&expected), "{path} {name}");
            }
            // Four values, their logarithms, and the bound.
            assert_eq!(compared, 9, "{:?}", table.iter().map(|(name, _)| name).collect::<Vec<_>>());
        }
    }
}

#[test]
fn columns_are_the_arrays_of_a_json_request() {
    let server = Server::start();
    let expected = server.answer("/v1/radiance", &body());
    let (i, r) = (column(0), column(1));
    let mut text = "theta_r_deg,theta_i_deg\r\n".to_owned();
    let rows: Vec<String> = i.iter().zip(&r).map(|(i, r)| format!("{r},{i}\r\n")).collect();
    text.push_str(&rows.concat());
    let split = |range: std::ops::Range<usize>| {
        vec![("theta_i_deg", i[range.clone()].to_vec()), ("theta_r_deg", r[range].to_vec())]
    };
    let batches = stream(&[split(0..1), split(1..7000), split(7000..7000), split(7000..COUNT)]);
    let mut array = format!(
        "\x00\x00{{'descr': [('theta_i_deg', '<f8'), ('theta_r_deg', '>f8')], 'fortran_order': False, 'shape': ({COUNT},), }}\n"
    )
    .into_bytes();
    let length = u16::try_from(array.len() - 2).unwrap();
    array[..2].copy_from_slice(&length.to_le_bytes());
    let mut array = [b"\x93NUMPY\x01\x00".as_slice(), &array].concat();
    for (i, r) in i.iter().zip(&r) {
        array.extend(i.to_le_bytes());
        array.extend(r.to_be_bytes());
    }
    let path = format!("/v1/radiance?{QUERY}&phi_r_deg=20");
    for (kind, sent) in [("Text/CSV; charset=UTF-8", text.into_bytes()), (ARROW, batches), (NPY, array)] {
        let response = post(&server, &path, kind, "application/json", sent);
        let status = response.status();
        let answer: Value = response.json().unwrap();
        assert_eq!(status, 200, "{kind}: {answer}");
        assert_eq!(answer, expected, "{kind}");
    }
    // One column, two numbers in the query.
    let path = format!("/v1/brdf?{QUERY}&theta_r_deg=-30&theta_i_deg=10");
    let few = post(&server, &path, CSV, "*/*", b"phi_r_deg\n0\n20\n".to_vec()).json::<Value>().unwrap();
    let mut scene = body();
    scene["geometry"] = json!({"theta_i_deg": 10, "theta_r_deg": -30, "phi_r_deg": [0, 20]});
    assert_eq!(few, server.answer("/v1/brdf", &scene));
}

#[test]
fn tables_repeat_the_angles_unless_they_came_as_binary_columns() {
    let server = Server::start();
    let columns = [("theta_i_deg", vec![10.0, 20.0]), ("theta_r_deg", vec![20.0, 10.0])];
    let (binary, text) = (stream(&[columns.to_vec()]), b"theta_i_deg,theta_r_deg\n10,20\n20,10\n".to_vec());
    let with = |kind: &str, accept: &str, sent: &Vec<u8>, more: &str| {
        let response = post(&server, &format!("/v1/radiance?{QUERY}{more}"), kind, accept, sent.clone());
        assert_eq!(response.status(), 200);
        let bytes = response.bytes().unwrap();
        let columns = match accept {
            ARROW => arrow_columns(&bytes),
            NPY => npy_columns(&bytes),
            _ => csv_columns(&bytes),
        };
        assert!(columns.iter().all(|(_, numbers)| numbers.len() == 2));
        columns.iter().filter(|(name, _)| name.ends_with("_deg")).count()
    };
    for accept in [ARROW, NPY, CSV] {
        assert_eq!(with(ARROW, accept, &binary, ""), 0, "{accept}");
        assert_eq!(with(ARROW, accept, &binary, "&angles=true"), 3, "{accept}");
        assert_eq!(with(CSV, accept, &text, ""), 3, "{accept}");
        assert_eq!(with(CSV, accept, &text, "&angles=false"), 0, "{accept}");
    }
    let link =
        "/v1/diagrams?model=lambertian&diffuse_albedo=0.5&sweep=theta_i_deg&from_deg=0&to_deg=90&at_deg=0";
    let tag = |link: &str| {
        let response = server.request("GET", link).header("accept", CSV).send().unwrap();
        (response.headers()["etag"].clone(), csv_columns(&response.bytes().unwrap()).len())
    };
    let (plain, said, without) =
        (tag(link), tag(&format!("{link}&angles=true")), tag(&format!("{link}&angles=false")));
    assert_eq!(plain, said);
    assert_ne!(plain.0, without.0);
    assert_eq!(plain.1 - without.1, 3);
}

#[test]
fn what_is_wrong_with_query_and_columns_is_said_at_once() {
    let server = Server::start();
    let path = "/v1/radiance?model=torrance_sparrow&facet_slope_deg=-1&theta_i_deg=5&glitter=1";
    let text = b"theta_i_deg,theta_r_deg,weight\n1,2,3\n,91,1\n1e999,x,1\n";
    let document = problem(post(&server, path, CSV, "*/*", text.to_vec()), 422);
    let expected = [
        ("/facet_slope_deg", "out_of_range"),
        ("/geometry/theta_i_deg/1", "wrong_type"),
        ("/geometry/theta_i_deg/2", "out_of_range"),
        ("/geometry/theta_r_deg/1", "out_of_range"),
        ("/geometry/theta_r_deg/2", "wrong_type"),
        ("/geometry/weight", "unknown_field"),
        ("/glitter", "unknown_field"),
        ("/theta_i_deg", "inconsistent"),
    ];
    assert_eq!(errors(&document), expected.map(|(pointer, code)| (pointer.to_owned(), code.to_owned())));

    let path = format!("/v1/radiance?{QUERY}");
    let document = problem(post(&server, &path, CSV, "*/*", b"theta_i_deg\n".to_vec()), 422);
    let expected = [("/geometry/theta_i_deg", "empty"), ("/theta_r_deg", "required")];
    assert_eq!(errors(&document), expected.map(|(pointer, code)| (pointer.to_owned(), code.to_owned())));

    // Of many elements twenty are listed.
    let text = format!("theta_i_deg,theta_r_deg\n{}", "95,1\n".repeat(50));
    let document = problem(post(&server, &path, CSV, "*/*", text.into_bytes()), 422);
    assert_eq!(document["errors"].as_array().unwrap().len(), 21);
    assert!(document["errors"][20]["detail"].as_str().unwrap().contains("30 elements more"));

    // A JSON body leaves nothing for the query to say.
    let response = server.post("/v1/radiance?model=lambertian", crate::server::scene().to_string());
    let expected = [("/model".to_owned(), "inconsistent".to_owned())];
    assert_eq!(errors(&problem(response, 422)), expected);
}

#[test]
fn broken_bodies_say_which_format_they_are_not() {
    let server = Server::start();
    let path = format!("/v1/radiance?{QUERY}&theta_r_deg=0");
    for (kind, sent, what) in [
        (CSV, "theta_i_deg\n1,2\n", "line 2"),
        (ARROW, "theta_i_deg\n1\n", "at most 65536"),
        (NPY, "\u{93}NUMPY", "begin with"),
    ] {
        let document = problem(post(&server, &path, kind, "*/*", sent.into()), 400);
        assert_eq!(document["type"], "/problems/malformed-columns");
        let detail = document["detail"].as_str().unwrap();
        assert!(detail.contains(kind) && detail.contains(what), "{detail}");
    }
}

#[test]
fn the_limit_of_directions_holds_in_every_format() {
    let server = Server::with(&["--direction-limit", "3"]);
    let path = format!("/v1/radiance?{QUERY}&theta_r_deg=0");
    for (count, status) in [(3, 200), (4, 422)] {
        let numbers = vec![1.0; count];
        let text = format!("theta_i_deg\n{}", "1\n".repeat(count));
        let mut answers = vec![
            post(&server, &path, CSV, "*/*", text.into_bytes()),
            post(&server, &path, ARROW, "*/*", stream(&[vec![("theta_i_deg", numbers.clone())]])),
        ];
        let mut sent = crate::server::scene();
        sent["geometry"] = json!({"theta_i_deg": numbers, "theta_r_deg": 0});
        answers.push(server.post("/v1/radiance", sent.to_string()));
        for answer in answers {
            assert_eq!(answer.status(), status);
            if status == 422 {
                let document = problem(answer, 422);
                assert_eq!(errors(&document)[0].1, "too_many");
                assert!(document["detail"].as_str().unwrap().contains("from 1 to 3"), "{document}");
            }
        }
    }
}

#[test]
fn the_best_of_what_is_accepted_is_answered() {
    let server = Server::start();
    let sent = crate::server::scene().to_string().into_bytes();
    for (accept, kind) in [
        ("*/*", "application/json"),
        ("text/csv;q=0.4, application/json;q=0.3", "text/csv; charset=utf-8; header=present"),
        ("application/json;q=0, application/*;q=0.5", ARROW),
        ("Application/X-NumPy", NPY),
        ("application/npy; q=1.0, text/csv; q=0.999", NPY),
        ("text/html, application/VND.apache.arrow.stream;q=0.001", ARROW),
    ] {
        let response = post(&server, "/v1/radiance", "application/json", accept, sent.clone());
        assert_eq!(response.status(), 200, "{accept}");
        assert_eq!(response.headers()["content-type"], kind, "{accept}");
        assert!(response.headers()["vary"].to_str().unwrap().contains("accept"));
    }
    for path in ["/v1/radiance", "/v1/brdf", "/v1/diagrams", "/v1/image-irradiance"] {
        let refused = problem(post(&server, path, "application/json", "text/html", sent.clone()), 406);
        for offered in ["application/json", CSV, ARROW, NPY] {
            assert!(refused["detail"].as_str().unwrap().contains(offered), "{path} {refused}");
        }
    }
    let refused = problem(post(&server, "/v1/radiance", "text/html", "*/*", sent.clone()), 415);
    for accepted in ["application/json", CSV, ARROW, NPY] {
        assert!(refused["detail"].as_str().unwrap().contains(accepted), "{refused}");
    }
    problem(post(&server, "/v1/plan", CSV, "*/*", sent), 415);
}

#[test]
fn a_body_that_stands_still_is_given_up() {
    let server = Server::with(&["--stall-timeout-seconds", "0.3"]);
    let mut stream = TcpStream::connect(server.address()).unwrap();
    write!(
        stream,
        "POST /v1/radiance HTTP/1.1\r\nhost: x\r\ncontent-type: application/json\r\ncontent-length: 100\r\n\r\n{{\"model\""
    )
    .unwrap();
    let mut answer = [0; 2000];
    let length = stream.read(&mut answer).unwrap();
    let answer = String::from_utf8_lossy(&answer[..length]);
    assert!(answer.starts_with("HTTP/1.1 408 "), "{answer}");
    assert!(answer.contains("for 0.3 s"), "{answer}");
}

#[test]
fn figures_and_diagrams_come_as_rows() {
    let server = Server::start();
    let link =
        "/v1/diagrams?model=lambertian&diffuse_albedo=0.5&sweep=theta_i_deg&from_deg=0&to_deg=90&at_deg=0,10";
    for path in [link, "/v1/figures/18", "/v1/figures/23a"] {
        let ask = |accept: &str| {
            let response = server.request("GET", path).header("accept", accept).send().unwrap();
            assert_eq!(response.status(), 200, "{path} {accept}");
            response.bytes().unwrap()
        };
        let (text, arrow) = (ask(CSV), ask(ARROW));
        let batches: Vec<_> = StreamReader::try_new(&arrow[..], None).unwrap().map(Result::unwrap).collect();
        let rows: usize = batches.iter().map(RecordBatch::num_rows).sum();
        let mut reader = csv::Reader::from_reader(&text[..]);
        let records: Vec<_> = reader.records().map(Result::unwrap).collect();
        assert_eq!(rows, records.len(), "{path}");
        let npy = ask(NPY);
        assert_eq!(npyz::NpyFile::new(&npy[..]).unwrap().len(), rows as u64, "{path}");
        // Column by column, texts apart.
        let mut row = 0;
        for batch in batches {
            for (at, column) in batch.columns().iter().enumerate() {
                let Some(numbers) = column.as_primitive_opt::<Float64Type>() else { continue };
                for index in 0..batch.num_rows() {
                    let expected = records[row + index][at].parse().unwrap_or(f64::NAN);
                    let number = if numbers.is_null(index) { f64::NAN } else { numbers.value(index) };
                    assert_eq!(bits(&[number]), bits(&[expected]), "{path} {at} {}", row + index);
                }
            }
            row += batch.num_rows();
        }
    }
}
