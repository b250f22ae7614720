//! Diagrams and figures as JSON and CSV.

use crate::server::Server;
use serde_json::{Value, json};

const LINK: &str = "/v1/diagrams?model=torrance_sparrow&facet_slope_deg=12&n=1.5&diffuse_albedo=0.2&sweep=theta_r_deg\
    &from_deg=-60&to_deg=60&step_deg=20&at_deg=10,40&log10=true";

fn csv(server: &Server, link: &str) -> (String, Vec<Vec<String>>) {
    let response = server.request("GET", link).header("accept", "text/csv").send().unwrap();
    assert_eq!(response.status(), 200);
    assert!(response.headers()["content-type"].to_str().unwrap().starts_with("text/csv"));
    let text = response.text().unwrap();
    let mut reader = csv::ReaderBuilder::new().from_reader(text.as_bytes());
    let header = reader.headers().unwrap().iter().collect::<Vec<_>>().join(",");
    (header, reader.records().map(|row| row.unwrap().iter().map(str::to_owned).collect()).collect())
}

#[test]
fn json_and_csv_hold_the_same_numbers() {
    let server = Server::start();
    let diagram: Value = server.get(LINK).json().unwrap();
    let (header, rows) = csv(&server, LINK);
    assert_eq!(
        header,
        "theta_i_deg,theta_r_deg,phi_r_deg,total_W_m-2_sr-1,diffuse_lobe_W_m-2_sr-1,specular_lobe_W_m-2_sr-1,\
         log10_total,log10_diffuse_lobe,log10_specular_lobe,relative_error_bound"
    );
    assert_eq!(diagram["axis"]["values"].as_array().unwrap().len(), 7);
    let mut rows = rows.iter();
    for series in diagram["series"].as_array().unwrap() {
        for (index, position) in diagram["axis"]["values"].as_array().unwrap().iter().enumerate() {
            let row = rows.next().unwrap();
            assert_eq!(row[0], series["at_deg"].to_string());
            assert_eq!(row[1], position.to_string());
            for (column, name) in
                [(3, "total"), (5, "specular_lobe"), (6, "log10_total"), (9, "relative_error_bound")]
            {
                assert_eq!(row[column], series[name][index].to_string(), "{name}");
            }
        }
    }
    assert!(rows.next().is_none());
}

#[test]
fn the_link_and_the_body_answer_the_same() {
    let server = Server::start();
    let body = json!({
        "model": "torrance_sparrow", "surface": {"facet_slope_deg": 12, "medium": {"n": 1.5}, "diffuse_albedo": 0.2}, "illumination": {},
        "sweep": "theta_r_deg", "from_deg": -60, "to_deg": 60, "step_deg": 20, "at_deg": [10, 40], "output": {"log10": true}
    });
    assert_eq!(server.get(LINK).json::<Value>().unwrap(), server.answer("/v1/diagrams", &body));
    // A list may be given one by one as well, and as points instead of a step.
    let repeated = LINK.replace("at_deg=10,40", "at_deg=10&at_deg=40").replace("step_deg=20", "points=7");
    assert_eq!(server.get(&repeated).json::<Value>().unwrap(), server.answer("/v1/diagrams", &body));
}

#[test]
fn every_parameter_of_a_link_reaches_the_scene() {
    let server = Server::start();
    let link = "/v1/diagrams?quantity=brdf&model=unified&rms_height_um=0.1&correlation_length_um=7&facet_slope_deg=9\
        &n=1.3&k=2&diffuse_albedo=0.4&specular_scale=3&shadowing=none&wavelength_um=5e-1&irradiance=7\
        &parallel=0.25&perpendicular=0.75&pixel_area_um2=30&distance_um=1e+6&focal_length_um=5e4&aperture_um=2e4&off_axis_deg=5\
        &components=specular_lobe,specular_spike&relative_tolerance=1e-6&method=series\
        &sweep=theta_i_deg&from_deg=-40&to_deg=40&step_deg=10&at_deg=25&phi_r_deg=30&log10=false";
    let body = json!({
        "quantity": "brdf", "model": "unified",
        "surface": {"rms_height_um": 0.1, "correlation_length_um": 7, "facet_slope_deg": 9, "medium": {"n": 1.3, "k": 2},
            "diffuse_albedo": 0.4, "specular_scale": 3, "shadowing": "none"},
        "illumination": {"wavelength_um": 0.5, "irradiance": 7, "polarization": {"parallel": 0.25, "perpendicular": 0.75}},
        "sensor": {"pixel_area_um2": 30, "distance_um": 1e6, "focal_length_um": 5e4, "aperture_um": 2e4, "off_axis_deg": 5},
        "components": ["specular_lobe", "specular_spike"],
        "accuracy": {"relative_tolerance": 1e-6, "method": "series"},
        "sweep": "theta_i_deg", "from_deg": -40, "to_deg": 40, "step_deg": 10, "at_deg": [25], "phi_r_deg": 30,
        "output": {"log10": false}
    });
    assert_eq!(server.get(link).json::<Value>().unwrap(), server.answer("/v1/diagrams", &body));
}

