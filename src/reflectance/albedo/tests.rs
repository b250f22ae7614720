//! The coordinates and the integrals, against closed forms and against themselves.

use super::hemisphere::{Extent, Hemisphere, Kinks};
use super::{Albedo, AlbedoScene};
use crate::reflectance::degrees::SinCos;
use crate::reflectance::fresnel::{Medium, Polarization, RefractiveIndex};
use crate::reflectance::geometry::Geometry;
use crate::reflectance::numeric::EPSILON;
use crate::reflectance::numeric::cubature::{self, Cubature, Goal, NODES};
use crate::reflectance::numeric::quadrature::integrate;
use crate::reflectance::quantity::{FacetSlope, IndexK, IndexN, Quantity, SourceZenith};
use crate::reflectance::samples::conductor;
use crate::reflectance::scene::{Component, Components, Model, SceneParameters};
use crate::reflectance::shadowing::Shadowing;
use core::f64::consts::PI;

fn extent(width: f64) -> Extent {
    Extent { width, finest: 1.0, end: f64::INFINITY }
}

/// Over the hemisphere of viewers, ∫ f dω_r.
fn over_viewers(theta_i: f64, width: f64, kinks: Kinks, f: impl Fn(&Geometry) -> f64) -> Cubature {
    let hemisphere = Hemisphere::new(SinCos::of_degrees(theta_i), &extent(width), kinks);
    cubature::integrate(
        hemisphere.squares(),
        Goal { tolerance: 1e-11, beside: 0.0, most: 4000, has_kinks: false },
        || false,
        |square, grid| {
            for i in 0..NODES {
                let ring = hemisphere.ring(square, grid.first[i]);
                for j in 0..NODES {
                    let facet = ring.facet(grid.second[j]);
                    let solid_angle = facet.measure * ring.slope.sin * ring.slope.sin * ring.slope.cos;
                    grid.values[i][j] = 4.0 * facet.cos_local * solid_angle * f(&ring.geometry(&facet));
                }
            }
        },
    )
    .unwrap()
}

#[test]
fn the_facets_cover_the_hemisphere_once() {
    let (all, none) = (Kinks { grooves: true, critical: Some(0.6) }, Kinks::default());
    for (theta_i, width, kinks) in [
        (0.0, 1e-12, all),
        (0.0, 1.0, none),
        (1e-7, 0.1, all),
        (30.0, 1e-5, none),
        (45.0, 0.3, all),
        (60.0, 1.0, all),
        (85.0, 1e-3, all),
        (89.999, 0.1, none),
        (90.0 - 1e-13, 1e-4, all),
        (90.0, 0.5, none),
    ] {
        for (power, exact) in [(0, 2.0 * PI), (1, PI), (2, 2.0 * PI / 3.0)] {
            let got = over_viewers(theta_i, width, kinks, |geometry| geometry.cos_r.powi(power));
            let off = (got.value - exact).abs();
            assert!(off <= got.error + 1e-13 && got.error < 1e-9, "{theta_i} {width} {power}: {got:?}");
        }
    }
}

#[test]
fn a_facet_has_the_geometry_of_its_directions() {
    for theta_i in [10.0, 60.0, 89.0] {
        let hemisphere = Hemisphere::new(SinCos::of_degrees(theta_i), &extent(0.2), Kinks::default());
        for square in 0..hemisphere.squares() {
            for (first, second) in [(0.1, 0.2), (0.5, 0.5), (0.9, 0.7)] {
                let ring = hemisphere.ring(square, first);
                let got = ring.geometry(&ring.facet(second));
                let theta_r = libm::atan2(got.sin_r, got.cos_r);
                let exact = Geometry::from_radians(
                    theta_i.to_radians(),
                    theta_r,
                    libm::atan2(got.across(), got.sin_i - got.along()),
                );
                // Angles in radians carry ε of themselves, and their sines and cosines a few more.
                let off = |a: f64, b: f64| (a - b).abs() < 64.0 * EPSILON;
                assert!(off(got.cos_sum, exact.cos_sum) && off(got.cos_r, exact.cos_r), "{got:?} {exact:?}");
                assert!(off(got.length(), exact.length()), "{got:?} {exact:?}");
                // A root of 1 − cos φ, or of 1 − cos² θ_r, keeps half the digits.
                let root = 64.0 * EPSILON.sqrt();
                let (a, b) = (got.local_incidence(), exact.local_incidence());
                assert!((a.sin - b.sin).abs() < root && off(a.cos, b.cos), "{got:?} {exact:?}");
                assert!((got.along() - exact.along()).abs() < root, "{got:?} {exact:?}");
                assert!((got.across() - exact.across()).abs() < root, "{got:?} {exact:?}");
            }
        }
    }
}

fn at(parameters: SceneParameters, theta_i: f64) -> Albedo {
    AlbedoScene::new(parameters).unwrap().at(SourceZenith::new(theta_i).unwrap(), || false).unwrap()
}

fn lobe(albedo: &Albedo) -> (f64, f64) {
    let lobe = albedo.components[1].unwrap();
    (lobe.value.to_f64(), lobe.error.to_f64())
}

