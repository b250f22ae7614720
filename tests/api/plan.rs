//! What a request leaves out, warns of, and is planned to do.

use crate::properties::request;
use crate::server::Server;
use proptest::test_runner::{Config, TestRunner};
use serde_json::{Value, json};

/// A scene of heights with a sensor, in a few directions.
fn heights(height: f64, length: f64, geometry: &Value) -> Value {
    json!({
        "model": "beckmann_spizzichino",
        "surface": {"rms_height_um": height, "correlation_length_um": length},
        "illumination": {"wavelength_um": 0.6},
        "sensor": {"footprint_um2": 1e6, "patch_half_x_um": 500, "patch_half_y_um": 500},
        "geometry": geometry
    })
}

fn facets(geometry: &Value) -> Value {
    json!({
        "model": "torrance_sparrow", "surface": {"facet_slope_deg": 5, "diffuse_albedo": 0.2, "medium": {"n": 1.5}},
        "geometry": geometry
    })
}

fn warning<'a>(answer: &'a Value, code: &str) -> Option<&'a Value> {
    answer["warnings"].as_array().unwrap().iter().find(|warning| warning["code"] == code)
}

#[test]
fn rough_surfaces_have_no_spike_and_smooth_ones_no_lobe_in_the_mirror_direction() {
    let server = Server::start();
    let mirror = json!({"theta_i_deg": [10, 40], "theta_r_deg": [10, 40]});
    for (height, kept, left_out, reason) in [
        (0.42, "specular_lobe", "specular_spike", "too rough"),
        (1e-5, "specular_spike", "specular_lobe", "too smooth"),
    ] {
        let body = heights(height, 10.0, &mirror);
        let (answer, plan) = (server.answer("/v1/radiance", &body), server.answer("/v1/plan", &body));
        assert_eq!(plan["components"], json!([kept]));
        assert_eq!(plan["omitted"], answer["omitted"]);
        let omitted = &answer["omitted"][0];
        assert_eq!(omitted["component"], left_out);
        assert!(omitted["reason"].as_str().unwrap().contains(reason), "{omitted}");
        let bound = omitted["bound"].as_f64().unwrap();
        assert!(bound > 0.0 && bound <= 0.25e-9, "{bound}");
        assert!(answer.get(kept).is_some() && answer.get(left_out).is_none());
        // Part of the bound of every total.
        let bounds = answer["relative_error_bound"].as_array().unwrap();
        assert!(bounds.iter().all(|total| total.as_f64().unwrap() >= bound), "{answer}");
        // What is named is answered.
        let mut named = body.clone();
        named["components"] = json!(["specular_lobe", "specular_spike"]);
        let whole = server.answer("/v1/radiance", &named);
        assert!(whole.get(left_out).is_some() && whole["omitted"] == json!([]));
    }
}

#[test]
fn directions_differ_within_a_request() {
    let server = Server::start();
    // One direction off the mirror direction needs the lobe of a smooth surface.
    let body = heights(1e-5, 10.0, &json!({"theta_i_deg": 10, "theta_r_deg": [10, 10, 12]}));
    let answer = server.answer("/v1/radiance", &body);
    assert_eq!(answer["omitted"], json!([]));
}

#[test]
fn what_is_exactly_nothing_is_left_out_with_the_bound_0() {
    let server = Server::start();
    let geometry = json!({"theta_i_deg": 10, "theta_r_deg": 20});
    for (change, component, reason) in [
        (json!({"facet_slope_deg": 5, "diffuse_albedo": 0}), "diffuse_lobe", "diffuse_albedo"),
        (
            json!({"facet_slope_deg": 5, "diffuse_albedo": 0.1, "specular_scale": 0}),
            "specular_lobe",
            "specular_scale",
        ),
        (
            json!({"facet_slope_deg": 5, "diffuse_albedo": 0.1, "medium": {"n": 1}}),
            "specular_lobe",
            "no surface",
        ),
    ] {
        let mut body = facets(&geometry);
        body["surface"] = change;
        let omitted = server.answer("/v1/brdf", &body)["omitted"].clone();
        assert_eq!(omitted.as_array().unwrap().len(), 1, "{omitted}");
        assert_eq!((&omitted[0]["component"], &omitted[0]["bound"]), (&json!(component), &json!(0.0)));
        assert!(omitted[0]["reason"].as_str().unwrap().contains(reason), "{omitted}");
    }
    // Something is always answered.
    let mut body = facets(&geometry);
    body["surface"] = json!({"facet_slope_deg": 5, "diffuse_albedo": 0, "specular_scale": 0});
    let answer = server.answer("/v1/brdf", &body);
    assert_eq!(answer["total"], json!([0.0]));
    assert_eq!(answer["omitted"].as_array().unwrap().len(), 1);
}

