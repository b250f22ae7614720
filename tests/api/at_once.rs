//! What cannot be read hides nothing that is wrong elsewhere, and makes nothing wrong that is right.

use crate::server::{Server, errors, problem, scene};
use serde_json::{Value, json};

type Expected = Vec<(&'static str, &'static str)>;

fn check(document: &Value, expected: &Expected, request: &dyn std::fmt::Display) {
    let expected: Vec<_> = expected.iter().map(|(p, c)| ((*p).to_owned(), (*c).to_owned())).collect();
    assert_eq!(errors(document), expected, "{request}");
}

/// The detail of the error at a pointer.
fn detail<'a>(document: &'a Value, pointer: &str) -> &'a str {
    let errors = document["errors"].as_array().unwrap();
    errors.iter().find(|error| error["pointer"] == pointer).unwrap()["detail"].as_str().unwrap()
}

fn with(field: &str, value: Value) -> Value {
    let mut body = scene();
    body[field] = value;
    body
}

#[test]
fn a_part_that_is_wrong_hides_no_other() {
    let server = Server::start();
    let faults: Vec<(Value, Expected)> = vec![
        (
            with("components", json!(["foo", "specular_spike"])),
            vec![("/components/0", "unknown_value"), ("/sensor", "required")],
        ),
        (
            with("components", json!(["foo", "specular_lobe", "specular_lobe", "diffuse_lobe"])),
            vec![
                ("/components/0", "unknown_value"),
                ("/components/2", "duplicate"),
                ("/components/3", "inconsistent"),
            ],
        ),
        (
            {
                let mut body = with("components", json!(["specular_spike"]));
                body["surface"]["medium"] = json!(5);
                body
            },
            vec![("/sensor", "required"), ("/surface/medium", "wrong_type")],
        ),
        (
            {
                let mut body = with("components", json!(["specular_lobe", "specular_lobe"]));
                body["model"] = json!("phong");
                body
            },
            vec![("/components/1", "duplicate"), ("/model", "unknown_value")],
        ),
        (
            with("surface", json!(5)),
            // Nothing is said of fields that nobody could read.
            vec![("/surface", "wrong_type")],
        ),
        (
            with("geometry", json!({"theta_r_deg": [1, 2], "phi_r_deg": [1, 2, 3]})),
            vec![("/geometry/phi_r_deg", "unequal_lengths"), ("/geometry/theta_i_deg", "required")],
        ),
        (
            with("geometry", json!({"theta_i_deg": [1, 99, "x"], "theta_r_deg": [1, 2], "phi_r_deg": true})),
            vec![
                ("/geometry/phi_r_deg", "wrong_type"),
                ("/geometry/theta_i_deg/1", "out_of_range"),
                ("/geometry/theta_i_deg/2", "wrong_type"),
                ("/geometry/theta_r_deg", "unequal_lengths"),
            ],
        ),
        (
            {
                let mut body = scene();
                body["surface"]["medium"] = json!({"material": "unobtainium", "n": -1});
                body
            },
            vec![
                ("/surface/medium/material", "unknown_value"),
                ("/surface/medium/n", "inconsistent"),
                ("/surface/medium/n", "out_of_range"),
            ],
        ),
    ];
    for (body, expected) in &faults {
        check(&problem(server.post("/v1/radiance", body.to_string()), 422), expected, body);
    }
}

#[test]
fn a_part_that_is_wrong_hides_no_other_of_an_image() {
    let server = Server::start();
    let images: Vec<(Value, Expected)> = vec![
        (
            json!({"model": "zz", "foo": 1}),
            vec![("/foo", "unknown_field"), ("/geometry", "required"), ("/model", "unknown_value")],
        ),
        (
            json!({"C_dl": 1, "foo": 1, "geometry": {"theta_i_deg": 100, "theta_r_deg": 1}}),
            vec![
                ("/foo", "unknown_field"),
                ("/geometry/theta_i_deg", "out_of_range"),
                ("/model", "required"),
            ],
        ),
        (
            with("components", json!(["specular_spike"])),
            // Once, though two rules ask for it.
            vec![("/sensor", "required")],
        ),
        (
            with("sensor", json!({"footprint_um2": 1, "patch_half_x_um": 1, "patch_half_y_um": -1})),
            vec![("/sensor", "inconsistent"), ("/sensor/patch_half_y_um", "out_of_range")],
        ),
        (
            json!({"model": "fixed_source", "C_dl": 1, "C_sl": -1, "C_ss": 1, "facet_slope_deg": 1,
                "spike": {"shape": "sinc2", "width_deg": -1, "patch_half_x_um": "x"},
                "geometry": {"theta_i_deg": [1], "theta_r_deg": [1, 2]}}),
            vec![
                ("/C_sl", "out_of_range"),
                ("/geometry/theta_r_deg", "unequal_lengths"),
                ("/spike/patch_half_x_um", "wrong_type"),
                ("/spike/patch_half_y_um", "required"),
                ("/spike/wavelength_um", "required"),
                ("/spike/width_deg", "inconsistent"),
                ("/spike/width_deg", "out_of_range"),
            ],
        ),
    ];
    for (body, expected) in &images {
        check(&problem(server.post("/v1/image-irradiance", body.to_string()), 422), expected, body);
    }
}

