//! The whole input space, its extremes weighted: every answer is a number or null with a diagnostic.

use crate::server::Server;
use proptest::prelude::*;
use proptest::test_runner::{Config, TestRunner};
use serde_json::{Map, Value, json};

/// Numbers over the whole of a range given by decimal exponents, its ends often.
fn magnitude(least: f64, most: f64) -> impl Strategy<Value = f64> {
    prop_oneof![
        4 => (-3.0..3.0f64).prop_map(|e| 10f64.powf(e)),
        2 => (least..most).prop_map(|e| 10f64.powf(e)),
        1 => Just(10f64.powf(least)),
        1 => Just(10f64.powf(most)),
    ]
    .prop_filter("rounding can pass an end", move |value| {
        (format!("1e{least}").parse::<f64>().unwrap()..=format!("1e{most}").parse::<f64>().unwrap())
            .contains(value)
    })
}

fn length() -> impl Strategy<Value = f64> {
    magnitude(-60.0, 60.0)
}

fn zenith() -> impl Strategy<Value = f64> {
    prop_oneof![
        4 => 0.0..=90.0f64,
        1 => Just(0.0),
        1 => Just(90.0),
        1 => (-15.0..0.0f64).prop_map(|e| 90.0 - 10f64.powf(e)),
        1 => (-300.0..0.0f64).prop_map(|e| 10f64.powf(e)),
        1 => Just(30.0),
    ]
}

fn azimuth() -> impl Strategy<Value = f64> {
    prop_oneof![
        3 => -360.0..=360.0f64,
        3 => proptest::sample::select(vec![0.0, 180.0, -180.0, 360.0, -360.0, 90.0, -0.0, 1e-300]),
    ]
}

fn medium() -> impl Strategy<Value = Value> {
    prop_oneof![
        2 => Just(json!("perfect_conductor")),
        2 => (magnitude(-9.0, 9.0), prop_oneof![Just(0.0), magnitude(-9.0, 9.0)]).prop_map(|(n, k)| json!({"n": n, "k": k})),
        1 => Just(json!({"n": 1.0})),
        1 => Just(Value::Null),
    ]
}

fn sensor() -> impl Strategy<Value = Value> {
    prop_oneof![
        (magnitude(-120.0, 120.0), length(), length()).prop_map(|(footprint, x, y)| {
            json!({"footprint_um2": footprint, "patch_half_x_um": x, "patch_half_y_um": y})
        }),
        (magnitude(-120.0, 120.0), length(), length(), length(), 0.0..=89.0f64).prop_map(|(area, z, f, d, gamma)| {
            json!({"pixel_area_um2": area, "distance_um": z, "focal_length_um": f, "aperture_um": d, "off_axis_deg": gamma})
        }),
        Just(Value::Null),
    ]
}

fn components() -> impl Strategy<Value = Value> {
    let names = vec!["diffuse_lobe", "specular_lobe", "specular_spike"];
    prop_oneof![
        Just(json!("auto")),
        proptest::sample::subsequence(names, 1..=3).prop_map(|names| json!(names))
    ]
}

fn surface() -> impl Strategy<Value = Value> {
    let height = || proptest::option::weighted(0.9, length());
    let slope = proptest::option::weighted(0.5, magnitude(-12.0, 3.0));
    let scale = proptest::option::weighted(0.3, prop_oneof![Just(0.0), magnitude(-100.0, 100.0)]);
    let shadowing = proptest::sample::select(vec![json!(null), json!("none"), json!("v_groove")]);
    let albedo = prop_oneof![Just(0.0), Just(1.0), 0.0..=1.0f64];
    (height(), height(), slope, medium(), albedo, scale, shadowing).prop_map(
        |(height, length, slope, medium, albedo, scale, shadowing)| {
            json!({
                "rms_height_um": height, "correlation_length_um": length, "facet_slope_deg": slope, "medium": medium,
                "diffuse_albedo": albedo, "specular_scale": scale, "shadowing": shadowing
            })
        },
    )
}

