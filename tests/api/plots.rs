//! Diagrams and figures as pictures.

use crate::server::{Server, errors, problem};
use reqwest::blocking::Response;
use roxmltree::{Document, Node};
use serde_json::{Value, json};

const SVG: &str = "image/svg+xml";
const PNG: &str = "image/png";
const LINK: &str = "/v1/diagrams?model=torrance_sparrow&facet_slope_deg=12&n=1.5&diffuse_albedo=0.2&sweep=theta_r_deg\
    &from_deg=-80&to_deg=80&step_deg=2&at_deg=40";

fn get(server: &Server, link: &str, accept: &str) -> Response {
    server.request("GET", link).header("accept", accept).send().unwrap()
}

fn svg(server: &Server, link: &str) -> String {
    let response = get(server, link, SVG);
    assert_eq!(
        (response.status().as_u16(), &response.headers()["content-type"]),
        (200, &SVG.parse().unwrap())
    );
    response.text().unwrap()
}

/// Width and height of a PNG, of its head.
fn size(png: &[u8]) -> (u32, u32) {
    assert_eq!(png[..8], *b"\x89PNG\r\n\x1a\n");
    let number = |at: usize| u32::from_be_bytes(png[at..at + 4].try_into().unwrap());
    (number(16), number(20))
}

fn text_of(node: Node) -> String {
    node.descendants().filter(Node::is_text).filter_map(|part| part.text()).collect()
}

fn said(picture: &Document, name: &str) -> String {
    picture.descendants().find(|node| node.has_tag_name(name)).map(text_of).unwrap_or_default()
}

/// Numbers written in a picture: value, x, y.
fn numbers(picture: &Document) -> Vec<[f64; 3]> {
    let texts = picture.descendants().filter(|node| node.has_tag_name("text"));
    let number = |text: String| {
        let power = text.strip_prefix("10").map(|digits| {
            let digits = digits
                .chars()
                .map(|c| "⁰¹²³⁴⁵⁶⁷⁸⁹".chars().position(|d| d == c).map_or('-', |d| b"0123456789"[d] as char));
            digits.collect::<String>()
        });
        let whole = text.replace('−', "-").parse::<f64>();
        whole.or_else(|_| power.unwrap_or_default().parse())
    };
    let place = |node: &Node, name: &str| node.attribute(name).unwrap().parse::<f64>().unwrap();
    texts
        .filter_map(|node| Some([number(text_of(node)).ok()?, place(&node, "x"), place(&node, "y")]))
        .collect()
}

/// The lines of curves: colour and corners, in tenths of a pixel.
fn curves(picture: &Document) -> Vec<(String, Vec<[f64; 2]>)> {
    let lines = picture.descendants().filter(|node| node.has_tag_name("polyline"));
    let corners = |text: &str| -> Vec<[f64; 2]> {
        let pair = |pair: &str| {
            let (x, y) = pair.split_once(',').unwrap();
            [x.parse().unwrap(), y.parse().unwrap()]
        };
        text.split_whitespace().map(pair).collect()
    };
    let lines = lines.map(|node| {
        (node.attribute("stroke").unwrap().to_owned(), corners(node.attribute("points").unwrap()))
    });
    lines.filter(|(colour, corners)| corners.len() > 2 && colour != "#E2E2E2").collect()
}

/// Where a value stands, of two marks of an axis: `axis` 1 or 2, of marks that share the other coordinate.
fn ruler(marks: &[[f64; 3]], axis: usize) -> impl Fn(f64) -> f64 + use<> {
    let other = 3 - axis;
    let group =
        |mark: &[f64; 3]| marks.iter().filter(|m| m[other] == mark[other]).copied().collect::<Vec<_>>();
    let longest = marks.iter().map(group).max_by_key(Vec::len).unwrap();
    let (first, last) = (longest[0], longest[longest.len() - 1]);
    let slope = (last[axis] - first[axis]) / (last[0] - first[0]);
    move |value| first[axis] + slope * (value - first[0])
}