#[test]
fn nothing_follows_from_a_value_that_was_refused() {
    let server = Server::start();
    let mix = json!({"wavelength_um": 0.5, "polarization": {"parallel": 2, "perpendicular": 0.5}});
    let body = with("illumination", mix);
    let expected = vec![("/illumination/polarization/parallel", "out_of_range")];
    check(&problem(server.post("/v1/radiance", body.to_string()), 422), &expected, &body);
    let sweep = "/v1/diagrams?model=lambertian&sweep=theta_r_deg&at_deg=10";
    for (rest, expected) in [
        ("&from_deg=0&to_deg=90&step_deg=0", vec![("/step_deg", "out_of_range")]),
        ("&from_deg=0&to_deg=91", vec![("/to_deg", "out_of_range")]),
        ("&from_deg=50&to_deg=-91&step_deg=1e-6", vec![("/to_deg", "out_of_range")]),
        ("&from_deg=0&to_deg=90&points=0", vec![("/points", "out_of_range")]),
    ] {
        let link = format!("{sweep}{rest}");
        check(&problem(server.get(&link), 422), &expected, &link);
    }
}

#[test]
fn alternatives_exclude_each_other_by_name() {
    let server = Server::start();
    let sweep = "/v1/diagrams?model=lambertian&sweep=theta_r_deg&at_deg=10&from_deg=0&to_deg=90";
    for (rest, pointer, by) in [
        ("&medium=perfect_conductor&n=1.5", "/n", "medium"),
        ("&polarization=parallel&perpendicular=1", "/perpendicular", "polarization"),
        ("&footprint_um2=1&distance_um=1", "/distance_um", "footprint_um2"),
    ] {
        let link = format!("{sweep}{rest}");
        let document = problem(server.get(&link), 422);
        check(&document, &vec![(pointer, "inconsistent")], &link);
        let detail = detail(&document, pointer);
        assert!(detail.contains("excluded by") && detail.contains(by), "{detail}");
    }
    let body = with("sensor", json!({"footprint_um2": 1, "distance_um": -1}));
    let document = problem(server.post("/v1/radiance", body.to_string()), 422);
    let expected = vec![("/sensor/distance_um", "inconsistent"), ("/sensor/distance_um", "out_of_range")];
    check(&document, &expected, &body);
    let body = with("sensor", json!({}));
    let document = problem(server.post("/v1/radiance", body.to_string()), 422);
    check(&document, &vec![("/sensor", "required")], &body);
    let detail = detail(&document, "/sensor");
    assert!(detail.contains("footprint_um2") && detail.contains("camera"), "{detail}");
}

#[test]
fn pointers_are_whole_and_name_what_a_client_can_change() {
    let server = Server::start();
    let long = "x".repeat(60);
    for (name, pointer) in
        [(long.as_str(), format!("/{long}")), ("b\nc", "/b\nc".into()), ("a/~", "/a~1~0".into())]
    {
        let body = with(name, json!(1));
        let document = problem(server.post("/v1/radiance", body.to_string()), 422);
        assert_eq!(errors(&document), [(pointer, "unknown_field".to_owned())]);
        assert!(document["detail"].as_str().unwrap().chars().count() < 300, "{document}");
    }
    let link = "/v1/diagrams?model=beckmann_spizzichino&rms_height_um=1&correlation_length_um=4&wavelength_um=0.5\
        &sweep=theta_r_deg&at_deg=10&from_deg=0&to_deg=90&components=specular_spike";
    let document = problem(server.get(link), 422);
    check(&document, &vec![("/footprint_um2", "required")], &link);
}

#[test]
fn messages_say_what_is_meant() {
    let server = Server::start();
    let body =
        json!({"model": "torrance_sparrow", "surface": {}, "geometry": {"theta_i_deg": 1, "theta_r_deg": 1}});
    let document = problem(server.post("/v1/radiance", body.to_string()), 422);
    assert_eq!(
        detail(&document, "/surface/rms_height_um"),
        "required: the facet slope by (79) needs it, unless facet_slope_deg is given"
    );
    let document = problem(server.post("/v1/image-irradiance", r#"{"model": 5}"#), 422);
    assert!(detail(&document, "/model").contains("fixed_source, fixed_view, beckmann_spizzichino"));
    let link = "/v1/diagrams?model=lambertian&sweep=theta_r_deg&at_deg=10&from_deg=0&to_deg=90&medium=Al";
    let document = problem(server.get(link), 422);
    assert!(!detail(&document, "/medium").contains("object"), "{document}");
}

#[test]
fn broken_json_after_a_number_beyond_f64_has_its_place_in_the_text_as_sent() {
    let server = Server::start();
    let document = problem(server.post("/v1/radiance", r#"{"a": 1e400, "b": }"#), 400);
    let same_length = problem(server.post("/v1/radiance", r#"{"a": 1e200, "b": }"#), 400);
    assert_eq!(document["detail"], same_length["detail"]);
}
