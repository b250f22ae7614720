//! Beckmann-Spizzichino: (28), (33)-(39), (47)-(51).

use crate::family::{Line, Measured};
use crate::table::{Row, Table};
use reflectance::reflectance::beckmann_spizzichino::{Patch, RelativeRoughness};
use reflectance::reflectance::estimate::Estimate;
use reflectance::reflectance::geometry::Geometry;
use reflectance::reflectance::numeric::lobe_series::{self, Method};
use reflectance::reflectance::numeric::scaled::Scaled;
use reflectance::reflectance::radiometry::Camera;
use reflectance::reflectance::scattered_power::ScatteredPower;
use reflectance::reflectance::waves::{SmoothPlate, wavenumber};
use std::f64::consts::PI;
use std::sync::LazyLock;

pub(crate) static MEASURED: LazyLock<Measured> =
    LazyLock::new(|| Measured::run("bs", &Table::parse(include_str!("data/bs.tsv")), check));

/// |a cot a − 1|, the condition of sinc.
fn sinc_condition(a: f64) -> f64 {
    if a.abs() < 1e-3 { a * a / 3.0 } else { (a / a.tan() - 1.0).abs() }
}

/// sin θ_i − sin θ_r and 2 sin θ_r sin²(φ_r/2): the terms of v_x/k.
fn along_terms(row: &Row<'_>) -> (f64, f64) {
    let (i, r, phi) = (row.input("theta_i"), row.input("theta_r"), row.input("phi_r"));
    (2.0 * (0.5 * (i + r)).cos() * (0.5 * (i - r)).sin(), 2.0 * r.sin() * (0.5 * phi).sin().powi(2))
}

/// Condition of ρ_o with respect to the rounding of its two phases.
pub(crate) fn rho_condition(row: &Row<'_>, k: f64) -> f64 {
    let (front, back) = along_terms(row);
    let sum = front + back;
    let cancellation = if sum == 0.0 { 0.0 } else { (front.abs() + back.abs()) / sum.abs() };
    let across = row.input("theta_r").sin() * row.input("phi_r").sin();
    sinc_condition(k * sum * row.input("X")) * cancellation + sinc_condition(k * across * row.input("Y"))
}

/// The condition of a sum of positive parts: each weighted by its share, from (decimal logarithm, condition).
pub(crate) fn mixed(parts: [(f64, f64); 2]) -> f64 {
    let [(a, cint_a), (b, cint_b)] = parts;
    let share = if a == b { 0.5 } else { 1.0 / (1.0 + 10f64.powf(b - a)) };
    let weighted = |share: f64, cint: f64| if share == 0.0 { 0.0 } else { share * cint };
    weighted(share, cint_a) + weighted(1.0 - share, cint_b)
}

struct Scene<'r, 'f> {
    line: &'r Line<'f>,
    geometry: Geometry,
    roughness: RelativeRoughness,
    patch: Patch,
}

impl Scene<'_, '_> {
    /// (47) and its relatives over the irradiance: spike and lobe.
    fn spike(&self, cosines: f64) -> Scaled {
        self.roughness.spike(&self.geometry, cosines, &self.patch).value
    }

    fn lobe(&self, over_cosines: f64, method: Method) -> Scaled {
        let (Estimate { value, .. }, _) = self.roughness.lobe(&self.geometry, over_cosines, method);
        value
    }

    /// Where g = 0 the rough forms are undefined; the core answers the limit g → 0.
    fn rough(&self, output: &'static str, computed: Scaled, cint: f64) {
        let g = self.roughness.g(&self.geometry);
        if g > 0.0 {
            self.line.scaled(output, computed, cint);
        } else {
            let limit = if self.roughness.x(&self.geometry) > 0.0 { 0.0 } else { f64::INFINITY };
            self.line.instead_of_undefined(output, computed.to_f64(), limit);
        }
    }
}

fn check(line: &Line<'_>) {
    let row = &line.row;
    let input = |name| row.input(name);
    let geometry = Geometry::from_radians(input("theta_i"), input("theta_r"), input("phi_r"));
    let wavelength = input("lambda");
    let scene = Scene {
        line,
        geometry,
        roughness: RelativeRoughness {
            height: input("sigma_h") / wavelength,
            correlation_length: input("T") / wavelength,
        },
        patch: Patch {
            footprint: Scaled::new(input("footprint")) / Scaled::new(wavelength).squared(),
            half_x: input("X") / wavelength,
            half_y: input("Y") / wavelength,
        },
    };
    vectors(&scene);
    powers(&scene);
    radiances(&scene);
}