fn illumination() -> impl Strategy<Value = Value> {
    let polarization = prop_oneof![
        proptest::sample::select(vec![
            json!("unpolarized"),
            json!("parallel"),
            json!("perpendicular"),
            json!(null)
        ]),
        (0u32..=64).prop_map(
            |h| json!({"parallel": f64::from(h) / 64.0, "perpendicular": f64::from(64 - h) / 64.0})
        ),
    ];
    (proptest::option::weighted(0.9, length()), magnitude(-100.0, 100.0), polarization).prop_map(
        |(wavelength, irradiance, polarization)| {
            json!({"wavelength_um": wavelength, "irradiance": irradiance, "polarization": polarization})
        },
    )
}

/// Directions: a few at random, and the mirror direction of the first.
fn geometry() -> impl Strategy<Value = Value> {
    proptest::collection::vec((zenith(), (zenith(), any::<bool>()), azimuth()), 1..6).prop_map(|directions| {
        let (mut theta_i, mut theta_r, mut phi_r) = (Vec::new(), Vec::new(), Vec::new());
        for (i, (r, negative), phi) in directions {
            theta_i.push(i);
            theta_r.push(if negative { -r } else { r });
            phi_r.push(phi);
        }
        theta_i.push(theta_i[0]);
        theta_r.push(theta_i[0]);
        phi_r.push(0.0);
        json!({"theta_i_deg": theta_i, "theta_r_deg": theta_r, "phi_r_deg": phi_r})
    })
}

pub(crate) fn request() -> impl Strategy<Value = Value> {
    let model =
        proptest::sample::select(vec!["beckmann_spizzichino", "torrance_sparrow", "lambertian", "unified"]);
    let method = proptest::sample::select(vec!["auto", "series", "paper", "uniform", "smooth", "rough"]);
    let tolerance = magnitude(-15.0, -1.0);
    let scene = (model, surface(), illumination(), sensor(), geometry());
    (scene, components(), method, tolerance, any::<bool>(), any::<bool>()).prop_map(
        |((model, surface, illumination, sensor, geometry), components, method, tolerance, log10, each)| {
            json!({
                "model": model, "surface": surface, "illumination": illumination, "sensor": sensor,
                "geometry": geometry, "components": components,
                "accuracy": {"method": method, "relative_tolerance": tolerance},
                "output": {"log10": log10, "per_direction": each}
            })
        },
    )
}

/// What holds for every answer, whatever was asked.
fn check(request: &Value, answer: &Map<String, Value>) -> Result<(), TestCaseError> {
    let count = request["geometry"]["theta_i_deg"].as_array().unwrap().len();
    let explained: Vec<usize> = answer["diagnostics"]
        .as_array()
        .unwrap()
        .iter()
        .map(|diagnostic| usize::try_from(diagnostic["index"].as_u64().unwrap()).unwrap())
        .collect();
    for (name, column) in answer {
        let numeric = ["total", "relative_error_bound", "roughness_g"].contains(&name.as_str())
            || name.ends_with("_lobe")
            || name.ends_with("_spike")
            || name.starts_with("log10_");
        if !numeric {
            continue;
        }
        let column = column.as_array().unwrap();
        prop_assert_eq!(column.len(), count, "{}", name);
        for (index, value) in column.iter().enumerate() {
            match value.as_f64() {
                Some(value) => {
                    prop_assert!(value >= 0.0 || name.starts_with("log10_"), "{name}[{index}] = {value}");
                }
                None => {
                    prop_assert!(value.is_null() && explained.contains(&index), "{name}[{index}] = {value}");
                }
            }
        }
    }
    let methods = answer["methods"].as_object().unwrap();
    let counted: u64 = methods.values().map(|count| count.as_u64().unwrap()).sum();
    prop_assert_eq!(counted, count as u64);
    for component in request["components"].as_array().into_iter().flatten() {
        prop_assert!(answer.contains_key(component.as_str().unwrap()));
    }
    for name in ["log10_total", "method"] {
        let asked = if name == "method" { "per_direction" } else { "log10" };
        prop_assert_eq!(answer.contains_key(name), request["output"][asked] == true);
    }
    Ok(())
}

