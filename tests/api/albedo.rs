//! `/v1/albedo` from outside, the example of docs/energy.md, and that other resources warn of the same.

use crate::server::{Server, errors, problem};
use serde_json::{Value, json};

fn scene(theta_i: &Value) -> Value {
    json!({
        "model": "beckmann_spizzichino", "surface": {"rms_height_um": 0.1, "correlation_length_um": 5},
        "illumination": {"wavelength_um": 0.633}, "theta_i_deg": theta_i
    })
}

/// Facets with m = 0.3 that hide nothing of each other.
fn bright() -> Value {
    json!({
        "model": "torrance_sparrow",
        "surface": {"rms_height_um": 3, "correlation_length_um": 20, "shadowing": "none"}
    })
}

fn has(answer: &Value, code: &str) -> bool {
    answer["warnings"].as_array().unwrap().iter().any(|warning| warning["code"] == code)
}

fn numbers(answer: &Value, name: &str) -> Vec<f64> {
    let column = answer[name].as_array().unwrap_or_else(|| panic!("{name}: {answer}"));
    column.iter().map(|number| number.as_f64().unwrap_or(f64::INFINITY)).collect()
}

#[test]
fn shares_add_up_and_say_what_is_lost() {
    let server = Server::start();
    let answer = server.answer("/v1/albedo", &scene(&json!([0, 30, 60, 90])));
    let column = |name| numbers(&answer, name);
    let (total, lobe, spike) = (column("total"), column("specular_lobe"), column("specular_spike"));
    let (excess, fresnel) = (column("excess"), column("fresnel_reflectance"));
    let (bound, shares) = (column("relative_error_bound"), (column("spike_share"), column("lobe_share")));
    for i in 0..3 {
        assert!((total[i] - lobe[i] - spike[i]).abs() < 1e-15);
        assert!((excess[i] - total[i] + fresnel[i]).abs() < 1e-15 && fresnel[i] == 1.0);
        assert!((shares.0[i] + shares.1[i] - 1.0).abs() < 1e-15);
        // σ_h/T = 0.02: energy is kept to a thousandth.
        assert!(excess[i].abs() < 1e-3 && bound[i] <= 1e-6, "{answer}");
        let phase = 4.0 * std::f64::consts::PI * 0.1 / 0.633 * [0.0f64, 30.0, 60.0][i].to_radians().cos();
        assert!((spike[i] - (-phase * phase).exp()).abs() < 1e-14);
        assert!((column("total_integrated_scatter")[i] + (-phase * phase).exp_m1()).abs() < 1e-14);
    }
    // Nothing arrives of a source at the horizon, and without shadowing something is sent.
    assert_eq!((&answer["total"][3], &answer["specular_spike"][3]), (&Value::Null, &json!(1.0)));
    assert_eq!(answer["diagnostics"][0]["code"], "grazing_divergence");
    assert!(has(&answer, "energy_above_one"));
    // One number is one incidence, and a diffuse surface needs no integral.
    let lambertian = json!({"model": "lambertian", "surface": {"diffuse_albedo": 0.3}, "theta_i_deg": 20});
    let answer = server.answer("/v1/albedo", &lambertian);
    assert_eq!((&answer["total"], &answer["evaluations"]), (&json!([0.3]), &json!(0)));
    assert_eq!(answer.get("excess"), None);
}

#[test]
fn energy_above_one_is_told_wherever_it_is_asked_for() {
    let server = Server::start();
    let mut albedo = bright();
    albedo["theta_i_deg"] = json!([45, 85]);
    let answer = server.answer("/v1/albedo", &albedo);
    let value = numbers(&answer, "total")[1];
    assert!((value - 1.515).abs() < 5e-4 && has(&answer, "energy_above_one"), "{answer}");
    let mut radiance = bright();
    radiance["geometry"] = json!({"theta_i_deg": 85, "theta_r_deg": [0, 60, 85]});
    for path in ["/v1/radiance", "/v1/brdf", "/v1/plan"] {
        assert!(has(&server.answer(path, &radiance), "energy_above_one"), "{path}");
    }
    radiance["geometry"]["theta_i_deg"] = json!(45);
    assert!(!has(&server.answer("/v1/radiance", &radiance), "energy_above_one"));
    let mut diagram = bright();
    for (name, value) in [
        ("sweep", json!("theta_r_deg")),
        ("from_deg", json!(-80)),
        ("to_deg", json!(80)),
        ("points", json!(9)),
        ("at_deg", json!([85])),
    ] {
        diagram[name] = value;
    }
    let answer = server.answer("/v1/diagrams", &diagram);
    assert!(answer.to_string().contains("\"energy_above_one\""), "{answer}");
    // A surface that is not rough, whose lobe is as bright near grazing.
    let mut waves = scene(&json!(85));
    waves["surface"] = json!({"rms_height_um": 0.3165, "correlation_length_um": 0.9495});
    let value = numbers(&server.answer("/v1/albedo", &waves), "total")[0];
    assert!((value - 3.237).abs() < 5e-3, "{value}");
    waves.as_object_mut().unwrap().remove("theta_i_deg");
    waves["geometry"] = json!({"theta_i_deg": 85, "theta_r_deg": 80});
    assert!(has(&server.answer("/v1/radiance", &waves), "energy_above_one"));
}

