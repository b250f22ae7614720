//! What leaves the surface, over the hemisphere, as a share of what arrives.

use core::f64::consts::{FRAC_PI_2, PI, TAU};
use reflectance::reflectance::beckmann_spizzichino::{Patch, RelativeRoughness};
use reflectance::reflectance::fresnel::{Medium, Polarization};
use reflectance::reflectance::geometry::Geometry;
use reflectance::reflectance::lambertian;
use reflectance::reflectance::numeric::EPSILON;
use reflectance::reflectance::numeric::lobe_series::Method;
use reflectance::reflectance::numeric::quadrature::{Integral, integrate_to};
use reflectance::reflectance::numeric::scaled::Scaled;
use reflectance::reflectance::quantity::{Fraction, Irradiance, Quantity};
use reflectance::reflectance::shadowing::ShadowingFunction;
use reflectance::reflectance::torrance_sparrow::{FacetLobe, normalized_scale};

/// ∫ `flux` dω over the hemisphere of viewers, cut where a lobe of this `width` (radians) about the mirror direction
/// begins and ends. `flux` is even in the azimuth.
fn over_hemisphere(theta_i: f64, width: f64, tolerance: f64, flux: impl Fn(&Geometry) -> f64) -> Integral {
    let zeniths = [0.0, theta_i - 4.0 * width, theta_i, theta_i + 4.0 * width, FRAC_PI_2]
        .map(|zenith: f64| zenith.clamp(0.0, FRAC_PI_2));
    let azimuths = [0.0, (3.0 * width / libm::sin(theta_i)).min(PI), PI];
    let mut whole = Integral::ZERO;
    for zenith in zeniths.windows(2) {
        whole = whole.plus(integrate_to(tolerance, zenith[0], zenith[1], |theta_r| {
            let around: f64 = azimuths
                .windows(2)
                .map(|azimuth| {
                    let at = |phi| flux(&Geometry::from_radians(theta_i, theta_r, phi));
                    integrate_to(tolerance, azimuth[0], azimuth[1], at).value
                })
                .sum();
            2.0 * libm::sin(theta_r) * around
        }));
    }
    // The inner integrals carry the tolerance each.
    Integral { value: whole.value, error: whole.error + tolerance * whole.value }
}

/// Spike and lobe together: e^{−g} and the lobe's exitance over the irradiance of the surface.
fn reflected_share(height: f64, correlation_length: f64, degrees: f64) -> Integral {
    let roughness = RelativeRoughness { height, correlation_length };
    let theta_i = degrees.to_radians();
    let cos_i = libm::cos(theta_i);
    let width = ((height + 0.1) / correlation_length).min(0.3);
    // L cos θ_r/(E cos θ_i): the lobe with 1/cos θ_i for 1/cos θ_r.
    let lobe = over_hemisphere(theta_i, width, 1e-7, |geometry| {
        roughness.lobe(geometry, 1.0 / cos_i, Method::Series).0.value.to_f64()
    });
    let phase = 4.0 * PI * height * cos_i;
    Integral { value: lobe.value + libm::exp(-phase * phase), error: lobe.error }
}

#[test]
fn spike_and_lobe_share_the_energy_near_normal_incidence() {
    for (height, correlation_length) in [(0.05, 5.0), (0.05, 10.0), (0.2, 5.0), (0.3, 10.0), (1.0, 10.0)] {
        // The Kirchhoff field keeps energy to the fourth order of the lobe's width, which is that of the slopes, σ_h/T, and
        // of diffraction, λ/2πT, in quadrature; 4 is room for the coefficient (about 2 is needed here).
        let slope: f64 = height / correlation_length;
        let diffraction: f64 = 1.0 / (TAU * correlation_length);
        let fourth_order = (slope * slope + diffraction * diffraction).powi(2);
        for degrees in [0.0, 10.0] {
            let share = reflected_share(height, correlation_length, degrees);
            let slack = 4.0 * fourth_order + share.error;
            assert!(
                (share.value - 1.0).abs() < slack,
                "{height} {correlation_length} {degrees}: {share:?} {slack}"
            );
        }
    }
}

#[test]
fn energy_is_lost_at_oblique_incidence_and_on_steep_slopes() {
    // Errata E19, to the digits printed there: neither shadowing nor multiple scattering.
    for (height, correlation_length, degrees, printed, half_digit) in
        [(1.0, 10.0, 45.0, 0.998, 5e-4), (1.0, 10.0, 75.0, 0.964, 5e-4), (0.5, 1.5, 0.0, 0.88, 5e-3)]
    {
        let share = reflected_share(height, correlation_length, degrees);
        assert!((share.value - printed).abs() < half_digit + share.error, "{degrees}: {share:?}");
    }
}

