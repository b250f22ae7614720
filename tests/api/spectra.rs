//! An array of wavelengths: one answer for each, in every resource and format that has them.

use crate::server::{Server, errors, problem};
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
    assert_eq!(refused("/v1/radiance", &wide), [(all, "too_many".to_owned())]);
    let limits: Value = server.get("/v1/limits").json().unwrap();
    let limit = limits["limits"].as_array().unwrap().iter().find(|limit| limit["name"] == "wavelengths");
    assert_eq!(limit.unwrap()["value"], 1000);
}
