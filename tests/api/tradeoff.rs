//! `/v1/tradeoff`: every method's true error, bound and time in one scene.

use crate::server::{Server, errors, problem, scene};
use serde_json::{Value, json};

fn rows(answer: &Value) -> &Vec<Value> {
    answer["rows"].as_array().unwrap()
}

fn row<'a>(answer: &'a Value, method: &str, tolerance: f64) -> &'a Value {
    rows(answer)
        .iter()
        .find(|row| row["method"] == method && row["relative_tolerance"] == tolerance)
        .unwrap_or_else(|| panic!("{method} {tolerance}: {answer}"))
}

fn numbers(value: &Value) -> Vec<f64> {
    value.as_array().unwrap().iter().map(|number| number.as_f64().unwrap()).collect()
}

#[test]
fn every_method_and_tolerance_has_its_row() {
    let server = Server::start();
    let mut body = scene();
    body["accuracy"] = json!({"relative_tolerance": 1e-4});
    let answer = server.answer("/v1/tradeoff", &body);
    let names: Vec<_> = rows(&answer)
        .iter()
        .map(|row| (row["method"].as_str().unwrap(), row["relative_tolerance"].as_f64().unwrap()))
        .collect();
    let auto = [1e-1, 1e-3, 1e-4, 1e-6, 1e-9, 1e-12].map(|tolerance| ("auto", tolerance));
    let named = ["series", "paper", "uniform", "smooth", "rough"].map(|method| (method, 1e-4));
    assert_eq!(names, [auto.as_slice(), named.as_slice()].concat());
    let requested: Vec<_> = rows(&answer).iter().filter(|row| row["as_requested"] == true).collect();
    assert_eq!(requested, [row(&answer, "auto", 1e-4)]);
    assert_eq!(answer["auto"], row(&answer, "auto", 1e-4)["methods"]);

    let floor = answer["reference"]["largest_relative_error_bound"].as_f64().unwrap();
    for row in rows(&answer) {
        let number = |name: &str| row[name].as_f64().unwrap_or_else(|| panic!("{name}: {row}"));
        let bound = number("largest_relative_error_bound");
        // What lies within the reference's own error is shown as that.
        assert!(number("largest_relative_error") <= bound.max(floor), "{row}");
        assert!(number("median_relative_error") <= number("largest_relative_error"), "{row}");
        assert_eq!(row["keeps_tolerance"], bound <= number("relative_tolerance"), "{row}");
        assert!(number("nanoseconds_per_direction") > 0.0 && number("time_ratio") >= 1.0, "{row}");
        assert!(number("repeats") >= 1.0, "{row}");
        let counts = row["methods"].as_object().unwrap().values().map(|count| count.as_u64().unwrap());
        assert_eq!(counts.sum::<u64>(), 2, "{row}");
        if row["method"] == "auto" {
            assert_eq!(row["keeps_tolerance"], true, "{row}");
        }
    }
    assert!(rows(&answer).iter().any(|row| row["time_ratio"] == 1.0));
}

#[test]
fn the_errors_are_those_of_the_radiances() {
    let server = Server::start();
    let mut body = scene();
    body["geometry"]["theta_r_deg"] = json!([-50, 0, 30, 50, 70]);
    let answer = server.answer("/v1/tradeoff", &body);
    let mut totals = |method: &str| {
        body["accuracy"] = json!({"method": method});
        let answer = server.answer("/v1/radiance", &body);
        (numbers(&answer["total"]), numbers(&answer["relative_error_bound"]))
    };
    let (exact, floor) = totals("series");
    for method in ["smooth", "rough", "uniform"] {
        let (values, bounds) = totals(method);
        let mut errors: Vec<_> = values
            .iter()
            .zip(&exact)
            .zip(&floor)
            .map(|((value, exact), floor)| ((value - exact) / exact).abs().max(*floor))
            .collect();
        errors.sort_by(f64::total_cmp);
        let row = row(&answer, method, 1e-9);
        assert_eq!(row["largest_relative_error"], errors[4], "{method}");
        assert_eq!(row["median_relative_error"], errors[2], "{method}");
        assert_eq!(row["largest_relative_error_bound"], bounds.into_iter().fold(0.0, f64::max), "{method}");
    }
}

#[test]
fn the_row_that_is_asked_for_may_be_a_named_method() {
    let mut body = scene();
    body["accuracy"] = json!({"method": "paper"});
    let answer = Server::start().answer("/v1/tradeoff", &body);
    assert_eq!(row(&answer, "paper", 1e-9)["as_requested"], true);
    assert_eq!(row(&answer, "auto", 1e-9)["as_requested"], false);
    assert_eq!(answer["auto"], row(&answer, "auto", 1e-9)["methods"]);
}

