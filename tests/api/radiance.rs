//! What `/v1/radiance`, `/v1/brdf`, `/v1/image-irradiance` and `/v1/roughness` answer.

use crate::server::Server;
use serde_json::{Value, json};

fn numbers(value: &Value) -> Vec<f64> {
    value.as_array().unwrap().iter().map(|number| number.as_f64().unwrap()).collect()
}

fn scene() -> Value {
    json!({
        "model": "unified",
        "surface": {"rms_height_um": 0.05, "correlation_length_um": 5, "diffuse_albedo": 0.3},
        "illumination": {"wavelength_um": 0.6, "irradiance": 2},
        "sensor": {"footprint_um2": 1e4, "patch_half_x_um": 50, "patch_half_y_um": 50},
        "geometry": {"theta_i_deg": [0, 20, 60], "theta_r_deg": [0, 25, 60], "phi_r_deg": [0, 90, 0]}
    })
}

#[test]
fn the_total_is_the_sum_and_the_brdf_divides_by_the_irradiance_of_the_surface() {
    let server = Server::start();
    let (radiance, brdf) = (server.answer("/v1/radiance", &scene()), server.answer("/v1/brdf", &scene()));
    let [total, diffuse, lobe, spike, bound] =
        ["total", "diffuse_lobe", "specular_lobe", "specular_spike", "relative_error_bound"]
            .map(|name| numbers(&radiance[name]));
    let f = numbers(&brdf["total"]);
    let f_bound = numbers(&brdf["relative_error_bound"]);
    for (index, cos) in [1.0, 20f64.to_radians().cos(), 0.5].into_iter().enumerate() {
        let sum = diffuse[index] + lobe[index] + spike[index];
        assert!((total[index] - sum).abs() <= 4.0 * f64::EPSILON * sum, "{index}");
        // Both bounds, and the roundings of this line's own product and cosine.
        let slack = bound[index] + f_bound[index] + 8.0 * f64::EPSILON;
        assert!((f[index] * 2.0 * cos / total[index] - 1.0).abs() <= slack, "{index}");
    }
    assert_eq!(radiance["unit"], "W m^-2 sr^-1");
    assert_eq!(brdf["unit"], "sr^-1");
    assert_eq!(brdf["quantity"], "brdf");
}

#[test]
fn scalars_are_broadcast_and_answered_as_arrays() {
    let server = Server::start();
    let mut body = scene();
    body["geometry"] = json!({"theta_i_deg": 20, "theta_r_deg": 25, "phi_r_deg": 90});
    let one = server.answer("/v1/radiance", &body);
    body["geometry"] = json!({"theta_i_deg": [20, 20], "theta_r_deg": 25, "phi_r_deg": 90});
    let two = server.answer("/v1/radiance", &body);
    assert_eq!(numbers(&one["total"]).len(), 1);
    assert_eq!(numbers(&two["total"]), [numbers(&one["total"])[0]; 2]);
}

#[test]
fn null_means_the_default() {
    let server = Server::start();
    let mut body = scene();
    let plain = server.answer("/v1/radiance", &body);
    for pointer in [
        "/surface/facet_slope_deg",
        "/surface/medium",
        "/surface/specular_scale",
        "/surface/shadowing",
        "/illumination/polarization",
        "/components",
        "/accuracy",
        "/output",
    ] {
        let (parent, name) = pointer.rsplit_once('/').unwrap();
        body.pointer_mut(parent).unwrap()[name] = Value::Null;
    }
    assert_eq!(server.answer("/v1/radiance", &body), plain);
    // And the defaults that the document states, spelled out.
    body["surface"]["medium"] = json!("perfect_conductor");
    body["surface"]["shadowing"] = json!("v_groove");
    body["illumination"]["polarization"] = json!({"parallel": 0.5, "perpendicular": 0.5});
    body["components"] = json!("auto");
    body["accuracy"] = json!({"relative_tolerance": 1e-9, "method": "auto"});
    body["output"] = json!({"log10": false, "per_direction": false});
    assert_eq!(server.answer("/v1/radiance", &body), plain);
}

#[test]
fn grazing_view_is_null_with_a_diagnostic() {
    let body = json!({
        "model": "beckmann_spizzichino", "surface": {"rms_height_um": 0.2, "correlation_length_um": 4},
        "illumination": {"wavelength_um": 0.55}, "geometry": {"theta_i_deg": 30, "theta_r_deg": [89.99999999999999, 90, -90]}
    });
    let answer = Server::start().answer("/v1/radiance", &body);
    assert!(answer["total"][0].as_f64().is_some_and(|value| value > 0.0));
    for index in [1, 2] {
        assert!(answer["total"][index].is_null() && answer["specular_lobe"][index].is_null());
        let found = answer["diagnostics"]
            .as_array()
            .unwrap()
            .iter()
            .any(|diagnostic| diagnostic["index"] == index && diagnostic["code"] == "grazing_divergence");
        assert!(found, "{answer}");
    }
}

