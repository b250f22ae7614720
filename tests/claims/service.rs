//! The service's own router, asked in this process as a client would ask it.

use axum::Router;
use axum::body::Body;
use axum::http::{Request, StatusCode, header};
use clap::Parser as _;
use http_body_util::BodyExt as _;
use reflectance::config::Cli;
use reflectance::http::router;
use serde_json::{Map, Value, json};
use std::sync::LazyLock;
use tokio::runtime::Runtime;
use tower_service::Service as _;

/// The angles of the captions' curves, degrees (errata E28).
pub(crate) const ANGLES: [f64; 4] = [10.0, 30.0, 45.0, 60.0];

struct Service {
    runtime: Runtime,
    router: Router,
}

static SERVICE: LazyLock<Service> = LazyLock::new(|| {
    let runtime = Runtime::new().expect("runtime");
    Service { runtime, router: router(&Cli::parse_from(["reflectance"]).config) }
});

fn send(request: Request<Body>) -> (StatusCode, Value) {
    SERVICE.runtime.block_on(async {
        let response = SERVICE.router.clone().call(request).await.expect("infallible");
        let status = response.status();
        let body = response.into_body().collect().await.expect("a body").to_bytes();
        (status, serde_json::from_slice(&body).expect("JSON"))
    })
}

/// The status and the answer of a GET.
pub(crate) fn get(link: &str) -> (StatusCode, Value) {
    send(Request::get(link).body(Body::empty()).expect("a request"))
}

/// The picture of a link.
pub(crate) fn drawn(link: &str) -> String {
    let request = Request::get(link).header(header::ACCEPT, "image/svg+xml").body(Body::empty());
    SERVICE.runtime.block_on(async {
        let response = SERVICE.router.clone().call(request.expect("a request")).await.expect("infallible");
        assert_eq!(response.status(), StatusCode::OK, "{link}");
        let body = response.into_body().collect().await.expect("a body").to_bytes();
        String::from_utf8(body.to_vec()).expect("text")
    })
}

/// The answer to a POST, which has to succeed.
pub(crate) fn post(path: &str, body: &Value) -> Value {
    let request = Request::post(path)
        .header(header::CONTENT_TYPE, "application/json")
        .body(Body::from(body.to_string()))
        .expect("a request");
    let (status, answer) = send(request);
    assert_eq!(status, StatusCode::OK, "{answer}");
    answer
}

/// Numbers of a JSON array; null is NaN.
pub(crate) fn numbers(array: &Value) -> Vec<f64> {
    let array = array.as_array().expect("an array");
    array.iter().map(|value| value.as_f64().unwrap_or(f64::NAN)).collect()
}

/// One table: an axis and a curve for each fixed angle.
pub(crate) struct Diagram {
    pub(crate) axis: Vec<f64>,
    pub(crate) curves: Vec<Curve>,
}

/// One curve.
pub(crate) struct Curve {
    pub(crate) at: f64,
    axis: Vec<f64>,
    columns: Map<String, Value>,
}

impl Diagram {
    fn parse(value: &Value) -> Self {
        let axis = numbers(&value["axis"]["values"]);
        let series = value["series"].as_array().expect("series");
        let curves = series.iter().map(|curve| Curve {
            at: curve["at_deg"].as_f64().expect("a fixed angle"),
            axis: axis.clone(),
            columns: curve.as_object().expect("a curve").clone(),
        });
        Self { curves: curves.collect(), axis }
    }

    /// The curve of this fixed angle.
    pub(crate) fn curve(&self, at: f64) -> &Curve {
        self.curves.iter().find(|curve| curve.at == at).expect("a curve at this angle")
    }
}

impl Curve {
    /// A column by its name in the answer.
    pub(crate) fn column(&self, name: &str) -> Vec<f64> {
        numbers(&self.columns[name])
    }

    /// A column's value at a point of the axis.
    pub(crate) fn value(&self, name: &str, angle: f64) -> f64 {
        let index = self.axis.iter().position(|&a| a == angle).expect("a point of the axis");
        self.column(name)[index]
    }

    /// A column's value in the specular direction.
    pub(crate) fn specular(&self, name: &str) -> f64 {
        self.value(name, self.at)
    }

    /// The codes of its diagnostics.
    pub(crate) fn diagnostics(&self) -> Vec<&str> {
        let all = self.columns["diagnostics"].as_array().expect("diagnostics");
        all.iter().map(|diagnostic| diagnostic["code"].as_str().expect("a code")).collect()
    }
}

/// The tables of a figure of the report, with logarithms.
pub(crate) fn figure(id: &str) -> Vec<Diagram> {
    let (status, answer) = get(&format!("/v1/figures/{id}?log10=true"));
    assert_eq!(status, StatusCode::OK, "{answer}");
    let panels = answer["panels"].as_array().expect("panels");
    panels.iter().map(|panel| Diagram::parse(&panel["diagram"])).collect()
}

