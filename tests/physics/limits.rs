//! Reciprocity, the microfacet form of the rough limit, shadowing, and the roughness of figure 23.

use crate::{assert_close, directions};
use reflectance::reflectance::beckmann_spizzichino::{Patch, RelativeRoughness};
use reflectance::reflectance::fresnel::{Medium, Polarization, RefractiveIndex};
use reflectance::reflectance::geometry::Geometry;
use reflectance::reflectance::numeric::lobe_series::Method;
use reflectance::reflectance::numeric::scaled::Scaled;
use reflectance::reflectance::quantity::{
    BeckmannAlpha, CorrelationLength, IndexK, IndexN, InvertibleFacetSlope, Quantity, RmsHeight,
};
use reflectance::reflectance::roughness::{Widths, facet_slope_radians, height_to_length_ratio};
use reflectance::reflectance::shadowing::{Shadowing, ShadowingFunction};
use reflectance::reflectance::surface::facet_density;
use reflectance::reflectance::torrance_sparrow::FacetLobe;

/// Source and viewer change places: the zeniths swap and the azimuth between them stays.
fn pairs() -> impl Iterator<Item = (Geometry, Geometry)> {
    let zeniths = [0.0, 5.0, 30.0, 60.0, 85.0, 89.999];
    let azimuths = [0.0, 40.0, 90.0, 170.0, 180.0];
    zeniths.into_iter().flat_map(move |i| {
        zeniths.into_iter().flat_map(move |r| {
            azimuths.into_iter().map(move |phi| (directions(i, r, phi), directions(r, i, phi)))
        })
    })
}

const ROUGHNESS: [RelativeRoughness; 4] = [
    RelativeRoughness { height: 0.02, correlation_length: 3.0 },
    RelativeRoughness { height: 0.3, correlation_length: 2.0 },
    RelativeRoughness { height: 2.0, correlation_length: 10.0 },
    RelativeRoughness { height: 40.0, correlation_length: 100.0 },
];

/// Every shadowing, on slopes of this m.
fn shadowings(width: f64) -> [ShadowingFunction; 4] {
    let slope = Widths::from_beckmann_alpha(BeckmannAlpha::new(width).expect("m")).beckmann_alpha;
    Shadowing::ALL.map(|shadowing| shadowing.of_slope(Some(slope)).expect("a slope"))
}

#[test]
fn the_lobes_are_reciprocal() {
    let facets = FacetLobe {
        sigma_alpha: 0.2,
        specular_scale: 4.0,
        medium: Medium::PerfectConductor,
        polarization: Polarization::unpolarized(),
        shadowing: ShadowingFunction::VGroove,
    };
    for (there, back) in pairs() {
        for shadowing in shadowings(0.3) {
            let (over_there, over_back) =
                (shadowing.factor_over_cosines(&there), shadowing.factor_over_cosines(&back));
            for roughness in ROUGHNESS {
                let lobe = |geometry: &Geometry, over: f64| roughness.lobe(geometry, over, Method::Series).0;
                let (a, b) = (lobe(&there, over_there), lobe(&back, over_back));
                // Each keeps its own bound.
                let difference = (a.value.to_f64() - b.value.to_f64()).abs();
                assert!(difference <= (a.error + b.error).to_f64(), "{roughness:?} {there:?}");
            }
            let (a, b) = (facets.lobe(&there, over_there), facets.lobe(&back, over_back));
            let difference = (a.value.to_f64() - b.value.to_f64()).abs();
            assert!(difference <= (a.error + b.error).to_f64(), "{there:?}");
        }
    }
}

#[test]
fn the_spike_as_printed_is_not_reciprocal_and_the_square_of_d_would_make_it_so() {
    // Errata E15, for a fixed patch seen whole: f(0.5, 0.8)/f(0.8, 0.5) = 1.5866. The footprint of that patch is A cos θ_r.
    let brdf = |i: f64, r: f64| {
        let geometry = Geometry::from_radians(i, r, 0.0);
        let patch = Patch { footprint: Scaled::new(geometry.cos_r), half_x: 0.5, half_y: 0.5 };
        let mirror = RelativeRoughness { height: 0.0, correlation_length: 1.0 };
        (mirror.spike(&geometry, geometry.cos_i, &patch).value.to_f64(), geometry.d())
    };
    let ((there, d_there), (back, d_back)) = (brdf(0.5, 0.8), brdf(0.8, 0.5));
    assert!((there / back - 1.5866).abs() < 5e-5, "{}", there / back);
    // ρ_o² is even in v and its phase here is 0.75: rounding 64 ε each.
    assert_close(there * d_there * d_there, back * d_back * d_back, 256.0);
}

