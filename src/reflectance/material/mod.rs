//! What surfaces are made of: n and k of materials by vacuum wavelength, from the refractiveindex.info database.
//!
//! `tables.txt`, which `scripts/materials/extract.py` writes, holds a part of that database (CC0 1.0), each source with
//! its citation. A material has one source or several that disagree; the first is the one taken where none is named.
//! Samples are interpolated linearly in the wavelength, n and k each by itself, as the database's own Python package
//! does; formulas are evaluated. Where no k is tabulated it is 0.
//!
//! The index is n − ik with k ≥ 0 (errata E5), relative to vacuum; of glasses, as their makers state it, to air. What is
//! looked up counts as exact: bounds of errors are against the model with just this n and k. How well they are known is
//! another matter, which the disagreement of sources tells: `docs/materials.md`.

mod dispersion;
mod names;
mod tables;

use super::fresnel::RefractiveIndex;
use super::quantity::{IndexK, IndexN, Quantity as _, Wavelength};
use core::hash::{Hash, Hasher};
use dispersion::Curve;
use std::sync::LazyLock;

pub use names::{find, nearest, search};

/// The licence of every table.
pub const LICENCE: &str = "CC0-1.0";

/// All that is known, read when first asked for: a millisecond.
static DATABASE: LazyLock<Database> = LazyLock::new(|| tables::parse(tables::TEXT).unwrap_or_default());

/// A part of the refractiveindex.info database.
#[derive(Debug, Default)]
pub struct Database {
    /// Which release of it.
    pub version: &'static str,
    /// In the order of the file.
    pub materials: Vec<Material>,
}

/// The tables of this crate.
pub fn database() -> &'static Database {
    &DATABASE
}

/// A material with what is known of it.
#[derive(Debug)]
pub struct Material {
    /// Its formula, or what it is sold as.
    pub name: &'static str,
    /// Other names that find it.
    pub aliases: Vec<&'static str>,
    /// At least one, the default first.
    pub sources: Vec<Source>,
}

/// One publication's n and k of a material.
#[derive(Debug)]
pub struct Source {
    /// Its name among the sources of the material: the database's page.
    pub id: &'static str,
    /// Shelf, book and page of the database.
    pub page: &'static str,
    /// Authors, title, journal, year.
    pub citation: &'static str,
    /// Of the publications.
    pub dois: Vec<&'static str>,
    /// What sample, at which temperature, how measured: as far as the database says.
    pub note: Option<&'static str>,
    n: Curve,
    k: Option<Curve>,
}

/// What was looked up.
#[derive(Clone, Copy, Debug)]
pub struct Lookup {
    /// Of which material.
    pub material: &'static Material,
    /// In which of its sources.
    pub source: &'static Source,
    /// At which vacuum wavelength.
    pub wavelength: Wavelength,
    /// n − ik.
    pub index: RefractiveIndex,
}

/// By name: n and k follow.
impl Hash for Lookup {
    fn hash<H: Hasher>(&self, state: &mut H) {
        (self.material.name, self.source.id, self.wavelength).hash(state);
    }
}

impl Material {
    /// The source of this name, in whatever case.
    pub fn source(&self, id: &str) -> Option<&Source> {
        self.sources.iter().find(|source| source.id.eq_ignore_ascii_case(id))
    }

    /// The source that is taken where none is named.
    pub fn default_source(&self) -> Option<&Source> {
        self.sources.first()
    }

    /// The sources whose range holds this wavelength.
    pub fn sources_at(&self, wavelength: Wavelength) -> impl Iterator<Item = &Source> {
        self.sources.iter().filter(move |source| source.covers(wavelength))
    }
}

impl Source {
    /// The least and the largest wavelength, micrometres, at which n is known, and k unless it is nowhere.
    pub fn range(&self) -> [f64; 2] {
        let [mut least, mut largest] = self.n.range();
        if let Some(k) = &self.k {
            let [from, to] = k.range();
            (least, largest) = (least.max(from), largest.min(to));
        }
        [least, largest]
    }

    /// Whether k is tabulated; where it is not, it is taken as 0.
    pub fn has_k(&self) -> bool {
        self.k.is_some()
    }

    /// Whether the range holds this wavelength.
    pub fn covers(&self, wavelength: Wavelength) -> bool {
        let [least, largest] = self.range();
        (least..=largest).contains(&wavelength.get())
    }

    /// n − ik; None outside the range.
    ///
    /// Samples are interpolated to within 4 ε of the larger neighbour, formulas evaluated in double precision. At four
    /// random wavelengths and both ends of every source the values are those of the database's own Python package: the
    /// same bits between samples, n by formulas with powers to a few ε (`tests/golden/material.rs`).
    pub fn at(&self, wavelength: Wavelength) -> Option<RefractiveIndex> {
        if !self.covers(wavelength) {
            return None;
        }
        let n = self.n.at(wavelength.get())?;
        let k = self.k.as_ref().map_or(Some(0.0), |k| k.at(wavelength.get()))?;
        Some(RefractiveIndex { n: IndexN::new(n).ok()?, k: IndexK::new(k).ok()? })
    }
}

#[cfg(test)]
mod tests {
    use super::{Source, database, find};
    use crate::reflectance::quantity::{Quantity, Wavelength};

    fn sources() -> impl Iterator<Item = (&'static str, &'static Source)> {
        let of = |material: &'static super::Material| material.sources.iter().map(|s| (material.name, s));
        database().materials.iter().flat_map(of)
    }

    #[test]
    fn every_source_has_an_index_throughout_its_range_and_none_beyond() {
        assert!(sources().count() > 100);
        for (material, source) in sources() {
            let [least, largest] = source.range();
            let at = |wavelength: f64| source.at(Wavelength::new(wavelength).unwrap());
            for step in 0..=500 {
                let wavelength = least * (largest / least).powf(f64::from(step) / 500.0);
                let index = at(wavelength.clamp(least, largest));
                assert!(
                    index.is_some_and(|index| source.has_k() || index.k.get() == 0.0),
                    "{material} {}",
                    source.id
                );
            }
            assert!(
                at(least.next_down()).is_none() && at(largest.next_up()).is_none(),
                "{material} {}",
                source.id
            );
        }
    }

    #[test]
    fn every_source_says_where_it_comes_from() {
        for (material, source) in sources() {
            assert!(source.citation.len() > 20, "{material} {}", source.id);
            assert_eq!(source.page.split('/').count(), 3, "{material} {}", source.id);
        }
        for material in &database().materials {
            let ids: std::collections::BTreeSet<_> =
                material.sources.iter().map(|source| source.id).collect();
            assert_eq!(ids.len(), material.sources.len(), "{}", material.name);
        }
        assert!(database().version.starts_with("v20"));
    }

    #[test]
    fn metals_absorb_and_the_sign_of_k_is_that_of_n_minus_ik() {
        // Rakić 1995 at a sample of his table.
        let aluminium = find("aluminum").unwrap();
        assert_eq!(aluminium.default_source().unwrap().id, "Rakic");
        let index = aluminium.sources[0].at(Wavelength::new(0.6525).unwrap()).unwrap();
        assert!((1.0..2.0).contains(&index.n.get()) && (7.0..8.5).contains(&index.k.get()), "{index:?}");
    }
}
