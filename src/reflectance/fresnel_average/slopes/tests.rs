//! The mean against other routes to it, and its bound.

use super::{FINEST, Normals, SlopeAverage};
use crate::reflectance::bounds::SLOPE_AVERAGED;
use crate::reflectance::degrees::SinCos;
use crate::reflectance::fresnel::{Energy, Medium, Polarization, RefractiveIndex};
use crate::reflectance::fresnel_average::{half_vector, mean_plane};
use crate::reflectance::geometry::Geometry;
use crate::reflectance::numeric::{EPSILON, quadrature::integrate};
use crate::reflectance::quantity::{
    AveragedRatio, Azimuth, Fraction, IndexK, IndexN, Quantity, SourceZenith, ViewerZenith,
};
use core::f64::consts::{PI, SQRT_2};

fn index(n: f64, k: f64) -> RefractiveIndex {
    RefractiveIndex { n: IndexN::new(n).unwrap(), k: IndexK::new(k).unwrap() }
}

fn slope_average(medium: &Medium, polarization: Polarization, incidence: SinCos, ratio: f64) -> SlopeAverage {
    super::slope_average(medium, polarization, incidence, AveragedRatio::new(ratio).unwrap(), FINEST)
}

#[test]
fn the_weights_add_up_to_the_illuminated_fraction() {
    for ratio in [1e-100, 1e-6, 0.01, 0.1, 0.5, 1.0, SLOPE_AVERAGED.max] {
        for theta_i in [0.0, 1e-6, 30.0, 60.0, 85.0, 90.0] {
            let incidence = SinCos::of_degrees(theta_i);
            let normals = Normals::new(incidence, SQRT_2 * ratio, FINEST);
            let whole = normals.integrate(FINEST, index(1.5, 0.0), |normal| normal.weight);
            let error = normals.integrate(0.01, index(1.5, 0.0), |normal| normal.weight_error).value;
            let closed =
                slope_average(&Medium::PerfectConductor, Polarization::unpolarized(), incidence, ratio)
                    .illuminated_fraction;
            // The stated errors, and the closed form's.
            let slack = whole.error + error + normals.horizon_error() + 8.0 * EPSILON * closed;
            assert!((whole.value - closed).abs() <= slack, "{ratio} {theta_i} {whole:?} {closed}");
        }
    }
}

#[test]
fn normal_incidence_is_one_integral_even_across_total_reflection() {
    // θ′ = α: E[F′] = ∫ F′(atan st) t e^{−t²/2} dt, split where F′ is not smooth.
    let (n, deviation) = (1.0 / 1.5, 0.5);
    let parallel = Polarization::parallel();
    let f = |t: f64| {
        let cos = 1.0 / libm::hypot(1.0, deviation * t);
        let energy = index(n, 0.0).energies(SinCos { sin: deviation * t * cos, cos }).mixed(parallel);
        energy.value * t * libm::exp(-0.5 * t * t)
    };
    let critical = n / (1.0 - n * n).sqrt() / deviation;
    let exact =
        [(0.0, n / deviation), (n / deviation, critical), (critical, 2.0 * critical), (2.0 * critical, 12.0)]
            .map(|(a, b)| integrate(a, b, f).value)
            .iter()
            .sum::<f64>();
    let got =
        slope_average(&Medium::Index(index(n, 0.0)), parallel, SinCos::of_degrees(0.0), deviation / SQRT_2);
    let slack = got.reflectance.error + 64.0 * EPSILON * exact;
    assert!((got.reflectance.value - exact).abs() <= slack, "{got:?} {exact}");
    assert!(got.reflectance.error < 1e-12 * exact, "{got:?}");
}

#[test]
fn oblique_incidence_across_total_reflection() {
    // By 22-digit nested quadrature over the plane of slopes, split along Brewster's and the critical angle. Without the
    // splits such a quadrature settles nowhere near: the critical angle, 53°, is one deviation of the slopes away from 40°.
    let exact = 0.207_622_019_237_823_78;
    let (sin, cos) = libm::sincos(0.7);
    let glass = Medium::Index(index(0.8, 0.0));
    let got = slope_average(&glass, Polarization::unpolarized(), SinCos { sin, cos }, 0.15);
    let energy = got.reflectance;
    assert!((energy.value - exact).abs() <= energy.error, "{energy:?}");
    assert!(energy.error < 700.0 * EPSILON * exact, "{energy:?}");
}

