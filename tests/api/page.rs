//! The page at `/` and its files, as they leave the service; what it does is tested in `tests/browser/`.

use crate::server::{Server, problem};
use flate2::read::GzDecoder;
use reqwest::blocking::Response;
use serde_json::Value;
use std::io::Read as _;

fn ask(server: &Server, path: &str, headers: &[(&str, &str)]) -> Response {
    headers
        .iter()
        .fold(server.request("GET", path), |request, (name, value)| request.header(*name, *value))
        .send()
        .unwrap()
}

fn header<'a>(response: &'a Response, name: &str) -> &'a str {
    response.headers().get(name).map_or("", |value| value.to_str().unwrap())
}

/// The paths that the page names.
fn files(server: &Server) -> Vec<String> {
    let page = server.get("/").text().unwrap();
    let mut files: Vec<_> =
        page.split('"').filter(|text| text.starts_with("assets/")).map(|path| format!("/{path}")).collect();
    files.sort();
    files.dedup();
    assert!(files.len() > 10, "{files:?}");
    files
}

#[test]
fn the_page_lets_no_foreign_script_in() {
    let response = Server::start().get("/");
    assert_eq!(response.status(), 200);
    assert_eq!(header(&response, "content-type"), "text/html; charset=utf-8");
    let policy = header(&response, "content-security-policy").to_owned();
    let directives: Vec<_> = policy.split(';').map(str::trim).collect();
    for directive in
        ["default-src 'none'", "script-src 'self'", "connect-src 'self'", "frame-ancestors 'none'"]
    {
        assert!(directives.contains(&directive), "{directive} in {policy}");
    }
    assert!(!policy.contains("unsafe-eval") && !policy.contains("http"), "{policy}");
    let page = response.text().unwrap();
    for script in page.split("<script").skip(1) {
        let (tag, rest) = script.split_once('>').unwrap();
        assert!(tag.contains("src=") && rest.trim_start().starts_with("</script>"), "inline: {script}");
    }
    assert!(!page.contains("<style") && !page.contains(" style=") && !page.contains("//"), "{page}");
}

#[test]
fn the_page_is_asked_for_again_and_its_files_are_not() {
    let server = Server::start();
    let page = server.get("/");
    assert_eq!(header(&page, "cache-control"), "public, no-cache");
    let tag = header(&page, "etag").to_owned();
    assert_eq!(ask(&server, "/", &[("if-none-match", &tag)]).status(), 304);
    for path in files(&server) {
        let file = server.get(&path);
        assert_eq!(file.status(), 200, "{path}");
        assert_eq!(header(&file, "cache-control"), "public, max-age=31536000, immutable", "{path}");
        assert_eq!(header(&file, "vary"), "accept, accept-encoding", "{path}");
        let kind = match path.rsplit('.').next() {
            Some("js") => "text/javascript; charset=utf-8",
            Some("css") => "text/css; charset=utf-8",
            _ => "image/svg+xml",
        };
        assert_eq!(header(&file, "content-type"), kind, "{path}");
        let tag = header(&file, "etag").to_owned();
        assert!(tag.starts_with('"'), "{tag}");
        assert_eq!(ask(&server, &path, &[("if-none-match", &tag)]).status(), 304, "{path}");
    }
}

#[test]
fn files_are_packed_already_for_whoever_takes_gzip() {
    let server = Server::start();
    for path in files(&server) {
        let plain = server.get(&path);
        assert_eq!(header(&plain, "content-encoding"), "", "{path}");
        let plain_tag = header(&plain, "etag").to_owned();
        let plain = plain.bytes().unwrap();
        let packed = ask(&server, &path, &[("accept-encoding", "gzip, deflate, br, zstd")]);
        assert_eq!(header(&packed, "content-encoding"), "gzip", "{path}");
        assert_ne!(header(&packed, "etag"), plain_tag, "{path}");
        let length = header(&packed, "content-length").to_owned();
        let packed = packed.bytes().unwrap();
        assert_eq!(length, packed.len().to_string(), "{path}");
        let mut unpacked = Vec::new();
        GzDecoder::new(&packed[..]).read_to_end(&mut unpacked).unwrap();
        assert_eq!(unpacked, plain, "{path}");
        if path.ends_with("plotly.min.js") {
            assert!(packed.len() < 1_600_000, "{} bytes", packed.len());
        }
    }
    // Another coding is made of it where gzip is refused.
    let script = files(&server).into_iter().find(|path| path.ends_with("app.js")).unwrap();
    let packed = ask(&server, &script, &[("accept-encoding", "zstd")]);
    assert_eq!(header(&packed, "content-encoding"), "zstd");
    let plain = zstd::decode_all(&packed.bytes().unwrap()[..]).unwrap();
    assert_eq!(plain, server.get(&script).bytes().unwrap());
}

#[test]
fn what_is_no_file_of_the_page_is_not_there() {
    let server = Server::start();
    let script = files(&server).into_iter().find(|path| path.ends_with("app.js")).unwrap();
    for path in ["/assets/", "/assets/app.js", "/assets/0/app.js", "/assets/%ff", &format!("{script}/")] {
        let status = server.get(path).status().as_u16();
        assert!(status == 404 || status == 400, "{path}: {status}");
        problem(server.get(path), status);
    }
    assert_eq!(server.request("POST", &script).send().unwrap().status(), 405);
}

#[test]
fn the_page_is_also_under_its_version() {
    let server = Server::start();
    let version = env!("CARGO_PKG_VERSION");
    assert_eq!(server.get(&format!("/{version}/")).text().unwrap(), server.get("/").text().unwrap());
    for path in files(&server) {
        assert_eq!(server.get(&format!("/{version}{path}")).status(), 200, "{path}");
    }
}

#[test]
fn a_figure_is_the_diagrams_that_it_links() {
    let server = Server::start();
    let list: Value = server.get("/v1/figures").json().unwrap();
    let mut without = Vec::new();
    for figure in list["figures"].as_array().unwrap() {
        let (id, links) = (figure["id"].as_str().unwrap(), figure["diagrams"].as_array().unwrap());
        if links.is_empty() {
            without.push(id);
            continue;
        }
        let whole: Value = server.get(figure["href"].as_str().unwrap()).json().unwrap();
        let panels = whole["panels"].as_array().unwrap();
        assert_eq!(panels.len(), links.len(), "{id}");
        for (panel, link) in panels.iter().zip(links) {
            let diagram: Value = server.get(link.as_str().unwrap()).json().unwrap();
            let mut expected = panel["diagram"].clone();
            // A figure's curves say which model they are.
            for series in expected["series"].as_array_mut().unwrap() {
                series.as_object_mut().unwrap().remove("label");
            }
            assert_eq!(diagram, expected, "{id}: {link}");
        }
    }
    assert_eq!(without, ["18", "19"]);
}
