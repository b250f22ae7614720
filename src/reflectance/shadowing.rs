//! Shadowing and masking of facets by their neighbours: the G of (65), and Smith's of a Gaussian surface.

pub(super) mod lanes;
mod smith;

use super::degrees::SinCos;
use super::geometry::Geometry;
use super::roughness::BeckmannWidth;

pub use smith::{Smith, smith_lambda};

/// How facets hide each other.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Shadowing {
    /// Not at all: G = 1.
    None,
    /// The symmetric V-grooves of Torrance and Sparrow, (65).
    VGroove,
    /// A surface of Gaussian slopes, the heights at which source and viewer see a facet being one: 1/(1 + Λ_i + Λ_r).
    Smith,
    /// The same with source and viewer independent of each other: 1/((1 + Λ_i)(1 + Λ_r)).
    SmithUncorrelated,
}

impl Shadowing {
    /// Every one.
    pub const ALL: [Self; 4] = [Self::None, Self::VGroove, Self::Smith, Self::SmithUncorrelated];

    /// The name in requests and answers.
    pub const fn name(self) -> &'static str {
        match self {
            Self::None => "none",
            Self::VGroove => "v_groove",
            Self::Smith => "smith",
            Self::SmithUncorrelated => "smith_uncorrelated",
        }
    }

    /// Whether it depends on the slope of the surface.
    pub const fn needs_slope(self) -> bool {
        matches!(self, Self::Smith | Self::SmithUncorrelated)
    }

    /// G of a surface of this slope, Beckmann's m; none where one is needed and not known.
    pub fn of_slope(self, slope: Option<BeckmannWidth>) -> Option<ShadowingFunction> {
        match self {
            Self::None => Some(ShadowingFunction::None),
            Self::VGroove => Some(ShadowingFunction::VGroove),
            Self::Smith => slope.map(|slope| ShadowingFunction::Smith(Smith::correlated(slope))),
            Self::SmithUncorrelated => {
                slope.map(|slope| ShadowingFunction::Smith(Smith::uncorrelated(slope)))
            }
        }
    }
}

/// [`Shadowing`] of one surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ShadowingFunction {
    /// G = 1.
    None,
    /// (65)
    VGroove,
    /// Smith's.
    Smith(Smith),
}

impl ShadowingFunction {
    /// G, between 0 and 1: the share of the facets' light that is neither shadowed nor masked. A source behind the surface
    /// gives 0; the facet that mirrors the source to the viewer faces both wherever both are above the surface, so that no
    /// side of a facet has to be asked for.
    ///
    /// (65): with q = cos θ_i + cos θ_r and v²/k² = 4 cos² θ′, the ratio 2 cos α/cos θ′ is 4 q k²/v²: no angle is formed.
    /// NaN where its limit depends on the path (both directions grazing and opposite, errata E36). Relative error below 16 ε;
    /// of Smith's see [`Smith`].
    pub fn factor(self, geometry: &Geometry) -> f64 {
        let &Geometry { cos_i, cos_r, .. } = geometry;
        match self {
            Self::None => 1.0,
            Self::VGroove => (groove(geometry) * cos_i.min(cos_r)).clamp(0.0, 1.0),
            // Both directions grazing or not: a limit of 0.
            Self::Smith(_) if cos_i <= 0.0 || cos_r <= 0.0 => 0.0,
            Self::Smith(smith) => (cos_i * cos_r * smith.over_cosines(geometry)).min(1.0),
        }
    }

