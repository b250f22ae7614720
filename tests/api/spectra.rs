//! An array of wavelengths: one answer for each, in every resource and format that has them.

use crate::server::{Server, errors, problem};
use arrow_array::cast::AsArray as _;
use arrow_array::types::Float64Type;
use arrow_ipc::reader::StreamReader;
use serde_json::{Value, json};

const WAVELENGTHS: [f64; 3] = [0.65, 0.4, 1.5];

/// The answer at one wavelength, as it stands in a spectrum.
fn line(mut answer: Value, wavelength: f64) -> Value {
    let object = answer.as_object_mut().unwrap();
    object.remove("quantity");
    object.remove("unit");
    object.insert("wavelength_um".to_owned(), json!(wavelength));
    answer
}

fn at(body: &Value, wavelength: &Value) -> Value {
    let mut body = body.clone();
    body["illumination"]["wavelength_um"] = wavelength.clone();
    body
}

fn requests() -> Vec<Value> {
    let geometry = json!({"theta_i_deg": 30, "theta_r_deg": [0, 30, 89]});
    let surface = json!({"rms_height_um": 0.1, "correlation_length_um": 3, "medium": {"material": "Ag"}});
    vec![
        json!({"model": "beckmann_spizzichino", "surface": surface, "geometry": geometry}),
        json!({
            "model": "unified", "surface": surface, "geometry": geometry, "output": {"log10": true, "per_direction": true},
            "sensor": {"pixel_area_um2": 25, "distance_um": 5e5, "focal_length_um": 5e4, "aperture_um": 2.5e4}
        }),
        json!({
            "model": "torrance_sparrow", "geometry": geometry,
            "surface": {"facet_slope_deg": 10, "medium": {"n": 1.5}, "diffuse_albedo": 0.1}
        }),
    ]
}

#[test]
fn a_spectrum_is_the_answers_at_its_wavelengths() {
    let server = Server::start();
    for body in requests() {
        for path in ["/v1/radiance", "/v1/brdf", "/v1/image-irradiance"] {
            if path == "/v1/image-irradiance" && body.get("sensor").is_none() {
                continue;
            }
            let spectrum = server.answer(path, &at(&body, &json!(WAVELENGTHS)));
            let single = |wavelength: f64| server.answer(path, &at(&body, &json!(wavelength)));
            assert_eq!(spectrum["quantity"], single(0.4)["quantity"]);
            assert_eq!(spectrum["unit"], single(0.4)["unit"]);
            let lines = WAVELENGTHS.map(|wavelength| line(single(wavelength), wavelength));
            assert_eq!(spectrum["spectrum"], json!(lines), "{path} {body}");
        }
    }
}

#[test]
fn a_diagram_has_the_series_of_every_wavelength() {
    let server = Server::start();
    let link = "/v1/diagrams?model=beckmann_spizzichino&rms_height_um=0.1&correlation_length_um=3&material=Ag\
        &sweep=theta_r_deg&from_deg=-60&to_deg=60&step_deg=20&at_deg=10,40&wavelength_um=";
    let spectrum: Value = server.get(&format!("{link}0.65,0.4,1.5")).json().unwrap();
    let mut expected = Vec::new();
    for wavelength in WAVELENGTHS {
        let single: Value = server.get(&format!("{link}{wavelength}")).json().unwrap();
        assert_eq!(spectrum["axis"], single["axis"]);
        for series in single["series"].as_array().unwrap() {
            let mut series = series.clone();
            series["wavelength_um"] = json!(wavelength);
            series["medium"] = single["medium"].clone();
            expected.push(series);
        }
    }
    assert_eq!(spectrum["series"], json!(expected));
    let body = json!({
        "model": "beckmann_spizzichino", "illumination": {"wavelength_um": WAVELENGTHS},
        "surface": {"rms_height_um": 0.1, "correlation_length_um": 3, "medium": {"material": "Ag"}},
        "sweep": "theta_r_deg", "from_deg": -60, "to_deg": 60, "step_deg": 20, "at_deg": [10, 40]
    });
    assert_eq!(server.answer("/v1/diagrams", &body), spectrum);
}

#[test]
fn tables_begin_with_the_wavelength() {
    let server = Server::start();
    let rows = |body: &Value| {
        let request = server.request("POST", "/v1/radiance").header("content-type", "application/json");
        let text =
            request.header("accept", "text/csv").body(body.to_string()).send().unwrap().text().unwrap();
        text.lines().map(str::to_owned).collect::<Vec<_>>()
    };
    for body in requests() {
        let spectrum = rows(&at(&body, &json!(WAVELENGTHS)));
        let single = WAVELENGTHS.map(|wavelength| rows(&at(&body, &json!(wavelength))));
        assert_eq!(spectrum[0], format!("wavelength_um,{}", single[0][0]));
        let expected: Vec<String> = WAVELENGTHS
            .iter()
            .zip(&single)
            .flat_map(|(wavelength, rows)| rows[1..].iter().map(move |row| format!("{wavelength},{row}")))
            .collect();
        assert_eq!(spectrum[1..], expected);
    }
}

/// Name and cells of a column, None where null.
type NamedColumn = (String, Vec<Option<f64>>);

/// The columns of an Arrow stream, how many batches it has, and what it says of its series.
fn arrow(bytes: &[u8]) -> (Vec<NamedColumn>, usize, String) {
    let reader = StreamReader::try_new(bytes, None).unwrap();
    let schema = reader.schema();
    let mut columns: Vec<NamedColumn> =
        schema.fields().iter().map(|field| (field.name().clone(), Vec::new())).collect();
    let mut batches = 0;
    for batch in reader {
        batches += 1;
        for (column, (_, numbers)) in batch.unwrap().columns().iter().zip(&mut columns) {
            numbers.extend(column.as_primitive::<Float64Type>());
        }
    }
    (columns, batches, schema.metadata()["series"].clone())
}

