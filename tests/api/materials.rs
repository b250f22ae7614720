//! Materials: looked up in requests, and listed.

use crate::server::{Server, errors, problem};
use serde_json::{Value, json};

fn body(medium: &Value, wavelength: &Value) -> Value {
    json!({
        "model": "torrance_sparrow",
        "surface": {"facet_slope_deg": 13, "medium": medium},
        "illumination": {"wavelength_um": wavelength},
        "geometry": {"theta_i_deg": 45, "theta_r_deg": [0, 30, 60], "phi_r_deg": 10}
    })
}

/// An answer without what it says of the medium, and that.
fn without_medium(mut answer: Value) -> (Value, Value) {
    let medium = answer.as_object_mut().unwrap().remove("medium").unwrap_or_default();
    (answer, medium)
}

#[test]
fn a_material_is_its_n_and_k_at_the_wavelength() {
    let server = Server::start();
    for (name, source, wavelength, found) in [
        ("Al", None, 0.633, ["Al", "Rakic"]),
        ("aluminum", Some("mcpeak"), 0.633, ["Al", "McPeak"]),
        ("fused silica", None, 0.55, ["SiO2", "Malitson"]),
        ("N-BK7", Some("Schott"), 2.5, ["N-BK7", "Schott"]),
    ] {
        let asked = json!({"material": name, "source": source});
        let answer = server.answer("/v1/radiance", &body(&asked, &json!(wavelength)));
        let (values, medium) = without_medium(answer);
        assert_eq!([medium["material"].as_str(), medium["source"].as_str()], found.map(Some));
        let given = json!({"n": medium["n"], "k": medium["k"]});
        assert_eq!(values, server.answer("/v1/radiance", &body(&given, &json!(wavelength))), "{name}");
        // The same numbers where the material is asked for by itself.
        let [name, source] = found;
        let alone: Value = server
            .get(&format!("/v1/materials/{name}?wavelength_um={wavelength}&source={source}"))
            .json()
            .unwrap();
        assert_eq!(alone["sources"][0]["index"], given);
        assert_eq!(alone["sources"][0]["k_tabulated"], medium["k_tabulated"].is_null());
        for path in ["/v1/plan", "/v1/tradeoff"] {
            assert_eq!(server.answer(path, &body(&asked, &json!(wavelength)))["medium"], medium, "{path}");
        }
    }
    // A medium that is given as numbers is not repeated.
    let answer = server.answer("/v1/radiance", &body(&json!({"n": 1.5}), &json!(0.5)));
    assert!(answer.get("medium").is_none());
}

#[test]
fn what_is_wrong_with_a_material_is_said_with_what_would_do() {
    let server = Server::start();
    let refused = |body: Value| problem(server.post("/v1/brdf", body.to_string()), 422);
    let detail = |problem: &Value| problem["errors"][0]["detail"].as_str().unwrap().to_owned();
    let of = |pointer: &str, code: &str| vec![(pointer.to_owned(), code.to_owned())];

    let problem = refused(body(&json!({"material": "alumnium"}), &json!(0.5)));
    assert_eq!(errors(&problem), of("/surface/medium/material", "unknown_value"));
    assert!(detail(&problem).contains("Al (aluminium)"), "{problem}");

    let problem = refused(body(&json!({"material": "Au", "source": "Palik"}), &json!(0.5)));
    assert_eq!(errors(&problem), of("/surface/medium/source", "unknown_value"));
    assert!(detail(&problem).contains("Johnson, McPeak, Olmon-ev"), "{problem}");

    let problem = refused(body(&json!({"material": "Au"}), &json!(10.6)));
    assert_eq!(errors(&problem), of("/illumination/wavelength_um", "out_of_range"));
    assert!(detail(&problem).contains("0.1879 to 1.937"), "{problem}");
    assert!(detail(&problem).contains("Olmon-ev") && !detail(&problem).contains("McPeak"), "{problem}");

    let mut no_light = body(&json!({"material": "Au"}), &json!(null));
    assert_eq!(errors(&refused(no_light.clone())), of("/illumination/wavelength_um", "required"));
    no_light.as_object_mut().unwrap().remove("illumination");
    assert_eq!(errors(&refused(no_light)), of("/illumination/wavelength_um", "required"));

    let problem = refused(body(&json!({"source": "Rakic"}), &json!(0.5)));
    assert_eq!(errors(&problem), of("/surface/medium/material", "required"));
    let problem = refused(body(&json!({"material": 13, "source": 7}), &json!(0.5)));
    assert_eq!(errors(&problem).len(), 2);
    let problem = refused(body(&json!("Al"), &json!(0.5)));
    assert!(detail(&problem).contains("{\"material\": …}"), "{problem}");
    // n − ik with k ≥ 0, and a medium has an n.
    for (medium, pointer) in
        [(json!({"n": 1, "k": -1e-300}), "/surface/medium/k"), (json!({"n": 0, "k": 1}), "/surface/medium/n")]
    {
        assert_eq!(errors(&refused(body(&medium, &json!(0.5)))), of(pointer, "out_of_range"));
    }
    // A height lobe needs the wavelength as well: told once.
    let problem = refused(json!({
        "model": "beckmann_spizzichino",
        "surface": {"rms_height_um": 0.2, "correlation_length_um": 4, "medium": {"material": "Au"}},
        "geometry": {"theta_i_deg": 30, "theta_r_deg": 0}
    }));
    assert_eq!(errors(&problem), of("/illumination/wavelength_um", "required"));
}