    /// G/cos θ_r, the factor of (47) and (70) that stays finite at grazing view unless there is no shadowing, where it is
    /// infinite at cos θ_r = 0. Of V-grooves both go to zero at the same rate and the ratio to 2 cos α/cos θ′ (errata E38), of
    /// Smith's to 2√π/m, uncorrelated over 1 + Λ_i. NaN as [`Self::factor`], and of the correlated Smith where both
    /// directions are grazing. Relative error below 16 ε, and of Smith's 4 ε above that of G over both cosines.
    #[inline(always)]
    pub fn factor_over_cos_r(self, geometry: &Geometry) -> f64 {
        let &Geometry { cos_i, cos_r, .. } = geometry;
        let whole = 1.0 / cos_r;
        match self {
            Self::None => whole,
            Self::VGroove => {
                let groove = groove(geometry);
                let hidden = groove * cos_i / cos_r;
                // At cos θ_r = 0 the whole is infinite and the minimum finite.
                least(if cos_r <= cos_i { groove } else { hidden }, whole)
            }
            Self::Smith(smith) => {
                // Beyond a grazing source it is 0 as well.
                let cos_i = if cos_i < 0.0 { 0.0 } else { cos_i };
                cos_i * smith.over_cosines(geometry)
            }
        }
    }

    /// G/(cos θ_i cos θ_r), the factor of a BRDF, in the form that stays finite at grazing source or view unless there is no
    /// shadowing; with the correlated Smith it is infinite where both are. NaN as [`Self::factor`]. Relative error below 16 ε,
    /// and of Smith's as [`Smith`] says.
    #[inline(always)]
    pub fn factor_over_cosines(self, geometry: &Geometry) -> f64 {
        let &Geometry { cos_i, cos_r, .. } = geometry;
        let both = 1.0 / (cos_i * cos_r);
        match self {
            Self::None => both,
            // 0/0 where both directions are grazing.
            Self::VGroove => least(groove(geometry) / cos_i.max(cos_r), both),
            Self::Smith(smith) => smith.over_cosines(geometry),
        }
    }

    /// What its relative error has above 16 ε, in ε.
    #[inline(always)]
    pub(super) const fn units(self) -> f64 {
        match self {
            Self::None | Self::VGroove => 0.0,
            Self::Smith(smith) => smith.units(),
        }
    }
}

/// 1/(1 + Λ) as B. Walter, S. Marschner, H. Li and K. Torrance approximate it ("Microfacet Models for Refraction through
/// Rough Surfaces", 2007) for Λ of [`smith_lambda`]: that is good to 0.004, at a tenth of the price.
pub(super) fn smith_visible_roughly(direction: SinCos, width: f64) -> f64 {
    let v = direction.cos / (direction.sin * width);
    if v < 1.6 { v * (3.535 + 2.181 * v) / (1.0 + v * (2.276 + 2.577 * v)) } else { 1.0 }
}

/// 2 cos α/cos θ′; NaN, 0/0, where v = 0.
#[inline(always)]
fn groove(geometry: &Geometry) -> f64 {
    let length = geometry.length();
    4.0 * geometry.cos_sum / (length * length)
}

/// The smaller of G's two forms, NaN where the first is, and not below 0.
#[inline(always)]
fn least(hidden: f64, whole: f64) -> f64 {
    let least = if whole < hidden { whole } else { hidden };
    if least < 0.0 { 0.0 } else { least }
}

#[cfg(test)]
mod tests {
    use super::{ShadowingFunction as G, smith_lambda, smith_visible_roughly};
    use crate::reflectance::degrees::SinCos;
    use crate::reflectance::geometry::Geometry;
    use crate::reflectance::quantity::{Azimuth, Quantity, SourceZenith, ViewerZenith};

    fn geometry(theta_i: f64, theta_r: f64, phi_r: f64) -> Geometry {
        Geometry::new(
            SourceZenith::new(theta_i).unwrap(),
            ViewerZenith::new(theta_r).unwrap(),
            Azimuth::new(phi_r).unwrap(),
        )
    }

    #[test]
    fn nothing_is_hidden_at_the_mirror_direction() {
        for theta in [0.0, 30.0, 89.0, 89.999999] {
            assert_eq!(G::VGroove.factor(&geometry(theta, theta, 0.0)), 1.0);
        }
    }

