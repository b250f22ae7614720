//! Shadowing and masking of facets by their neighbours: the G of (65).

use super::geometry::Geometry;

/// How facets hide each other.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shadowing {
    /// Not at all: G = 1.
    None,
    /// The symmetric V-grooves of Torrance and Sparrow, (65).
    VGroove,
}

impl Shadowing {
    /// The name in requests and answers.
    pub const fn name(self) -> &'static str {
        match self {
            Self::None => "none",
            Self::VGroove => "v_groove",
        }
    }

    /// G of (65), between 0 and 1: the share of the facets' light that is neither shadowed nor masked.
    ///
    /// With q = cos θ_i + cos θ_r and v²/k² = 4 cos² θ′, the ratio 2 cos α/cos θ′ is
    /// 4 q k²/v²: no angle is formed. A source behind the surface gives 0. NaN where the limit depends on
    /// the path (both directions grazing and opposite, errata E36). Relative error below 16 ε.
    pub fn factor(self, geometry: &Geometry) -> f64 {
        match self {
            Self::None => 1.0,
            Self::VGroove => {
                let Some(groove) = groove(geometry) else { return f64::NAN };
                (groove * geometry.cos_i.min(geometry.cos_r)).clamp(0.0, 1.0)
            }
        }
    }

    /// G/cos θ_r, the factor of (70) that stays finite at grazing view if there are V-grooves: both go
    /// to zero at the same rate and the ratio to 2 cos α/cos θ′ (errata E38). Without shadowing it is
    /// infinite at cos θ_r = 0. NaN as [`Self::factor`]. Relative error below 16 ε.
    pub fn factor_over_cos_r(self, geometry: &Geometry) -> f64 {
        let &Geometry { cos_i, cos_r, .. } = geometry;
        match self {
            Self::None => 1.0 / cos_r,
            Self::VGroove => {
                let Some(groove) = groove(geometry) else { return f64::NAN };
                if cos_r <= cos_i {
                    // At cos θ_r = 0 the second is infinite and the minimum finite.
                    groove.min(1.0 / cos_r)
                } else {
                    (groove * cos_i / cos_r).min(1.0 / cos_r).max(0.0)
                }
            }
        }
    }

    /// G/(cos θ_i cos θ_r), the factor of a BRDF, in the form that stays finite at grazing source or
    /// view if there are V-grooves. NaN as [`Self::factor`]. Relative error below 16 ε.
    pub fn factor_over_cosines(self, geometry: &Geometry) -> f64 {
        let &Geometry { cos_i, cos_r, .. } = geometry;
        let both = 1.0 / (cos_i * cos_r);
        match self {
            Self::None => both,
            Self::VGroove => {
                let Some(groove) = groove(geometry) else { return f64::NAN };
                // 0/0 where both directions are grazing.
                let hidden = groove / cos_i.max(cos_r);
                if hidden.is_nan() { hidden } else { hidden.min(both) }
            }
        }
    }
}

/// 2 cos α/cos θ′; none where v = 0.
fn groove(geometry: &Geometry) -> Option<f64> {
    let length = geometry.length();
    // v/k is 0 or above 1e-17: its square cannot underflow.
    (length > 0.0).then(|| 4.0 * geometry.cos_sum / (length * length))
}

#[cfg(test)]
mod tests {
    use super::Shadowing;
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
            assert_eq!(Shadowing::VGroove.factor(&geometry(theta, theta, 0.0)), 1.0);
        }
    }

    #[test]
    fn figure_19_has_its_kinks_at_0_and_80_degrees() {
        // For θ_i = 60°: 2 cos 10° cos 80° = sin 20° = cos 70° at θ_r = 80°, and 2 cos 60° = 1 at θ_r = 0.
        for (theta_r, whole) in [(0.001, true), (79.999, true), (-0.001, false), (80.001, false)] {
            assert_eq!(Shadowing::VGroove.factor(&geometry(60.0, theta_r, 0.0)) == 1.0, whole, "{theta_r}");
        }
    }

    #[test]
    fn grazing_view_has_a_finite_limit() {
        // 2 cos α/cos θ′ with α = 15°, θ′ = 75°.
        let limit = 2.0 * libm::cos(15f64.to_radians()) / libm::cos(75f64.to_radians());
        let got = Shadowing::VGroove.factor_over_cos_r(&geometry(60.0, 90.0, 0.0));
        // The reference takes the cosine of a rounded 75°: tan 75° times its rounding, and a few more.
        assert!((got / limit - 1.0).abs() < 16.0 * f64::EPSILON, "{got} {limit}");
        let near = Shadowing::VGroove.factor_over_cos_r(&geometry(60.0, 89.999_999_999, 0.0));
        assert!((near / limit - 1.0).abs() < 1e-9, "{near} {limit}");
        assert_eq!(Shadowing::None.factor_over_cos_r(&geometry(60.0, 90.0, 0.0)), f64::INFINITY);
    }

    #[test]
    fn both_grazing() {
        assert!(Shadowing::VGroove.factor(&geometry(90.0, 90.0, 0.0)).is_nan());
        assert!(Shadowing::VGroove.factor_over_cos_r(&geometry(90.0, 90.0, 0.0)).is_nan());
        // Towards any other azimuth v does not vanish and the limit is 0.
        assert_eq!(Shadowing::VGroove.factor(&geometry(90.0, 90.0, 40.0)), 0.0);
        assert_eq!(Shadowing::VGroove.factor_over_cos_r(&geometry(90.0, 90.0, 40.0)), 0.0);
    }
}