#[test]
fn every_figure_is_drawn_and_says_what_it_shows() {
    let server = Server::start();
    let list: Value = server.get("/v1/figures").json().unwrap();
    for figure in list["figures"].as_array().unwrap() {
        let href = figure["href"].as_str().unwrap();
        let text = svg(&server, href);
        let picture = Document::parse(&text).unwrap();
        let root = picture.root_element();
        assert_eq!(root.attribute("role"), Some("img"));
        assert_eq!([root.attribute("width"), root.attribute("height")], [Some("720"), Some("480")]);
        let title = said(&picture, "title");
        assert!(title.starts_with(&format!("Figure {}: ", figure["id"].as_str().unwrap())), "{title}");
        assert!(title.ends_with(figure["title"].as_str().unwrap()), "{title}");
        let description = said(&picture, "desc");
        let parameters = figure["parameters"].as_str().unwrap();
        assert!(description.contains(parameters) && description.contains("largest"), "{description}");
        // The parameters are in the picture too, whatever lines they take.
        let shown: String = picture
            .descendants()
            .filter(|node| node.has_tag_name("text"))
            .map(text_of)
            .collect::<Vec<_>>()
            .join(" ");
        assert!(shown.contains(&parameters.replace('_', "")), "{href}: {shown}");
        for node in root.descendants().filter(Node::is_element) {
            let name = node.tag_name().name();
            let known =
                ["svg", "title", "desc", "text", "tspan", "rect", "line", "polyline", "polygon", "circle"];
            assert!(known.contains(&name), "{name}");
            assert!(node.attributes().all(|a| !a.name().starts_with("on") && a.name() != "href"), "{node:?}");
        }
        let png = get(&server, href, PNG);
        assert_eq!(png.headers()["content-type"], PNG);
        assert_eq!(size(&png.bytes().unwrap()), (720, 480), "{href}");
    }
}

#[test]
fn curves_are_where_their_numbers_are() {
    let server = Server::start();
    for (scale, column) in [("linear", "total"), ("log10", "log10_total")] {
        let diagram: Value = server.get(&format!("{LINK}&log10=true")).json().unwrap();
        let text = svg(&server, &format!("{LINK}&scale={scale}&curves=total&decades=30"));
        let picture = Document::parse(&text).unwrap();
        let marks = numbers(&picture);
        let (x, y) = (ruler(&marks, 1), ruler(&marks, 2));
        let [(_, corners)] = &curves(&picture)[..] else { panic!("one curve") };
        let values = diagram["series"][0][column].as_array().unwrap();
        assert_eq!(corners.len(), values.len());
        for ((corner, value), angle) in
            corners.iter().zip(values).zip(diagram["axis"]["values"].as_array().unwrap())
        {
            let expected = [x(angle.as_f64().unwrap()), y(value.as_f64().unwrap())];
            // Half a pixel.
            assert!(
                (corner[0] - expected[0]).abs() < 5.0 && (corner[1] - expected[1]).abs() < 5.0,
                "{corner:?} {expected:?}"
            );
        }
    }
}

#[test]
fn a_polar_curve_is_as_far_from_the_origin_as_its_values_are_large() {
    let server = Server::start();
    let diagram: Value = server.get(LINK).json().unwrap();
    let text = svg(&server, &format!("{LINK}&form=polar&curves=total"));
    let picture = Document::parse(&text).unwrap();
    // Marks of the values stand at one height below the surface, from the origin to the right.
    let x = ruler(&numbers(&picture), 1);
    // The surface is the longest of the level lines.
    let level = |points: &str| -> Option<[f64; 2]> {
        let [left, right] = points.split_whitespace().collect::<Vec<_>>()[..] else { return None };
        let [(from, height), (to, same)] = [left, right].map(|pair| pair.split_once(',').unwrap());
        (height == same)
            .then(|| [to.parse::<f64>().unwrap() - from.parse::<f64>().unwrap(), height.parse().unwrap()])
    };
    let lines = picture.descendants().filter(|node| node.has_tag_name("polyline"));
    let levels = lines.filter_map(|node| level(node.attribute("points").unwrap()));
    let [_, surface] = levels.max_by(|a, b| a[0].total_cmp(&b[0])).unwrap();
    let [(_, corners)] = &curves(&picture)[..] else { panic!("one curve") };
    let values = diagram["series"][0]["total"].as_array().unwrap();
    for ((corner, value), angle) in
        corners.iter().zip(values).zip(diagram["axis"]["values"].as_array().unwrap())
    {
        let (sin, cos) = angle.as_f64().unwrap().to_radians().sin_cos();
        let radius = x(value.as_f64().unwrap()) - x(0.0);
        let expected = [x(0.0) + radius * sin, surface - radius * cos];
        assert!(
            (corner[0] - expected[0]).abs() < 5.0 && (corner[1] - expected[1]).abs() < 5.0,
            "{corner:?} {expected:?}"
        );
    }
}

