//! S(g, x) summed to convergence, and ln S.

use crate::family::{Line, Measured};
use crate::table::Table;
use reflectance::reflectance::numeric::lobe_series::{self, Method};
use std::sync::LazyLock;

pub(crate) static MEASURED: LazyLock<Measured> =
    LazyLock::new(|| Measured::run("series", &Table::parse(include_str!("data/series.tsv")), check));

fn check(line: &Line<'_>) {
    let row = &line.row;
    let cint = row.cond("S").expect("condition of S");
    let series = lobe_series::evaluate(Method::Series, row.input("g"), row.input("x"));
    line.scaled("S", series.estimate.value, cint);
    // S ≤ 0.52, so that its logarithm is never near 0: judged relatively, and by no condition.
    line.value("lnS", series.estimate.value.ln(), 0.0);
    let exact = row.exact("S");
    if exact.log.is_none() {
        line.bound("S", series.estimate.value.to_f64(), series.estimate.error.to_f64());
    }
}

#[test]
fn passes() {
    MEASURED.assert_passes(1700, 5100);
}
