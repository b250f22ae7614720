//! `docs/figures.md`: every figure as the service draws it. `UPDATE_FIGURES=1 cargo test --test claims gallery` draws the
//! pictures anew.

use crate::service::drawn;
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

#[test]
fn pictures_are_compared_to_a_tenth_of_a_pixel() {
    assert!(are_alike("<a x=\"10\" y=\"-2.5\"/>", "<a x=\"11\" y=\"-2.5\"/>"));
    assert!(!are_alike("<a x=\"10\"/>", "<a x=\"12\"/>"));
    assert!(!are_alike("<a x=\"10\"/>", "<a y=\"10\"/>"));
    assert!(!are_alike("", "<a/>"));
}
