//! The linear models of image irradiance: (74) and (80).

use crate::bs::mixed;
use crate::family::{Line, Measured};
use crate::table::Table;
use reflectance::reflectance::beckmann_spizzichino::Patch;
use reflectance::reflectance::geometry::Geometry;
use reflectance::reflectance::image_irradiance::{LinearModel, Offset, Spike, Strengths};
use reflectance::reflectance::numeric::scaled::Scaled;
use std::sync::LazyLock;

pub(crate) static MEASURED: LazyLock<Measured> =
    LazyLock::new(|| Measured::run("image", &Table::parse(include_str!("data/image.tsv")), check));

fn check(line: &Line<'_>) {
    let row = &line.row;
    let input = |name| row.input(name);
    let (theta_i, theta_r, phi_r) = (input("theta_i"), input("theta_r"), input("phi_r"));
    let geometry = Geometry::from_radians(theta_i, theta_r, phi_r);
    let offset = Offset::from_radians(theta_i, theta_r, phi_r);
    let (half_x, half_y) = (input("X") / input("lambda"), input("Y") / input("lambda"));
    let model = |spike| LinearModel {
        strengths: Strengths {
            diffuse_lobe: input("C_dl"),
            specular_lobe: input("C_sl"),
            specular_spike: input("C_ss"),
        },
        sigma_alpha: input("sigma_alpha"),
        spike,
    };
    let delta = model(Spike::Delta);
    let sinc2 = model(Spike::Sinc2(Patch { footprint: Scaled::ONE, half_x, half_y }));
    let gauss = model(Spike::Gaussian { width: input("sigma_s") });

    let cint = |name| row.cint(name).unwrap_or(0.0);
    let (cint_sinc2, cint_gauss) = (cint("spike_sinc2"), cint("spike_gauss"));
    let source = |model: &LinearModel| model.fixed_source(&geometry, offset);
    let view = |model: &LinearModel| model.fixed_view(&geometry, offset);
    let models = [delta, sinc2, gauss];
    for (answers, [dl, sl, smooth, with_sinc2, with_gauss]) in [
        (
            models.map(|model| source(&model)),
            ["src_dl", "src_sl", "src_delta_smooth_part", "src_sinc2", "src_gauss"],
        ),
        (
            models.map(|model| view(&model)),
            ["view_dl", "view_sl", "view_delta_smooth_part", "view_sinc2", "view_gauss"],
        ),
    ] {
        let log = |name| row.exact(name).log10();
        let [answer, sinc2, gauss] = answers;
        line.scaled(dl, answer.diffuse_lobe.value, 0.0);
        line.scaled(sl, answer.specular_lobe.value, cint(sl));
        let cint_smooth = mixed([(log(dl), 0.0), (log(sl), cint(sl))]);
        line.scaled(smooth, answer.total().value, cint_smooth);
        let with = |spike, cint: f64| {
            let strength = input("C_ss").log10();
            mixed([(log(smooth), cint_smooth), (strength + log(spike), cint)])
        };
        line.scaled(with_sinc2, sinc2.total().value, with("spike_sinc2", cint_sinc2));
        line.scaled(with_gauss, gauss.total().value, with("spike_gauss", cint_gauss));
    }
    line.truth("delta_on", Some(source(&delta).delta_on));

    // The shape of the spike is its term at unit strength.
    let shape = |spike| {
        let unit = Strengths { diffuse_lobe: 0.0, specular_lobe: 0.0, specular_spike: 1.0 };
        source(&LinearModel { strengths: unit, ..model(spike) }).specular_spike.value
    };
    line.scaled("spike_sinc2", shape(sinc2.spike), cint_sinc2);
    line.scaled("spike_gauss", shape(gauss.spike), cint_gauss);
    if row.output("gauss_width_curvature").is_some() {
        line.value("gauss_width_curvature", Spike::width_by_curvature(half_x, geometry.cos_i), 0.0);
        line.value("gauss_width_energy", Spike::width_by_energy(half_x, geometry.cos_i), 0.0);
    }
}

#[test]
fn passes() {
    MEASURED.assert_passes(1000, 26876);
}