#[test]
fn a_picture_is_drawn_as_it_is_asked_for() {
    let server = Server::start();
    for (query, width, height) in
        [("width_px=300&height_px=300", 300, 300), ("width_px=2400&height_px=1800", 2400, 1800)]
    {
        for form in ["cartesian", "polar"] {
            let link = format!("{LINK}&form={form}&{query}");
            assert_eq!(size(&get(&server, &link, PNG).bytes().unwrap()), (width, height));
            let text = svg(&server, &link);
            let picture = Document::parse(&text).unwrap();
            let said =
                ["width", "height"].map(|name| picture.root_element().attribute(name).unwrap().to_owned());
            assert_eq!(said, [width, height].map(|pixels| pixels.to_string()));
        }
    }
    let background = |text: &str| {
        let picture = Document::parse(text).unwrap();
        let first = picture.descendants().find(|node| node.has_tag_name("rect"));
        first.unwrap().attribute("fill").unwrap().to_owned()
    };
    assert_ne!(background(&svg(&server, LINK)), background(&svg(&server, &format!("{LINK}&theme=dark"))));
    let lines =
        |query: &str| curves(&Document::parse(&svg(&server, &format!("{LINK}{query}"))).unwrap()).len();
    assert_eq!(
        [lines(""), lines("&curves=total"), lines("&curves=components"), lines("&curves=all")],
        [3, 1, 2, 3]
    );
    // Of several curves the totals, unless more is asked for; their parts are told apart by dashes.
    assert_eq!(lines("&at_deg=10&at_deg=20"), 3);
    assert!(svg(&server, &format!("{LINK}&at_deg=10&curves=all")).contains("diffuse lobe"));
    // The same as a body.
    let body = json!({
        "model": "torrance_sparrow", "surface": {"facet_slope_deg": 12, "medium": {"n": 1.5}, "diffuse_albedo": 0.2},
        "illumination": {}, "sweep": "theta_r_deg", "from_deg": -80, "to_deg": 80, "step_deg": 2, "at_deg": [40],
        "plot": {"form": "polar", "scale": "log10", "decades": 3, "curves": "all", "theme": "dark", "width_px": 640, "height_px": 400}
    });
    let request = server.request("POST", "/v1/diagrams").header("accept", SVG);
    let posted = request.header("content-type", "application/json").body(body.to_string()).send().unwrap();
    let link = "&form=polar&scale=log10&decades=3&curves=all&theme=dark&width_px=640&height_px=400";
    assert_eq!(posted.text().unwrap(), svg(&server, &format!("{LINK}{link}")));
}