#[test]
fn of_many_directions_64_are_measured() {
    let mut body = scene();
    let zeniths: Vec<_> = (0..1000).map(|i| f64::from(i) * 0.08).collect();
    body["geometry"]["theta_r_deg"] = json!(zeniths);
    let answer = Server::start().answer("/v1/tradeoff", &body);
    let used = numbers(&answer["directions_used"]);
    assert_eq!((used.len(), used[0], used[63]), (64, 0.0, 999.0));
    assert!(used.windows(2).all(|pair| (15.0..=16.0).contains(&(pair[1] - pair[0]))), "{used:?}");
    assert_eq!(answer["directions"], 1000);
    assert_eq!(answer["directions_compared"], 64);
}

#[test]
fn a_scene_that_needs_no_series_has_one_row() {
    let server = Server::start();
    for (model, components) in [
        ("torrance_sparrow", json!("auto")),
        ("lambertian", json!("auto")),
        ("unified", json!(["diffuse_lobe", "specular_lobe"])),
    ] {
        let body = json!({
            "model": model,
            "surface": {"rms_height_um": 0.2, "correlation_length_um": 4, "diffuse_albedo": 0.3},
            "illumination": {"wavelength_um": 0.55}, "components": components,
            "geometry": {"theta_i_deg": 30, "theta_r_deg": [0, 30]}
        });
        let answer = server.answer("/v1/tradeoff", &body);
        assert_eq!(rows(&answer).len(), 1, "{answer}");
        let row = row(&answer, "closed_form", 1e-9);
        assert_eq!((&row["as_requested"], &row["time_ratio"]), (&json!(true), &json!(1.0)));
        // An error is not shown below the reference's bound. The bound of a batch is wider, at most as its allowance for
        // (α/σ_α)² is: 24 to 14.
        let [error, bound] = ["largest_relative_error", "largest_relative_error_bound"]
            .map(|name| row[name].as_f64().unwrap());
        assert!(error <= bound && bound <= 24.0 / 14.0 * error, "{error} {bound}");
        assert_eq!(answer["reference"]["method"], "closed_form");
        assert_eq!(answer["auto"], json!({"closed_form": 2}));
    }
}

#[test]
fn what_has_no_finite_total_is_not_compared() {
    let server = Server::start();
    let mut body = scene();
    body["geometry"]["theta_r_deg"] = json!([30, 90]);
    let answer = server.answer("/v1/tradeoff", &body);
    assert_eq!((&answer["directions_compared"], &answer["directions_used"]), (&json!(1), &json!([0, 1])));
    assert!(row(&answer, "auto", 1e-9)["largest_relative_error"].is_number());
    body["geometry"]["theta_r_deg"] = json!(90);
    let answer = server.answer("/v1/tradeoff", &body);
    assert_eq!(answer["directions_compared"], 0);
    assert!(answer["reference"]["largest_relative_error_bound"].is_null());
    for row in rows(&answer) {
        for name in [
            "largest_relative_error",
            "median_relative_error",
            "largest_relative_error_bound",
            "keeps_tolerance",
        ] {
            assert!(row[name].is_null(), "{name}: {row}");
        }
    }
}

#[test]
fn what_is_wrong_is_what_is_wrong_with_a_radiance() {
    let server = Server::start();
    let mut faults = vec![json!({}), json!([]), json!({"model": "phong", "geometry": {"theta_i_deg": 100}})];
    for (pointer, value) in [
        ("/surface/rms_height_um", json!(-1)),
        ("/geometry/theta_r_deg", json!([1, "x", 95])),
        ("/geometry/phi_r_deg", json!([1, 2, 3])),
    ] {
        let mut body = scene();
        let (parent, name) = pointer.rsplit_once('/').unwrap();
        body.pointer_mut(parent).unwrap()[name] = value;
        body["tolerance"] = json!(1);
        faults.push(body);
    }
    for body in faults {
        let [expected, got] = ["/v1/radiance", "/v1/tradeoff"]
            .map(|path| errors(&problem(server.post(path, body.to_string()), 422)));
        assert_eq!(got, expected, "{body}");
    }
    problem(server.post("/v1/tradeoff", "{"), 400);
    problem(server.get("/v1/tradeoff"), 405);
}

#[test]
fn many_at_once_are_all_measured() {
    let server = Server::start();
    std::thread::scope(|scope| {
        let asked: Vec<_> =
            (0..8).map(|_| scope.spawn(|| rows(&server.answer("/v1/tradeoff", &scene())).len())).collect();
        for answer in asked {
            assert_eq!(answer.join().unwrap(), 10);
        }
    });
}
