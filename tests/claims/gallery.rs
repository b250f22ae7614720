//! `docs/figures.md`: every figure as the service draws it. `UPDATE_FIGURES=1 cargo test --test claims gallery` draws the
//! pictures anew.

use crate::service::{ANGLES, Over, drawn, facets, figure, peak};
use reflectance::reflectance::figures::FIGURES;
use std::collections::BTreeSet;
use std::fs;
use std::path::PathBuf;

/// A picture that takes longer to load than to look at is too large.
const MOST_BYTES: usize = 40_000;

/// The pictures of the page: file, and the link that is below each.
fn pictures(page: &str) -> Vec<(String, String)> {
    let mut lines = page.lines();
    let mut pictures = Vec::new();
    while let Some(line) = lines.next() {
        let Some((_, file)) = line.split_once("](figures/") else { continue };
        let link = lines.find(|line| !line.is_empty()).expect("a link below the picture");
        pictures.push((file.trim_end_matches(')').to_owned(), link.trim_matches('`').to_owned()));
    }
    pictures
}

/// Words and numbers; a number's sign, point and exponent stand between its parts.
fn tokens(text: &str) -> Vec<&str> {
    let mut tokens = Vec::new();
    let mut rest = text;
    while let Some(first) = rest.chars().next() {
        let is_digit = first.is_ascii_digit();
        let length = rest.find(|c: char| c.is_ascii_digit() != is_digit).unwrap_or(rest.len());
        let (token, behind) = rest.split_at(length);
        tokens.push(token);
        rest = behind;
    }
    tokens
}

/// Whether two pictures are the same up to a tenth of a pixel: the last digit of a value, and with it the side to which a
/// coordinate is rounded, is the processor's.
fn are_alike(a: &str, b: &str) -> bool {
    let (a, b) = (tokens(a), tokens(b));
    let is_close = |a: &str, b: &str| match (a.parse::<u64>(), b.parse::<u64>()) {
        (Ok(a), Ok(b)) => a.abs_diff(b) <= 1,
        _ => a == b,
    };
    a.len() == b.len() && a.iter().zip(&b).all(|(a, b)| is_close(a, b))
}

#[test]
fn the_gallery_shows_what_the_service_draws() {
    let docs = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("docs");
    let page = fs::read_to_string(docs.join("figures.md")).expect("docs/figures.md");
    let pictures = pictures(&page);
    let figures: BTreeSet<_> = FIGURES.iter().map(|figure| format!("{}.svg", figure.id)).collect();
    assert_eq!(pictures.iter().map(|(file, _)| file.clone()).collect::<BTreeSet<_>>(), figures);
    let mut stale = Vec::new();
    for (file, link) in pictures {
        let picture = drawn(&link);
        assert!(picture.len() < MOST_BYTES, "{file} has {} bytes", picture.len());
        let path = docs.join("figures").join(&file);
        let committed = fs::read_to_string(&path).unwrap_or_default();
        if are_alike(&committed, &picture) {
            continue;
        }
        if std::env::var_os("UPDATE_FIGURES").is_some() {
            fs::write(&path, picture).expect("docs/figures");
        } else {
            stale.push(file);
        }
    }
    assert!(stale.is_empty(), "out of date (UPDATE_FIGURES=1 draws them anew): {stale:?}");
}

/// "a, b and c"
fn listed(parts: &[String]) -> String {
    match parts {
        [first @ .., last] if !first.is_empty() => format!("{} and {last}", first.join(", ")),
        _ => parts.concat(),
    }
}

/// What the page says below the picture of a figure.
fn section<'a>(page: &'a str, id: &str) -> &'a str {
    let (_, behind) = page.split_once(&format!("\n### {id}\n")).expect("a section");
    behind.split_once("\n#").map_or(behind, |(section, _)| section)
}

#[test]
fn what_the_gallery_says_of_facet_lobes_is_so() {
    let docs = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("docs");
    let page = fs::read_to_string(docs.join("figures.md")).expect("docs/figures.md");
    for (id, sigma_alpha) in [("20c", 0.5), ("20d", 1.0), ("20e", 2.0), ("20f", 3.0)] {
        let diagram = figure(id).remove(0);
        let off = ANGLES.map(|at| {
            let curve = diagram.curve(at);
            let specular = curve.specular("total");
            let deviation = |(angle, value): (&f64, f64)| {
                let gaussian = (-0.5 * ((angle - at) / (2.0 * sigma_alpha)).powi(2)).exp();
                (value / specular - gaussian).abs()
            };
            let points =
                diagram.axis.iter().zip(curve.column("total")).filter(|(angle, _)| angle.abs() <= 80.0);
            format!("{:.1}", 100.0 * points.map(deviation).fold(0.0, f64::max))
        });
        let said = format!("{} %", listed(&off));
        assert!(section(&page, id).contains(&said), "{id}: {said}");
    }
    for (id, sigma_alpha) in [("21a", 5.0), ("21b", 7.0), ("21c", 9.0), ("21e", 15.0), ("21f", 17.0)] {
        let peaks =
            ANGLES.map(|at| peak(&facets(sigma_alpha), Over::Viewer, at).map(|peak| format!("{peak:.1}°")));
        let said = listed(&peaks.into_iter().flatten().collect::<Vec<_>>());
        assert!(section(&page, id).contains(&said), "{id}: {said}");
    }
}

#[test]
fn pictures_are_compared_to_a_tenth_of_a_pixel() {
    assert!(are_alike("<a x=\"10\" y=\"-2.5\"/>", "<a x=\"11\" y=\"-2.5\"/>"));
    assert!(!are_alike("<a x=\"10\"/>", "<a x=\"12\"/>"));
    assert!(!are_alike("<a x=\"10\"/>", "<a y=\"10\"/>"));
    assert!(!are_alike("", "<a/>"));
}
