//! ⟨FF*⟩ of (41) in its three readings, and the BRDF lobe times each (errata E25).

use crate::condition;
use crate::family::{Line, Measured};
use crate::fresnel::{index, polarization};
use crate::server::Server;
use crate::table::{Exact, Table};
use reflectance::reflectance::beckmann_spizzichino::RelativeRoughness;
use reflectance::reflectance::degrees::SinCos;
use reflectance::reflectance::fresnel_average::{FINEST, half_vector, mean_plane, slope_average};
use reflectance::reflectance::geometry::Geometry;
use reflectance::reflectance::numeric::EPSILON;
use reflectance::reflectance::numeric::lobe_series::{self, Method};
use reflectance::reflectance::numeric::scaled::Scaled;
use reflectance::reflectance::quantity::{AveragedRatio, Quantity as _};
use serde_json::json;
use std::sync::LazyLock;

pub(crate) static MEASURED: LazyLock<Measured> =
    LazyLock::new(|| Measured::run("ff", &Table::parse(include_str!("data/ff.tsv")), check));

/// Slope averages across the critical angle of an index below 1, where F′ has a kink, on which the oracle's quadrature did
/// not settle: it is off by 8e-11 to 4e-3. These are by tanh-sinh quadrature over the plane of slopes, split along the kink
/// (and for 0049, at normal incidence, in one dimension by two substitutions), 18 digits and more.
const ACROSS_CRITICAL_ANGLE: [(&str, f64); 5] = [
    ("v-ff-0007", 0.187_361_292_126_773_51),
    ("v-ff-0020", 0.841_669_504_569_067_9),
    ("v-ff-0025", 0.999_990_557_709_189_4),
    ("v-ff-0049", 0.314_766_602_324_664_2),
    ("v-ff-0065", 0.109_007_377_188_136_12),
];

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
    let ratio = AveragedRatio::new(ratio).expect("a ratio that is integrated");
    let average = slope_average(&medium, polarization, incidence, ratio, FINEST);
    let cint = |incidence| condition::mixed(n, k, incidence, h, v);
    let (cint_mean, cint_half) = (cint(incidence), cint(geometry.local_incidence()));
    line.value("FF_mean_plane", mean_plane.value, cint_mean);
    line.value("FF_half_vector", half_vector.value, cint_half);
    line.value("illuminated_fraction", average.illuminated_fraction, 0.0);
    line.bound("FF_mean_plane", mean_plane.value, mean_plane.error);
    line.bound("FF_half_vector", half_vector.value, half_vector.error);

    let roughness = RelativeRoughness {
        height: input("sigma_h") / input("lambda"),
        correlation_length: input("T") / input("lambda"),
    };
    let over_cosines = 1.0 / geometry.cos_r / geometry.cos_i;
    let (lobe, _) = roughness.lobe(&geometry, over_cosines, Method::Series);
    // The condition of S is the moments' of the terms that are summed.
    let series = lobe_series::evaluate(Method::Series, roughness.g(&geometry), roughness.x(&geometry));
    let cint_lobe = series.condition_g + series.condition_x;
    line.scaled("f_lobe_inf", lobe.value, cint_lobe);
    line.scaled("f_lobe_finite_mean_plane", lobe.value * mean_plane.value, cint_lobe + cint_mean);
    line.scaled("f_lobe_finite_half_vector", lobe.value * half_vector.value, cint_lobe + cint_half);
    let (mean, finite) = (average.reflectance.value, lobe.value * average.reflectance.value);
    if let Some((_, reference)) = ACROSS_CRITICAL_ANGLE.iter().find(|(id, _)| *id == row.id()) {
        let oracle = row.exact("FF_slope_average").nearest;
        if (oracle / reference - 1.0).abs() < 1e-12 {
            line.fail("FF_slope_average", "needs no other reference");
        }
        let with_lobe = Exact::of(row.exact("f_lobe_inf").nearest * reference);
        line.instead("FF_slope_average", Scaled::new(mean), &Exact::of(*reference), 0.0);
        line.instead("f_lobe_finite_slope_average", finite, &with_lobe, cint_lobe);
    } else {
        line.scaled("FF_slope_average", Scaled::new(mean), 0.0);
        line.scaled("f_lobe_finite_slope_average", finite, cint_lobe);
        line.bound("FF_slope_average", mean, average.reflectance.error);
    }
}

