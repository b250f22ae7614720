//! Smith's masking and shadowing of a surface of Gaussian slopes.
//!
//! B. G. Smith, *Geometrical shadowing of a random rough surface*, IEEE Trans. Antennas Propag. 15 (1967) 668. A facet is seen from
//! a direction of zenith θ with probability G₁ = 1/(1 + Λ), where (1 + Λ) cos θ is the projected area of all facets that
//! face that way, over the mean plane's. Both ways of combining source and viewer are as E. Heitz names them,
//! *Understanding the masking-shadowing function in microfacet-based BRDFs*, JCGT 3 (2014) 48.
//!
//! With m and v = cot θ/m, Λ cos θ = ½ m sin θ ∫ erfc from v on: a product, in which nothing cancels and which is finite at
//! grazing, where Λ alone is not.

use crate::reflectance::degrees::SinCos;
use crate::reflectance::geometry::Geometry;
use crate::reflectance::numeric::erfc_integral::erfc_integral;
use crate::reflectance::region::Span;
use crate::reflectance::roughness::BeckmannWidth;

/// Smith's function of one surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Smith {
    /// Beckmann's m of the density exp(−tan²α/m²)/(π m² cos⁴α) of the facets, per solid angle.
    width: f64,
    /// Whether the heights at which source and viewer see a facet are one.
    correlated: bool,
}

impl Smith {
    /// 1/(1 + Λ_i + Λ_r): a facet that lies high is seen from everywhere.
    pub const fn correlated(width: BeckmannWidth) -> Self {
        Self { width: width.get(), correlated: true }
    }

    /// 1/((1 + Λ_i)(1 + Λ_r)): source and viewer see a facet independently of each other.
    pub const fn uncorrelated(width: BeckmannWidth) -> Self {
        Self { width: width.get(), correlated: false }
    }

    /// Whether source and viewer see one height.
    pub(in crate::reflectance) const fn is_correlated(self) -> bool {
        self.correlated
    }

    /// Λ cos θ between the ends of a zenith: it grows with it.
    pub(in crate::reflectance) fn hidden(self, sin: Span, cos: Span) -> Span {
        Span { least: hidden(sin.least, cos.most, self.width), most: hidden(sin.most, cos.least, self.width) }
    }

    /// How much larger its relative error is than that of the others, in ε, for an m that is known to 8 ε.
    pub(super) const fn units(self) -> f64 {
        if self.correlated { 20.0 } else { 40.0 }
    }

    /// G over cos θ_i cos θ_r. Finite unless both directions are grazing and it is correlated; 0 for a source behind the
    /// surface.
    ///
    /// Relative error below 23 ε and that of m if it is correlated, 36 ε and twice that of m if not: (1 + Λ) cos θ carries
    /// 4 ε and m's for cosine and slope, 9 ε for the integral and 4 ε for its own roundings.
    #[inline(always)]
    pub(super) fn over_cosines(self, geometry: &Geometry) -> f64 {
        let &Geometry { cos_i, sin_i, cos_r, sin_r, .. } = geometry;
        let (hidden_i, hidden_r) = (hidden(sin_i, cos_i, self.width), hidden(sin_r, cos_r, self.width));
        // (½ + Λ_i) cos θ_i cos θ_r and the same of the viewer add up to 1 + Λ_i + Λ_r.
        let correlated = cos_r * (0.5 * cos_i + hidden_i) + cos_i * (0.5 * cos_r + hidden_r);
        let uncorrelated = (cos_i + hidden_i) * (cos_r + hidden_r);
        let over = 1.0 / if self.correlated { correlated } else { uncorrelated };
        if cos_i < 0.0 { 0.0 } else { over }
    }
}

/// Λ cos θ
#[inline(always)]
fn hidden(sin: f64, cos: f64, width: f64) -> f64 {
    let slope = width * sin;
    let v = cos / slope;
    // A source behind the surface sees nothing, whatever this is.
    let v = if v > 0.0 { v } else { 0.0 };
    0.5 * slope * erfc_integral(v)
}

/// Λ: the share 1/(1 + Λ) of the facets is seen from this direction. `width` is Beckmann's m = 2σ_h/T; 0 at normal incidence,
/// infinite at grazing. Absolute error below 8 ε (1 + Λ).
pub fn smith_lambda(direction: SinCos, width: f64) -> f64 {
    hidden(direction.sin, direction.cos, width) / direction.cos
}

#[cfg(test)]
mod tests {
    use super::{Smith, smith_lambda};
    use crate::reflectance::degrees::SinCos;
    use crate::reflectance::geometry::Geometry;
    use crate::reflectance::numeric::EPSILON;
    use crate::reflectance::quantity::{Azimuth, BeckmannAlpha, Quantity, SourceZenith, ViewerZenith};
    use crate::reflectance::roughness::{BeckmannWidth, Widths};
    use crate::reflectance::shadowing::ShadowingFunction;
    use core::f64::consts::PI;

    const ZENITHS: [f64; 5] = [0.0, 20.0, 60.0, 85.0, 89.9];

    /// 1 + Λ at these zeniths by its definition, ∫ (cos θ + p sin θ)⁺ exp(−p²/m²)/(m√π) dp over cos θ:
    /// scripts/coefficients/erfc_integral.py in 60 digits.
    const BY_DEFINITION: [(f64, [f64; 5]); 3] = [
        (0.05, [1.0, 1.0, 1.0, 1.0008760980443059, 8.59125726643956]),
        (0.4, [1.0, 1.0, 1.0037218167377633, 1.850956249498435, 65.15252918668533]),
        (3.0, [1.0, 1.0355143149634098, 2.0197640514113857, 10.181300205808677, 485.38490150584005]),
    ];

