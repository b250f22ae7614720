//! Surface statistics: (4)-(9), (73).

use crate::family::{Line, Measured};
use crate::table::Table;
use reflectance::reflectance::numeric::scaled::Scaled;
use reflectance::reflectance::surface::{
    RayleighPair, autocorrelation, facet_density, height_density, profile_slope_density, slope_angle_density,
};
use std::sync::LazyLock;

pub(crate) static MEASURED: LazyLock<Measured> =
    LazyLock::new(|| Measured::run("surface", &Table::parse(include_str!("data/surface.tsv")), check));

fn check(line: &Line<'_>) {
    let row = &line.row;
    let (p1, p2) = (row.input("p1"), row.input("p2"));
    // A Gaussian's condition is twice its exponent.
    let gaussian = |value: Scaled, exponent: f64| line.scaled("value", value, 2.0 * exponent);
    match row.text("kind") {
        "rayleigh" => {
            let pair = RayleighPair { height: p1, wavelength: p2, sin_beta: row.input("p3").sin() };
            line.scaled("path_difference", pair.path_difference(), 0.0);
            line.scaled("phase_difference", pair.phase_difference(), 0.0);
            line.scaled("critical_height", pair.critical_height(), 0.0);
            line.truth("rough", Some(pair.is_rough()));
        }
        "height_pdf" => gaussian(height_density(p1, p2), 0.5 * (p1 / p2).powi(2)),
        "autocorrelation" => gaussian(autocorrelation(p1, p2), (p1 / p2).powi(2)),
        "slope_pdf_gauss" => gaussian(slope_angle_density(p1, p2), 0.5 * (p1 / p2).powi(2)),
        "slope_pdf_height" => {
            let ratio = p2 / row.input("p3");
            let exponent = (p1.tan() / (2.0 * ratio)).powi(2);
            gaussian(profile_slope_density(p1, ratio), exponent);
            line.scaled("facet_ndf", facet_density(p1, ratio), 2.0 * exponent);
        }
        other => line.fail("kind", other),
    }
}

#[test]
fn passes() {
    MEASURED.assert_passes(1200, 4080);
}