#[test]
fn a_smooth_surface_of_short_correlation_scatters_as_its_closed_form() {
    // For g → 0 and T → 0 S is g: the lobe is π³ (T σ_h/λ²)² (4 cos² θ′)²/cos θ_i, and with cos 2θ′ averaged over the
    // hemisphere that adds up to 8π⁴ (T σ_h/λ²)² (4/3 + cos θ_i)/cos θ_i.
    for theta_i in [0.0, 20.0, 60.0, 85.0, 89.99] {
        let mut p = conductor(Model::BeckmannSpizzichino, [1e-9, 1e-8], 1e-9);
        p.components = Components::Named(vec![Component::SpecularLobe]);
        let (value, error) = lobe(&at(p, theta_i));
        let cos = SinCos::of_degrees(theta_i).cos;
        let exact = 8.0 * PI.powi(4) * 1e-34 * (4.0 / 3.0 + cos) / cos;
        // What is beyond the limit is of the order of (kT)² = 4e-15.
        assert!((value - exact).abs() <= error + 1e-13 * exact, "{theta_i}: {value} {exact} {error}");
        assert!(error < 1.1e-9 * exact, "{theta_i}");
    }
}

#[test]
fn facets_at_normal_incidence_are_one_integral() {
    // ∫ c·a_f e^{−α²/2σ²} F′(α) cos α 2π sin α dα up to 45°, with G = min(1, 2 cos 2α).
    let glass = RefractiveIndex { n: IndexN::new(1.5).unwrap(), k: IndexK::new(0.0).unwrap() };
    for (slope, shadowing) in
        [(5.0, Shadowing::None), (40.0, Shadowing::VGroove), (200.0, Shadowing::VGroove)]
    {
        let mut p = conductor(Model::TorranceSparrow, [1.0, 1.0], 1e-11);
        p.surface.facet_slope = Some(FacetSlope::new(slope).unwrap());
        p.surface.medium = Medium::Index(glass);
        p.surface.shadowing = Some(shadowing);
        let sigma = slope.to_radians();
        let scale = crate::reflectance::torrance_sparrow::normalized_scale(sigma);
        let integrand = |alpha: f64| {
            let (sin, cos) = libm::sincos(alpha);
            let seen =
                if shadowing == Shadowing::None { 1.0 } else { (2.0 * libm::cos(2.0 * alpha)).min(1.0) };
            let reflected = glass.energies(SinCos { sin, cos }).mixed(Polarization::unpolarized()).value;
            scale * libm::exp(-0.5 * (alpha / sigma).powi(2)) * reflected * seen * cos * 2.0 * PI * sin
        };
        let exact = integrate(0.0, PI / 6.0, integrand).plus(integrate(PI / 6.0, PI / 4.0, integrand));
        let (value, error) = lobe(&at(p, 0.0));
        // The scale is good to 8 ε, and so is the angle of slope.
        let slack = error + exact.error + 64.0 * EPSILON * exact.value;
        assert!((value - exact.value).abs() <= slack, "{slope}: {value} {exact:?} {error}");
        assert!(error < 2e-11 * value, "{slope}: {error}");
    }
}

#[test]
fn narrow_lobes_send_all_that_arrives() {
    // What is left of 1 is of the order of the squared width, and of what grazes: none here.
    for theta_i in [0.0, 30.0, 80.0] {
        for lengths in [[1e3, 1e9], [1e-3, 1e9], [1e6, 1e15]] {
            let albedo = at(conductor(Model::BeckmannSpizzichino, lengths, 1e-9), theta_i);
            let (total, error) = (albedo.total.value.to_f64(), albedo.total.error.to_f64());
            assert!((total - 1.0).abs() <= error + 1e-9, "{theta_i} {lengths:?}: {total} {error}");
        }
        let mut p = conductor(Model::TorranceSparrow, [1.0, 1.0], 1e-9);
        p.surface.facet_slope = Some(FacetSlope::new(1e-12).unwrap());
        let (value, error) = lobe(&at(p, theta_i));
        assert!((value - 1.0).abs() <= error + 1e-13, "{theta_i}: {value} {error}");
    }
}

#[test]
fn a_grazing_source_has_its_limit_or_none() {
    for (model, shadowing, exact) in [
        (Model::BeckmannSpizzichino, Shadowing::None, f64::INFINITY),
        (Model::TorranceSparrow, Shadowing::None, f64::INFINITY),
        (Model::Unified, Shadowing::None, 0.0),
        (Model::Unified, Shadowing::VGroove, 0.0),
    ] {
        let mut p = conductor(model, [0.2, 2.0], 1e-6);
        p.surface.shadowing = Some(shadowing);
        assert_eq!(at(p, 90.0).components[1].unwrap().value.to_f64(), exact, "{model:?} {shadowing:?}");
    }
    // With V-grooves the limit is what comes next to it.
    for model in [Model::BeckmannSpizzichino, Model::TorranceSparrow] {
        let mut p = conductor(model, [0.2, 2.0], 1e-8);
        p.surface.shadowing = Some(Shadowing::VGroove);
        let (limit, error) = lobe(&at(p.clone(), 90.0));
        let (next, next_error) = lobe(&at(p, 90.0 - 1e-11));
        assert!((limit - next).abs() <= error + next_error + 1e-9 * limit, "{model:?}: {limit} {next}");
    }
    let mut dark = conductor(Model::TorranceSparrow, [0.2, 2.0], 1e-6);
    dark.surface.specular_scale = crate::reflectance::quantity::SpecularScale::new(0.0).ok();
    assert!(at(dark, 90.0).total.value.is_zero());
}

#[test]
fn nobody_waits_for_a_stopped_integral() {
    let scene = AlbedoScene::new(conductor(Model::BeckmannSpizzichino, [0.2, 2.0], 1e-6)).unwrap();
    assert!(scene.at(SourceZenith::new(10.0).unwrap(), || true).is_none());
}
