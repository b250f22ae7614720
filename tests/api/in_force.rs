//! What the service says of its limits and of its problems is what it does.

use crate::server::{Server, problem, scene};
use serde_json::{Value, json};

fn diagram(points: usize, method: &str) -> Value {
    json!({
        "model": "beckmann_spizzichino", "surface": {"rms_height_um": 10, "correlation_length_um": 40},
        "illumination": {"wavelength_um": 0.5}, "accuracy": {"method": method}, "sweep": "theta_r_deg",
        "from_deg": -90, "to_deg": 90, "points": points, "at_deg": [10, 20]
    })
}

#[test]
fn every_limit_is_in_the_message_of_its_error_and_in_the_list() {
    let flags = [
        ("--body-limit-bytes", "60000"),
        ("--expanded-body-limit-bytes", "70000"),
        ("--direction-limit", "4321"),
        ("--row-limit", "300007"),
        ("--incidence-limit", "77"),
        ("--cpu-limit-seconds", "0.25"),
    ];
    let server = Server::with(&flags.map(|(flag, value)| [flag, value]).concat());
    let list: Value = server.get("/v1/limits").json().unwrap();
    let mut directions = scene();
    directions["geometry"]["theta_r_deg"] = vec![1; 4322].into();
    let mut incidences = scene();
    incidences.as_object_mut().unwrap().remove("geometry");
    incidences["theta_i_deg"] = vec![1; 78].into();
    let packed = zstd::encode_all(vec![b' '; 70_001].as_slice(), 1).unwrap();
    for (name, path, body) in [
        ("body_limit_bytes", "/v1/radiance", vec![b' '; 60_001]),
        ("expanded_body_limit_bytes", "/v1/radiance", packed),
        ("direction_limit", "/v1/radiance", directions.to_string().into_bytes()),
        ("incidence_limit", "/v1/albedo", incidences.to_string().into_bytes()),
        ("row_limit", "/v1/diagrams", diagram(150_004, "auto").to_string().into_bytes()),
        ("cpu_limit_seconds", "/v1/diagrams", diagram(150_003, "series").to_string().into_bytes()),
    ] {
        let limits = list["limits"].as_array().unwrap();
        let limit = limits.iter().find(|limit| limit["name"] == name).unwrap();
        let (flag, value) = flags.into_iter().find(|(flag, _)| limit["flag"] == *flag).unwrap();
        assert_eq!(limit["value"].to_string(), value, "{flag}");
        let request = server.request("POST", path).header("content-type", "application/json").body(body);
        let coding = if name.starts_with("expanded") { "zstd" } else { "identity" };
        let response = request.header("content-encoding", coding).send().unwrap();
        let document = problem(response, u16::try_from(limit["status"].as_u64().unwrap()).unwrap());
        assert_eq!(document["type"], limit["type"], "{name}");
        assert!(document.to_string().contains(value), "{name}: {document}");
    }
}

#[test]
fn a_number_is_accepted_exactly_within_its_range() {
    let server = Server::start();
    let list: Value = server.get("/v1/limits").json().unwrap();
    let ranges = list["ranges"].as_array().unwrap();
    let status = |name: &str, value: f64| {
        let base = "/v1/diagrams?model=lambertian&sweep=theta_i_deg&from_deg=0&to_deg=90&points=2&at_deg=0";
        let mut rest: Vec<_> = base.split('&').filter(|part| !part.starts_with(name)).collect();
        if name == "k" {
            rest.push("n=1");
        }
        let rest = rest.join("&");
        server.get(&format!("{rest}&{name}={value}")).status().as_u16()
    };
    for name in [
        "rms_height_um",
        "facet_slope_deg",
        "n",
        "k",
        "irradiance",
        "specular_scale",
        "relative_tolerance",
        "phi_r_deg",
        "at_deg",
    ] {
        let range =
            ranges.iter().find(|range| range["of"] == "DiagramRequest" && range["name"] == name).unwrap();
        let (least, most) = (range["minimum"].as_f64().unwrap(), range["maximum"].as_f64().unwrap());
        assert_eq!((status(name, least), status(name, most)), (200, 200), "{name}");
        assert_eq!((status(name, least.next_down()), status(name, most.next_up())), (422, 422), "{name}");
    }
}

#[test]
fn the_type_of_a_problem_leads_to_what_it_means() {
    let server = Server::start();
    let list: Value = server.get("/problems").json().unwrap();
    for listed in list["problems"].as_array().unwrap() {
        let page: Value = server.get(listed["type"].as_str().unwrap()).json().unwrap();
        assert_eq!(&page, listed);
    }
    let document = problem(server.get("/v1/roughness"), 422);
    let page: Value = server.get(document["type"].as_str().unwrap()).json().unwrap();
    for member in ["type", "title", "status"] {
        assert_eq!(page[member], document[member]);
    }
    let unknown = problem(server.get("/problems/nothing"), 404);
    assert!(unknown["detail"].as_str().unwrap().contains("content-too-large"), "{unknown}");
}