#[test]
fn passes() {
    MEASURED.assert_passes(70, 910);
}

/// Asked of the service, whose angles are degrees: the lobe over the perfect conductor's, by each reading of F.
#[test]
fn over_http() {
    let server = Server::start();
    let mut compared = 0;
    for row in Table::parse(include_str!("data/ff.tsv")).rows() {
        let input = |name| row.input(name);
        let angles = ["theta_i", "theta_r", "phi_r"].map(input);
        let (n, k, h, v) = (input("n"), input("k"), input("h"), input("v"));
        let (medium, polarization) = (index(n, k), polarization(h, v));
        let ratio = AveragedRatio::new(input("sigma_h") / input("T")).expect("a ratio that is integrated");
        let mut body = json!({
            "model": "beckmann_spizzichino",
            "surface": {"rms_height_um": input("sigma_h"), "correlation_length_um": input("T")},
            "illumination": {
                "wavelength_um": input("lambda"), "polarization": {"parallel": h, "perpendicular": v}
            },
            "components": ["specular_lobe"],
            "accuracy": {"relative_tolerance": 1e-15},
            "geometry": {
                "theta_i_deg": angles[0].to_degrees(), "theta_r_deg": angles[1].to_degrees(),
                "phi_r_deg": angles[2].to_degrees()
            }
        });
        let ask = |body: &serde_json::Value| {
            let answer = server.post("/v1/brdf", body);
            let number = |name: &str| answer[name][0].as_f64().unwrap_or(f64::NAN);
            (number("total"), number("relative_error_bound"))
        };
        let (perfect, perfect_bound) = ask(&body);
        // Of what underflows there is no quotient.
        if perfect.is_nan() || perfect < 1e-290 {
            continue;
        }
        body["surface"]["medium"] = json!({"n": n, "k": k});
        let mean = |angles: [f64; 3], reading: &str| {
            let geometry = Geometry::from_radians(angles[0], angles[1], angles[2]);
            let incidence = SinCos { sin: geometry.sin_i, cos: geometry.cos_i };
            match reading {
                "mean_plane" => mean_plane(&medium, polarization, &geometry).value,
                "half_vector" => half_vector(&medium, polarization, &geometry).value,
                _ => slope_average(&medium, polarization, incidence, ratio, FINEST).reflectance.value,
            }
        };
        for (reading, output) in [
            ("mean_plane", "FF_mean_plane"),
            ("half_vector", "FF_half_vector"),
            ("slope_average", "FF_slope_average"),
        ] {
            body["surface"]["fresnel_average"] = json!(reading);
            let (finite, bound) = ask(&body);
            let reference = ACROSS_CRITICAL_ANGLE.iter().find(|(id, _)| *id == row.id());
            let exact = match (reading, reference) {
                ("slope_average", Some((_, reference))) => *reference,
                _ => row.exact(output).nearest,
            };
            // An angle in degrees is off by 2 ε: what F does of a change a million times that, taken linear.
            let here = mean(angles, reading);
            let step = 2e6 * EPSILON;
            let moved: f64 = (0..3)
                .map(|which| {
                    let mut turned = angles;
                    turned[which] *= 1.0 - step;
                    (mean(turned, reading) / here - 1.0).abs() / 1e6
                })
                .sum();
            let slack = bound + perfect_bound + 64.0 * EPSILON + 4.0 * moved;
            let off = (finite / perfect / exact - 1.0).abs();
            assert!(off <= slack, "{} {reading}: off by {off:e}, {slack:e}", row.id());
            assert!(slack < 1e-9, "{} {reading}: {slack:e}", row.id());
            compared += 1;
        }
    }
    assert!(compared >= 150, "{compared}");
}
