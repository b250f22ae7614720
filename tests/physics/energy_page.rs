//! The tables of docs/energy.md: what lobe and spike send back, by slope, height and incidence.

use crate::albedo::{at, conductor, to_tolerance, total};
use reflectance::reflectance::albedo::{Albedo, AlbedoScene};
use reflectance::reflectance::scene::{Component, Components, Model};
use reflectance::reflectance::shadowing::Shadowing;
use std::fmt::Write as _;
use std::path::PathBuf;

const BEGIN: &str = "<!-- energy: begin -->\n";
const END: &str = "<!-- energy: end -->";
const INCIDENCES: [f64; 7] = [0.0, 30.0, 45.0, 60.0, 75.0, 80.0, 85.0];
/// Beckmann's m = 2σ_h/T.
const WIDTHS: [f64; 5] = [0.05, 0.1, 0.2, 0.3, 0.6];
/// The correlation length of the tables about slopes: so many wavelengths that g is above 10⁴ up to 85°.
const LENGTH: f64 = 20_000.0;

fn head(text: &mut String, first: &str) {
    write!(text, "| {first} |").expect("string");
    for theta_i in INCIDENCES {
        write!(text, " {theta_i}° |").expect("string");
    }
    writeln!(text, "\n|{}", " --- |".repeat(INCIDENCES.len() + 1)).expect("string");
}

/// One row to three digits behind the point.
fn row(text: &mut String, name: &str, value: impl Fn(f64) -> f64) {
    write!(text, "| {name} |").expect("string");
    for theta_i in INCIDENCES {
        write!(text, " {:.3} |", value(theta_i)).expect("string");
    }
    text.push('\n');
}

/// The specular lobe's albedo.
fn lobe(model: Model, width: f64, shadowing: Shadowing, theta_i: f64) -> f64 {
    let mut parameters = conductor(model, 0.5 * width * LENGTH, LENGTH);
    parameters.surface.shadowing = Some(shadowing);
    parameters.components = Components::Named(vec![Component::SpecularLobe]);
    total(&at(&to_tolerance(&parameters, 1e-5), theta_i)).0
}

fn tables() -> String {
    let mut text =
        String::from("The lobe of (47) where the surface is rough, that is (49), without shadowing:\n\n");
    head(&mut text, "m");
    for width in WIDTHS {
        row(&mut text, &width.to_string(), |theta_i| {
            lobe(Model::BeckmannSpizzichino, width, Shadowing::None, theta_i)
        });
    }
    text.push_str("\nThe same with `smith`:\n\n");
    head(&mut text, "m");
    for width in WIDTHS {
        row(&mut text, &width.to_string(), |theta_i| {
            lobe(Model::BeckmannSpizzichino, width, Shadowing::Smith, theta_i)
        });
    }
    text.push_str("\nThe facet lobe (70) of Torrance and Sparrow, σ_α by (79), without shadowing and with `v_groove`:\n\n");
    head(&mut text, "m");
    for (shadowing, name) in [(Shadowing::None, "none"), (Shadowing::VGroove, "v_groove")] {
        for width in WIDTHS {
            row(&mut text, &format!("{width}, `{name}`"), |theta_i| {
                lobe(Model::TorranceSparrow, width, shadowing, theta_i)
            });
        }
    }
    text.push_str("\nLobe and spike of (47) together, by σ_h/λ and T/λ, without shadowing:\n\n");
    head(&mut text, "σ_h/λ, T/λ");
    for (height, length) in [(0.05, 5.0), (0.2, 5.0), (1.0, 10.0), (0.5, 1.5)] {
        let scene = to_tolerance(&conductor(Model::BeckmannSpizzichino, height, length), 1e-5);
        row(&mut text, &format!("{height}, {length}"), |theta_i| total(&at(&scene, theta_i)).0);
    }
    text.push_str("\nThe share of the spike in that, e^{−g} over all:\n\n");
    head(&mut text, "σ_h/λ, T/λ");
    for (height, length) in [(0.05, 5.0), (0.2, 5.0), (1.0, 10.0), (0.5, 1.5)] {
        let scene = to_tolerance(&conductor(Model::BeckmannSpizzichino, height, length), 1e-5);
        let share = |albedo: &Albedo| AlbedoScene::shares_of(albedo).expect("both are there")[0];
        row(&mut text, &format!("{height}, {length}"), |theta_i| share(&at(&scene, theta_i)));
    }
    text
}

#[test]
fn the_albedos_are_what_the_page_says() {
    let path = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("docs/energy.md");
    let document = std::fs::read_to_string(&path).expect("docs/energy.md");
    let (before, rest) = document.split_once(BEGIN).expect("begin mark");
    let (committed, after) = rest.split_once(END).expect("end mark");
    let measured = tables();
    if std::env::var_os("UPDATE_ENERGY").is_some() {
        std::fs::write(&path, [before, BEGIN, &measured, END, after].concat()).expect("docs/energy.md");
        return;
    }
    assert_eq!(measured, committed, "docs/energy.md is out of date: UPDATE_ENERGY=1 rewrites it");
}
