//! The `OpenAPI` document, the reference, and what both promise.

use crate::server::Server;
use serde_json::Value;
use std::collections::BTreeSet;
use std::path::Path;
use std::process::Command;

#[test]
fn the_committed_document_is_the_one_served() {
    let committed = Path::new(env!("CARGO_MANIFEST_DIR")).join("openapi/openapi.json");
    let printed = Command::new(env!("CARGO_BIN_EXE_reflectance")).arg("openapi").output().unwrap();
    assert!(printed.status.success());
    let printed = String::from_utf8(printed.stdout).unwrap();
    if std::env::var_os("UPDATE_OPENAPI").is_some() {
        std::fs::write(&committed, &printed).unwrap();
    }
    assert_eq!(Server::start().get("/openapi.json").text().unwrap(), printed);
    let kept = std::fs::read_to_string(&committed).unwrap();
    // The texts are long: say that they differ rather than print both.
    assert!(
        kept == printed,
        "openapi/openapi.json is stale: UPDATE_OPENAPI=1 cargo test --test api rewrites it"
    );
}

#[test]
fn the_document_is_complete() {
    let document: Value = Server::start().get("/openapi.json").json().unwrap();
    assert_eq!(document["openapi"].as_str().map(|version| &version[..3]), Some("3.1"));
    assert!(document["info"]["license"]["name"].as_str().is_some_and(|name| !name.is_empty()));
    let mut names = BTreeSet::new();
    for (path, item) in document["paths"].as_object().unwrap() {
        for (method, operation) in item.as_object().unwrap() {
            assert!(operation["summary"].is_string(), "{method} {path} has no summary");
            let name = operation["operationId"].as_str().expect("a name for generated clients");
            assert!(
                names.insert(name.to_owned()),
                "{method} {path} is called {name} as another operation is"
            );
            for (status, response) in operation["responses"].as_object().unwrap() {
                let description = response["description"].as_str().unwrap_or_default();
                assert!(!description.is_empty(), "{method} {path} {status} has no description");
            }
        }
    }
    let text = document.to_string();
    for reference in text.split("\"$ref\":\"#/components/schemas/").skip(1) {
        let name = reference.split('"').next().unwrap();
        assert!(document["components"]["schemas"].get(name).is_some(), "{name} is referred to but not there");
    }
}

#[test]
fn ranges_in_the_document_are_the_ones_in_force() {
    let server = Server::start();
    let document: Value = server.get("/openapi.json").json().unwrap();
    let property = |schema: &str, name: &str| &document["components"]["schemas"][schema]["properties"][name];
    for (schema, name) in
        [("Surface", "rms_height_um"), ("Surface", "facet_slope_deg"), ("Surface", "diffuse_albedo")]
    {
        let bounds = property(schema, name);
        for (end, step) in [("minimum", f64::next_down as fn(f64) -> f64), ("maximum", f64::next_up)] {
            let bound = bounds[end].as_f64().unwrap_or_else(|| panic!("{name} has no {end}"));
            let status = |value: f64| {
                let body = serde_json::json!({
                    "model": "torrance_sparrow", "surface": {"facet_slope_deg": 5, name: value},
                    "illumination": {}, "geometry": {"theta_i_deg": 1, "theta_r_deg": 2}
                });
                server.post("/v1/radiance", body.to_string()).status().as_u16()
            };
            assert_eq!(status(bound), 200, "{name} {end} {bound}");
            assert_eq!(status(step(bound)), 422, "beyond {name} {end} {bound}");
        }
    }
}

#[test]
fn the_reference_needs_no_other_server() {
    let server = Server::start();
    let page = server.get("/docs/");
    assert_eq!(page.status(), 200);
    let mut texts = vec![page.text().unwrap()];
    for part in ["swagger-ui-bundle.js", "swagger-ui.css", "swagger-initializer.js"] {
        let response = server.get(&format!("/docs/{part}"));
        assert_eq!(response.status(), 200, "{part}");
        if part == "swagger-initializer.js" {
            texts.push(response.text().unwrap());
        }
    }
    for text in &texts {
        assert!(!text.contains("src=\"http") && !text.contains("href=\"http"), "{text}");
    }
    assert!(texts[1].contains("/openapi.json"), "{}", texts[1]);
}

#[test]
fn the_reference_calls_nobody_else() {
    let script = Server::start().get("/docs/swagger-initializer.js").text().unwrap();
    assert!(script.contains(r#""validatorUrl": "none""#), "{script}");
}