#[test]
fn every_wish_that_cannot_be_drawn_is_named() {
    let server = Server::start();
    let wrong = "&form=round&scale=ln&decades=0&curves=none&theme=blue&width_px=299&height_px=2401";
    let names = ["curves", "decades", "form", "height_px", "scale", "theme", "width_px"];
    for link in [LINK, "/v1/figures/22?log10=false"] {
        for accept in [SVG, PNG, "application/json"] {
            let document = problem(get(&server, &format!("{link}{wrong}"), accept), 422);
            let found: Vec<String> = errors(&document).into_iter().map(|(pointer, _)| pointer).collect();
            assert_eq!(found, names.map(|name| format!("/{name}")), "{document}");
        }
    }
    let body = json!({
        "model": "lambertian", "surface": {"diffuse_albedo": 1}, "illumination": {}, "sweep": "theta_r_deg",
        "from_deg": 0, "to_deg": 10, "at_deg": [0], "plot": {"width_px": 500.5, "colour": "red", "theme": 1}
    });
    let document = problem(server.post("/v1/diagrams", body.to_string()), 422);
    let found: Vec<String> = errors(&document).into_iter().map(|(pointer, _)| pointer).collect();
    assert_eq!(found, ["/plot/colour", "/plot/theme", "/plot/width_px"]);
    let limits: Value = server.get("/v1/limits").json().unwrap();
    let limit = |name: &str| {
        limits["limits"].as_array().unwrap().iter().find(|limit| limit["name"] == name).unwrap()["value"]
            .clone()
    };
    assert_eq!([limit("picture_pixels"), limit("picture_series")], [json!(2400), json!(400)]);
}

#[test]
fn a_browser_that_wants_an_image_gets_one() {
    let server = Server::start();
    let kind = |accept: &str| get(&server, "/v1/figures/19", accept).headers()["content-type"].clone();
    assert_eq!(kind("image/avif,image/webp,image/apng,image/svg+xml,image/*,*/*;q=0.8"), SVG);
    assert_eq!(kind("image/png,image/svg+xml;q=0.5"), PNG);
    assert_eq!(kind("image/*"), SVG);
    assert_eq!(kind("*/*"), "application/json");
    for link in [LINK, "/v1/figures/19"] {
        let document = problem(get(&server, link, "image/webp"), 406);
        assert!(document["detail"].as_str().unwrap().ends_with("image/svg+xml, image/png"), "{document}");
    }
}

#[test]
fn a_picture_is_kept_like_every_answer_to_a_link() {
    let server = Server::start();
    let tag =
        |link: &str, accept: &str| get(&server, link, accept).headers()["etag"].to_str().unwrap().to_owned();
    for link in [LINK, "/v1/figures/22?log10=false"] {
        let [plain, dark] = ["", "&theme=dark"].map(|query| format!("{link}{query}"));
        assert_ne!(tag(&plain, SVG), tag(&dark, SVG));
        assert_ne!(tag(&plain, SVG), tag(&plain, PNG));
        // What is the default anyway changes nothing, nor does what only pictures read change numbers.
        assert_eq!(
            tag(&plain, SVG),
            tag(&format!("{link}&theme=light&width_px=720&scale=linear&decades=5"), SVG)
        );
        assert_eq!(tag(&plain, "text/csv"), tag(&dark, "text/csv"));
        let first = get(&server, &plain, PNG);
        assert!(first.headers()["vary"].to_str().unwrap().contains("accept"));
        let again = server
            .request("GET", &plain)
            .header("accept", PNG)
            .header("if-none-match", &first.headers()["etag"]);
        assert_eq!(again.send().unwrap().status(), 304);
        let head = server.request("HEAD", &plain).header("accept", PNG).send().unwrap();
        assert_eq!((head.status().as_u16(), &head.headers()["etag"]), (200, &first.headers()["etag"]));
        assert_eq!(first.bytes().unwrap(), get(&server, &plain, PNG).bytes().unwrap());
    }
}

#[test]
fn what_has_no_picture_has_axes() {
    let server = Server::start();
    let zero = "/v1/diagrams?model=lambertian&diffuse_albedo=0&sweep=theta_r_deg&at_deg=10";
    let grazing =
        "/v1/diagrams?model=torrance_sparrow&facet_slope_deg=12&shadowing=none&sweep=theta_r_deg&at_deg=40";
    for form in ["cartesian", "polar"] {
        // Not a number at all.
        let text = svg(&server, &format!("{grazing}&from_deg=90&to_deg=90&points=1&form={form}"));
        assert!(text.contains(">no value to draw<"), "{text}");
        // Zeros: a line at the bottom, but no logarithms.
        let text = svg(&server, &format!("{zero}&from_deg=0&to_deg=60&form={form}"));
        assert!(!text.contains("no value to draw"), "{text}");
        let text = svg(&server, &format!("{zero}&from_deg=0&to_deg=60&scale=log10&form={form}"));
        assert!(text.contains(">no value to draw<"), "{text}");
        // One point.
        let text = svg(&server, &format!("{grazing}&from_deg=30&to_deg=30&points=1&form={form}"));
        let picture = Document::parse(&text).unwrap();
        assert_eq!(picture.descendants().filter(|node| node.has_tag_name("circle")).count(), 1);
        // A gap at the end.
        let text = svg(&server, &format!("{grazing}&from_deg=30&to_deg=90&form={form}"));
        assert_eq!(curves(&Document::parse(&text).unwrap()).len(), 1);
    }
}