#[test]
fn oblique_incidence_agrees_with_the_plane_of_slopes() {
    let (metal, mix) = (index(0.2, 3.4), Polarization::unpolarized());
    let (incidence, deviation) = (SinCos::of_degrees(50.0), 0.2);
    // The source leaves the facets at p = −cot 50° = −4.2 deviations: most of its e^{−9} is within reach.
    let shadow = -incidence.cos / incidence.sin / deviation;
    let mean = integrate(shadow, 9.5, |p| {
        integrate(0.0, 9.5, |q| {
            let secant = (1.0 + deviation * deviation * (p * p + q * q)).sqrt();
            let cos = (incidence.cos + incidence.sin * deviation * p) / secant;
            let sin = (1.0 - cos * cos).max(0.0).sqrt();
            let weight = libm::exp(-0.5 * (p * p + q * q)) / PI;
            weight * metal.energies(SinCos { sin, cos }).mixed(mix).value
        })
        .value
    });
    let got = slope_average(&Medium::Index(metal), mix, incidence, deviation / SQRT_2);
    // sin by 1 − cos² costs the reference ε/sin² near normal incidence of a facet; the weight there is small.
    let exact = mean.value / got.illuminated_fraction;
    assert!((got.reflectance.value / exact - 1.0).abs() < 256.0 * EPSILON, "{got:?} {exact}");
}

#[test]
fn readings_meet_on_a_smooth_surface_in_the_mirror_direction() {
    let (glass, mix) = (Medium::Index(index(1.5, 0.0)), Polarization::unpolarized());
    let geometry = Geometry::new(
        SourceZenith::new(40.0).unwrap(),
        ViewerZenith::new(40.0).unwrap(),
        Azimuth::new(0.0).unwrap(),
    );
    let plane = mean_plane(&glass, mix, &geometry);
    let half = half_vector(&glass, mix, &geometry);
    let slopes = slope_average(&glass, mix, SinCos::of_degrees(40.0), 1e-12).reflectance;
    for other in [half, slopes] {
        assert!((other.value - plane.value).abs() <= other.error + plane.error, "{other:?} {plane:?}");
    }
}

#[test]
fn the_bound_holds_where_steep_facets_decide_and_at_either_tolerance() {
    // n, k, σ_h/T, θ_i, h and the mean: by 64-bit significands, tanh-sinh rules of 200 and 160 nodes a unit in both
    // directions, split at the same angles.
    for (n, k, ratio, theta_i, h, exact) in [
        (1.5, 0.0, 0.05, 45.0, 0.5, 0.051_373_338_234_928_63),
        (1.000_023_2, 0.0, 0.126, 30.0, 0.5, 1.824_712_689_771_258e-10),
        (1.000_000_001, 0.0, 0.25, 75.0, 0.0, 1.470_836_133_555_441_8e-5),
        (0.7, 1e-4, 0.4, 45.0, 1.0, 0.604_619_430_654_336_9),
        (2.6854, 0.0, 2.45, 71.3, 1.0, 0.148_679_833_962_960_3),
        (1.3735, 7.6179, 0.2, 80.0, 0.5, 0.876_675_458_863_939_8),
        (0.18, 3.43, 3.9, 89.99, 0.25, 0.956_377_974_171_237_3),
        (1000.0, 0.0, 0.3, 85.0, 1.0, 0.963_120_367_790_360_6),
    ] {
        let share = |share: f64| Fraction::new(share).unwrap();
        let mix = Polarization::mix(share(h), share(1.0 - h)).unwrap();
        for tolerance in [FINEST, 1e-9, 1.0] {
            let got = super::slope_average(
                &Medium::Index(index(n, k)),
                mix,
                SinCos::of_degrees(theta_i),
                AveragedRatio::new(ratio).unwrap(),
                tolerance,
            )
            .reflectance;
            // The reference is rounded.
            let slack = got.error + EPSILON * exact;
            assert!((got.value - exact).abs() <= slack, "{n} {ratio} {tolerance}: {got:?} {exact}");
            // F′ of an index so near 1 is itself not known better.
            let most: f64 = if n == 1.000_000_001 { 1e-5 } else { 4e-13 };
            assert!(got.error < exact * most.max(2.0 * tolerance), "{n} {ratio} {tolerance}: {got:?}");
        }
    }
}

#[test]
fn a_perfect_conductor_reflects_everything() {
    let incidence = SinCos::of_degrees(9.0);
    let got = slope_average(&Medium::PerfectConductor, Polarization::parallel(), incidence, 1.0);
    assert_eq!(got.reflectance, Energy::ONE);
}