#[test]
fn the_rough_limit_is_the_microfacet_form_with_beckmanns_density() {
    // Errata E24: (49) over the irradiance is D/(4 cos θ_r), F = G = 1; λ drops out.
    for (geometry, _) in pairs() {
        for (height, correlation_length) in [(10.0, 100.0), (1e6, 3e6)] {
            let roughness = RelativeRoughness { height, correlation_length };
            let ratio = height / correlation_length;
            let rough = roughness.lobe(&geometry, 1.0 / geometry.cos_r, Method::Rough).0.value;
            let alpha = geometry.alpha();
            let density = facet_density(alpha, ratio);
            // The exponent u is known to 48 ε on one side and to 12 ε and the condition of tan α, α/(sin α cos α), on the
            // other; the factors cost 96 ε, and cos⁻⁴ α four times that condition.
            let slope = geometry.tan_alpha() / (2.0 * ratio);
            let condition = 1.0 + geometry.tan_alpha() * alpha;
            let log_slack =
                f64::EPSILON * (96.0 + slope * slope * (32.0 + 4.0 * condition) + 8.0 * condition);
            let difference = rough.ln() - (density.ln() - (4.0 * geometry.cos_r).ln());
            // The logarithms themselves are rounded.
            let slack = log_slack + 4.0 * f64::EPSILON * rough.ln().abs();
            assert!(difference.abs() <= slack, "{geometry:?} {ratio} {difference} {slack}");
        }
    }
}

#[test]
fn shadowing_is_symmetric_and_at_most_one() {
    for (there, back) in pairs() {
        for width in [1e-9, 0.05, 0.3, 2.0, 1e9] {
            for shadowing in shadowings(width) {
                let (g, swapped) = (shadowing.factor(&there), shadowing.factor(&back));
                assert!((0.0..=1.0).contains(&g), "{shadowing:?} {there:?} {g}");
                // Both are known to 16 ε, or 16 and 40 ε, of the exact one, which is symmetric.
                assert_close(g, swapped, 56.0);
            }
        }
        assert_eq!(ShadowingFunction::None.factor(&there), 1.0);
    }
}

#[test]
fn reflectances_are_shares() {
    for (n, k) in [(1.5, 0.0), (0.7, 0.0), (0.2, 3.4), (1e-9, 1e9), (1e9, 0.0), (1.0, 1e-12)] {
        let medium =
            Medium::Index(RefractiveIndex { n: IndexN::new(n).unwrap(), k: IndexK::new(k).unwrap() });
        for (geometry, _) in pairs() {
            let energy = medium.reflectance(geometry.local_incidence(), Polarization::unpolarized());
            assert!((0.0..=1.0).contains(&energy.value) && energy.error >= 0.0, "{n} {k} {energy:?}");
        }
    }
}

#[test]
fn the_roughness_relation_goes_both_ways() {
    for ratio in [1e-60, 1e-6, 0.03, 0.1, 0.2, 1.0, 50.0] {
        let sigma = facet_slope_radians(ratio);
        let back = height_to_length_ratio(sigma).unwrap();
        // 4 ε there, times the condition √2σ/(sin cos) of the way back, and its own 8 ε.
        let angle = core::f64::consts::SQRT_2 * sigma;
        let condition = angle / (libm::sin(angle) * libm::cos(angle));
        assert_close(back, ratio, 8.0 + 5.0 * condition);
    }
}

#[test]
fn figure_23_has_the_slopes_of_its_ratios() {
    // (a) with σ_h = 0.0003 (errata E41), (c), (e); 7.99 is 7.997 cut.
    for (rms_height, printed) in [(0.0003, 2.428), (0.001, 7.997), (0.002, 15.416)] {
        let widths =
            Widths::from_heights(RmsHeight::new(rms_height).unwrap(), CorrelationLength::new(0.01).unwrap());
        assert!((widths.facet_slope.get() - printed).abs() < 0.0005, "{widths:?}");
        let back = Widths::from_facet_slope(InvertibleFacetSlope::new(widths.facet_slope.get()).unwrap());
        // 4 ε and a conversion there, 8 ε back, at a condition below 1.1.
        assert_close(back.height_to_length.get(), rms_height / 0.01, 16.0);
    }
}