fn vectors(scene: &Scene<'_, '_>) {
    let Scene { line, geometry, roughness, patch } = scene;
    let row = &line.row;
    let k = wavenumber(row.input("lambda"));
    let (front, back) = along_terms(row);
    // The core keeps v/k, whose own last steps, 2⁻¹⁰⁷⁴ each, are k times as large in v.
    let steps = 4.0 * k * f64::from_bits(1);
    line.absolute("v_x", k * geometry.along(), k * (front.abs() + back.abs()), steps);
    line.stepped("v_y", k * geometry.across(), 0.0, steps);
    line.value("v_z", -k * geometry.cos_sum, 0.0);
    line.stepped("v_xy", k * geometry.horizontal, 0.0, steps);
    let (g, x) = (roughness.g(geometry), roughness.x(geometry));
    line.value("g", g, 0.0);
    line.value("x", x, 0.0);
    line.value("rho_o", patch.rho(geometry), rho_condition(row, k));
    line.value("D", geometry.d(), 0.0);
    let series = lobe_series::evaluate(Method::Series, g, x);
    line.scaled("S", series.estimate.value, row.cint("S").unwrap_or(0.0));
    if g > 0.0 {
        // The logarithm's error is that of S.
        let ln = series.estimate.value.ln();
        line.value("lnS", ln, row.cint("S").unwrap_or(0.0) / ln.abs());
    } else {
        line.instead_of_undefined("lnS", series.estimate.value.ln(), f64::NEG_INFINITY);
    }
}

/// (32), (33), (38), (39): fields at R_o scattered by the area A = 4XY.
fn powers(scene: &Scene<'_, '_>) {
    let Scene { line, geometry, roughness, .. } = scene;
    let row = &line.row;
    let input = |name| row.input(name);
    let plate = SmoothPlate {
        half_x: input("X"),
        half_y: input("Y"),
        wavelength: input("lambda"),
        distance: input("R_o"),
    };
    line.value("E2ss", plate.specular_amplitude(input("E0"), geometry.cos_i), 0.0);
    let power = ScatteredPower {
        roughness: *roughness,
        patch: scene.patch,
        amplitude: input("E0"),
        distance: input("R_o") / input("lambda"),
    };
    let (spike, lobe) = (power.spike(geometry).value, |method| power.lobe(geometry, method).value);
    let (cint_spike, cint_lobe) = (row.cint("L_spike").unwrap_or(0.0), row.cint("L_lobe").unwrap_or(0.0));
    line.scaled("power_spike", spike, cint_spike);
    line.scaled("power_lobe", lobe(Method::Series), cint_lobe);
    let log = |name| row.exact(name).log10();
    let cint = mixed([(log("power_spike"), cint_spike), (log("power_lobe"), cint_lobe)]);
    line.scaled("power", spike + lobe(Method::Series), cint);
    let (g, x) = (roughness.g(geometry), roughness.x(geometry));
    line.scaled("power_lobe_smooth", lobe(Method::Smooth), (1.0 - g).abs() + x);
    scene.rough("power_rough", lobe(Method::Rough), row.cint("L_rough").unwrap_or(0.0));
}

fn radiances(scene: &Scene<'_, '_>) {
    let Scene { line, geometry, roughness, .. } = scene;
    let row = &line.row;
    let input = |name| row.input(name);
    let cint = |name| row.cint(name).unwrap_or(0.0);
    let log = |name| row.exact(name).log10();
    let (cos_i, cos_r) = (geometry.cos_i, geometry.cos_r);
    // S_a of (15), with the oracle's `wave` for the root.
    let irradiance = Scaled::new(input("E0")).squared() * input("wave") * 0.5;

    let spike = scene.spike(cos_i * cos_i) * irradiance;
    let lobe = |method| scene.lobe(1.0 / cos_r, method) * irradiance;
    line.scaled("L_spike", spike, cint("L_spike"));
    line.scaled("L_lobe", lobe(Method::Series), cint("L_lobe"));
    let total = spike + lobe(Method::Series);
    line.scaled("L", total, cint("L"));
    let (g, x) = (roughness.g(geometry), roughness.x(geometry));
    let cint_smooth = (1.0 - g).abs() + x;
    let smooth = lobe(Method::Smooth);
    line.scaled("L_lobe_smooth", smooth, cint_smooth);
    let cint_sum = mixed([(log("L_spike"), cint("L_spike")), (log("L_lobe_smooth"), cint_smooth)]);
    line.scaled("L_smooth", spike + smooth, cint_sum);
    // (48) as printed lacks the exponential of x (errata E21): π/4 (T/λ)² (q(1 + tan²α))² g e^{-g}/cos θ_r.
    let patch = Scaled::new(roughness.correlation_length) * geometry.facet_factor();
    let printed = patch.squared() * (0.25 * PI) * g * Scaled::exp(-g) / Scaled::new(cos_r) * irradiance;
    line.scaled("L_lobe_smooth_printed", printed, (1.0 - g).abs());
    scene.rough("L_rough", lobe(Method::Rough), cint("L_rough"));
    line.scaled("I_s", irradiance * cos_i, 0.0);

    let spike = scene.spike(cos_i);
    let lobe = |method| scene.lobe(1.0 / cos_r / cos_i, method);
    line.scaled("f_spike", spike, cint("L_spike"));
    line.scaled("f_lobe", lobe(Method::Series), cint("L_lobe"));
    line.scaled("f_r", spike + lobe(Method::Series), cint("L"));
    scene.rough("f_rough", lobe(Method::Rough), cint("L_rough"));

    let camera = Camera {
        pixel_area: 1.0,
        distance: 1.0,
        focal_length: input("f"),
        aperture: input("d"),
        cos_off_axis: input("gamma").cos(),
    };
    line.scaled("I_im", total * camera.image_irradiance_factor(), cint("L"));
}

#[test]
fn passes() {
    MEASURED.assert_passes(1300, 62358);
}
