//! S(g, x) summed to convergence, and ln S; and the bound of every method and every tier of truncation.

use crate::family::{Line, Measured};
use crate::measure::{exceeds, relative_error};
use crate::table::Table;
use reflectance::reflectance::numeric::lobe_series::{self, LobeSeries, Method, patches};
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
    for method in Method::ALL {
        bound_holds(line, method.name(), &lobe_series::evaluate(method, row.input("g"), row.input("x")));
    }
    for tier in patches::ALL {
        let value = lobe_series::evaluate_within(tier, row.input("g"), row.input("x"));
        bound_holds(line, &format!("auto to {:e}", tier.truncation), &value);
    }
}

fn bound_holds(line: &Line<'_>, by: &str, series: &LobeSeries) {
    let (value, bound) = (series.estimate.value, series.estimate.relative_error());
    let error = relative_error(value.to_f64(), value.log10(), &line.row.exact("S"));
    if exceeds(error, bound) {
        line.fail("S", &format!("by {by} is off by {error:e}, stated {bound:e}"));
    }
}

#[test]
fn passes() {
    MEASURED.assert_passes(1700, 5100);
}
