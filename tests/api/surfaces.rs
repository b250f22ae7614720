//! What a surface is made of and how its facets hide each other, as requests say it.

use crate::server::{Server, problem};
use serde_json::{Value, json};

const ALUMINIUM: [f64; 2] = [1.3735, 7.6179];

fn scene(model: &str) -> Value {
    json!({
        "model": model,
        "surface": {"rms_height_um": 0.2, "correlation_length_um": 1.0, "medium": {"n": ALUMINIUM[0], "k": ALUMINIUM[1]}},
        "illumination": {"wavelength_um": 0.633},
        "components": ["specular_lobe"],
        "geometry": {"theta_i_deg": 60, "theta_r_deg": [-70, 0, 50, 60, 85], "phi_r_deg": 20}
    })
}

fn lobe(server: &Server, body: &Value) -> Vec<f64> {
    let answer = server.answer("/v1/radiance", body);
    let numbers = answer["specular_lobe"].as_array().expect("a lobe");
    numbers.iter().map(|value| value.as_f64().unwrap_or(f64::NAN)).collect()
}

#[test]
fn at_grazing_view_the_lobe_is_finite_with_smith() {
    let server = Server::start();
    for model in ["beckmann_spizzichino", "torrance_sparrow"] {
        for shadowing in ["smith", "smith_uncorrelated"] {
            let mut body = scene(model);
            body["surface"]["shadowing"] = json!(shadowing);
            body["geometry"]["theta_r_deg"] = json!([89.99999, 90]);
            let found = lobe(&server, &body);
            // The last degree's 1e-5 changes what is left by less than 1e-5.
            assert!(
                found[1] > 0.0 && (found[0] / found[1] - 1.0).abs() < 1e-5,
                "{model} {shadowing} {found:?}"
            );
        }
    }
}

#[test]
fn smith_takes_the_share_that_the_slopes_say() {
    // m = 2σ_h/T = 0.4. 1 + Λ at 60° by scripts/coefficients/erfc_integral.py.
    let one_and_lambda = 1.003_721_816_737_763_3;
    let server = Server::start();
    let mut body = scene("beckmann_spizzichino");
    body["geometry"]["theta_r_deg"] = json!([60]);
    let mut with = |shadowing: &str| {
        body["surface"]["shadowing"] = json!(shadowing);
        lobe(&server, &body)[0]
    };
    let whole = with("none");
    // Both bounds are of the tolerance, 1e-9.
    assert!((with("smith") / whole * (2.0 * one_and_lambda - 1.0) - 1.0).abs() < 2e-9);
    assert!((with("smith_uncorrelated") / whole * one_and_lambda * one_and_lambda - 1.0).abs() < 2e-9);
}

#[test]
fn a_facet_slope_of_its_own_decides_what_smith_hides() {
    // (79): σ_α of σ_h/T = 0.2 with all its digits says the same as the heights.
    let server = Server::start();
    let mut body = scene("torrance_sparrow");
    body["surface"]["shadowing"] = json!("smith");
    let by_heights = lobe(&server, &body);
    body["surface"]["facet_slope_deg"] = json!((0.4f64.atan() / 2f64.sqrt()).to_degrees());
    let by_slope = lobe(&server, &body);
    for (a, b) in by_heights.iter().zip(&by_slope) {
        // The steepest facet has (α/σ_α)² of 40, times a few ε in σ_α.
        assert!((a / b - 1.0).abs() < 1e-13, "{a} {b}");
    }
    body["surface"]["facet_slope_deg"] = json!(30);
    assert!(lobe(&server, &body)[4] != by_slope[4]);
}

#[test]
fn the_readings_of_f_agree_on_gentle_slopes_in_the_mirror_direction() {
    let server = Server::start();
    let mut body = scene("beckmann_spizzichino");
    body["surface"]["correlation_length_um"] = json!(1e5);
    body["geometry"] = json!({"theta_i_deg": 60, "theta_r_deg": 60});
    let mut with = |average: &str| {
        body["surface"]["fresnel_average"] = json!(average);
        lobe(&server, &body)[0]
    };
    let [half, mean, slopes] = ["half_vector", "mean_plane", "slope_average"].map(&mut with);
    // σ_h/T is 2e-6: the mean over the slopes differs in its square. Both bounds are of the tolerance.
    assert!((mean / half - 1.0).abs() < 2e-9, "{mean} {half}");
    assert!((slopes / half - 1.0).abs() < 2.1e-9, "{slopes} {half}");
}