#[test]
fn the_spike_holds_e_to_the_minus_g() {
    // A patch of half-sides X = Y = 20 λ, seen whole from everywhere: its footprint is A cos θ_r. With the direction
    // cosines (sin θ_i + a, b) of the viewer, cos θ_r dω = da db, and the share is
    // ∫∫ e^{−g} cos θ_i/cos θ_r · K(a) K(b) da db, K(a) = kX/π sinc²(kXa) of integral 1.
    let half = 20.0;
    let k_half = TAU * half;
    let reach = 4.0 / (2.0 * half);
    for (height, theta_i) in [(0.02, 0.0), (0.05, 0.3), (0.1, 0.6), (0.2, 0.8)] {
        let roughness = RelativeRoughness { height, correlation_length: 1.0 };
        let (sin_i, cos_i) = libm::sincos(theta_i);
        let viewer = |a: f64, b: f64| {
            let (x, y) = (sin_i + a, b);
            Geometry::from_radians(theta_i, libm::asin(libm::hypot(x, y)), libm::atan2(y, x))
        };
        // By the zeros of the sinc, half a wave each.
        let lobes = |f: &dyn Fn(f64) -> f64| -> f64 {
            (-4..4)
                .map(|i| {
                    integrate_to(1e-6, f64::from(i) / (2.0 * half), f64::from(i + 1) / (2.0 * half), f).value
                })
                .sum()
        };
        let share = lobes(&|a| {
            2.0 * (0..4)
                .map(|i| {
                    integrate_to(1e-6, f64::from(i) / (2.0 * half), f64::from(i + 1) / (2.0 * half), |b| {
                        let geometry = viewer(a, b);
                        let patch = Patch {
                            footprint: Scaled::new(4.0 * half * half * geometry.cos_r),
                            half_x: half,
                            half_y: half,
                        };
                        roughness.spike(&geometry, cos_i, &patch).value.to_f64()
                    })
                    .value
                })
                .sum::<f64>()
        });
        let kernel = lobes(&|a| {
            let sinc = if a == 0.0 { 1.0 } else { libm::sin(k_half * a) / (k_half * a) };
            k_half / PI * sinc * sinc
        });
        let phase = 4.0 * PI * height * cos_i;
        let expected = libm::exp(-phase * phase) * kernel * kernel;
        // The factor f = e^{g₀ − g} cos θ_i/cos θ_r is 1 at the mirror direction and its odd part cancels: with
        // |f(u) + f(−u) − 2|/2 ≤ C|u|² on the window, the share is off by C (∫a²K + ∫b²K) ≤ 2 C reach/(π k X).
        let factor = |a: f64, b: f64| {
            let geometry = viewer(a, b);
            libm::exp(phase * phase - roughness.g(&geometry)) * cos_i / geometry.cos_r
        };
        let mut curvature: f64 = 0.0;
        for step_a in -8..=8 {
            for step_b in 0..=8 {
                let (a, b) = (reach * f64::from(step_a) / 8.0, reach * f64::from(step_b) / 8.0);
                if (step_a, step_b) != (0, 0) {
                    let even = (factor(a, b) + factor(-a, -b) - 2.0).abs() / 2.0;
                    curvature = curvature.max(even / (a * a + b * b));
                }
            }
        }
        let slack = expected * (2.0 * curvature * reach / (PI * k_half) + 1e-5);
        assert!((share - expected).abs() < slack, "{height} {theta_i}: {share} {expected} {slack}");
        // The tolerance is 2 % at most, and e^{−g} is not near 1 throughout.
        assert!(slack < 0.02 * expected, "{height} {theta_i}: {slack} {expected}");
    }
}

#[test]
fn facets_of_a_perfect_conductor_send_everything_back() {
    for sigma_alpha in [0.01, 0.05, 0.087] {
        let facets = FacetLobe {
            sigma_alpha,
            specular_scale: normalized_scale(sigma_alpha),
            medium: Medium::PerfectConductor,
            polarization: Polarization::unpolarized(),
            shadowing: ShadowingFunction::None,
        };
        // At normal incidence facets up to 45° reflect upwards; beyond 9 σ there are none (e^{−40}).
        let share = over_hemisphere(0.0, 2.0 * sigma_alpha, 1e-14, |geometry| {
            facets.lobe(geometry, 1.0).value.to_f64()
        });
        // The weight of (α/σ)², 2 on the average, times its 14 ε, and 48 ε.
        let slack = share.error + 80.0 * EPSILON;
        assert!((share.value - 1.0).abs() < slack, "{sigma_alpha}: {share:?}");
    }
}

#[test]
fn a_white_diffuser_sends_everything_back() {
    let (white, beam) = (Fraction::new(1.0).unwrap(), Irradiance::new(1.0).unwrap());
    for theta_i in [0.0, 1.0] {
        let share = over_hemisphere(theta_i, 0.3, 1e-14, |geometry| {
            lambertian::radiance(white, beam, geometry.cos_i).to_f64() * geometry.cos_r / geometry.cos_i
        });
        assert!((share.value - 1.0).abs() < share.error + 16.0 * EPSILON, "{share:?}");
    }
}
