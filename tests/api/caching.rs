//! Links: entity tags, how long answers keep, paths with a version.

use crate::server::{Server, problem};
use reqwest::blocking::Response;

const VERSION: &str = env!("CARGO_PKG_VERSION");
const LINK: &str = "/v1/diagrams?model=torrance_sparrow&facet_slope_deg=30&n=1.5&diffuse_albedo=0.2&sweep=theta_r_deg\
    &from_deg=-60&to_deg=60&at_deg=10,40";

fn ask(server: &Server, path: &str, headers: &[(&str, &str)]) -> Response {
    headers
        .iter()
        .fold(server.request("GET", path), |request, (name, value)| request.header(*name, *value))
        .send()
        .unwrap()
}

fn header(response: &Response, name: &str) -> String {
    response.headers()[name].to_str().unwrap().to_owned()
}

fn tag(server: &Server, path: &str) -> String {
    let response = server.get(path);
    assert_eq!(response.status(), 200, "{path}");
    header(&response, "etag")
}

#[test]
fn links_that_mean_the_same_have_the_same_tag() {
    let server = Server::start();
    let expected = tag(&server, LINK);
    assert!(expected.starts_with('"'), "a strong tag: {expected}");
    let (path, query) = LINK.split_once('?').unwrap();
    let mut parameters: Vec<_> = query.split('&').collect();
    parameters.reverse();
    for same in [
        format!("{path}?{}", parameters.join("&")),
        LINK.replace("slope_deg=30", "slope_deg=30.0"),
        LINK.replace("slope_deg=30", "slope_deg=3e1"),
        LINK.replace("slope_deg=30", "slope_deg=%33%30"),
        LINK.replace("at_deg=10,40", "at_deg=10&at_deg=40"),
        LINK.replace("at_deg=10,40", "at_deg=10%2C40.00"),
        LINK.replace("n=1.5", "n=1.5&k=0"),
        format!("{LINK}&quantity=radiance&step_deg=1&phi_r_deg=0&irradiance=1&polarization=unpolarized"),
        format!("{LINK}&parallel=0.5&perpendicular=0.5&relative_tolerance=1e-9&method=auto&components=auto"),
        format!("{LINK}&log10=false&per_direction=false"),
    ] {
        assert_eq!(tag(&server, &same), expected, "{same}");
    }
    for other in [
        LINK.replace("=30", "=30.000000000000004"),
        LINK.replace("at_deg=10,40", "at_deg=40,10"),
        LINK.replace("&from_deg=-60", "&from_deg=-59"),
        LINK.replace("&to_deg=60", "&to_deg=59"),
        LINK.replace("&n=1.5", "&n=1.5&k=1"),
        LINK.replace("&n=1.5", ""),
        LINK.replace("torrance_sparrow", "unified&shadowing=none&components=diffuse_lobe"),
        format!("{LINK}&quantity=brdf"),
        format!("{LINK}&step_deg=0.5"),
        format!("{LINK}&points=121"),
        format!("{LINK}&phi_r_deg=1"),
        format!("{LINK}&irradiance=2"),
        format!("{LINK}&polarization=parallel"),
        format!("{LINK}&relative_tolerance=1e-8"),
        format!("{LINK}&method=series"),
        format!("{LINK}&components=specular_lobe"),
        format!("{LINK}&components=specular_lobe,diffuse_lobe"),
        format!("{LINK}&shadowing=none"),
        format!("{LINK}&specular_scale=1"),
        format!("{LINK}&wavelength_um=1"),
        format!("{LINK}&rms_height_um=1"),
        format!("{LINK}&correlation_length_um=1"),
        format!("{LINK}&footprint_um2=1&patch_half_x_um=1&patch_half_y_um=1"),
        format!("{LINK}&log10=true"),
        format!("{LINK}&per_direction=true"),
    ] {
        assert_ne!(tag(&server, &other), expected, "{other}");
    }
    let listed = |order: &str| tag(&server, &format!("{LINK}&components={order}"));
    assert_eq!(listed("specular_lobe,diffuse_lobe"), listed("diffuse_lobe&components=specular_lobe"));
    let roughness = tag(&server, "/v1/roughness?facet_slope_deg=5&wavelength_um=0.5");
    assert_eq!(tag(&server, "/v1/roughness?wavelength_um=5e-1&theta_i_deg=0&facet_slope_deg=5.0"), roughness);
    assert_ne!(tag(&server, "/v1/roughness?wavelength_um=5e-1&theta_i_deg=1&facet_slope_deg=5.0"), roughness);
    assert_eq!(tag(&server, "/v1/figures/18?log10=false"), tag(&server, "/v1/figures/18"));
    assert_ne!(tag(&server, "/v1/figures/18?log10=true"), tag(&server, "/v1/figures/18"));
}

#[test]
fn tags_hold_on_every_replica() {
    let (one, other) = (Server::start(), Server::with(&["--pool-threads", "1"]));
    for path in [LINK, "/v1/figures", "/v1/figures/11a", "/v1/roughness?beckmann_alpha=1", "/openapi.json"] {
        assert_eq!(tag(&one, path), tag(&other, path), "{path}");
    }
}

