//! (24), (25), (62), (63).

use crate::condition;
use crate::family::{Line, Measured};
use crate::measure::exceeds;
use crate::table::Table;
use reflectance::reflectance::degrees::SinCos;
use reflectance::reflectance::fresnel::{Complex, Medium, Polarization, RefractiveIndex, TimeFactor};
use reflectance::reflectance::quantity::{Fraction, IndexK, IndexN, Quantity};
use std::sync::LazyLock;

pub(crate) static MEASURED: LazyLock<Measured> =
    LazyLock::new(|| Measured::run("fresnel", &Table::parse(include_str!("data/fresnel.tsv")), check));

/// h and v as energies.
pub(crate) fn polarization(h: f64, v: f64) -> Polarization {
    Polarization::mix(Fraction::new(h).expect("h"), Fraction::new(v).expect("v")).expect("h + v = 1")
}

/// n − ik.
pub(crate) fn index(n: f64, k: f64) -> Medium {
    Medium::Index(RefractiveIndex { n: IndexN::new(n).expect("n"), k: IndexK::new(k).expect("k") })
}

fn check(line: &Line<'_>) {
    let row = &line.row;
    let incidence = SinCos::of_radians(row.input("theta"));
    let (medium, condition) = if row.cell("in.pec") == Some("true") {
        (Medium::PerfectConductor, condition::Fresnel::default())
    } else {
        let (n, k) = (row.input("n"), row.input("k"));
        (index(n, k), condition::Fresnel::of(n, k, incidence.cos, incidence.sin))
    };
    let time_factor = match row.text("index_sign") {
        "n-ik" => TimeFactor::Positive,
        _ => TimeFactor::Negative,
    };

    let fields = medium.fields(incidence, time_factor);
    // Each part of a field is judged by the size of the whole field.
    let field = |re, im, computed: Complex, condition: f64| {
        let size = f64::hypot(row.exact(re).nearest, row.exact(im).nearest);
        line.absolute(re, computed.re, size * (1.0 + condition), 0.0);
        line.absolute(im, computed.im, size * (1.0 + condition), 0.0);
    };
    field("F_para_re", "F_para_im", fields.parallel, condition.field_parallel);
    field("F_perp_re", "F_perp_im", fields.perpendicular, condition.field_perpendicular);

    let energies = medium.energies(incidence);
    let mixed = medium.reflectance(incidence, polarization(row.input("h"), row.input("v")));
    let all = [("E_para", energies.parallel), ("E_perp", energies.perpendicular), ("E_mix", mixed)];
    for (name, energy) in all {
        // A perfect conductor has no cint: it is exact.
        line.value(name, energy.value, row.cint(name).unwrap_or(0.0));
        line.bound(name, energy.value, energy.error);
    }
    // `condition` is the oracle's cint, to its three digits, until its own rounding shows.
    for (name, computed) in
        [("E_para", condition.energy_parallel), ("E_perp", condition.energy_perpendicular)]
    {
        let given = row.cint(name).unwrap_or(0.0);
        let comparable = given < 1e6 && computed < 1e6 && row.exact(name).nearest != 0.0;
        if comparable && exceeds((computed - given).abs(), 0.006 * (1.0 + given)) {
            line.fail(name, &format!("has cint {given}, computed {computed}"));
        }
    }
}

#[test]
fn passes() {
    MEASURED.assert_passes(1200, 8400);
}
