//! The pages that name files, functions and tests name existing ones, and docs/paper.md leaves no equation and no
//! erratum out.

use reflectance::reflectance::findings::WarningCode;
use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

fn root() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR"))
}

fn page(name: &str) -> String {
    fs::read_to_string(root().join("docs").join(name)).expect("a page")
}

/// The text between backquotes, in order.
fn code_spans(line: &str) -> impl Iterator<Item = &str> {
    line.split('`').skip(1).step_by(2)
}

/// A file as the pages write it: from the root, or from `src/reflectance`.
fn find(path: &str) -> Option<PathBuf> {
    [root().join(path), root().join("src/reflectance").join(path)]
        .into_iter()
        .find(|candidate| candidate.exists())
}

fn is_path(span: &str) -> bool {
    [".rs", ".md", ".toml", ".tsv", ".sh", ".json"].iter().any(|end| span.ends_with(end))
        || span.ends_with('/')
}

/// `name` or `Type::name`.
fn is_name(span: &str) -> bool {
    let identifier = |part: &str| {
        part.starts_with(|c: char| c.is_ascii_alphabetic())
            && part.chars().all(|c| c.is_ascii_alphanumeric() || c == '_')
    };
    span.split("::").all(identifier)
}

/// Whether a source defines an item: a function, type, constant, module, variant or field of the name, in a file
/// that also defines the type it belongs to.
fn defines(source: &str, name: &str) -> bool {
    name.split("::").all(|part| {
        source.lines().any(|line| {
            let words: Vec<_> = line.split(|c: char| !c.is_ascii_alphanumeric() && c != '_').collect();
            let defined = words.windows(2).any(|pair| {
                matches!(pair[0], "fn" | "struct" | "enum" | "const" | "static" | "mod") && pair[1] == part
            });
            let member = line.trim_start().trim_start_matches("pub ").strip_prefix(part);
            defined || member.is_some_and(|rest| rest.starts_with([':', ',', ';', '(', ' ']))
        })
    })
}

/// What a page names and the sources lack.
fn missing(text: &str) -> Vec<String> {
    let mut missing = Vec::new();
    for line in text.lines().filter(|line| line.starts_with('|')) {
        for cell in line.split('|') {
            let mut source: Option<String> = None;
            for span in code_spans(cell) {
                if is_path(span) {
                    match find(span) {
                        Some(path) => source = read(&path),
                        None => missing.push(span.to_owned()),
                    }
                } else if let Some(source) = &source
                    && is_name(span)
                    && !defines(source, span)
                {
                    missing.push(format!("{span} in {cell}"));
                }
            }
        }
    }
    missing
}

/// The text of a file; none of a folder.
fn read(path: &Path) -> Option<String> {
    path.is_file().then(|| fs::read_to_string(path).expect("text"))
}

/// The numbers in "(1)-(3), (34)" or "E1, E2".
fn numbers(cell: &str, open: char) -> Vec<u32> {
    let mut found = Vec::new();
    let mut from = None;
    for part in cell.split(open).skip(1) {
        let digits: String = part.chars().take_while(char::is_ascii_digit).collect();
        let Ok(number) = digits.parse::<u32>() else { continue };
        found.extend(from.map_or(number, |first: u32| first + 1)..=number);
        from = part.trim_end().ends_with('-').then_some(number);
    }
    found
}

#[test]
fn every_file_function_and_test_that_the_pages_name_exists() {
    for name in ["paper.md", "architecture.md"] {
        assert_eq!(missing(&page(name)), Vec::<String>::new(), "docs/{name}");
    }
}

/// All source files below a folder, as paths from the root.
fn sources(folder: &Path) -> Vec<String> {
    let mut found = Vec::new();
    for entry in fs::read_dir(folder).expect("a folder").flatten() {
        let path = entry.path();
        if path.is_dir() {
            found.extend(sources(&path));
        } else if path.extension().is_some_and(|end| end == "rs") {
            let from_root = path.strip_prefix(root()).expect("below the root");
            found.push(from_root.to_str().expect("a name").to_owned());
        }
    }
    found
}

/// The files that a page names neither by their path nor by their folder's.
fn unnamed(page: &str, files: Vec<String>) -> Vec<String> {
    let spans: Vec<_> = page.lines().flat_map(code_spans).collect();
    let names = |span: &str, file: &str| span == file || span.ends_with('/') && file.starts_with(span);
    files.into_iter().filter(|file| !spans.iter().any(|span| names(span, file))).collect()
}

#[test]
fn the_architecture_names_every_file() {
    let files: Vec<_> = ["src", "tests", "examples", "benches"]
        .iter()
        .flat_map(|folder| sources(&root().join(folder)))
        // What a crate consists of says itself.
        .filter(|file| !["src/lib.rs", "src/reflectance/mod.rs"].contains(&file.as_str()))
        .collect();
    assert!(files.len() > 100, "{}", files.len());
    assert_eq!(unnamed(&page("architecture.md"), files), Vec::<String>::new());
}

#[test]
fn every_warning_has_its_row_in_the_plan() {
    let text = page("plan.md");
    let rows: Vec<_> = text.lines().filter_map(|line| line.strip_prefix("| `")?.split('`').next()).collect();
    let codes: Vec<_> = WarningCode::ALL.into_iter().map(WarningCode::name).collect();
    assert_eq!(rows, codes);
}

#[test]
fn every_equation_and_every_erratum_has_its_row() {
    let text = page("paper.md");
    let first_cells: Vec<_> = text
        .lines()
        .filter(|l| l.starts_with('|'))
        .filter_map(|line| line.split('|').nth(1))
        .map(str::trim)
        .collect();
    let rows = |open: char, start: char| {
        let cells = first_cells.iter().filter(|cell| cell.starts_with(start));
        cells.flat_map(|cell| numbers(cell, open)).collect::<Vec<_>>()
    };
    let equations: BTreeSet<_> = rows('(', '(').into_iter().collect();
    let lacking: Vec<_> = (1..=80).filter(|n| !equations.contains(n)).collect();
    assert_eq!(lacking, Vec::<u32>::new(), "equations without a row");
    let errata = rows('E', 'E');
    assert_eq!(errata, (1..=50).collect::<Vec<_>>(), "errata, each once and in order");
}

#[test]
fn the_checks_see_what_is_missing() {
    let page = "| (1) | `geometry.rs` `Geometry::along`, `Geometry::nowhere` | `nowhere.rs` |";
    assert_eq!(missing(page).len(), 2, "{:?}", missing(page));
    assert_eq!(missing("| (1) | `waves.rs` `Lossless::energy_flow`, `SmoothPlate` |"), Vec::<String>::new());
    assert_eq!(numbers("(1)-(3), (34)", '('), [1, 2, 3, 34]);
    let files = || vec!["src/main.rs".to_owned(), "src/http/body.rs".to_owned()];
    assert_eq!(unnamed("`src/main.rs` and `body.rs`", files()), ["src/http/body.rs"]);
    assert_eq!(unnamed("`src/http/`", files()), ["src/main.rs"]);
    assert_eq!(numbers("E1, E17", 'E'), [1, 17]);
}