#[test]
fn every_format_has_the_same_numbers() {
    let server = Server::start();
    let body = scene(&json!([0, 60])).to_string();
    let as_json = server.answer("/v1/albedo", &scene(&json!([0, 60])));
    let request = |accept: &str| {
        let request = server.request("POST", "/v1/albedo").header("accept", accept);
        request.header("content-type", "application/json").body(body.clone()).send().unwrap()
    };
    let text = request("text/csv").text().unwrap();
    let mut lines = text.lines();
    let head: Vec<_> = lines.next().unwrap().split(',').collect();
    for (row, line) in lines.enumerate() {
        for (name, cell) in head.iter().zip(line.split(',')) {
            assert_eq!(as_json[name][row].as_f64(), cell.parse().ok(), "{name} {row}");
        }
    }
    assert!(head.starts_with(&["theta_i_deg", "total", "specular_lobe", "specular_spike"]), "{head:?}");
    assert_eq!(request("application/x-npy").bytes().unwrap()[..6], b"\x93NUMPY"[..]);
    assert_eq!(request("application/vnd.apache.arrow.stream").status(), 200);
    assert_eq!(request("image/png").status(), 406);
}

#[test]
fn a_spectrum_has_the_albedos_of_its_wavelengths() {
    let server = Server::start();
    let mut body = scene(&json!([0, 70]));
    body["surface"]["medium"] = json!({"material": "Cu"});
    let at = |wavelengths: Value| {
        let mut body = body.clone();
        body["illumination"]["wavelength_um"] = wavelengths;
        body
    };
    let spectrum = server.answer("/v1/albedo", &at(json!([0.45, 0.65])));
    let mut rows = Vec::new();
    for (index, wavelength) in [0.45, 0.65].into_iter().enumerate() {
        let mut single = server.answer("/v1/albedo", &at(json!(wavelength)));
        rows.extend(numbers(&single, "total").into_iter().map(|total| (wavelength, total)));
        single.as_object_mut().unwrap().remove("quantity");
        single["wavelength_um"] = json!(wavelength);
        assert_eq!(spectrum["spectrum"][index], single);
    }
    assert!(rows[0].1 < rows[2].1, "copper is red: {rows:?}");
    let request = server.request("POST", "/v1/albedo").header("accept", "text/csv");
    let request = request.header("content-type", "application/json");
    let text = request.body(at(json!([0.45, 0.65])).to_string()).send().unwrap().text().unwrap();
    assert!(text.starts_with("wavelength_um,theta_i_deg,total,"), "{text}");
    let found: Vec<(f64, f64)> = text
        .lines()
        .skip(1)
        .map(|line| {
            let cells: Vec<f64> = line.split(',').map(|cell| cell.parse().unwrap()).collect();
            (cells[0], cells[2])
        })
        .collect();
    assert_eq!(found, rows);
    let few = Server::with(&["--incidence-limit", "3"]);
    let document = problem(few.post("/v1/albedo", at(json!([0.45, 0.65])).to_string()), 422);
    assert_eq!(errors(&document), [("/theta_i_deg".to_owned(), "too_many".to_owned())]);
}

#[test]
fn what_is_wrong_is_named_and_the_limit_holds() {
    let server = Server::with(&["--incidence-limit", "3"]);
    let refused = |body: &Value| errors(&problem(server.post("/v1/albedo", body.to_string()), 422));
    let pair = |pointer: &str, code: &str| (pointer.to_owned(), code.to_owned());
    assert_eq!(
        refused(&scene(&json!([0, 91, -1]))),
        [pair("/theta_i_deg/1", "out_of_range"), pair("/theta_i_deg/2", "out_of_range")]
    );
    assert_eq!(refused(&scene(&json!([]))), [pair("/theta_i_deg", "empty")]);
    assert_eq!(refused(&scene(&json!("steep"))), [pair("/theta_i_deg", "wrong_type")]);
    let document = problem(server.post("/v1/albedo", scene(&json!([0, 1, 2, 3])).to_string()), 422);
    assert_eq!(errors(&document), [pair("/theta_i_deg", "too_many")]);
    assert!(document.to_string().contains("at most 3"), "{document}");
    // No sensor, but what the components need.
    let mut bare = scene(&json!(0));
    bare["surface"] = json!({"rms_height_um": 0.1});
    bare["geometry"] = json!({});
    assert_eq!(
        refused(&bare),
        [pair("/geometry", "unknown_field"), pair("/surface/correlation_length_um", "required")]
    );
    bare.as_object_mut().unwrap().remove("geometry");
    bare["components"] = json!(["specular_spike"]);
    let answer = server.answer("/v1/albedo", &bare);
    assert_eq!((answer.get("specular_lobe"), answer.get("excess")), (None, None));
}

#[test]
fn much_work_ends_at_the_limit_of_processor_time() {
    let server = Server::with(&["--cpu-limit-seconds", "0.02"]);
    let mut body = scene(&json!((0..1000).map(|i| 0.09 * f64::from(i)).collect::<Vec<_>>()));
    body["accuracy"] = json!({"relative_tolerance": 1e-10});
    let document = problem(server.post("/v1/albedo", body.to_string()), 422);
    assert!(document["type"].as_str().unwrap().ends_with("cpu-time-exceeded"), "{document}");
    assert!(document["detail"].as_str().unwrap().contains("0.02 s"), "{document}");
}

#[test]
fn the_page_shows_a_request_that_is_answered() {
    let page = include_str!("../../docs/energy.md");
    let body = page.split("-d '").nth(1).and_then(|rest| rest.split('\'').next()).expect("a body");
    let answer = Server::start().answer("/v1/albedo", &serde_json::from_str(body).expect("JSON"));
    assert_eq!(answer["total"].as_array().unwrap().len(), 4);
    for line in page.lines().filter(|line| line.starts_with("| `")) {
        for name in line.split('|').nth(1).unwrap().split('`').skip(1).step_by(2) {
            // The diffuse lobe is no part of this model.
            assert!(answer.get(name).is_some() || name == "diffuse_lobe", "{name}: {answer}");
        }
    }
}
