//! Waves and the camera: (11), (12), (15), (32), (43), (50), (51), (57).

use crate::family::{Line, Measured};
use crate::table::Table;
use reflectance::reflectance::numeric::scaled::Scaled;
use reflectance::reflectance::radiometry::Camera;
use reflectance::reflectance::waves::{Lossless, SmoothPlate, wavenumber};
use std::sync::LazyLock;

pub(crate) static MEASURED: LazyLock<Measured> =
    LazyLock::new(|| Measured::run("waves", &Table::parse(include_str!("data/waves.tsv")), check));

fn check(line: &Line<'_>) {
    let row = &line.row;
    let input = |name| row.input(name);
    let (cos_i, cos_r) = (libm::cos(input("theta_i")), libm::cos(input("theta_r")));
    let medium = Lossless { permittivity: input("eps"), permeability: input("mu") };
    let field = input("E0");
    line.value("admittance", medium.admittance(), 0.0);
    line.value("impedance", medium.impedance(), 0.0);
    line.value("H_o", medium.magnetic_amplitude(field), 0.0);
    line.value("S_a", medium.energy_flow(field), 0.0);
    line.value("S_a_printed", medium.energy_flow_as_printed(field), 0.0);
    line.value("I_s", medium.surface_irradiance(field, cos_i), 0.0);
    line.value("I_s_printed", medium.surface_irradiance_as_printed(field, cos_i), 0.0);
    line.value("k", wavenumber(input("lambda")), 0.0);
    let plate = SmoothPlate {
        half_x: input("X"),
        half_y: input("Y"),
        wavelength: input("lambda"),
        distance: input("R_o"),
    };
    line.value("E2ss", plate.specular_amplitude(field, cos_i), 0.0);
    let camera = Camera {
        pixel_area: input("dA_im"),
        distance: input("z"),
        focal_length: input("f"),
        aperture: input("d"),
        cos_off_axis: libm::cos(input("gamma")),
    };
    line.scaled("footprint", camera.footprint(), 0.0);
    line.scaled("dA_s", camera.surface_area(cos_r), 0.0);
    line.value("I_im_over_L", camera.image_irradiance_factor(), 0.0);
    // (57) with κ_diff itself, which the oracle does not bind to an albedo.
    let diffuse = Scaled::new(input("kappa_diff")) * input("L_i") * input("dw_i") * cos_i.max(0.0);
    line.scaled("L_lambert", diffuse, 0.0);
}

#[test]
fn passes() {
    MEASURED.assert_passes(400, 6400);
}