#[test]
fn a_link_names_a_material_too() {
    let server = Server::start();
    let link = "/v1/diagrams?model=torrance_sparrow&facet_slope_deg=13&sweep=theta_r_deg&from_deg=0&to_deg=60\
        &step_deg=30&at_deg=45&wavelength_um=0.6";
    let by_name = server.get(&format!("{link}&material=gold&source=McPeak"));
    let tag = by_name.headers()["etag"].clone();
    let (diagram, medium) = without_medium(by_name.json().unwrap());
    assert_eq!(medium["source"], "McPeak");
    let by_index = server.get(&format!("{link}&n={}&k={}", medium["n"], medium["k"]));
    // The one says what was looked up, the other does not.
    assert_ne!(by_index.headers()["etag"], tag);
    assert_eq!(by_index.json::<Value>().unwrap(), diagram);
    let again = server.get(&format!("{link}&material=Au&source=mcpeak"));
    assert_eq!(again.headers()["etag"], tag);
    let both = problem(server.get(&format!("{link}&material=Au&n=1&medium=perfect_conductor")), 422);
    let inconsistent = |name: &str| (format!("/{name}"), "inconsistent".to_owned());
    assert_eq!(errors(&both), [inconsistent("medium"), inconsistent("n")]);
    let outside =
        problem(server.get(&format!("{link}&material=Au&source=Werner").replace("=0.6", "=6")), 422);
    assert_eq!(errors(&outside), [("/wavelength_um".to_owned(), "out_of_range".to_owned())]);
}

#[test]
fn the_list_says_whose_numbers_they_are() {
    let server = Server::start();
    let list = |query: &str| server.get(&format!("/v1/materials{query}")).json::<Value>().unwrap();
    let all = list("");
    let names: Vec<&str> = all["materials"]
        .as_array()
        .unwrap()
        .iter()
        .map(|material| material["name"].as_str().unwrap())
        .collect();
    for name in [
        "Ag",
        "Al",
        "Au",
        "Cr",
        "Cu",
        "Fe",
        "Ni",
        "Pt",
        "Ti",
        "W",
        "Si",
        "Ge",
        "GaAs",
        "MgO",
        "TiO2",
        "Al2O3",
        "SiO2",
        "N-BK7",
        "SF11",
        "H2O",
        "PMMA",
        "polycarbonate",
    ] {
        assert!(names.contains(&name), "{name}");
    }
    for material in all["materials"].as_array().unwrap() {
        let sources = material["sources"].as_array().unwrap();
        assert_eq!(sources.iter().filter(|source| source["default"] == true).count(), 1, "{material}");
        for source in sources {
            assert_eq!(source["licence"], "CC0-1.0");
            let ends = ["least", "largest"].map(|end| source["wavelength_um"][end].as_f64().unwrap());
            assert!(ends[0] < ends[1] && source["citation"].as_str().unwrap().len() > 20, "{source}");
        }
        assert_eq!(server.get(material["href"].as_str().unwrap()).status(), 200);
    }
    assert_eq!(list("?search=GOLD")["materials"][0]["name"], "Au");
    assert_eq!(list("?search=xyzzy")["materials"], json!([]));
    let gold = list("?name=gold");
    assert_eq!(gold["materials"].as_array().unwrap().len(), 1);
    assert!(gold["materials"][0]["sources"].as_array().unwrap().len() > 5);
    let silica = list("?name=silica");
    assert_eq!(silica["materials"][0]["sources"][0]["k_tabulated"], false);
    let unknown = problem(server.get("/v1/materials?name=golld"), 422);
    assert_eq!(errors(&unknown), [("/name".to_owned(), "unknown_value".to_owned())]);
    assert!(unknown["detail"].as_str().unwrap().contains("Au (gold)"), "{unknown}");
}

#[test]
fn a_material_by_itself_has_an_index_where_a_source_reaches() {
    let server = Server::start();
    let gold: Value = server.get("/v1/materials/gold?wavelength_um=10.6").json().unwrap();
    let reach: Vec<&str> = gold["sources"]
        .as_array()
        .unwrap()
        .iter()
        .filter(|source| source["index"].is_object())
        .map(|source| source["id"].as_str().unwrap())
        .collect();
    assert_eq!(reach, ["Olmon-ev", "Babar", "Ordal"]);
    let response = server.get("/v1/materials/Au");
    let tag = response.headers()["etag"].clone();
    assert_eq!(response.headers()["cache-control"], "public, max-age=3600");
    let known = server.request("GET", "/v1/materials/gold").header("if-none-match", tag).send().unwrap();
    assert_eq!(known.status(), 304);
    assert!(response.json::<Value>().unwrap()["sources"][0].get("index").is_none());
    assert!(
        problem(server.get("/v1/materials/silvr"), 404)["detail"].as_str().unwrap().contains("Ag (silver)")
    );
    problem(server.get("/v1/materials/%ff"), 404);
    for (query, pointer) in [
        ("wavelength_um=1e9", "/wavelength_um"),
        ("wavelength_um=3&source=Johnson", "/wavelength_um"),
        ("source=x", "/source"),
        ("lambda=1", "/lambda"),
    ] {
        let problem = problem(server.get(&format!("/v1/materials/Au?{query}")), 422);
        assert_eq!(errors(&problem)[0].0, pointer);
    }
}