/// Sends each request to each path; `check` is for those that are answered.
fn for_all(paths: &[&str], cases: u32, strategy: impl Strategy<Value = Value>, least_answered: usize) {
    let server = Server::start();
    let answered = std::cell::Cell::new(0);
    let config = Config { failure_persistence: None, ..Config::with_cases(cases) };
    TestRunner::new(config)
        .run(&strategy, |request| {
            for path in paths {
                let response = server.post(path, request.to_string());
                let status = response.status().as_u16();
                let text = response.text().unwrap();
                match status {
                    200 => {
                        answered.set(answered.get() + 1);
                        let answer: Value = serde_json::from_str(&text).unwrap();
                        check(&request, answer.as_object().unwrap())?;
                    }
                    422 => prop_assert!(text.contains("\"errors\":[{"), "{text}"),
                    other => return Err(TestCaseError::fail(format!("{path}: {other} {text}"))),
                }
            }
            Ok(())
        })
        .unwrap_or_else(|error| panic!("{error}"));
    assert!(answered.get() >= least_answered, "only {} requests were answered", answered.get());
}

#[test]
fn every_answer_is_a_number_or_null_with_a_reason() {
    for_all(&["/v1/radiance", "/v1/brdf"], 1500, request(), 500);
}

/// A value of any kind, for any field.
fn anything() -> impl Strategy<Value = Value> {
    let leaf = prop_oneof![
        Just(Value::Null),
        any::<bool>().prop_map(Value::from),
        any::<f64>().prop_map(|value| json!(value)),
        any::<i64>().prop_map(Value::from),
        ".{0,12}".prop_map(Value::from),
        proptest::sample::select(vec!["NaN", "1e400", "-Infinity", "auto", "smith", "perfect_conductor"])
            .prop_map(Value::from),
    ];
    leaf.prop_recursive(3, 24, 6, |inner| {
        prop_oneof![
            proptest::collection::vec(inner.clone(), 0..6).prop_map(Value::from),
            proptest::collection::vec((".{0,6}", inner), 0..4)
                .prop_map(|entries| Value::Object(entries.into_iter().collect())),
        ]
    })
}

/// A request with one to three of its fields replaced or added.
fn broken() -> impl Strategy<Value = Value> {
    let places = vec![
        "/model",
        "/surface",
        "/surface/medium",
        "/surface/rms_height_um",
        "/surface/unknown",
        "/illumination",
        "/illumination/polarization",
        "/sensor",
        "/sensor/footprint_um2",
        "/geometry",
        "/geometry/theta_i_deg",
        "/geometry/phi_r_deg",
        "/components",
        "/accuracy",
        "/accuracy/method",
        "/output",
        "/output/log10",
        "/x",
    ];
    let change = (proptest::sample::select(places), anything());
    (request(), proptest::collection::vec(change, 1..4)).prop_map(|(mut request, changes)| {
        for (place, value) in changes {
            let (parent, name) = place.rsplit_once('/').unwrap();
            if let Some(Value::Object(object)) = request.pointer_mut(parent) {
                object.insert(name.to_owned(), value);
            }
        }
        request
    })
}

#[test]
fn whatever_is_sent_is_answered_or_refused() {
    let server = Server::start();
    let config = Config { failure_persistence: None, ..Config::with_cases(1500) };
    TestRunner::new(config)
        .run(&broken(), |request| {
            for path in ["/v1/radiance", "/v1/plan", "/v1/diagrams", "/v1/image-irradiance"] {
                let response = server.post(path, request.to_string());
                let status = response.status().as_u16();
                prop_assert!(status == 200 || status == 422, "{path}: {status} {}", response.text().unwrap());
            }
            Ok(())
        })
        .unwrap_or_else(|error| panic!("{error}"));
}

#[test]
fn whatever_bytes_are_sent_are_answered_or_refused() {
    let server = Server::start();
    let cut = (request(), any::<proptest::sample::Index>(), any::<u8>()).prop_map(|(request, at, byte)| {
        let mut bytes = request.to_string().into_bytes();
        let index = at.index(bytes.len());
        bytes[index] = byte;
        bytes
    });
    let bytes = prop_oneof![proptest::collection::vec(any::<u8>(), 0..200), cut];
    let config = Config { failure_persistence: None, ..Config::with_cases(1500) };
    TestRunner::new(config)
        .run(&bytes, |bytes| {
            let status = server.post("/v1/radiance", bytes).status().as_u16();
            prop_assert!([200, 400, 422].contains(&status), "{status}");
            Ok(())
        })
        .unwrap_or_else(|error| panic!("{error}"));
}