/// A Beckmann-Spizzichino scene of σ_h, T, λ with the patch of the figures (errata E28).
pub(crate) fn heights([sigma_h, t, lambda]: [f64; 3]) -> Value {
    json!({
        "model": "beckmann_spizzichino",
        "surface": {"rms_height_um": sigma_h, "correlation_length_um": t},
        "illumination": {"wavelength_um": lambda},
        "sensor": {"footprint_um2": 400, "patch_half_x_um": 10, "patch_half_y_um": 10},
        "components": ["specular_lobe", "specular_spike"],
    })
}

/// The lobe alone, by the rough form (49). It depends on σ_h/T only, its scale aside.
pub(crate) fn rough(ratio: f64) -> Value {
    with_method(lobe(heights([ratio, 1.0, 0.01])), "rough")
}

/// The lobe of a scene, without its spike.
pub(crate) fn lobe(mut scene: Value) -> Value {
    scene["components"] = json!(["specular_lobe"]);
    scene
}

/// The scene with its lobe evaluated as named.
pub(crate) fn with_method(mut scene: Value, method: &str) -> Value {
    scene["accuracy"] = json!({"method": method});
    scene
}

/// A Torrance-Sparrow lobe of σ_α in degrees with c·a_f = 1 and F = G = 1.
pub(crate) fn facets(sigma_alpha: f64) -> Value {
    json!({
        "model": "torrance_sparrow",
        "surface": {"facet_slope_deg": sigma_alpha, "specular_scale": 1, "shadowing": "none"},
        "illumination": {"irradiance": 1},
        "components": ["specular_lobe"],
    })
}

/// The same with the G of (65).
pub(crate) fn shadowed_facets(sigma_alpha: f64) -> Value {
    let mut scene = facets(sigma_alpha);
    scene["surface"]["shadowing"] = json!("v_groove");
    scene
}

/// Which angle runs.
#[derive(Clone, Copy)]
pub(crate) enum Over {
    Viewer,
    Source,
}

/// A diagram of `points` points from `from` to `to` with logarithms.
pub(crate) fn diagram(
    scene: &Value,
    over: Over,
    (from, to): (f64, f64),
    points: usize,
    at: &[f64],
) -> Diagram {
    let mut body = scene.clone();
    let sweep = match over {
        Over::Viewer => "theta_r_deg",
        Over::Source => "theta_i_deg",
    };
    let division = json!({
        "sweep": sweep, "from_deg": from, "to_deg": to, "points": points, "at_deg": at,
        "output": {"log10": true},
    });
    let fields = body.as_object_mut().expect("an object");
    fields.extend(division.as_object().expect("an object").clone());
    Diagram::parse(&post("/v1/diagrams", &body))
}

/// A diagram from -89.5° to 89.5° in steps of 0.5°, as the figures have it.
pub(crate) fn whole(scene: &Value, over: Over, at: &[f64]) -> Diagram {
    diagram(scene, over, (-89.5, 89.5), 359, at)
}

/// A column's value for one pair of directions.
pub(crate) fn point(scene: &Value, name: &str, theta_i: f64, theta_r: f64) -> f64 {
    diagram(scene, Over::Viewer, (theta_r, theta_r), 1, &[theta_i]).curves[0].value(name, theta_r)
}

/// The angle of the lobe's maximum next to the specular angle; none where the lobe rises all the way to grazing.
pub(crate) fn peak(scene: &Value, over: Over, at: f64) -> Option<f64> {
    peak_beyond(scene, over, at, at - 5.0)
}

/// The angle of the first maximum beyond an angle of the sweep, to 1e-5 degrees.
pub(crate) fn peak_beyond(scene: &Value, over: Over, at: f64, mut from: f64) -> Option<f64> {
    let (mut to, mut points) = (89.5, 401);
    loop {
        let diagram = diagram(scene, over, (from, to), points, &[at]);
        let values = diagram.curves[0].column("specular_lobe");
        let inner = (1..points - 1).find(|&i| values[i] > values[i - 1] && values[i] >= values[i + 1])?;
        (from, to) = (diagram.axis[inner - 1], diagram.axis[inner + 1]);
        if to - from < 2e-5 {
            return Some(diagram.axis[inner]);
        }
        points = 51;
    }
}

/// The argument in `(low, high)` at which an increasing function passes 0.
pub(crate) fn crossing(mut low: f64, mut high: f64, function: impl Fn(f64) -> f64) -> f64 {
    assert!(function(low) < 0.0 && function(high) > 0.0, "no sign change");
    // 2⁻²⁶ of the interval is finer than any quoted digit.
    for _ in 0..26 {
        let middle = 0.5 * (low + high);
        if function(middle) < 0.0 { low = middle } else { high = middle }
    }
    0.5 * (low + high)
}

/// Width of a component's lobe at half of its specular value, degrees.
pub(crate) fn full_width(scene: &Value, name: &str, at: f64, reach: f64) -> f64 {
    let half = 0.5 * point(scene, name, at, at);
    let right = crossing(at, at + reach, |angle| half - point(scene, name, at, angle));
    let left = crossing(-at, reach - at, |angle| half - point(scene, name, at, -angle));
    right + left
}