#[test]
fn what_is_known_is_not_sent_again() {
    let server = Server::start();
    for path in [
        LINK,
        "/v1/figures",
        "/v1/figures/11a",
        "/v1/roughness?beckmann_alpha=1",
        "/openapi.json",
        "/v1/limits",
    ] {
        let first = server.get(path);
        assert_eq!(header(&first, "vary"), "accept, accept-encoding", "{path}");
        let tag = header(&first, "etag");
        for known in [tag.clone(), format!("W/{tag}"), format!("\"0\", {tag}"), "*".to_owned()] {
            for method in ["GET", "HEAD"] {
                let again = server.request(method, path).header("if-none-match", &known).send().unwrap();
                assert_eq!(again.status(), 304, "{path} {known}");
                for name in ["etag", "vary", "cache-control"] {
                    assert_eq!(again.headers()[name], first.headers()[name], "{path}");
                }
                assert!(again.bytes().unwrap().is_empty());
            }
        }
        assert_eq!(ask(&server, path, &[("if-none-match", "\"0\"")]).status(), 200);
    }
}

#[test]
fn a_tag_is_of_one_format_and_one_coding() {
    let server = Server::start();
    let mut tags = Vec::new();
    for accept in ["application/json", "text/csv", "application/vnd.apache.arrow.stream", "application/x-npy"]
    {
        for coding in ["identity", "gzip", "br", "zstd"] {
            let headers = [("accept", accept), ("accept-encoding", coding)];
            let tag = header(&ask(&server, LINK, &headers), "etag");
            let again = ask(&server, LINK, &[headers[0], headers[1], ("if-none-match", &tag)]);
            assert_eq!(again.status(), 304);
            assert_eq!(header(&again, "etag"), tag);
            assert!(!tags.contains(&tag), "{tag} of {accept} in {coding} is another's");
            tags.push(tag);
        }
    }
    let known = tags.last().unwrap();
    assert_eq!(ask(&server, LINK, &[("if-none-match", known)]).status(), 200, "another form of the answer");
}

#[test]
fn a_link_that_is_known_is_not_evaluated() {
    // Minutes of work at the least, and milliseconds of time for it.
    let heavy = "/v1/diagrams?model=beckmann_spizzichino&rms_height_um=100&correlation_length_um=4&wavelength_um=0.5\
        &method=series&sweep=theta_r_deg&from_deg=-90&to_deg=90&points=100000&at_deg=0,5,10,15,20,25,30,35,40,45";
    let server = Server::with(&["--cpu-limit-seconds", "0.001"]);
    assert_eq!(ask(&server, heavy, &[("if-none-match", "*")]).status(), 304);
}

#[test]
fn a_path_with_the_version_keeps_for_ever() {
    let server = Server::start();
    for path in [LINK, "/v1/figures", "/v1/figures/18", "/v1/roughness?beckmann_alpha=1", "/openapi.json"] {
        let (plain, versioned) = (server.get(path), server.get(&format!("/{VERSION}{path}")));
        assert_eq!(header(&plain, "cache-control"), "public, max-age=3600");
        assert_eq!(header(&versioned, "cache-control"), "public, max-age=31536000, immutable");
        assert_eq!(header(&plain, "etag"), header(&versioned, "etag"));
        assert_eq!(plain.text().unwrap(), versioned.text().unwrap(), "{path}");
    }
    // How the service was started is no matter of its version.
    assert_eq!(header(&server.get(&format!("/{VERSION}/v1/limits")), "cache-control"), "public, no-cache");
    assert_eq!(
        server.post(&format!("/{VERSION}/v1/radiance"), crate::server::scene().to_string()).status(),
        200
    );
    let document = problem(server.get("/0.0.0/v1/figures"), 404);
    assert!(document["detail"].as_str().unwrap().contains(VERSION), "{document}");
    problem(server.get(&format!("/{VERSION}/nothing")), 404);
    problem(server.get(&format!("/{VERSION}/{VERSION}/v1/figures")), 404);
    let openapi: serde_json::Value = server.get("/openapi.json").json().unwrap();
    assert_eq!(openapi["servers"][1]["url"], format!("/{VERSION}"));
}

#[test]
fn what_needs_a_key_is_for_no_shared_cache() {
    let server = Server::start();
    let response = ask(&server, "/v1/figures", &[("authorization", "Bearer anything")]);
    assert_eq!(header(&response, "cache-control"), "private, max-age=3600");
}

#[test]
fn errors_are_not_kept() {
    let server = Server::start();
    for (path, status) in
        [("/v1/diagrams", 422), ("/v1/figures/99", 404), ("/v1/limits?x=1", 422), ("/nothing", 404)]
    {
        let response = server.get(path);
        assert_eq!(header(&response, "cache-control"), "no-store");
        assert!(response.headers().get("etag").is_none());
        problem(response, status);
    }
    // An error is an error, whatever the client has.
    assert_eq!(ask(&server, "/v1/diagrams?model=none", &[("if-none-match", "*")]).status(), 422);
}