#[test]
fn every_strained_assumption_is_named_with_its_number() {
    let server = Server::start();
    let at = |theta: f64| json!({"theta_i_deg": theta, "theta_r_deg": [0, theta]});
    let with = |mut body: Value, pointer: &str, value: Value| {
        let (parent, name) = pointer.rsplit_once('/').unwrap();
        body.pointer_mut(parent).unwrap()[name] = value;
        body
    };
    let narrow = json!({"footprint_um2": 100, "patch_half_x_um": 5, "patch_half_y_um": 5});
    let steep = json!({"rms_height_um": 2, "correlation_length_um": 8, "diffuse_albedo": 0.3});
    let scene = |height, length| heights(height, length, &at(20.0));
    let cases: [(&str, f64, f64, Value); 8] = [
        // Errata E29: 4π T²/(2√3 σ_h λ).
        ("kirchhoff_curvature", 4.0 * std::f64::consts::PI / 12f64.sqrt() / 0.6, 1e-9, scene(1.0, 1.0)),
        ("height_below_geometrical_optics", 0.5, 1e-15, {
            let body = with(facets(&at(20.0)), "/surface/rms_height_um", json!(0.3));
            with(body, "/illumination", json!({"wavelength_um": 0.6}))
        }),
        // 4XY/T²
        ("patch_not_large", 4.0, 1e-15, with(scene(1.0, 5.0), "/sensor", narrow)),
        ("small_slopes_violated", 0.25, 1e-15, with(facets(&at(20.0)), "/surface", steep)),
        // m = 0.5: v = cot 80°/m = 0.35265, erfc v = 0.6180, Λ = (e^{−v²}/(√π v) − erfc v)/2 = 0.3974, 1 − 1/(1 + 2Λ).
        ("shadowing_significant", 0.4428, 2e-4, heights(2.0, 8.0, &at(80.0))),
        ("multiple_scattering_significant", 0.25, 0.1, heights(4.0, 8.0, &at(60.0))),
        // A perfect conductor with a diffuse lobe of albedo 0.3 beside it.
        ("energy_above_one", 1.3, 0.03, {
            let body = with(facets(&at(20.0)), "/surface/diffuse_albedo", json!(0.3));
            with(body, "/surface/medium", json!("perfect_conductor"))
        }),
        ("method_out_of_range", 1.0, 1e-6, with(scene(1.2, 12.0), "/accuracy", json!({"method": "paper"}))),
    ];
    for (code, value, slack, body) in cases {
        let answer = server.answer("/v1/radiance", &body);
        let found = warning(&answer, code).unwrap_or_else(|| panic!("{code}: {answer}"));
        let got = found["value"].as_f64().unwrap();
        assert!((got - value).abs() <= slack * value.max(1.0), "{code}: {got}, expected {value}");
        // The plan says so as well, word for word.
        let plan = server.answer("/v1/plan", &body);
        assert_eq!(warning(&plan, code), Some(found));
    }
    // And none of them where nothing is strained: 20 µm of patch a side, gentle slopes, moderate angles.
    let calm = server.answer("/v1/radiance", &heights(2.0, 40.0, &at(20.0)));
    assert_eq!(calm["warnings"], json!([]), "{calm}");
    let mut calm = facets(&at(20.0));
    calm["surface"]["rms_height_um"] = json!(1.2);
    calm["illumination"] = json!({"wavelength_um": 0.6});
    let calm = server.answer("/v1/radiance", &calm);
    assert_eq!(calm["warnings"], json!([]), "{calm}");
}

#[test]
fn a_method_is_out_of_range_by_its_value_before_that_is_rounded() {
    let server = Server::start();
    let lobe = |height: f64, length: f64, geometry: Value, method: &str| {
        let mut body = heights(height, length, &geometry);
        body["illumination"] = json!({"wavelength_um": 1, "irradiance": 1e90});
        body["components"] = json!(["specular_lobe"]);
        body["accuracy"] = json!({"method": method});
        server.answer("/v1/radiance", &body)
    };
    let mirror = || json!({"theta_i_deg": 30, "theta_r_deg": 30});
    // g is 1e6: e^{-g} and all that a hundred terms add to it are below f64.
    let paper = lobe(100.0, 1000.0, mirror(), "paper");
    assert_eq!((&paper["total"], &paper["relative_error_bound"]), (&json!([0.0]), &json!([1.0])));
    let found = warning(&paper, "method_out_of_range").unwrap_or_else(|| panic!("{paper}"));
    assert_eq!(found["indices"], json!([0]));
    // (T/σ_h)² is 1e240.
    let rough = lobe(1e-60, 1e60, mirror(), "rough");
    assert_eq!(rough["total"], json!([null]));
    assert!(warning(&rough, "method_out_of_range").is_some(), "{rough}");
    // Towards the source at 80°, T = 12 σ_h, it is e^{-1158} and right to a tenth.
    let retro = lobe(2e3, 24e3, json!({"theta_i_deg": 80, "theta_r_deg": -80}), "rough");
    assert_eq!(retro["total"], json!([0.0]));
    assert!(
        warning(&retro, "underflow").is_some() && warning(&retro, "method_out_of_range").is_none(),
        "{retro}"
    );
}

