//! ⟨FF*⟩ of (41) in its three readings, and the BRDF lobe times each (errata E25).

use crate::condition;
use crate::family::{Line, Measured};
use crate::fresnel::{index, polarization};
use crate::table::Table;
use reflectance::reflectance::beckmann_spizzichino::RelativeRoughness;
use reflectance::reflectance::degrees::SinCos;
use reflectance::reflectance::fresnel_average::{half_vector, mean_plane, slope_average};
use reflectance::reflectance::geometry::Geometry;
use reflectance::reflectance::numeric::lobe_series::{self, Method};
use std::sync::LazyLock;

pub static MEASURED: LazyLock<Measured> =
    LazyLock::new(|| Measured::run("ff", &Table::parse(include_str!("data/ff.tsv")), check));

fn check(line: &Line<'_>) {
    let row = &line.row;
    let input = |name| row.input(name);
    let geometry = Geometry::from_radians(input("theta_i"), input("theta_r"), input("phi_r"));
    let (n, k, h, v) = (input("n"), input("k"), input("h"), input("v"));
    let (medium, polarization) = (index(n, k), polarization(h, v));
    let incidence = SinCos { sin: geometry.sin_i, cos: geometry.cos_i };

    let mean_plane = mean_plane(&medium, polarization, &geometry);
    let half_vector = half_vector(&medium, polarization, &geometry);
    let ratio = input("sigma_h") / input("T");
    let average = slope_average(&medium, polarization, incidence, ratio).expect("a ratio that is integrated");
    let cint = |incidence| condition::mixed(n, k, incidence, h, v);
    let (cint_mean, cint_half) = (cint(incidence), cint(geometry.local_incidence()));
    line.value("FF_mean_plane", mean_plane.value, cint_mean);
    line.value("FF_half_vector", half_vector.value, cint_half);
    line.value("FF_slope_average", average.reflectance.value, 0.0);
    line.value("illuminated_fraction", average.illuminated_fraction, 0.0);
    line.bound("FF_mean_plane", mean_plane.value, mean_plane.error);
    line.bound("FF_half_vector", half_vector.value, half_vector.error);
    line.bound("FF_slope_average", average.reflectance.value, average.reflectance.error);

    let roughness = RelativeRoughness {
        height: input("sigma_h") / input("lambda"),
        correlation_length: input("T") / input("lambda"),
    };
    let over_cosines = 1.0 / geometry.cos_r / geometry.cos_i;
    let (lobe, _) = roughness.lobe(&geometry, over_cosines, Method::Series, 0.0);
    // The condition of S, which `series` holds to the oracle's.
    let series = lobe_series::evaluate(Method::Series, roughness.g(&geometry), roughness.x(&geometry), 0.0);
    let cint_lobe = series.condition_g + series.condition_x;
    line.scaled("f_lobe_inf", lobe.value, cint_lobe);
    line.scaled("f_lobe_finite_mean_plane", lobe.value * mean_plane.value, cint_lobe + cint_mean);
    line.scaled("f_lobe_finite_half_vector", lobe.value * half_vector.value, cint_lobe + cint_half);
    line.scaled("f_lobe_finite_slope_average", lobe.value * average.reflectance.value, cint_lobe);
}

#[test]
fn passes() {
    MEASURED.assert_passes(70, 840);
}
