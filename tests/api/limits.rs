//! Where values leave the range of a 64-bit float or of the model: each says so, and its logarithm is right.

use crate::server::Server;
use serde_json::{Value, json};

fn codes(answer: &Value, index: usize) -> Vec<&str> {
    answer["diagnostics"]
        .as_array()
        .unwrap()
        .iter()
        .filter(|diagnostic| diagnostic["index"] == index)
        .map(|diagnostic| diagnostic["code"].as_str().unwrap())
        .collect()
}

#[test]
fn a_camera_at_the_ends_of_its_range_keeps_its_spike() {
    let server = Server::start();
    // log10 of footprint/λ² = (z/f)² dA/λ²; at θ_i = θ_r = 0 and g = (4π·1e-3/λ)² the spike is that times e^{-g}.
    for (pixel, distance, focal, wavelength, log10) in [
        (1e-120, 1e-60, 1e60, 1e60, -480.0),
        (1e100, 1e60, 1e-50, 1e3, 314.0),
        (1e-100, 1e-60, 1e50, 1.0, -320.0),
    ] {
        let g = (4e-3 * std::f64::consts::PI / wavelength).powi(2);
        let log10: f64 = log10 - g / std::f64::consts::LN_10;
        let body = json!({
            "model": "beckmann_spizzichino", "surface": {"rms_height_um": 0.001},
            "illumination": {"wavelength_um": wavelength},
            "sensor": {"pixel_area_um2": pixel, "distance_um": distance, "focal_length_um": focal, "aperture_um": 1},
            "geometry": {"theta_i_deg": 0, "theta_r_deg": 0},
            "components": ["specular_spike"], "output": {"log10": true}
        });
        let answer = server.answer("/v1/radiance", &body);
        let got = answer["log10_total"][0].as_f64().unwrap_or_else(|| panic!("{body}: {answer}"));
        // Twice 64 units of the logarithm: the expectation is rounded as well.
        assert!((got - log10).abs() <= 128.0 * f64::EPSILON / 2.0 * (log10.abs() + 1.0), "{body}: {got}");
        if log10 > 309.0 {
            assert!(answer["total"][0].is_null());
            assert_eq!(codes(&answer, 0), ["overflow"]);
        } else if log10 < -330.0 {
            assert_eq!((&answer["total"][0], &answer["relative_error_bound"][0]), (&json!(0.0), &json!(1.0)));
        }
    }
}

#[test]
fn both_directions_grazing_have_a_limit_or_say_that_they_have_none() {
    let server = Server::start();
    let ask = |model: &str, shadowing: &str, phi: f64| {
        let body = json!({
            "model": model,
            "surface": {"rms_height_um": 0.02, "correlation_length_um": 0.4, "shadowing": shadowing},
            "illumination": {"wavelength_um": 0.55},
            "geometry": {"theta_i_deg": 90, "theta_r_deg": 90, "phi_r_deg": phi}, "components": ["specular_lobe"]
        });
        server.answer("/v1/radiance", &body)
    };
    // Towards another azimuth facets have a slope: the V-grooves hide them all, nothing hides them without.
    let hidden = ask("beckmann_spizzichino", "v_groove", 40.0);
    assert_eq!((&hidden["total"][0], hidden["diagnostics"].as_array().unwrap().len()), (&json!(0.0), 0));
    assert_eq!(codes(&ask("beckmann_spizzichino", "none", 40.0), 0), ["grazing_divergence"]);
    // In the mirror direction everything depends on the path, and so does 0 · ∞ of the unified model.
    for shadowing in ["none", "v_groove"] {
        assert_eq!(
            codes(&ask("beckmann_spizzichino", shadowing, 0.0), 0),
            ["undefined_limit"],
            "{shadowing}"
        );
    }
    let unified = ask("unified", "none", 40.0);
    assert!(unified["total"][0].is_null());
    assert_eq!(codes(&unified, 0), ["undefined_limit"]);
}

#[test]
fn a_grazing_source_leaves_the_unified_lobe_nothing() {
    let server = Server::start();
    let body = json!({
        "model": "unified",
        "surface": {"facet_slope_deg": 5, "rms_height_um": 0.02, "correlation_length_um": 0.4, "shadowing": "none"},
        "illumination": {"wavelength_um": 0.55},
        "geometry": {"theta_i_deg": [90, 89.999999, 89.9999], "theta_r_deg": 30}, "components": ["specular_lobe"]
    });
    // 1 − e^{-g} goes to 0 as cos² θ_i and the BRDF's 1/cos θ_i takes one of them: what is left goes with cos θ_i.
    let total: Vec<f64> = server.answer("/v1/brdf", &body)["total"]
        .as_array()
        .unwrap()
        .iter()
        .map(|value| value.as_f64().unwrap())
        .collect();
    assert_eq!(total[0], 0.0);
    // The exponential changes with the angle by its slope, some 1e-3 over the 1e-4 degrees between them.
    assert!((total[2] / total[1] / 100.0 - 1.0).abs() < 1e-2, "{total:?}");
}

#[test]
fn no_surface_reflects_nothing_even_at_grazing() {
    let server = Server::start();
    let body = json!({
        "model": "beckmann_spizzichino",
        "surface": {"rms_height_um": 0.2, "correlation_length_um": 4, "medium": {"n": 1, "k": 0}},
        "illumination": {"wavelength_um": 0.55},
        "geometry": {"theta_i_deg": 30, "theta_r_deg": [45, 90]}, "components": ["specular_lobe"]
    });
    let answer = server.answer("/v1/radiance", &body);
    assert_eq!(answer["total"], json!([0.0, 0.0]));
    assert_eq!(answer["relative_error_bound"], json!([0.0, 0.0]));
}

