//! Looked-up indices against the Python package of the database that they come from: at both ends of each source and at
//! random wavelengths between, written by scripts/materials/extract.py.

use reflectance::reflectance::material::{database, find};
use reflectance::reflectance::quantity::{Quantity, Wavelength};
use std::collections::BTreeSet;

const LOOKUPS: &str = include_str!("data/materials.tsv");

/// Relative, of n. Powers of the wavelength are products of up to 8 factors here and a library's function there: a term
/// of n² differs by 9 + 1 roundings of 2⁻⁵³ at most, up to 7 terms add one each, on both sides, and the root halves all.
const POWERS: f64 = (10.0 + 2.0 * 7.0) * f64::EPSILON / 4.0 + f64::EPSILON;

#[test]
fn lookups_are_those_of_the_databases_own_package() {
    let mut seen = BTreeSet::new();
    let mut differing = 0;
    for line in LOOKUPS.lines().skip(1) {
        let cells: Vec<&str> = line.split('\t').collect();
        let [material, source, wavelength, n, k, has_k] = cells[..] else { panic!("{line}") };
        let number = |cell: &str| cell.parse::<f64>().unwrap();
        let found = find(material).and_then(|material| material.source(source)).expect(line);
        let index = found.at(Wavelength::new(number(wavelength)).unwrap()).expect(line);
        assert_eq!(found.has_k(), has_k == "1", "{line}");
        // k is between samples, by the same operations in the same order: the same bits.
        assert_eq!(index.k.get(), number(k), "{line}");
        let error = (index.n.get() / number(n) - 1.0).abs();
        assert!(error <= POWERS, "{line}: {error:e}");
        differing += usize::from(error > 0.0);
        seen.insert((material, source));
    }
    // Only formulas with powers, of which there are few.
    assert!(differing < 20, "{differing}");
    assert_eq!(seen.len(), database().materials.iter().map(|material| material.sources.len()).sum::<usize>());
}