#[test]
fn logarithms_hold_where_the_value_underflows() {
    let body = json!({
        "model": "beckmann_spizzichino", "surface": {"rms_height_um": 10, "correlation_length_um": 100},
        "illumination": {"wavelength_um": 0.5},
        "sensor": {"footprint_um2": 1e6, "patch_half_x_um": 500, "patch_half_y_um": 500},
        "geometry": {"theta_i_deg": 0, "theta_r_deg": 0},
        "components": ["specular_spike"], "output": {"log10": true, "per_direction": true}
    });
    let answer = Server::start().answer("/v1/radiance", &body);
    assert_eq!(answer["specular_spike"][0], 0.0);
    let g = numbers(&answer["roughness_g"])[0];
    let log10 = numbers(&answer["log10_specular_spike"])[0];
    // (47) at normal incidence: footprint/λ² e^{-g}.
    let expected = (1e6f64 / 0.25).log10() - g * std::f64::consts::LOG10_E;
    assert!((log10 / expected - 1.0).abs() < 16.0 * f64::EPSILON, "{log10} {expected}");
    let warnings = answer["warnings"].as_array().unwrap();
    assert!(warnings.iter().any(|warning| warning["code"] == "underflow"), "{answer}");
}

#[test]
fn a_million_directions_are_one_request() {
    const COUNT: usize = 1_000_000;
    let server = Server::start();
    let angles: Vec<f64> = (0..COUNT).map(|index| 80.0 * index as f64 / COUNT as f64).collect();
    let body = json!({
        "model": "torrance_sparrow", "surface": {"facet_slope_deg": 10}, "illumination": {},
        "geometry": {"theta_i_deg": 45, "theta_r_deg": angles}
    });
    let answer = server.answer("/v1/radiance", &body);
    for name in ["total", "specular_lobe", "relative_error_bound"] {
        assert_eq!(answer[name].as_array().unwrap().len(), COUNT, "{name}");
    }
}

#[test]
fn image_irradiance_is_radiance_times_the_factor_of_51() {
    let server = Server::start();
    let mut body = scene();
    body["sensor"] = json!({"pixel_area_um2": 25, "distance_um": 1e6, "focal_length_um": 5e4, "aperture_um": 2e4, "off_axis_deg": 60});
    let (radiance, image) =
        (server.answer("/v1/radiance", &body), server.answer("/v1/image-irradiance", &body));
    // π/4 (d/f)² cos⁴ γ
    let factor = std::f64::consts::FRAC_PI_4 * 0.16 / 16.0;
    for name in ["total", "diffuse_lobe", "specular_lobe", "specular_spike"] {
        let (l, i) = (numbers(&radiance[name]), numbers(&image[name]));
        let bounds = numbers(&image["relative_error_bound"]);
        for ((l, i), bound) in l.iter().zip(&i).zip(bounds) {
            assert!((i / l / factor - 1.0).abs() <= bound + 8.0 * f64::EPSILON, "{name} {l} {i}");
        }
    }
    assert_eq!(image["quantity"], "image_irradiance");
    assert_eq!(image["unit"], "W m^-2");
}

#[test]
fn roughness_measures_agree_whichever_is_given() {
    let server = Server::start();
    let ask = |query: &str| server.get(&format!("/v1/roughness?{query}")).json::<Value>().unwrap();
    let heights = ask("rms_height_um=0.3&correlation_length_um=3&wavelength_um=0.6&theta_i_deg=60");
    let slope = ask(&format!("facet_slope_deg={}", heights["facet_slope_deg"]));
    let alpha = ask(&format!("beckmann_alpha={}", heights["beckmann_alpha"]));
    for name in
        ["rms_height_over_correlation_length", "facet_slope_deg", "alpha0_deg", "beckmann_alpha", "rms_slope"]
    {
        let value = heights[name].as_f64().unwrap();
        for other in [&slope, &alpha] {
            // (79) there and back: 8 ε each, and the conditioning of its inverse at 8°, below 2.
            assert!((other[name].as_f64().unwrap() / value - 1.0).abs() < 32.0 * f64::EPSILON, "{name}");
        }
    }
    assert!(slope.get("roughness_g").is_none() && slope.get("rayleigh_height_um").is_none());
    // λ/(8 cos 60°), and g = (4π · 0.3/0.6 · cos 60°)² = π².
    assert!((heights["rayleigh_height_um"].as_f64().unwrap() - 0.15).abs() < 1e-16);
    assert!(
        (heights["roughness_g"].as_f64().unwrap() / std::f64::consts::PI.powi(2) - 1.0).abs()
            < 16.0 * f64::EPSILON
    );
    assert_eq!(heights["regime"], "moderate");
    let grazing = ask("rms_height_um=1&correlation_length_um=9&wavelength_um=0.6&theta_i_deg=90");
    assert!(grazing["rayleigh_height_um"].is_null());
    assert_eq!(grazing["diagnostics"][0]["field"], "rayleigh_height_um");
    assert_eq!(grazing["regime"], "smooth");
}
