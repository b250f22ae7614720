//! Materials by name, and what may have been meant.

use super::{Material, database};

/// Letters and digits of a name that are compared with others: more than any material has.
const LONGEST: usize = 48;

/// A name as it is compared: letters and digits, in lower case.
fn plain(name: &str) -> Vec<char> {
    name.chars().filter(|c| c.is_alphanumeric()).flat_map(char::to_lowercase).take(LONGEST).collect()
}

impl Material {
    /// Its name and aliases.
    pub fn names(&self) -> impl Iterator<Item = &'static str> {
        std::iter::once(self.name).chain(self.aliases.iter().copied())
    }
}

/// The material of a name or alias; case, blanks and hyphens do not matter.
pub fn find(name: &str) -> Option<&'static Material> {
    let wanted = plain(name);
    database().materials.iter().find(|material| material.names().any(|name| plain(name) == wanted))
}

/// The materials of which a name or an alias contains this text, compared as in [`find`]; all for an empty
/// text.
pub fn search(text: &str) -> impl Iterator<Item = &'static Material> {
    let wanted: String = plain(text).into_iter().collect();
    let contains = move |name: &str| plain(name).into_iter().collect::<String>().contains(&wanted);
    database().materials.iter().filter(move |material| material.names().any(&contains))
}

/// The materials whose names are nearest to one that there is not, the nearest first.
pub fn nearest(name: &str, count: usize) -> Vec<&'static Material> {
    let wanted = plain(name);
    let distance = |material: &Material| {
        material.names().map(|name| edits(&wanted, &plain(name))).min().unwrap_or(usize::MAX)
    };
    let mut materials: Vec<_> = database().materials.iter().collect();
    materials.sort_by_cached_key(|material| distance(material));
    materials.truncate(count);
    materials
}

/// Letters to insert, remove or replace to make one word of the other (Levenshtein 1966).
fn edits(from: &[char], to: &[char]) -> usize {
    let mut row: Vec<usize> = (0..=to.len()).collect();
    for (above, a) in from.iter().enumerate() {
        let mut diagonal = std::mem::replace(&mut row[0], above + 1);
        for (column, b) in to.iter().enumerate() {
            let replaced = diagonal + usize::from(a != b);
            diagonal = row[column + 1];
            row[column + 1] = replaced.min(diagonal + 1).min(row[column] + 1);
        }
    }
    row[to.len()]
}

#[cfg(test)]
mod tests {
    use super::{database, edits, find, nearest, plain, search};
    use std::collections::BTreeSet;

    #[test]
    fn names_find_one_material_each() {
        let mut seen = BTreeSet::new();
        for material in &database().materials {
            for name in material.names() {
                assert!(seen.insert(plain(name)), "{name} twice");
                assert_eq!(find(name).unwrap().name, material.name);
                assert!(name.chars().filter(|c| c.is_alphanumeric()).count() < super::LONGEST, "{name}");
            }
        }
        for (name, found) in
            [("AL", "Al"), ("Gold", "Au"), ("fused-silica", "SiO2"), ("nbk7", "N-BK7"), ("Aluminum", "Al")]
        {
            assert_eq!(find(name).unwrap().name, found);
        }
        assert!(find("").is_none() && find("unobtainium").is_none() && find(&"Al".repeat(1000)).is_none());
    }

    #[test]
    fn the_nearest_names_are_what_was_meant() {
        for (name, meant) in [
            ("alumnium", "Al"),
            ("slver", "Ag"),
            ("NBK-8", "N-BK7"),
            ("fused silca", "SiO2"),
            ("golld", "Au"),
        ] {
            assert_eq!(nearest(name, 3)[0].name, meant, "{name}");
        }
        assert_eq!(nearest("", 3).len(), 3);
        let word = |text: &str| text.chars().collect::<Vec<_>>();
        assert_eq!(edits(&word("kitten"), &word("sitting")), 3);
        assert_eq!(edits(&word(""), &word("ab")), 2);
    }

    #[test]
    fn a_search_is_by_parts_of_names() {
        let found = |text: &str| search(text).map(|material| material.name).collect::<Vec<_>>();
        assert_eq!(found("silicon"), ["Si", "SiO2"]);
        assert_eq!(found("ALUMIN"), ["Al", "Al2O3"]);
        assert_eq!(found("").len(), database().materials.len());
        assert!(found("xyzzy").is_empty());
    }
}
