//! (79) both ways.

use crate::family::{Line, Measured};
use crate::table::Table;
use reflectance::reflectance::degrees::from_radians;
use reflectance::reflectance::roughness::{facet_slope_radians, facet_slope_small, height_to_length_ratio};
use std::sync::LazyLock;

pub(crate) static MEASURED: LazyLock<Measured> =
    LazyLock::new(|| Measured::run("roughness", &Table::parse(include_str!("data/roughness.tsv")), check));

fn check(line: &Line<'_>) {
    let row = &line.row;
    if row.text("kind") == "to_ratio" {
        let cond = row.cond("ratio").unwrap_or(0.0);
        line.value("ratio", height_to_length_ratio(row.input("p1")).unwrap_or(f64::NAN), cond);
    } else {
        let ratio = row.input("p1") / row.input("p2");
        let sigma_alpha = facet_slope_radians(ratio);
        line.value("sigma_alpha", sigma_alpha, 0.0);
        line.value("sigma_alpha_deg", from_radians(sigma_alpha), 0.0);
        line.value("sigma_alpha_small_slope", facet_slope_small(ratio), 0.0);
    }
}

#[test]
fn passes() {
    MEASURED.assert_passes(500, 1000);
}
