//! Looked-up indices against the Python package of the database that they come from: at both ends of each source and at
//! random wavelengths between, written by scripts/materials/extract.py.

use reflectance::reflectance::material::{database, find};
use reflectance::reflectance::quantity::{Quantity, Wavelength};
use std::collections::BTreeSet;

const LOOKUPS: &str = include_str!("data/materials.tsv");

#[test]
fn lookups_are_those_of_the_databases_own_package() {
    let mut seen = BTreeSet::new();
    for line in LOOKUPS.lines().skip(1) {
        let cells: Vec<&str> = line.split('\t').collect();
        let [material, source, wavelength, n, k, has_k] = cells[..] else { panic!("{line}") };
        let number = |cell: &str| cell.parse::<f64>().unwrap();
        let found = find(material).and_then(|material| material.source(source)).expect(line);
        let index = found.at(Wavelength::new(number(wavelength)).unwrap()).expect(line);
        assert_eq!(found.has_k(), has_k == "1", "{line}");
        // The same operations in the same order: the same bits.
        assert_eq!([index.n.get(), index.k.get()], [number(n), number(k)], "{line}");
        seen.insert((material, source));
    }
    assert_eq!(seen.len(), database().materials.iter().map(|material| material.sources.len()).sum::<usize>());
}
