//! The service's own inputs, posted to the started binary.

use crate::bs::mixed;
use crate::condition;
use crate::family::{Line, Measured};
use crate::measure::{exceeds, relative_error};
use crate::server::Server;
use crate::table::{Row, Table};
use reflectance::reflectance::beckmann_spizzichino::RelativeRoughness;
use reflectance::reflectance::geometry::Geometry;
use reflectance::reflectance::quantity::{Azimuth, Quantity, SourceZenith, ViewerZenith};
use serde_json::{Map, Value, json};
use std::sync::LazyLock;

pub(crate) static MEASURED: LazyLock<Measured> = LazyLock::new(|| {
    let server = Server::start();
    Measured::run("api", &Table::parse(include_str!("data/api.tsv")), |line| check(line, &server))
});

/// The request of a line, from its columns that are JSON Pointers.
fn request(row: &Row<'_>) -> Value {
    let mut body = Value::Object(Map::new());
    for (pointer, cell) in row.pointers() {
        let mut place = &mut body;
        for key in pointer[1..].split('/') {
            if place.is_null() {
                *place = json!({});
            }
            place = &mut place[key];
        }
        *place = serde_json::from_str(cell).expect("JSON");
    }
    body["output"] = json!({"log10": true, "per_direction": true});
    body
}

/// The only element of an array of the answer; null is NaN.
fn only(answer: &Value, name: &str) -> f64 {
    let array = answer[name].as_array().unwrap_or_else(|| panic!("no {name} in {answer}"));
    assert_eq!(array.len(), 1, "{name} in {answer}");
    array[0].as_f64().unwrap_or(f64::NAN)
}

/// A value of the answer and its logarithm, null for a value of exactly 0.
fn with_log10(answer: &Value, name: &str) -> (f64, f64) {
    let (value, log10) = (only(answer, name), only(answer, &format!("log10_{name}")));
    (value, if value == 0.0 && log10.is_nan() { f64::NEG_INFINITY } else { log10 })
}

fn check(line: &Line<'_>, server: &Server) {
    let row = &line.row;
    let mut body = request(row);
    let number = |pointer: &str| body.pointer(pointer).and_then(Value::as_f64);
    let degrees = |name: &str| number(&format!("/geometry/{name}")).expect("angle");
    let geometry = Geometry::new(
        SourceZenith::new(degrees("theta_i_deg")).expect("θ_i"),
        ViewerZenith::new(degrees("theta_r_deg")).expect("θ_r"),
        Azimuth::new(degrees("phi_r_deg")).expect("φ_r"),
    );
    let fresnel = fresnel_condition(&body, &geometry);
    let given = |name| row.cint(name).unwrap_or(0.0);
    // F′ is a factor of the lobe only.
    let log = |name| row.exact(name).log10();
    let share = |total| mixed([(log("specular_lobe"), fresnel), (total, 0.0)]);
    let fresnel_of_total = if row.output("diffuse_lobe").is_some() {
        share(log("diffuse_lobe"))
    } else {
        share(log("specular_spike"))
    };

    let heights = match (number("/surface/rms_height_um"), number("/illumination/wavelength_um")) {
        (Some(height), Some(wavelength)) => Some(RelativeRoughness {
            height: height / wavelength,
            correlation_length: number("/surface/correlation_length_um").expect("T") / wavelength,
        }),
        _ => None,
    };

    body["accuracy"] = json!({"method": "series"});
    let radiance = server.post("/v1/radiance", &body);
    for name in ["specular_lobe", "specular_spike", "diffuse_lobe", "total"] {
        if row.output(name).is_some() {
            let (value, log10) = with_log10(&radiance, name);
            let extra = match name {
                "specular_lobe" => fresnel,
                "total" => fresnel_of_total,
                _ => 0.0,
            };
            line.pair(name, value, log10, given(name) + extra);
        }
    }
    bound_holds(line, "series", &radiance, "total");
    let brdf = server.post("/v1/brdf", &body);
    let (value, log10) = with_log10(&brdf, "total");
    line.pair("brdf_total", value, log10, given("brdf_total") + fresnel_of_total);
    bound_holds(line, "series, BRDF", &brdf, "brdf_total");

    body["accuracy"] = json!({"relative_tolerance": 1e-13});
    let auto = server.post("/v1/radiance", &body);
    for (name, extra) in [("specular_lobe", fresnel), ("total", fresnel_of_total)] {
        if row.output(name).is_some() {
            let (value, log10) = with_log10(&auto, name);
            line.pair_by("by auto at 1e-13", name, value, log10, given(name) + extra);
        }
    }
    for tolerance in [1e-1, 1e-3, 1e-6, 1e-9, 1e-12, 1e-13] {
        body["accuracy"] = json!({"relative_tolerance": tolerance});
        keeps_tolerance(line, tolerance, &server.post("/v1/radiance", &body), "total");
    }

    let Some(heights) = heights else { return };
    line.value("roughness_g", only(&radiance, "roughness_g"), 0.0);
    let (g, x) = (heights.g(&geometry), heights.x(&geometry));
    for (method, output, cint) in [
        ("smooth", Some("smooth_lobe"), (1.0 - g).abs() + x),
        ("rough", Some("rough_lobe"), x / g),
        ("paper", None, 0.0),
        ("uniform", None, 0.0),
    ] {
        body["accuracy"] = json!({"method": method});
        let answer = server.post("/v1/radiance", &body);
        if let Some(output) = output {
            let (value, log10) = with_log10(&answer, "specular_lobe");
            line.pair(output, value, log10, cint);
        }
        bound_holds(line, method, &answer, "total");
    }
}

/// The condition of F′, which the oracle leaves out of `cint`.
fn fresnel_condition(body: &Value, geometry: &Geometry) -> f64 {
    let medium = &body["surface"]["medium"];
    let (Some(n), Some(k)) = (medium["n"].as_f64(), medium["k"].as_f64()) else { return 0.0 };
    let (h, v) = match body["illumination"]["polarization"].as_str() {
        Some("parallel") => (1.0, 0.0),
        Some("perpendicular") => (0.0, 1.0),
        _ => (0.5, 0.5),
    };
    condition::mixed(n, k, geometry.local_incidence(), h, v)
}

/// Whether `auto` keeps the tolerance, or says that f64 does not let it, and its bound in any case.
fn keeps_tolerance(line: &Line<'_>, tolerance: f64, auto: &Value, total: &'static str) {
    bound_holds(line, &format!("auto at {tolerance:e}"), auto, total);
    let warned =
        auto["warnings"].as_array().is_some_and(|all| all.iter().any(|w| w["code"] == "tolerance_not_met"));
    let bound = only(auto, "relative_error_bound");
    if warned == (bound <= tolerance) {
        line.fail(total, &format!("by auto at {tolerance:e} is bounded by {bound:e}, warned: {warned}"));
    }
}

/// Whether `relative_error_bound` is at least the true relative error of the total, whatever made it.
fn bound_holds(line: &Line<'_>, method: &str, answer: &Value, total: &'static str) {
    let bound = &answer["relative_error_bound"][0];
    // Null: no bound below infinity is known, which the converged series may never say.
    let bound = if bound.is_null() && !method.starts_with("series") {
        f64::INFINITY
    } else {
        bound.as_f64().unwrap_or(0.0)
    };
    let (value, log10) = with_log10(answer, "total");
    let error = relative_error(value, log10, &line.row.exact(total));
    if exceeds(error, bound) {
        line.fail(total, &format!("by {method} is off by {error:e}, stated {bound:e}"));
    }
}

#[test]
fn passes() {
    MEASURED.assert_passes(1500, 22500);
}
