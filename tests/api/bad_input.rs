//! Everything that is wrong with a request, all at once, each with a pointer.

use crate::server::{Server, errors, problem, scene};
use serde_json::{Value, json};

/// The scene with changes: each a JSON Pointer's place and a value.
fn with(changes: &[(&str, Value)]) -> Value {
    let mut body = scene();
    for (pointer, value) in changes {
        let (parent, name) = pointer.rsplit_once('/').unwrap();
        body.pointer_mut(parent).unwrap()[name] = value.clone();
    }
    body
}

/// Changes to the scene, and what each of them is refused with.
type Fault = (Vec<(&'static str, Value)>, Vec<(&'static str, &'static str)>);

fn refused(server: &Server, (changes, expected): &Fault) {
    let body = with(changes).to_string();
    let expected: Vec<_> = expected.iter().map(|(p, c)| ((*p).to_owned(), (*c).to_owned())).collect();
    for path in ["/v1/radiance", "/v1/brdf"] {
        assert_eq!(errors(&problem(server.post(path, body.clone()), 422)), expected, "{changes:?}");
    }
}

#[test]
fn a_number_or_direction_that_is_wrong_has_its_pointer_and_its_code() {
    let server = Server::start();
    let many = |count: usize| json!(vec![1.0; count]);
    let faults: Vec<Fault> = vec![
        (vec![("/surface/rms_height_um", json!(0))], vec![("/surface/rms_height_um", "out_of_range")]),
        (vec![("/surface/rms_height_um", json!(-1))], vec![("/surface/rms_height_um", "out_of_range")]),
        (vec![("/surface/rms_height_um", json!(1e-300))], vec![("/surface/rms_height_um", "out_of_range")]),
        (vec![("/surface/rms_height_um", json!("NaN"))], vec![("/surface/rms_height_um", "out_of_range")]),
        (
            vec![("/surface/rms_height_um", json!("Infinity"))],
            vec![("/surface/rms_height_um", "out_of_range")],
        ),
        (vec![("/surface/rms_height_um", json!("1e400"))], vec![("/surface/rms_height_um", "out_of_range")]),
        (vec![("/surface/rms_height_um", json!("0.2"))], vec![("/surface/rms_height_um", "wrong_type")]),
        (vec![("/surface/rms_height_um", json!(null))], vec![("/surface/rms_height_um", "required")]),
        (vec![("/surface/rms_height_um", json!([1]))], vec![("/surface/rms_height_um", "wrong_type")]),
        (
            vec![("/geometry/theta_i_deg", json!(90.00000000000001))],
            vec![("/geometry/theta_i_deg", "out_of_range")],
        ),
        (vec![("/geometry/theta_i_deg", json!(-1))], vec![("/geometry/theta_i_deg", "out_of_range")]),
        (vec![("/geometry/phi_r_deg", json!(361))], vec![("/geometry/phi_r_deg", "out_of_range")]),
        (
            vec![("/geometry/theta_r_deg", json!([0, "x", 91, null]))],
            vec![
                ("/geometry/theta_r_deg/1", "wrong_type"),
                ("/geometry/theta_r_deg/2", "out_of_range"),
                ("/geometry/theta_r_deg/3", "wrong_type"),
            ],
        ),
        (
            vec![("/geometry/theta_i_deg", json!([1, 2, 3])), ("/geometry/phi_r_deg", json!([1, 2]))],
            vec![("/geometry/phi_r_deg", "unequal_lengths"), ("/geometry/theta_r_deg", "unequal_lengths")],
        ),
        (vec![("/geometry/theta_r_deg", json!([]))], vec![("/geometry/theta_r_deg", "empty")]),
        (vec![("/geometry/theta_r_deg", many(1_000_001))], vec![("/geometry/theta_r_deg", "too_many")]),
        (vec![("/geometry/theta_r_deg", json!({}))], vec![("/geometry/theta_r_deg", "wrong_type")]),
        (vec![("/geometry/theta", json!(1))], vec![("/geometry/theta", "unknown_field")]),
        (vec![("/geometry", json!(7))], vec![("/geometry", "wrong_type")]),
        (
            vec![("/geometry", json!({}))],
            vec![("/geometry/theta_i_deg", "required"), ("/geometry/theta_r_deg", "required")],
        ),
    ];
    for fault in &faults {
        refused(&server, fault);
    }
}

#[test]
fn a_choice_that_is_wrong_has_its_pointer_and_its_code() {
    let server = Server::start();
    let faults: Vec<Fault> = vec![
        (vec![("/model", json!("phong"))], vec![("/model", "unknown_value")]),
        (vec![("/model", json!(3))], vec![("/model", "wrong_type")]),
        (vec![("/components", json!(["specular_lob"]))], vec![("/components/0", "unknown_value")]),
        (vec![("/components", json!(["diffuse_lobe"]))], vec![("/components/0", "inconsistent")]),
        (
            vec![("/components", json!(["specular_lobe", "specular_lobe"]))],
            vec![("/components/1", "duplicate")],
        ),
        (vec![("/components", json!([]))], vec![("/components", "empty")]),
        (vec![("/components", json!("all"))], vec![("/components", "wrong_type")]),
        (vec![("/components", json!(["specular_spike"]))], vec![("/sensor", "required")]),
        (
            vec![("/sensor", json!({"footprint_um2": 1, "patch_half_x_um": -1}))],
            vec![("/sensor/patch_half_x_um", "out_of_range"), ("/sensor/patch_half_y_um", "required")],
        ),
        (
            vec![(
                "/sensor",
                json!({"pixel_area_um2": 1, "distance_um": 1, "focal_length_um": 1, "aperture_um": 1, "off_axis_deg": 90}),
            )],
            vec![("/sensor/off_axis_deg", "out_of_range")],
        ),
        (
            vec![(
                "/sensor",
                json!({"footprint_um2": 1, "patch_half_x_um": 1, "patch_half_y_um": 1, "aperture_um": 1}),
            )],
            vec![("/sensor/aperture_um", "inconsistent")],
        ),
        (
            vec![("/illumination/polarization", json!({"parallel": 0.7, "perpendicular": 0.7}))],
            vec![("/illumination/polarization", "inconsistent")],
        ),
        (
            vec![("/illumination/polarization", json!("circular"))],
            vec![("/illumination/polarization", "unknown_value")],
        ),
        (
            vec![("/illumination/wavelength_um", json!(null))],
            vec![("/illumination/wavelength_um", "required")],
        ),
        (vec![("/surface/medium", json!("Al"))], vec![("/surface/medium", "unknown_value")]),
        (
            vec![("/surface/medium", json!({"material": "Alu"}))],
            vec![("/surface/medium/material", "unknown_value")],
        ),
        (
            vec![("/surface/medium", json!({"n": 0, "k": -1}))],
            vec![("/surface/medium/k", "out_of_range"), ("/surface/medium/n", "out_of_range")],
        ),
        (vec![("/surface/shadowing", json!("Smith"))], vec![("/surface/shadowing", "unknown_value")]),
        (vec![("/surface/shadowing", json!(true))], vec![("/surface/shadowing", "wrong_type")]),
        (
            vec![("/accuracy", json!({"method": "exact", "relative_tolerance": 1}))],
            vec![("/accuracy/method", "unknown_value"), ("/accuracy/relative_tolerance", "out_of_range")],
        ),
        (vec![("/output", json!({"log10": 1}))], vec![("/output/log10", "wrong_type")]),
        (vec![("/a~b", json!(1))], vec![("/a~0b", "unknown_field")]),
    ];
    for fault in &faults {
        refused(&server, fault);
    }
}

#[test]
fn all_faults_come_at_once() {
    let body = json!({
        "model": "beckmann_spizzichino",
        "surface": {"rms_height_um": -1, "colour": "red"},
        "illumination": {"irradiance": "bright"},
        "geometry": {"theta_i_deg": [1, 2], "theta_r_deg": [1, 95, 3]},
        "components": ["specular_spike"],
        "extra": null
    });
    let document = problem(Server::start().post("/v1/radiance", body.to_string()), 422);
    let expected = [
        ("/extra", "unknown_field"),
        ("/geometry/theta_r_deg", "unequal_lengths"),
        ("/geometry/theta_r_deg/1", "out_of_range"),
        ("/illumination/irradiance", "wrong_type"),
        ("/illumination/wavelength_um", "required"),
        ("/sensor", "required"),
        ("/surface/colour", "unknown_field"),
        ("/surface/rms_height_um", "out_of_range"),
    ];
    assert_eq!(errors(&document), expected.map(|(pointer, code)| (pointer.to_owned(), code.to_owned())));
}

#[test]
fn messages_name_the_range_and_the_names_that_are_accepted() {
    let server = Server::start();
    let detail = |changes: &[(&str, Value)]| {
        let document = problem(server.post("/v1/radiance", with(changes).to_string()), 422);
        document["errors"][0]["detail"].as_str().unwrap().to_owned()
    };
    assert!(detail(&[("/surface/rms_height_um", json!(0))]).contains("from 1e-60 to 1e60 micrometres"));
    assert!(detail(&[("/geometry/theta_i_deg", json!(91))]).contains("from 0 to 90 degrees"));
    assert!(detail(&[("/model", json!("phong"))]).contains("torrance_sparrow"));
    assert!(detail(&[("/geometry/theta", json!(1))]).contains("theta_i_deg, theta_r_deg, phi_r_deg"));
    assert!(detail(&[("/geometry/theta_r_deg", json!([]))]).contains("1000000"));
}

#[test]
fn long_lists_of_faults_are_cut_and_counted() {
    let server = Server::start();
    let body = with(&[("/geometry/theta_r_deg", json!(vec![100; 50_000]))]);
    let document = problem(server.post("/v1/radiance", body.to_string()), 422);
    let listed = errors(&document);
    assert_eq!(listed.len(), 21);
    assert_eq!(listed[0], ("/geometry/theta_r_deg".to_owned(), "more".to_owned()));
    let more = document["errors"].as_array().unwrap().iter().find(|error| error["code"] == "more").unwrap();
    assert!(more["detail"].as_str().unwrap().contains("49980"), "{more}");
    let mut body = scene();
    for index in 0..3000 {
        body[format!("f{index}")] = json!(0);
    }
    let document = problem(server.post("/v1/radiance", body.to_string()), 422);
    assert_eq!(errors(&document).len(), 201);
}

#[test]
fn broken_json_says_where() {
    let server = Server::start();
    for (body, expected) in [
        ("", "empty"),
        ("{\n  \"model\": \"lambertian\",\n  \"surface\" {}\n}", "line 3 column 13"),
        ("{\"model\": NaN}", "JSON has no NaN"),
        ("{\"model\": -Infinity}", "JSON has no NaN"),
        ("{\"model\": \"x\"} trailing", "line 1 column 16"),
        ("{\"model\": \"\u{1}\"}", "line 1"),
        ("{'model': 1}", "line 1 column 2"),
        ("{\"a\": 01}", "line 1"),
        ("\u{feff}{}", "line 1 column 1"),
    ] {
        let document = problem(server.post("/v1/radiance", body), 400);
        assert!(document["detail"].as_str().unwrap().contains(expected), "{body}: {document}");
    }
    problem(server.post("/v1/radiance", &b"{\"model\": \"\xff\xfe\"}"[..]), 400);
    for deep in [
        "[".repeat(10_000),
        "{\"a\":".repeat(10_000),
        format!("{}{}", "[".repeat(50_000), "]".repeat(50_000)),
    ] {
        problem(server.post("/v1/radiance", deep), 400);
    }
}

#[test]
fn numbers_beyond_f64_are_faults_of_their_fields() {
    let server = Server::start();
    let body = scene()
        .to_string()
        .replace("0.55", "1e400")
        .replace("0.2", "-1e999")
        .replace("[0,30]", "[0,1e309,2e308]");
    let expected = [
        ("/geometry/theta_r_deg/1", "out_of_range"),
        ("/geometry/theta_r_deg/2", "out_of_range"),
        ("/illumination/wavelength_um", "out_of_range"),
        ("/surface/rms_height_um", "out_of_range"),
    ];
    let document = problem(server.post("/v1/radiance", body), 422);
    assert_eq!(errors(&document), expected.map(|(pointer, code)| (pointer.to_owned(), code.to_owned())));
}

#[test]
fn a_name_given_twice_is_a_fault() {
    let body = scene().to_string().replacen("\"model\"", "\"model\":\"lambertian\",\"model\"", 1);
    let document = problem(Server::start().post("/v1/radiance", body), 422);
    assert_eq!(errors(&document), [("/model".to_owned(), "duplicate".to_owned())]);
}

#[test]
fn json_that_is_no_scene_is_refused() {
    let server = Server::start();
    for body in ["null", "[]", "3", "\"scene\"", "true", "[[[[]]]]"] {
        let document = problem(server.post("/v1/radiance", body), 422);
        assert_eq!(errors(&document), [(String::new(), "wrong_type".to_owned())], "{body}");
    }
    let many = format!("[{}]", vec!["{}"; 100_000].join(","));
    let document = problem(server.post("/v1/radiance", many), 422);
    assert_eq!(errors(&document), [(String::new(), "too_many".to_owned())]);
}

#[test]
fn queries_are_checked_as_bodies_are() {
    let server = Server::start();
    for (link, expected) in [
        ("/v1/roughness", vec![("", "required")]),
        ("/v1/roughness?facet_slope_deg=63.7", vec![("/facet_slope_deg", "out_of_range")]),
        (
            "/v1/roughness?facet_slope_deg=nan&beckmann_alpha=x",
            vec![
                ("/beckmann_alpha", "inconsistent"),
                ("/beckmann_alpha", "wrong_type"),
                ("/facet_slope_deg", "inconsistent"),
                ("/facet_slope_deg", "out_of_range"),
            ],
        ),
        (
            "/v1/roughness?facet_slope_deg=1&beckmann_alpha=1",
            vec![("/beckmann_alpha", "inconsistent"), ("/facet_slope_deg", "inconsistent")],
        ),
        ("/v1/roughness?rms_height_um=1", vec![("/correlation_length_um", "required")]),
        (
            "/v1/roughness?correlation_length_um=1&x=1&y=2",
            vec![("/rms_height_um", "required"), ("/x", "unknown_field"), ("/y", "unknown_field")],
        ),
        ("/v1/roughness?facet_slope_deg=1&facet_slope_deg=2", vec![("/facet_slope_deg", "duplicate")]),
        ("/v1/roughness?facet_slope_deg=", vec![("/facet_slope_deg", "wrong_type")]),
        ("/v1/figures?all", vec![("/all", "unknown_field")]),
        ("/v1/figures/11a?log10=yes", vec![("/log10", "wrong_type")]),
        (
            "/v1/diagrams?model=lambertian&sweep=theta_r_deg&from_deg=10&to_deg=0&at_deg=10,95,x&phi_r_deg=400",
            vec![
                ("/at_deg/1", "out_of_range"),
                ("/at_deg/2", "wrong_type"),
                ("/phi_r_deg", "out_of_range"),
                ("/to_deg", "inconsistent"),
            ],
        ),
        (
            "/v1/diagrams?model=lambertian&sweep=theta_r_deg&from_deg=0&to_deg=10&at_deg=-10&step_deg=1&points=4",
            vec![("/at_deg/0", "out_of_range"), ("/points", "inconsistent")],
        ),
        (
            "/v1/diagrams?model=lambertian&sweep=theta_r_deg&from_deg=0&to_deg=10&at_deg=-10",
            vec![("/at_deg/0", "out_of_range")],
        ),
        (
            "/v1/diagrams?model=beckmann_spizzichino&sweep=theta_r_deg&from_deg=0&to_deg=10&at_deg=10",
            vec![
                ("/correlation_length_um", "required"),
                ("/rms_height_um", "required"),
                ("/wavelength_um", "required"),
            ],
        ),
        (
            "/v1/diagrams?model=lambertian&sweep=theta_r_deg&from_deg=0&to_deg=90&step_deg=1e-6&at_deg=1&parallel=0.4&perpendicular=0.4",
            vec![("/parallel", "inconsistent"), ("/step_deg", "too_many")],
        ),
    ] {
        let document = problem(server.get(link), 422);
        let expected: Vec<_> = expected.iter().map(|(p, c)| ((*p).to_owned(), (*c).to_owned())).collect();
        assert_eq!(errors(&document), expected, "{link}");
    }
    let long = format!("/v1/roughness?{}", "a&".repeat(3000));
    for link in ["/v1/roughness?a=%zz", "/v1/roughness?%ff=1", &long] {
        problem(server.get(link), 400);
    }
}

#[test]
fn linear_models_ask_for_their_own_strengths() {
    let server = Server::start();
    let geometry = json!({"theta_i_deg": 1, "theta_r_deg": 1});
    for (body, expected) in [
        (
            json!({"model": "fixed_source", "K_dl": 1, "facet_slope_deg": 1, "spike": "delta", "geometry": geometry}),
            vec![
                ("/C_dl", "required"),
                ("/C_sl", "required"),
                ("/C_ss", "required"),
                ("/K_dl", "unknown_field"),
            ],
        ),
        (
            json!({"model": "fixed_view", "K_dl": 1, "K_sl": -1, "K_ss": 0, "facet_slope_deg": 1,
                "spike": {"shape": "gaussian"}, "geometry": geometry}),
            vec![
                ("/K_sl", "out_of_range"),
                ("/spike/patch_half_x_um", "required"),
                ("/spike/wavelength_um", "required"),
            ],
        ),
        (
            json!({"model": "fixed_view", "K_dl": 1, "K_sl": 1, "K_ss": 0, "facet_slope_deg": 1,
                "spike": {"shape": "delta", "width_deg": 1}, "geometry": geometry}),
            vec![("/spike/width_deg", "inconsistent")],
        ),
        (
            json!({"model": "lambertian", "surface": {}, "illumination": {}, "geometry": geometry}),
            vec![("/sensor", "required")],
        ),
        (json!({"model": "phong"}), vec![("/geometry", "required"), ("/model", "unknown_value")]),
    ] {
        let document = problem(server.post("/v1/image-irradiance", body.to_string()), 422);
        let expected: Vec<_> = expected.iter().map(|(p, c)| ((*p).to_owned(), (*c).to_owned())).collect();
        assert_eq!(errors(&document), expected, "{body}");
    }
}