#[test]
fn an_average_over_slopes_is_the_same_alone_and_among_many_sources() {
    let server = Server::start();
    let mut body = scene("torrance_sparrow");
    body["surface"]["fresnel_average"] = json!("slope_average");
    body["geometry"] = json!({"theta_i_deg": [10, 70, 10, 0, 90], "theta_r_deg": 20});
    let many = lobe(&server, &body);
    for (place, theta_i) in [(1, 70), (2, 10), (3, 0)] {
        body["geometry"] = json!({"theta_i_deg": theta_i, "theta_r_deg": 20});
        assert_eq!(lobe(&server, &body), [many[place]], "{theta_i}");
    }
    assert_eq!(many[0], many[2]);
}

#[test]
fn what_has_no_average_or_no_smith_is_refused_with_what_would_do() {
    let server = Server::start();
    let refused =
        |body: &Value| problem(server.post("/v1/radiance", body.to_string()), 422)["errors"].clone();
    let mut body = scene("torrance_sparrow");
    body["surface"]["facet_slope_deg"] = json!(70);
    body["surface"]["shadowing"] = json!("smith");
    body["surface"]["fresnel_average"] = json!("slope_average");
    let errors = refused(&body);
    for (place, limit) in ["63.6", "58.6"].iter().enumerate() {
        assert_eq!(errors[place]["pointer"], "/surface/facet_slope_deg");
        assert_eq!(errors[place]["code"], "out_of_range");
        assert!(errors[place]["detail"].as_str().unwrap().contains(limit), "{errors}");
    }
    let mut body = scene("beckmann_spizzichino");
    body["surface"]["fresnel_average"] = json!("slope_average");
    body["surface"]["rms_height_um"] = json!(4.1);
    let errors = refused(&body);
    assert_eq!(errors[0]["pointer"], "/surface/rms_height_um");
    assert!(errors[0]["detail"].as_str().unwrap().contains("from 1e-121 to 4"), "{errors}");
    // Each zenith takes a quadrature.
    body["surface"]["rms_height_um"] = json!(0.2);
    let zeniths: Vec<f64> = (0..501).map(|i| 0.1 * f64::from(i)).collect();
    body["geometry"] = json!({"theta_i_deg": zeniths, "theta_r_deg": 0});
    let errors = refused(&body);
    assert_eq!((&errors[0]["pointer"], &errors[0]["code"]), (&json!("/geometry"), &json!("too_many")));
    assert!(errors[0]["detail"].as_str().unwrap().contains("at most 500"), "{errors}");
}

#[test]
fn what_has_no_effect_is_said() {
    let server = Server::start();
    let mut body = scene("beckmann_spizzichino");
    body["surface"]["medium"] = json!("perfect_conductor");
    body["surface"]["fresnel_average"] = json!("mean_plane");
    let answer = server.answer("/v1/radiance", &body);
    let unused = answer["warnings"].as_array().unwrap().iter().any(|warning| {
        warning["code"] == "parameter_not_used" && warning["parameter"] == "surface.fresnel_average"
    });
    assert!(unused, "{answer}");
}

#[test]
fn smith_takes_away_the_energy_that_facets_would_make() {
    // Slopes of m = 0.3 at 85°: unshadowed their albedo is 1.53; Smith's facets hide each other as often as they crowd.
    let server = Server::start();
    let mut body = json!({
        "model": "beckmann_spizzichino", "surface": {"rms_height_um": 1.5, "correlation_length_um": 10},
        "illumination": {"wavelength_um": 0.1}, "components": ["specular_lobe"],
        "geometry": {"theta_i_deg": 85, "theta_r_deg": 60}
    });
    let mut above_one = |shadowing: &str| {
        body["surface"]["shadowing"] = json!(shadowing);
        let answer = server.answer("/v1/radiance", &body);
        let warnings = answer["warnings"].as_array().unwrap().clone();
        warnings
            .iter()
            .find(|warning| warning["code"] == "energy_above_one")
            .map(|found| found["value"].clone())
    };
    let bare = above_one("none").and_then(|value| value.as_f64()).expect("a warning");
    // The quadrature is good to 0.05 of it.
    assert!((bare / 1.53 - 1.0).abs() < 0.05, "{bare}");
    assert_eq!(above_one("smith"), None);
    assert_eq!(above_one("smith_uncorrelated"), None);
}
