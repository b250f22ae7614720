//! The planner against the evaluation that it plans.

use crate::scenes::Scene;
use crate::service::{Answer, post};
use serde_json::Value;

fn ask(path: &str, request: &Value) -> Answer {
    post(path, "application/json", request.to_string().into_bytes())
}

/// A number that is no less than 0, or null for one that is not finite.
fn size(value: &Value) -> f64 {
    let size = value.as_f64().unwrap_or(f64::INFINITY);
    assert!(value.is_null() || value.is_f64(), "{value}");
    assert!(size >= 0.0, "{value}");
    size
}

/// Plans a scene and evaluates it. Says whether the scene was accepted.
pub fn plan(scene: &Scene) -> bool {
    let (request, count) = scene.request();
    let plan = ask("/v1/plan", &request);
    let radiance = ask("/v1/radiance", &request);
    assert_eq!(plan.status, radiance.status, "{request}");
    if plan.status != 200 {
        assert_eq!(plan.json()["errors"], radiance.json()["errors"], "{request}");
        return false;
    }
    let (plan, radiance) = (plan.json(), radiance.json());
    assert_eq!((&plan["directions"], &plan["sampled"]), (&count.into(), &count.into()), "{request}");
    let counted: u64 = plan["methods"].as_object().expect("counts").values().filter_map(Value::as_u64).sum();
    assert_eq!(counted, count as u64, "{request} {plan}");
    for name in ["per_direction", "full_series", "relative_to_full_series"] {
        assert!(size(&plan["cost"][name]).is_finite(), "{request} {plan}");
    }

    // What is planned is what is done.
    let planned = plan["components"].as_array().expect("a list");
    for name in ["diffuse_lobe", "specular_lobe", "specular_spike"] {
        let column = radiance.get(name).map(|column| column.as_array().expect("a list").len());
        assert_eq!(column, planned.contains(&name.into()).then_some(count), "{request} {plan} {radiance}");
    }
    assert_eq!(plan["omitted"], radiance["omitted"], "{request}");
    assert_eq!(plan["methods"], radiance["methods"], "{request}");
    let bounds = radiance["relative_error_bound"].as_array().expect("a list");
    assert_eq!((bounds.len(), radiance["total"].as_array().expect("a list").len()), (count, count));
    // Where a total diverges it has no error.
    let largest = bounds.iter().map(size).filter(|bound| bound.is_finite()).fold(0.0, f64::max);
    let promised = size(&plan["relative_error_bound"]);
    // An answer's column is rounded once more.
    assert!(largest <= promised * (1.0 + 1e-9) + f64::EPSILON, "{largest} {promised} {request} {plan}");
    true
}