#[test]
fn what_is_given_for_nothing_is_named() {
    let server = Server::start();
    let body = json!({
        "model": "beckmann_spizzichino",
        "surface": {"rms_height_um": 0.2, "correlation_length_um": 4, "facet_slope_deg": 5, "specular_scale": 3,
                    "diffuse_albedo": 0.5},
        "illumination": {"wavelength_um": 0.55},
        "geometry": {"theta_i_deg": 30, "theta_r_deg": 45}, "components": ["specular_lobe"]
    });
    let answer = server.answer("/v1/radiance", &body);
    let named: Vec<_> = answer["warnings"]
        .as_array()
        .unwrap()
        .iter()
        .map(|warning| (warning["code"].as_str().unwrap(), warning["parameter"].as_str().unwrap()))
        .collect();
    let expected = ["surface.diffuse_albedo", "surface.facet_slope_deg", "surface.specular_scale"];
    assert_eq!(named, expected.map(|name| ("parameter_not_used", name)));
}

#[test]
fn a_roughness_that_the_scene_does_not_have_is_null_with_a_reason() {
    let server = Server::start();
    let body = json!({
        "model": "torrance_sparrow", "surface": {"facet_slope_deg": 5},
        "geometry": {"theta_i_deg": 30, "theta_r_deg": [45, 50]}, "output": {"per_direction": true}
    });
    let answer = server.answer("/v1/radiance", &body);
    assert_eq!(answer["roughness_g"], json!([null, null]));
    assert_eq!(codes(&answer, 1), ["no_roughness"]);
}

#[test]
fn the_geometrical_model_wants_heights_above_the_wavelength() {
    let server = Server::start();
    for (height, holds) in [(0.2, false), (0.82, false), (0.83, true), (5.0, true)] {
        let path =
            format!("/v1/roughness?rms_height_um={height}&correlation_length_um=40&wavelength_um=0.55");
        let answer: Value = server.get(&path).json().unwrap();
        assert_eq!(answer["validity"]["geometrical_optics"]["holds"], holds, "{height}: {answer}");
    }
}

#[test]
fn factors_below_the_smallest_float_do_not_lose_the_product() {
    let server = Server::start();
    let log10 = |surface: Value, irradiance: f64| {
        let model = if surface.get("diffuse_albedo").is_some() { "lambertian" } else { "torrance_sparrow" };
        let component = if model == "lambertian" { "diffuse_lobe" } else { "specular_lobe" };
        let body = json!({
            "model": model, "surface": surface, "illumination": {"irradiance": irradiance},
            "components": [component], "geometry": {"theta_i_deg": 60, "theta_r_deg": 60},
            "output": {"log10": true}
        });
        server.answer("/v1/radiance", &body)["log10_total"][0].as_f64().unwrap()
    };
    // ρ/π · E · cos 60°, and c·a_f/4 · E/cos 60° at the mirror direction.
    let half_over_pi = (0.5 / std::f64::consts::PI).log10();
    for (got, expected) in [
        (log10(json!({"diffuse_albedo": 1e-250}), 1e-100), -350.0 + half_over_pi),
        (log10(json!({"diffuse_albedo": 5e-324}), 1e100), 5e-324f64.log10() + 100.0 + half_over_pi),
        (
            log10(json!({"facet_slope_deg": 10, "specular_scale": 5e-324}), 1e100),
            5e-324f64.log10() + 100.0 - 2f64.log10(),
        ),
    ] {
        assert!((got - expected).abs() <= 64.0 * f64::EPSILON * (expected.abs() + 325.0), "{got} {expected}");
    }
}

#[test]
fn the_bound_holds_where_roundings_align_at_the_critical_angle() {
    let server = Server::start();
    let body = json!({
        "model": "torrance_sparrow",
        "surface": {"facet_slope_deg": 20, "specular_scale": 1, "medium": {"n": 0.12519920731668474, "k": 0}},
        "illumination": {"polarization": "perpendicular"}, "components": ["specular_lobe"],
        "geometry": {"theta_i_deg": 14.479520280109837, "theta_r_deg": 14.479520663921148,
                     "phi_r_deg": 119.90353532667406}
    });
    let answer = server.answer("/v1/radiance", &body);
    // By 80-digit arithmetic.
    let error = (answer["total"][0].as_f64().unwrap() / 0.211723773015146 - 1.0).abs();
    assert!(error <= answer["relative_error_bound"][0].as_f64().unwrap(), "{error} {answer}");
}

#[test]
fn a_right_azimuth_keeps_the_phase_of_the_spike_exactly_zero() {
    let server = Server::start();
    let spike = |half: f64| {
        let body = json!({
            "model": "beckmann_spizzichino", "surface": {"rms_height_um": 0.001},
            "illumination": {"wavelength_um": 1},
            "sensor": {"footprint_um2": 1, "patch_half_x_um": half, "patch_half_y_um": 1e-6},
            "geometry": {"theta_i_deg": 0, "theta_r_deg": 1e-4, "phi_r_deg": [90, 270, -90]},
            "components": ["specular_spike"]
        });
        server.answer("/v1/radiance", &body)["total"].clone()
    };
    // v_x = −sin θ_r cos 90° = 0: the patch may be as long as it likes.
    assert_eq!(spike(1e15), spike(1e-6));
}