    #[test]
    fn figure_19_has_its_kinks_at_0_and_80_degrees() {
        // For θ_i = 60°: 2 cos 10° cos 80° = sin 20° = cos 70° at θ_r = 80°, and 2 cos 60° = 1 at θ_r = 0.
        for (theta_r, whole) in [(0.001, true), (79.999, true), (-0.001, false), (80.001, false)] {
            assert_eq!(G::VGroove.factor(&geometry(60.0, theta_r, 0.0)) == 1.0, whole, "{theta_r}");
        }
    }

    #[test]
    fn grazing_view_has_a_finite_limit() {
        // 2 cos α/cos θ′ with α = 15°, θ′ = 75°.
        let limit = 2.0 * libm::cos(15f64.to_radians()) / libm::cos(75f64.to_radians());
        let got = G::VGroove.factor_over_cos_r(&geometry(60.0, 90.0, 0.0));
        // The reference takes the cosine of a rounded 75°: tan 75° times its rounding, and a few more.
        assert!((got / limit - 1.0).abs() < 16.0 * f64::EPSILON, "{got} {limit}");
        let near = G::VGroove.factor_over_cos_r(&geometry(60.0, 89.999_999_999, 0.0));
        assert!((near / limit - 1.0).abs() < 1e-9, "{near} {limit}");
        assert_eq!(G::None.factor_over_cos_r(&geometry(60.0, 90.0, 0.0)), f64::INFINITY);
    }

    #[test]
    fn both_grazing() {
        assert!(G::VGroove.factor(&geometry(90.0, 90.0, 0.0)).is_nan());
        assert!(G::VGroove.factor_over_cos_r(&geometry(90.0, 90.0, 0.0)).is_nan());
        // Towards any other azimuth v does not vanish and the limit is 0.
        assert_eq!(G::VGroove.factor(&geometry(90.0, 90.0, 40.0)), 0.0);
        assert_eq!(G::VGroove.factor_over_cos_r(&geometry(90.0, 90.0, 40.0)), 0.0);
    }

    #[test]
    fn lambda_makes_visible_facets_fill_the_view() {
        // Σ of the projections of all facets turned to the viewer is (1 + Λ) cos θ; by the density of slopes p along the
        // view, ∫ (cos θ + p sin θ)⁺ exp(−p²/m²)/(m√π) dp, which is Λ's definition.
        for (theta, width) in [(30.0, 0.5), (60.0, 0.4), (80.0, 0.2), (89.0, 1.0), (45.0, 2.0)] {
            let direction = SinCos::of_degrees(theta);
            let steps = 200_000;
            let step = 14.0 / f64::from(steps);
            let projected: f64 = (0..steps)
                .map(|i| -7.0 + step * (f64::from(i) + 0.5))
                .map(|t| (direction.cos + direction.sin * width * t).max(0.0) * libm::exp(-t * t))
                .sum::<f64>()
                * step
                / core::f64::consts::PI.sqrt();
            let got = 1.0 + smith_lambda(direction, width);
            // The midpoint rule at a kink: half a step squared.
            assert!((got - projected / direction.cos).abs() < 1e-8 / direction.cos, "{theta} {width} {got}");
        }
        assert_eq!(smith_lambda(SinCos::of_degrees(0.0), 0.3), 0.0);
        assert_eq!(smith_lambda(SinCos::of_degrees(90.0), 0.3), f64::INFINITY);
    }

    #[test]
    fn the_rational_form_is_as_good_as_it_says() {
        let mut worst: f64 = 0.0;
        for step in 0..9000 {
            let direction = SinCos::of_degrees(0.01 * f64::from(step));
            let exact = 1.0 / (1.0 + smith_lambda(direction, 0.7));
            worst = worst.max((smith_visible_roughly(direction, 0.7) - exact).abs());
        }
        assert!(worst < 0.004 && worst > 0.001, "{worst}");
    }
}
