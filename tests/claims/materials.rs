//! `docs/materials.md`: every material with its sources, and how far they disagree.
//! `UPDATE_MATERIALS=1 cargo test --test claims materials` rewrites its tables.

use reflectance::reflectance::degrees::SinCos;
use reflectance::reflectance::fresnel::{Medium, Polarization};
use reflectance::reflectance::material::{Material, Source, database};
use reflectance::reflectance::quantity::{Quantity, Wavelength};
use std::fmt::Write as _;
use std::path::PathBuf;

/// Green light, a helium-neon laser, a carbon dioxide laser: micrometres.
const WAVELENGTHS: [f64; 3] = [0.55, 0.633, 10.6];

fn sources() -> String {
    let mut text = "| material | also | sources: wavelengths in µm |\n| --- | --- | --- |\n".to_owned();
    for Material { name, aliases, sources } in &database().materials {
        let source = |source: &Source| {
            let [least, largest] = source.range();
            let only = if source.has_k() { "" } else { ", n only" };
            format!("`{}` {least} to {largest}{only}", source.id)
        };
        let sources: Vec<_> = sources.iter().map(source).collect();
        writeln!(text, "| {name} | {} | {} |", aliases.join(", "), sources.join("; ")).expect("string");
    }
    text
}

/// The reflectance at normal incidence by each source that reaches a wavelength.
fn reflectances(material: &Material, wavelength: f64) -> Vec<(&'static str, f64)> {
    let wavelength = Wavelength::new(wavelength).expect("a length");
    let reflectance = |source: &Source| {
        let medium = Medium::Index(source.at(wavelength).expect("in its range"));
        medium.reflectance(SinCos::of_degrees(0.0), Polarization::unpolarized()).value
    };
    material.sources_at(wavelength).map(|source| (source.id, reflectance(source))).collect()
}

/// Where sources differ by more than a hundredth.
fn disagreements() -> String {
    let mut text = "| material | λ, µm | R at normal incidence by source | largest − least |\n| --- | --- | --- | --- |\n".to_owned();
    for material in &database().materials {
        for wavelength in WAVELENGTHS {
            let by_source = reflectances(material, wavelength);
            let values = by_source.iter().map(|(_, value)| *value);
            let (least, largest) = (values.clone().fold(1.0, f64::min), values.fold(0.0, f64::max));
            if largest - least < 0.01 {
                continue;
            }
            let list: Vec<_> = by_source.iter().map(|(id, value)| format!("`{id}` {value:.3}")).collect();
            let (name, difference) = (material.name, largest - least);
            writeln!(text, "| {name} | {wavelength} | {} | {difference:.3} |", list.join(", "))
                .expect("string");
        }
    }
    text
}

#[test]
fn docs_materials_is_up_to_date() {
    let path = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("docs/materials.md");
    let mut page = std::fs::read_to_string(&path).expect("docs/materials.md");
    for (mark, table) in [("sources", sources()), ("disagreements", disagreements())] {
        let (begin, end) = (format!("<!-- {mark}: begin -->\n"), format!("<!-- {mark}: end -->\n"));
        let (before, rest) = page.split_once(&begin).expect("begin mark");
        let (committed, after) = rest.split_once(&end).expect("end mark");
        if std::env::var_os("UPDATE_MATERIALS").is_some() {
            page = [before, &begin, &table, &end, after].concat();
            std::fs::write(&path, &page).expect("docs/materials.md");
        } else {
            assert!(committed == table, "docs/materials.md is out of date (UPDATE_MATERIALS=1 rewrites it)");
        }
    }
}

#[test]
fn gold_differs_by_seven_percent_between_its_sources() {
    let gold = database().materials.iter().find(|material| material.name == "Au").expect("gold");
    let by_source = reflectances(gold, 0.55);
    let of = |id: &str| by_source.iter().find(|(source, _)| *source == id).expect("a source").1;
    assert_eq!(by_source[0].0, "Johnson");
    let more = of("McPeak") / of("Johnson") - 1.0;
    // What the page says, to the digits that it says.
    assert!((0.065..0.075).contains(&more), "{more}");
}