#[test]
fn a_warning_lists_twenty_directions_and_counts_the_rest() {
    let server = Server::start();
    let views: Vec<f64> = (0..200).map(|i| 0.45 * f64::from(i)).collect();
    let body = heights(2.0, 8.0, &json!({"theta_i_deg": 10, "theta_r_deg": views}));
    let answer = server.answer("/v1/radiance", &body);
    let found = warning(&answer, "shadowing_significant").unwrap();
    let indices: Vec<u64> =
        found["indices"].as_array().unwrap().iter().map(|i| i.as_u64().unwrap()).collect();
    let count = found["count"].as_u64().unwrap();
    // From some zenith on, all of them.
    assert_eq!(indices.len(), 20);
    assert_eq!(indices, (200 - count..220 - count).collect::<Vec<_>>());
}

#[test]
fn a_plan_tells_regime_methods_and_cost() {
    let server = Server::start();
    let angles: Vec<f64> = (0..5000).map(|i| 80.0 * f64::from(i) / 4999.0).collect();
    let body = heights(0.6, 10.0, &json!({"theta_i_deg": 0, "theta_r_deg": angles}));
    let plan = server.answer("/v1/plan", &body);
    // (4π σ_h/λ)² = 16π² at normal incidence and view.
    let largest = plan["roughness_g"]["largest"].as_f64().unwrap();
    assert!((largest / (16.0 * std::f64::consts::PI.powi(2)) - 1.0).abs() < 1e-14, "{largest}");
    assert!(plan["roughness_g"]["least"].as_f64().unwrap() < largest);
    assert_eq!(plan["regime"], json!({"least": "rough", "largest": "rough"}));
    assert_eq!((&plan["directions"], &plan["sampled"]), (&json!(5000), &json!(1024)));
    let ranges = plan["method_ranges"].as_array().unwrap();
    assert_eq!((&ranges[0]["first"], &ranges[ranges.len() - 1]["last"]), (&json!(0), &json!(4999)));
    let counted: u64 =
        plan["methods"].as_object().unwrap().values().map(|count| count.as_u64().unwrap()).sum();
    assert_eq!(counted, 1024);
    let cost = |body: &Value| server.answer("/v1/plan", body)["cost"].clone();
    let number = |cost: &Value, name: &str| cost[name].as_f64().unwrap();
    let (auto, mut summed) = (cost(&body), body.clone());
    summed["accuracy"] = json!({"method": "series"});
    summed["components"] = json!(["specular_lobe", "specular_spike"]);
    // What is asked for in full costs what the full series costs.
    assert_eq!(number(&cost(&summed), "relative_to_full_series"), 1.0);
    assert!(number(&auto, "relative_to_full_series") < 1.0);
    let ratio = number(&auto, "per_direction") / number(&auto, "full_series");
    assert_eq!(number(&auto, "relative_to_full_series"), ratio);
}

#[test]
fn the_plan_of_any_request_is_what_its_answer_does() {
    let server = Server::start();
    let config = Config { failure_persistence: None, ..Config::with_cases(1000) };
    let answered = std::cell::Cell::new(0);
    TestRunner::new(config)
        .run(&request(), |mut request| {
            // With logarithms a number may come by another path, and its bound with it.
            request["output"] = Value::Null;
            let body = request.to_string();
            let (answer, plan) = (server.post("/v1/radiance", body.clone()), server.post("/v1/plan", body));
            assert_eq!(answer.status(), plan.status());
            if answer.status() != 200 {
                let (answer, plan): (Value, Value) = (answer.json().unwrap(), plan.json().unwrap());
                assert_eq!(answer["errors"], plan["errors"]);
                return Ok(());
            }
            answered.set(answered.get() + 1);
            let (answer, plan): (Value, Value) = (answer.json().unwrap(), plan.json().unwrap());
            for name in ["methods", "omitted", "warnings"] {
                assert_eq!(answer[name], plan[name], "{name} of {request}");
            }
            for component in ["diffuse_lobe", "specular_lobe", "specular_spike"] {
                let planned = plan["components"].as_array().unwrap().contains(&json!(component));
                assert_eq!(answer.get(component).is_some(), planned, "{request}");
            }
            Ok(())
        })
        .unwrap_or_else(|error| panic!("{error}"));
    assert!(answered.get() > 300, "{}", answered.get());
}