    fn slope(width: f64) -> BeckmannWidth {
        Widths::from_beckmann_alpha(BeckmannAlpha::new(width).unwrap()).beckmann_alpha
    }

    fn geometry(theta_i: f64, theta_r: f64) -> Geometry {
        Geometry::new(
            SourceZenith::new(theta_i).unwrap(),
            ViewerZenith::new(theta_r).unwrap(),
            Azimuth::new(70.0).unwrap(),
        )
    }

    #[test]
    fn lambda_is_what_its_definition_says() {
        for (width, exact) in BY_DEFINITION {
            for (zenith, exact) in ZENITHS.into_iter().zip(exact) {
                let got = 1.0 + smith_lambda(SinCos::of_degrees(zenith), width);
                assert!((got / exact - 1.0).abs() <= 9.0 * EPSILON, "{zenith} {width}: {got} {exact}");
            }
        }
    }

    #[test]
    fn all_forms_of_g_keep_their_bounds() {
        let mut worst = [0.0f64; 2];
        for (width, exact) in BY_DEFINITION {
            let kinds = [Smith::correlated(slope(width)), Smith::uncorrelated(slope(width))];
            for (i, &of_source) in ZENITHS.iter().zip(&exact) {
                for (r, &of_viewer) in ZENITHS.iter().zip(&exact) {
                    let geometry = geometry(*i, *r);
                    for (kind, smith) in kinds.into_iter().enumerate() {
                        let exact = if smith.is_correlated() {
                            1.0 / (of_source + of_viewer - 1.0)
                        } else {
                            1.0 / (of_source * of_viewer)
                        };
                        let g = ShadowingFunction::Smith(smith);
                        let (cos_i, cos_r) = (geometry.cos_i, geometry.cos_r);
                        for got in [
                            g.factor(&geometry),
                            g.factor_over_cos_r(&geometry) * cos_r,
                            g.factor_over_cosines(&geometry) * cos_i * cos_r,
                        ] {
                            let units = (got / exact - 1.0).abs() / EPSILON;
                            worst[kind] = worst[kind].max(units);
                            // m is exact here; the comparison's own cosines and roundings are within what is allowed for m.
                            assert!(units <= 16.0 + smith.units(), "{smith:?} {i} {r}: {got} {exact}");
                        }
                    }
                }
            }
        }
        // And the bounds are not idle.
        assert!(worst.iter().all(|&units| units > 2.0), "{worst:?}");
    }

    #[test]
    fn grazing_has_its_limits() {
        let width = 0.3;
        let (correlated, uncorrelated) = (Smith::correlated(slope(width)), Smith::uncorrelated(slope(width)));
        let limit = 2.0 * PI.sqrt() / width;
        let seen = 1.0 / (1.0 + smith_lambda(SinCos::of_degrees(80.0), width));
        for (smith, limit) in [(correlated, limit), (uncorrelated, limit * seen)] {
            let g = ShadowingFunction::Smith(smith);
            let at = g.factor_over_cos_r(&geometry(80.0, 90.0));
            assert!((at / limit - 1.0).abs() < 64.0 * EPSILON, "{at} {limit}");
            // Next to it the difference goes with the cosine: 1e-9 of a degree is 2e-11, over a Λ_i and a slope of 0.3.
            let near = g.factor_over_cos_r(&geometry(80.0, 89.999_999_999));
            assert!((near / limit - 1.0).abs() < 1e-9, "{near} {limit}");
            assert_eq!(g.factor(&geometry(80.0, 90.0)), 0.0);
            assert_eq!(g.factor(&geometry(90.0, 90.0)), 0.0);
            assert_eq!(g.factor_over_cos_r(&geometry(90.0, 80.0)), 0.0);
        }
        // Both grazing: a radiance depends on the path, a BRDF has none.
        assert!(ShadowingFunction::Smith(correlated).factor_over_cos_r(&geometry(90.0, 90.0)).is_nan());
        assert_eq!(correlated.over_cosines(&geometry(90.0, 90.0)), f64::INFINITY);
        let both = uncorrelated.over_cosines(&geometry(90.0, 90.0));
        assert!((both / (limit * limit) - 1.0).abs() < 64.0 * EPSILON, "{both}");
    }

    #[test]
    fn a_source_behind_the_surface_lights_nothing() {
        let behind = Geometry::from_radians(2.0, 0.5, 0.0);
        for smith in [Smith::correlated(slope(0.3)), Smith::uncorrelated(slope(0.3))] {
            let g = ShadowingFunction::Smith(smith);
            let factors = [g.factor(&behind), g.factor_over_cos_r(&behind), g.factor_over_cosines(&behind)];
            assert_eq!(factors, [0.0; 3]);
        }
    }

    #[test]
    fn extreme_slopes_stay_numbers() {
        for width in [1e-120, 1e-9, 1e9, 1e120] {
            for smith in [Smith::correlated(slope(width)), Smith::uncorrelated(slope(width))] {
                for theta_r in [0.0, 1e-300, 45.0, 89.999_999_999_999] {
                    let g = ShadowingFunction::Smith(smith).factor(&geometry(30.0, theta_r));
                    assert!((0.0..=1.0).contains(&g), "{width} {theta_r} {g}");
                }
            }
        }
    }
}