#[test]
fn what_one_wavelength_omits_is_null_in_its_rows() {
    let server = Server::start();
    // Smooth for the last wavelengths, rough for the first.
    let wavelengths: Vec<f64> = (0..40).map(|index| 0.1 * 1.2f64.powi(index)).collect();
    let body = json!({
        "model": "beckmann_spizzichino",
        "surface": {"rms_height_um": 0.1, "correlation_length_um": 3, "medium": {"material": "Al"}},
        "sensor": {"footprint_um2": 1e6, "patch_half_x_um": 500, "patch_half_y_um": 500},
        "illumination": {"wavelength_um": wavelengths}, "accuracy": {"relative_tolerance": 1e-3},
        "geometry": {"theta_i_deg": [20, 30], "theta_r_deg": [20, 30]}
    });
    let request = server.request("POST", "/v1/radiance").header("content-type", "application/json");
    let request = request.header("accept", "application/vnd.apache.arrow.stream").body(body.to_string());
    let (columns, batches, notes) = arrow(&request.send().unwrap().bytes().unwrap());
    let column = |name: &str| &columns.iter().find(|(column, _)| column == name).unwrap().1;
    let lines = server.answer("/v1/radiance", &body);
    let lines = lines["spectrum"].as_array().unwrap();
    let notes: Value = serde_json::from_str(&notes).unwrap();
    assert!(batches < 10 && column("total").len() == 80, "{batches}");
    let mut omitted = [0; 2];
    for (index, line) in lines.iter().enumerate() {
        assert_eq!(notes[index]["medium"], line["medium"]);
        assert_eq!(notes[index]["wavelength_um"], line["wavelength_um"]);
        for row in 0..2 {
            let cell = |name: &str| json!(column(name)[2 * index + row]);
            assert_eq!(cell("wavelength_um"), line["wavelength_um"]);
            for (name, omitted) in ["specular_lobe", "specular_spike"].into_iter().zip(&mut omitted) {
                assert_eq!(cell(name), line[name].get(row).cloned().unwrap_or_default());
                *omitted += usize::from(line[name].is_null());
            }
            assert_eq!(cell("total"), line["total"][row]);
        }
    }
    assert!(omitted.iter().all(|&omitted| omitted > 0), "{omitted:?}");
}

#[test]
fn many_wavelengths_are_the_same_whether_made_at_once_or_streamed() {
    let server = Server::start();
    let wavelengths: Vec<f64> = (0..1000).map(|index| 0.3 + 0.001 * f64::from(index)).collect();
    let body = at(&requests()[0], &json!(wavelengths));
    let spectrum = server.answer("/v1/radiance", &body);
    let lines = spectrum["spectrum"].as_array().unwrap();
    assert_eq!(lines.len(), 1000);
    for index in [0, 1, 500, 999] {
        let single = server.answer("/v1/radiance", &at(&requests()[0], &json!(wavelengths[index])));
        assert_eq!(lines[index], line(single, wavelengths[index]));
    }
}

#[test]
fn what_is_wrong_with_wavelengths_is_said_one_by_one() {
    let server = Server::start();
    let body = &requests()[0];
    let refused = |path: &str, body: &Value| errors(&problem(server.post(path, body.to_string()), 422));
    let place = |index: usize| format!("/illumination/wavelength_um/{index}");
    let all = "/illumination/wavelength_um".to_owned();
    for (wavelengths, expected) in [
        (json!([]), vec![(all.clone(), "empty")]),
        (
            json!([0.5, 0, "x", 40]),
            vec![(place(1), "out_of_range"), (place(2), "wrong_type"), (place(3), "out_of_range")],
        ),
        (json!(vec![0.5; 1001]), vec![(all.clone(), "too_many")]),
        (json!({"from": 1}), vec![(all.clone(), "wrong_type")]),
    ] {
        let expected: Vec<_> =
            expected.into_iter().map(|(pointer, code)| (pointer, code.to_owned())).collect();
        assert_eq!(refused("/v1/radiance", &at(body, &wavelengths)), expected, "{wavelengths}");
    }
    let many = at(body, &json!(vec![40.0; 30]));
    assert_eq!(refused("/v1/radiance", &many).len(), 21);
    for path in ["/v1/plan", "/v1/tradeoff"] {
        assert_eq!(refused(path, &at(body, &json!([0.5, 0.6]))), [(all.clone(), "wrong_type".to_owned())]);
    }
    // 1000 wavelengths in 10001 directions are more rows than a table may have.
    let mut wide = at(body, &json!(vec![0.5; 1000]));
    wide["geometry"]["theta_r_deg"] = json!(vec![10; 10_001]);
    assert_eq!(refused("/v1/radiance", &wide), [("/geometry".to_owned(), "too_many".to_owned())]);
    let link = "/v1/diagrams?model=torrance_sparrow&facet_slope_deg=9&sweep=theta_r_deg&from_deg=0&to_deg=1";
    let list = |count: usize| vec!["0.5"; count].join(",");
    let many = server.get(&format!("{link}&at_deg={}&wavelength_um={}", list(50), list(201)));
    assert_eq!(errors(&problem(many, 422)), [("/at_deg".to_owned(), "too_many".to_owned())]);
    let limits: Value = server.get("/v1/limits").json().unwrap();
    let limit = limits["limits"].as_array().unwrap().iter().find(|limit| limit["name"] == "wavelengths");
    assert_eq!(limit.unwrap()["value"], 1000);
}