#[test]
fn each_point_says_how_it_was_evaluated_if_asked() {
    let server = Server::start();
    let link = "/v1/diagrams?model=beckmann_spizzichino&rms_height_um=0.2&correlation_length_um=4&wavelength_um=0.5\
        &sweep=theta_r_deg&from_deg=0&to_deg=10&step_deg=5&at_deg=10&per_direction=true&method=rough";
    let diagram: Value = server.get(link).json().unwrap();
    let series = &diagram["series"][0];
    assert_eq!(series["method"], json!(["rough", "rough", "rough"]));
    assert_eq!(series["methods"], json!({"rough": 3}));
    let (header, rows) = csv(&server, link);
    assert!(header.ends_with("relative_error_bound,roughness_g,method"), "{header}");
    for (row, g) in rows.iter().zip(series["roughness_g"].as_array().unwrap()) {
        assert_eq!(row[row.len() - 2..], [g.to_string(), "rough".to_owned()]);
    }
}

#[test]
fn a_link_is_answered_once() {
    let server = Server::start();
    for path in [LINK, "/v1/figures", "/v1/figures/20b"] {
        let first = server.get(path);
        let tag = first.headers()["etag"].clone();
        assert!(first.headers()["cache-control"].to_str().unwrap().contains("max-age"));
        assert!(tag.to_str().unwrap().starts_with('"'), "a strong tag");
        let again = server.request("GET", path).header("if-none-match", &tag).send().unwrap();
        assert_eq!(again.status(), 304, "{path}");
        assert_eq!(again.headers()["etag"], tag);
        assert!(again.bytes().unwrap().is_empty());
        let other = server.request("GET", path).header("if-none-match", "\"0\"").send().unwrap();
        assert_eq!(other.status(), 200);
    }
    let (json, csv) =
        (server.get(LINK), server.request("GET", LINK).header("accept", "text/csv").send().unwrap());
    assert_ne!(json.headers()["etag"], csv.headers()["etag"]);
}

#[test]
fn every_figure_is_computed_in_both_formats() {
    let server = Server::start();
    let list: Value = server.get("/v1/figures").json().unwrap();
    let figures = list["figures"].as_array().unwrap();
    assert_eq!(figures.len(), 38);
    for figure in figures {
        let href = figure["href"].as_str().unwrap();
        let answer: Value = server.get(href).json().unwrap();
        assert_eq!(answer["id"], figure["id"]);
        let points: usize = answer["panels"]
            .as_array()
            .unwrap()
            .iter()
            .map(|panel| {
                let diagram = &panel["diagram"];
                diagram["series"].as_array().unwrap().len()
                    * diagram["axis"]["values"].as_array().unwrap().len()
            })
            .sum();
        assert!(points > 100, "{href}");
        assert_eq!(csv(&server, href).1.len(), points, "{href}");
    }
}

#[test]
fn a_magnitude_of_tables_is_answered() {
    let server = Server::start();
    let link = "/v1/diagrams?model=lambertian&diffuse_albedo=1&sweep=theta_r_deg&from_deg=-90&to_deg=90&points=100000&at_deg=0,10,20,30,40,50,60,70,80,90";
    let diagram: Value = server.get(link).json().unwrap();
    assert_eq!(diagram["series"].as_array().unwrap().len(), 10);
    assert_eq!(diagram["series"][9]["total"].as_array().unwrap().len(), 100_000);
}
