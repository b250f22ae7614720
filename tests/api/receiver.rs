//! Receivers of finite size, as requests ask for them.

use crate::server::{Server, problem};
use serde_json::{Value, json};
use std::f64::consts::PI;

fn scene() -> Value {
    json!({
        "model": "unified",
        "surface": {"rms_height_um": 0.05, "correlation_length_um": 2, "diffuse_albedo": 0.1},
        "illumination": {"wavelength_um": 0.633},
        "sensor": {"receiver_half_angle_deg": 1},
        "geometry": {"theta_i_deg": 30, "theta_r_deg": [28.5, 29.5, 30, 31, 31.5]}
    })
}

#[test]
fn a_cone_reads_a_spike_without_knowing_the_patch() {
    let server = Server::start();
    let answer = server.answer("/v1/brdf", &scene());
    assert_eq!(answer["methods"], json!({"cone_quadrature": 5}));
    assert_eq!(answer["omitted"], json!([]));
    let spike: Vec<f64> =
        answer["specular_spike"].as_array().unwrap().iter().map(|value| value.as_f64().unwrap()).collect();
    assert!(spike[0] == 0.0 && spike[4] == 0.0 && spike[1] > 0.0, "{spike:?}");
    // e^{−g} over the projected solid angle; g = (4π σ_h cos θ/λ)².
    let g = (4.0 * PI * 0.05 * 30f64.to_radians().cos() / 0.633).powi(2);
    let over = PI * 1f64.to_radians().sin().powi(2) * 30f64.to_radians().cos();
    assert!((spike[2] * over / (-g).exp() - 1.0).abs() < 1e-13, "{spike:?}");
    // The rim, exactly 1° off, belongs to the cone.
    assert!(spike[3] > 0.0);
    let diffuse = answer["diffuse_lobe"][0].as_f64().unwrap();
    assert!((diffuse * PI / 0.1 - 1.0).abs() < 1e-14);
    for bound in answer["relative_error_bound"].as_array().unwrap() {
        assert!(bound.as_f64().unwrap() <= 1e-9, "{answer}");
    }
}

#[test]
fn no_angle_is_a_point() {
    let server = Server::start();
    let mut with = scene();
    with["sensor"] = json!({"footprint_um2": 400, "patch_half_x_um": 10, "patch_half_y_um": 10});
    let without = server.answer("/v1/radiance", &with);
    with["sensor"]["receiver_half_angle_deg"] = json!(0);
    assert_eq!(server.answer("/v1/radiance", &with), without);
    // A point alone says nothing of the patch, and there is no spike.
    with["sensor"] = json!({"receiver_half_angle_deg": 0});
    assert_eq!(server.answer("/v1/radiance", &with)["omitted"][0]["component"], "specular_spike");
}

#[test]
fn links_tables_cameras_and_plans_take_it_too() {
    let server = Server::start();
    let link = "/v1/diagrams?model=torrance_sparrow&facet_slope_deg=5&sweep=theta_r_deg&from_deg=0&to_deg=60&step_deg=20&at_deg=30&receiver_half_angle_deg=2";
    let diagram: Value = server.get(link).json().unwrap();
    let mut body = json!({
        "model": "torrance_sparrow", "surface": {"facet_slope_deg": 5}, "sensor": {"receiver_half_angle_deg": 2},
        "geometry": {"theta_i_deg": 30, "theta_r_deg": [0, 20, 40, 60]}
    });
    let radiance = server.answer("/v1/radiance", &body);
    assert_eq!(diagram["series"][0]["total"], radiance["total"]);
    let plan = server.answer("/v1/plan", &body);
    assert_eq!(plan["methods"], json!({"cone_quadrature": 4}));
    body["sensor"] = json!({
        "pixel_area_um2": 25, "distance_um": 500000, "focal_length_um": 50000, "aperture_um": 25000,
        "receiver_half_angle_deg": 2
    });
    let image = server.answer("/v1/image-irradiance", &body);
    let factor =
        |index: usize| image["total"][index].as_f64().unwrap() / radiance["total"][index].as_f64().unwrap();
    assert!((factor(3) / factor(0) - 1.0).abs() < 4e-9, "{image}");
    // An albedo takes no receiver into account.
    body["theta_i_deg"] = json!(30);
    body.as_object_mut().unwrap().remove("geometry");
    assert!(server.answer("/v1/albedo", &body)["total"][0].as_f64().unwrap() > 0.9);
}

#[test]
fn what_cannot_be_is_refused() {
    let server = Server::start();
    for (angle, code) in [
        (json!(-1), "out_of_range"),
        (json!(90.1), "out_of_range"),
        (json!(1e-61), "out_of_range"),
        (json!("1"), "wrong_type"),
    ] {
        let mut body = scene();
        body["sensor"]["receiver_half_angle_deg"] = angle;
        let found = problem(server.post("/v1/radiance", body.to_string()), 422);
        assert_eq!(found["errors"][0]["pointer"], "/sensor/receiver_half_angle_deg", "{found}");
        assert_eq!(found["errors"][0]["code"], code, "{found}");
        assert!(
            found["errors"][0]["detail"].as_str().unwrap().contains("from 1e-60 to 90 degrees"),
            "{found}"
        );
    }
    let mut body = scene();
    body["geometry"]["theta_r_deg"] = json!(vec![30; 10_001]);
    let found = problem(server.post("/v1/radiance", body.to_string()), 422);
    assert_eq!(found["errors"][0]["code"], "too_many", "{found}");
    let found = problem(server.post("/v1/tradeoff", scene().to_string()), 422);
    assert_eq!(found["errors"][0]["pointer"], "/sensor/receiver_half_angle_deg", "{found}");
}
