//! Every example in the document is a request that the service answers.

use crate::server::Server;
use serde_json::Value;

#[test]
fn every_example_of_a_body_is_answered() {
    let server = Server::start();
    let document: Value = server.get("/openapi.json").json().unwrap();
    let mut sent = 0;
    for (path, item) in document["paths"].as_object().unwrap() {
        let Some(body) = item["post"].get("requestBody") else { continue };
        let examples = body["content"]["application/json"]["examples"].as_object();
        for (name, example) in examples.unwrap_or_else(|| panic!("{path} has no example")) {
            let answer = server.answer(path, &example["value"]);
            // What is asked for, or in how many directions.
            let known = answer["quantity"].is_string() || answer["directions"].is_u64();
            assert!(known, "{path} {name}: {answer}");
            sent += 1;
        }
    }
    assert!(sent >= 12, "{sent} examples");
}

#[test]
fn every_example_of_a_parameter_is_answered() {
    let server = Server::start();
    let document: Value = server.get("/openapi.json").json().unwrap();
    let mut sent = 0;
    for (path, item) in document["paths"].as_object().unwrap() {
        let Some(parameters) = item["get"]["parameters"].as_array() else { continue };
        let mut link = path.clone();
        let mut query = Vec::new();
        for parameter in parameters {
            let Some(value) = parameter.get("example").map(plain) else { continue };
            let name = parameter["name"].as_str().unwrap();
            if parameter["in"] == "path" {
                link = link.replace(&format!("{{{name}}}"), &value);
            } else {
                query.push((name, value));
            }
        }
        let response = server.request("GET", &link).query(&query).send().unwrap();
        assert_eq!(response.status(), 200, "{link} {query:?}: {}", response.text().unwrap());
        sent += 1;
    }
    assert!(sent >= 3, "{sent} examples");
}

/// A value as it stands in a query.
fn plain(value: &Value) -> String {
    match value {
        Value::String(text) => text.clone(),
        Value::Array(values) => values.iter().map(plain).collect::<Vec<_>>().join(","),
        other => other.to_string(),
    }
}

#[test]
fn the_request_suggested_at_the_start_is_answered() {
    let server = Server::start();
    let line = server.greeting[1].trim();
    let body = line.split_once("-d '").and_then(|(_, rest)| rest.strip_suffix('\'')).expect("a body");
    assert!(line.contains(&format!("{}/v1/radiance", server.url)), "{line}");
    let answer = server.answer("/v1/radiance", &serde_json::from_str(body).unwrap());
    assert_eq!(answer["total"].as_array().unwrap().len(), 4);
}
