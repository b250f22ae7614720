//! Torrance-Sparrow: (57), (59)-(72).

use crate::bs::mixed;
use crate::family::{Line, Measured};
use crate::fresnel::{index, polarization};
use crate::table::{Exact, Table};
use reflectance::reflectance::fresnel::Medium;
use reflectance::reflectance::geometry::Geometry;
use reflectance::reflectance::numeric::scaled::Scaled;
use reflectance::reflectance::shadowing::ShadowingFunction;
use reflectance::reflectance::torrance_sparrow::FacetLobe;
use std::sync::LazyLock;

pub(crate) static MEASURED: LazyLock<Measured> =
    LazyLock::new(|| Measured::run("ts", &Table::parse(include_str!("data/ts.tsv")), check));

fn check(line: &Line<'_>) {
    let row = &line.row;
    let input = |name| row.input(name);
    let geometry = Geometry::from_radians(input("theta_i"), input("theta_r"), input("phi_r"));
    let medium = match (row.optional("n"), row.optional("k")) {
        (Some(n), Some(k)) => index(n, k),
        _ => Medium::PerfectConductor,
    };
    let lobe = FacetLobe {
        sigma_alpha: input("sigma_alpha"),
        specular_scale: input("c_af"),
        medium,
        polarization: polarization(input("h"), input("v")),
        shadowing: ShadowingFunction::VGroove,
    };
    let no_f = FacetLobe { medium: Medium::PerfectConductor, ..lobe };
    let cint_f = row.cint("F").unwrap_or(0.0);
    let cint_gauss = (geometry.alpha() / lobe.sigma_alpha).powi(2);
    let cint_lobe = row.cint("L_spec").unwrap_or(0.0);

    line.value("theta_local", geometry.theta_local(), 0.0);
    line.value("alpha", geometry.alpha(), 0.0);
    line.value("G", ShadowingFunction::VGroove.factor(&geometry), 0.0);
    let reflectance = medium.reflectance(geometry.local_incidence(), lobe.polarization);
    line.value("F", reflectance.value, cint_f);
    line.bound("F", reflectance.value, reflectance.error);
    line.value("kappa_spec", lobe.kappa_spec(&geometry).value, cint_f);
    line.scaled("gauss", lobe.gaussian(&geometry), cint_gauss);

    let beam = input("L_i") * input("dw_i");
    let radiance = |lobe: FacetLobe| lobe.radiance(&geometry, beam).value;
    line.scaled("L_spec", radiance(lobe), cint_lobe);
    line.scaled("L_spec_noF", radiance(no_f), cint_gauss);
    line.scaled("L_spec_noG", radiance(FacetLobe { shadowing: ShadowingFunction::None, ..lobe }), cint_lobe);
    line.scaled(
        "L_spec_noFG",
        radiance(FacetLobe { shadowing: ShadowingFunction::None, ..no_f }),
        cint_gauss,
    );

    // (57) with κ_diff itself, which the oracle does not bind to an albedo.
    let cos_i = geometry.cos_i.max(0.0);
    let diffuse = Scaled::new(input("kappa_diff")) * beam * cos_i;
    line.scaled("L_diff", diffuse, 0.0);
    let cint = mixed([(row.exact("L_spec").log10(), cint_lobe), (row.exact("L_diff").log10(), 0.0)]);
    line.scaled("L", radiance(lobe) + diffuse, cint);
    line.value("I_s", beam * cos_i, 0.0);
    let over_cosines = ShadowingFunction::VGroove.factor_over_cos_r(&geometry) / cos_i;
    let brdf = lobe.lobe(&geometry, over_cosines).value * reflectance.value;
    line.scaled("f_spec", brdf, cint_lobe);
    line.scaled("f_r", brdf + Scaled::new(input("kappa_diff")), cint);

    as_printed(line, &geometry);
}

/// (60) as printed, arcsine and all (errata E33, E34). ψ, the angle at the source between normal and viewer, has
/// sin ψ = sin φ_r sin θ_r/sin 2θ′ and sin 2θ′ cos ψ = cos θ_r sin θ_i + sin θ_r cos θ_i cos φ_r; the arcsine makes an
/// obtuse ψ acute, and an acute one gives the right α. Undefined at θ′ = 0.
fn as_printed(line: &Line<'_>, geometry: &Geometry) {
    let row = &line.row;
    let (i, r, phi) = (row.input("theta_i"), row.input("theta_r"), row.input("phi_r"));
    if row.exact("theta_local") == Exact::of(0.0) {
        line.value("alpha_eq60", f64::NAN, 0.0);
        line.truth("eq60_wrong", None);
        return;
    }
    let local = geometry.theta_local();
    // Lifted, so that subnormal angles keep their sign.
    let lift = 2f64.powi(200);
    let along = lift * (i - r).sin() + 2.0 * lift * r.sin() * i.cos() * (0.5 * phi).cos().powi(2);
    let obtuse = along < 0.0;
    line.truth("eq60_wrong", Some(obtuse));
    let alpha = if !obtuse {
        geometry.alpha()
    } else if local == 0.0 {
        // θ′ underflows, and with it its part in the spherical law of cosines.
        i
    } else {
        let across = lift * phi.sin() * r.sin();
        // 1 − |cos ψ|
        let versine = across * across / (along.hypot(across) * (along.hypot(across) - along));
        2.0 * ((0.5 * (i - local)).sin().powi(2) + 0.5 * i.sin() * local.sin() * versine).sqrt().asin()
    };
    if alpha == 0.0 {
        // The arccosine of (60) leaves the oracle 1e-112, what its 110 digits of 1 − cos²α hold.
        line.absolute("alpha_eq60", alpha, 1.0, 0.0);
    } else {
        line.value("alpha_eq60", alpha, 0.0);
    }
}

#[test]
fn passes() {
    MEASURED.assert_passes(1300, 33800);
}
