//! Measures what docs/accuracy.md says of the lobe series' methods, and draws its pictures: the error of each method
//! over the (g, x) plane, what `auto` chooses where, and the front of error against time.
//!
//! `scripts/accuracy.sh` runs it and the golden tests, which together write the page. `cargo test --example accuracy`
//! holds everything but the times to what is measured.

mod choice;
mod draw;
mod front;
#[cfg(test)]
mod held;
mod page;
mod plane;
mod scenes;
#[path = "../../benches/unit/mod.rs"]
mod unit;

use page::{Page, Table};
use std::error::Error;
use std::path::{Path, PathBuf};

/// The tables, in the page's order, with the pictures' data.
struct Measured {
    plane: plane::Map,
    choices: Vec<(f64, Vec<choice::Sequence>)>,
    front: Vec<front::Band>,
}

impl Measured {
    /// Everything; the times only if `timed`.
    fn now(timed: bool) -> Self {
        Self { plane: plane::Map::measured(), choices: choice::measured(), front: front::measured(timed) }
    }

    fn tables(&self) -> Vec<Table> {
        vec![
            self.plane.table(),
            choice::shares(&self.plane),
            choice::boundaries(&self.choices),
            front::table(&self.front),
        ]
    }

    fn draw(&self, folder: &Path) -> Result<(), Box<dyn Error>> {
        std::fs::write(folder.join("errors.svg"), draw::errors(&self.plane)?)?;
        std::fs::write(folder.join("choices.svg"), draw::choices(&self.plane)?)?;
        std::fs::write(folder.join("front.svg"), draw::front(&self.front)?)?;
        Ok(())
    }
}

fn docs() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("docs")
}

fn main() -> Result<(), Box<dyn Error>> {
    // The times are those of one thread.
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build()?;
    let measured = pool.install(|| Measured::now(true));
    let mut page = Page::read(&docs().join("accuracy.md"))?;
    for table in measured.tables() {
        println!("{table}");
        page.replace(table.name, &table.to_string())?;
    }
    page.replace("machine", &front::machine())?;
    page.write()?;
    measured.draw(&docs().join("accuracy"))
}

#[cfg(test)]
#[test]
fn the_page_says_what_is_measured() {
    let page = Page::read(&docs().join("accuracy.md")).unwrap();
    let differences: Vec<_> = Measured::now(false)
        .tables()
        .iter()
        .flat_map(|table| table.differences(page.part(table.name).unwrap()))
        .collect();
    assert!(
        differences.is_empty(),
        "docs/accuracy.md is out of date (scripts/accuracy.sh rewrites it):\n{}",
        differences.join("\n")
    );
}
