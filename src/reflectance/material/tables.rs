//! Reads `tables.txt`: a line begins with what it is, samples with a digit.

use super::dispersion::{Curve, Formula};
use super::{Database, Material, Source};

/// The file.
pub(super) const TEXT: &str = include_str!("tables.txt");

/// A line that is not understood.
#[derive(Debug, PartialEq, Eq)]
pub(super) struct Malformed {
    /// Its number.
    pub(super) line: usize,
}

/// The columns of samples that are being read.
#[derive(Default)]
struct Samples {
    wavelengths: Vec<f64>,
    columns: [Vec<f64>; 2],
}

/// What is being read of a source.
#[derive(Default)]
struct Draft {
    id: &'static str,
    page: &'static str,
    citation: &'static str,
    dois: Vec<&'static str>,
    note: Option<&'static str>,
    n: Option<Curve>,
    k: Option<Curve>,
    /// The samples, with the letters of their columns.
    open: Option<(&'static str, Samples)>,
}

impl Draft {
    /// Ends the samples.
    fn close(&mut self) -> Option<()> {
        let Some((columns, Samples { wavelengths, columns: values })) = self.open.take() else {
            return Some(());
        };
        (!wavelengths.is_empty() && wavelengths.is_sorted()).then_some(())?;
        for (letter, values) in columns.chars().zip(values) {
            let curve = Curve::Samples { wavelengths: wavelengths.clone(), values };
            let place = if letter == 'n' { &mut self.n } else { &mut self.k };
            place.is_none().then(|| *place = Some(curve))?;
        }
        Some(())
    }

    fn finish(mut self) -> Option<Source> {
        self.close()?;
        let Self { id, page, citation, dois, note, n, k, .. } = self;
        Some(Source { id, page, citation, dois, note, n: n?, k })
    }

    /// Takes in one line.
    fn line(&mut self, line: &'static str) -> Option<()> {
        if line.starts_with(|first: char| first.is_ascii_digit()) {
            let (columns, samples) = self.open.as_mut()?;
            let mut numbers = line.split(' ').map(str::parse);
            samples.wavelengths.push(numbers.next()?.ok()?);
            for values in samples.columns.iter_mut().take(columns.len()) {
                values.push(numbers.next()?.ok()?);
            }
            return numbers.next().is_none().then_some(());
        }
        self.close()?;
        let (kind, rest) = line.split_once(' ').unwrap_or((line, ""));
        match kind {
            "page" => self.page = rest,
            "cite" => self.citation = rest,
            "doi" => self.dois.push(rest),
            "note" => self.note = Some(rest),
            "n" | "k" | "nk" => self.open = Some((kind, Samples::default())),
            "formula" => {
                let (number, rest) = rest.split_once(' ')?;
                let numbers = rest.split(' ').map(str::parse).collect::<Result<Vec<f64>, _>>().ok()?;
                let [from, to, coefficients @ ..] = numbers.as_slice() else { return None };
                let (formula, coefficients) = (Formula::numbered(number)?, coefficients.to_vec());
                self.n = Some(Curve::Formula { formula, range: [*from, *to], coefficients });
            }
            _ => return None,
        }
        Some(())
    }
}

/// The whole file, or the first line at which it is none.
pub(super) fn parse(text: &'static str) -> Result<Database, Malformed> {
    let mut database = Database::default();
    let mut draft: Option<Draft> = None;
    let finish = |draft: Option<Draft>, materials: &mut Vec<Material>| {
        let Some(draft) = draft else { return Some(()) };
        materials.last_mut()?.sources.push(draft.finish()?);
        Some(())
    };
    let lines = text.lines().enumerate().filter(|(_, line)| !line.starts_with('#'));
    for (index, line) in lines.chain([(text.lines().count(), "end")]) {
        let (kind, rest) = line.split_once(' ').unwrap_or((line, ""));
        let done = match kind {
            "database" => {
                database.version = rest;
                Some(())
            }
            "end" => finish(draft.take(), &mut database.materials),
            "material" => finish(draft.take(), &mut database.materials).and_then(|()| {
                let (name, aliases) = rest.split_once(" |")?;
                let aliases = aliases.split(';').map(str::trim).filter(|alias| !alias.is_empty()).collect();
                database.materials.push(Material { name, aliases, sources: Vec::new() });
                Some(())
            }),
            "source" => {
                let done = finish(draft.take(), &mut database.materials);
                let id = rest.split(' ').next().unwrap_or_default();
                draft = Some(Draft { id, ..Draft::default() });
                done
            }
            _ => draft.as_mut().and_then(|draft| draft.line(line)),
        };
        done.ok_or(Malformed { line: index + 1 })?;
    }
    Ok(database)
}

#[cfg(test)]
mod tests {
    use super::{TEXT, parse};

    #[test]
    fn the_file_is_understood_to_the_last_line() {
        let database = parse(TEXT).unwrap();
        let lines = |begin: &str| TEXT.lines().filter(|line| line.starts_with(begin)).count();
        assert_eq!(database.materials.len(), lines("material "));
        assert_eq!(database.materials.iter().map(|m| m.sources.len()).sum::<usize>(), lines("source "));
        assert!(database.materials.iter().all(|material| !material.sources.is_empty()));
        // The default is the first, which the file says for who reads it.
        assert_eq!(lines("material "), TEXT.lines().filter(|line| line.ends_with(" default")).count());
    }

    #[test]
    fn what_is_not_understood_is_found() {
        for (text, line) in [
            ("rubbish", 1),
            ("material X |\nsource A\nnk\n0.5 1", 4),
            ("material X |\nsource A\nn\n0.5 1 2", 4),
            ("material X |\nsource A\nn\n1 1\n0.5 1\nsource B", 6),
            ("material X |\nsource A\nk\n0.5 1", 5),
            ("material X |\nsource A\nformula 9 1 2 3", 3),
            ("source A\nn\n1 1", 4),
        ] {
            assert_eq!(parse(text).unwrap_err().line, line, "{text}");
        }
    }
}