#[test]
fn a_value_that_no_float_holds_is_drawn_by_its_logarithm() {
    let server = Server::start();
    let link = "/v1/diagrams?model=beckmann_spizzichino&rms_height_um=0.001&correlation_length_um=0.01&wavelength_um=0.0001\
        &footprint_um2=400&patch_half_x_um=10&patch_half_y_um=10&components=specular_spike\
        &sweep=theta_r_deg&from_deg=59.9999&to_deg=60&points=2&at_deg=60&scale=log10&decades=100000";
    let text = svg(&server, link);
    let description = said(&Document::parse(&text).unwrap(), "desc");
    // 10^-1703.92, as the log10 column says.
    assert!(description.contains("largest 1.19×10⁻¹⁷⁰⁴ at 60°"), "{description}");
}

#[test]
fn ten_million_rows_make_a_small_picture_with_every_peak() {
    let server = Server::start();
    let angles: Vec<String> = (0..10).map(|index| (7 * index).to_string()).collect();
    // A spike a thousandth of a pixel wide on each curve.
    let link = format!(
        "/v1/diagrams?model=beckmann_spizzichino&rms_height_um=0.01&correlation_length_um=5&wavelength_um=0.5\
         &footprint_um2=1e10&patch_half_x_um=50000&patch_half_y_um=50000&components=specular_spike\
         &sweep=theta_r_deg&from_deg=-89&to_deg=89&points=1000000&at_deg={}",
        angles.join(",")
    );
    let text = svg(&server, &link);
    assert!(text.len() < 2_000_000, "{}", text.len());
    let picture = Document::parse(&text).unwrap();
    let heights = numbers(&picture);
    let y = ruler(&heights, 2);
    for (colour, corners) in curves(&picture) {
        let top = corners.iter().map(|corner| corner[1]).fold(f64::INFINITY, f64::min);
        assert!(top < y(0.0) - 1000.0, "{colour}: the peak at {top}");
    }
    assert_eq!(curves(&picture).len(), 10);
}

#[test]
fn many_curves_are_drawn_and_too_many_are_refused() {
    let server = Server::start();
    let angles =
        |count: usize| (0..count).map(|index| (0.5 * index as f64).to_string()).collect::<Vec<_>>().join(",");
    let wavelengths = |count: usize| {
        (0..count).map(|index| (0.4 + 0.01 * index as f64).to_string()).collect::<Vec<_>>().join(",")
    };
    let link = |angles_: usize, waves: usize| {
        format!(
            "/v1/diagrams?model=beckmann_spizzichino&rms_height_um=0.2&correlation_length_um=4&sweep=theta_r_deg&from_deg=-80&to_deg=80\
             &step_deg=0.5&at_deg={}&wavelength_um={}",
            angles(angles_),
            wavelengths(waves)
        )
    };
    let text = svg(&server, &link(100, 4));
    let picture = Document::parse(&text).unwrap();
    assert_eq!(curves(&picture).len(), 400);
    assert!(text.contains("400 curves") && text.len() < 3_000_000, "{}", text.len());
    let document = problem(get(&server, &link(100, 5), SVG), 422);
    assert_eq!(errors(&document), [("/at_deg".to_owned(), "too_many".to_owned())]);
    assert!(document["errors"][0]["detail"].as_str().unwrap().contains("at most 400"), "{document}");
    // The numbers are answered all the same.
    assert_eq!(get(&server, &link(100, 5), "text/csv").status(), 200);
}
