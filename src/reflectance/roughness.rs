//! One roughness, many widths. Each has its own type, and each type says of which density it is the width.
//!
//! The surface is Gaussian in height with the autocorrelation exp(−τ²/T²) of (5), so its slope along
//! any line is Gaussian with variance 2σ_h²/T². The ratio σ_h/T determines all widths.

use super::degrees;
use super::quantity::{BeckmannAlpha, CorrelationLength, InvertibleFacetSlope, RmsHeight};
use core::f64::consts::{FRAC_PI_2, SQRT_2};

/// √2 = `SQRT_2` + this, to 107 bits.
const SQRT_2_LOW: f64 = -9.667_293_313_452_913e-17;
/// π/2 = `FRAC_PI_2` + this, to 107 bits.
const FRAC_PI_2_LOW: f64 = 6.123_233_995_736_766e-17;

/// σ_α of (79) in radians from σ_h/T ≥ 0: atan(2σ_h/T)/√2. It makes the facet density exp(−α²/2σ_α²)
/// of (58) fall to 1/e where the rough lobe (49) has its exponential at 1/e, α = α₀.
///
/// Relative error below 4 ε and that of the ratio; below π/(2√2) for every ratio.
pub fn facet_slope_radians(ratio: f64) -> f64 {
    libm::atan(2.0 * ratio) / SQRT_2
}

/// σ_h/T from σ_α > 0 in radians: the inverse tan(√2 σ_α)/2 of (79), none from π/(2√2) on.
///
/// The double is taken as exact and the distance to π/2 is formed with 107 bits: relative error below 8 ε
/// up to the last double.
pub fn height_to_length_ratio(sigma_alpha: f64) -> Option<f64> {
    let angle = SQRT_2 * sigma_alpha;
    if angle < FRAC_PI_2 / 2.0 {
        return Some(libm::tan(angle) / 2.0);
    }
    let rest = complement(sigma_alpha, FRAC_PI_2, FRAC_PI_2_LOW);
    (rest > 0.0).then(|| 0.5 / libm::tan(rest))
}

/// The small-slope form √2 σ_h/T of (79), radians. It matches the curvatures at α = 0 and fits the rough lobe better
/// (errata E46); it has no upper limit.
pub fn facet_slope_small(ratio: f64) -> f64 {
    SQRT_2 * ratio
}

/// quarter − √2 `width`, the product and the difference with 107 bits.
fn complement(width: f64, quarter: f64, quarter_low: f64) -> f64 {
    let product = SQRT_2 * width;
    let product_low = libm::fma(SQRT_2, width, -product) + SQRT_2_LOW * width;
    (quarter - product) + (quarter_low - product_low)
}

macro_rules! widths {
    ($($(#[$doc:meta])* $name:ident;)*) => {$(
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
        pub struct $name(f64);

        impl $name {
            /// The number, in the type's unit.
            pub const fn get(self) -> f64 {
                self.0
            }
        }
    )*};
}

widths! {
    /// σ_h/T: standard deviation of the Gaussian height density (4) over the correlation length of (5).
    HeightToLength;
    /// σ_α of (79), degrees: standard deviation of the density exp(−α²/2σ_α²) of the facet slope *angle* α in (58).
    FacetSlopeWidth;
    /// √2 σ_h/T as an angle, degrees: what (79) tends to for gentle slopes (errata E46). The width of the same density as
    /// [`FacetSlopeWidth`], matched by curvature instead of the 1/e point.
    SmallSlopeWidth;
    /// α₀ of (78), degrees: the slope angle at which exp(−tan²α/tan²α₀) of (49) is 1/e.
    CharacteristicAngle;
    /// Beckmann's tan α₀ = 2σ_h/T: the m of the facet density exp(−tan²α/m²)/(π m² cos⁴α) per solid angle.
    BeckmannWidth;
    /// √2 σ_h/T: standard deviation of the slope along any one line, whose density is Gaussian and, as a density of the
    /// angle, (73). The gradient of both slopes together is √2 larger, 2σ_h/T, the same number as [`BeckmannWidth`].
    RmsSlope;
}

/// Every width in use for one surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Widths {
    /// σ_h/T
    pub height_to_length: HeightToLength,
    /// σ_α by (79)
    pub facet_slope: FacetSlopeWidth,
    /// σ_α for gentle slopes
    pub small_slope: SmallSlopeWidth,
    /// α₀
    pub characteristic_angle: CharacteristicAngle,
    /// tan α₀
    pub beckmann_alpha: BeckmannWidth,
    /// √2 σ_h/T
    pub rms_slope: RmsSlope,
}

impl Widths {
    /// From the height model's two lengths.
    pub fn from_heights(rms_height: RmsHeight, correlation_length: CorrelationLength) -> Self {
        Self::from_ratio(rms_height.get() / correlation_length.get())
    }

    /// From Beckmann's tan α₀.
    pub fn from_beckmann_alpha(beckmann_alpha: BeckmannAlpha) -> Self {
        Self::from_ratio(beckmann_alpha.get() / 2.0)
    }

    /// From σ_α, which keeps its value. Relative errors below 8 ε: the distance to the limit of (79) is formed in
    /// degrees, where it is exact.
    pub fn from_facet_slope(facet_slope: InvertibleFacetSlope) -> Self {
        let width = facet_slope.get();
        let angle = SQRT_2 * width;
        let ratio = if angle < 45.0 {
            libm::tan(degrees::to_radians(angle)) / 2.0
        } else {
            // Positive: the bound is the last double below 90/√2.
            0.5 / libm::tan(degrees::to_radians(complement(width, 90.0, 0.0)))
        };
        Self {
            facet_slope: FacetSlopeWidth(width),
            characteristic_angle: CharacteristicAngle(angle),
            ..Self::from_ratio(ratio)
        }
    }

    fn from_ratio(ratio: f64) -> Self {
        let alpha0 = libm::atan(2.0 * ratio);
        Self {
            height_to_length: HeightToLength(ratio),
            facet_slope: FacetSlopeWidth(degrees::from_radians(alpha0 / SQRT_2)),
            small_slope: SmallSlopeWidth(degrees::from_radians(facet_slope_small(ratio))),
            characteristic_angle: CharacteristicAngle(degrees::from_radians(alpha0)),
            beckmann_alpha: BeckmannWidth(2.0 * ratio),
            rms_slope: RmsSlope(SQRT_2 * ratio),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{Widths, facet_slope_radians, height_to_length_ratio};
    use crate::reflectance::quantity::{
        BeckmannAlpha, CorrelationLength, InvertibleFacetSlope, Quantity, RmsHeight,
    };
    use crate::reflectance::{bounds, numeric::EPSILON};

    fn heights(rms_height: f64, correlation_length: f64) -> Widths {
        Widths::from_heights(
            RmsHeight::new(rms_height).unwrap(),
            CorrelationLength::new(correlation_length).unwrap(),
        )
    }

    #[test]
    fn figure_23_carries_the_widths_of_its_ratios() {
        // The captions print three decimals; 7.99 is 7.997 cut (errata E41).
        for (ratio, printed) in [(0.03, 2.428), (0.1, 7.997), (0.2, 15.416)] {
            let width = heights(ratio, 1.0).facet_slope.get();
            assert!((width - printed).abs() < 0.0005, "{width} {printed}");
        }
    }

    #[test]
    fn there_and_back() {
        // Forward 4 ε, amplified on the way back by the condition of the inverse, and 8 ε for itself.
        for ratio in [1e-100, 1e-9, 0.03, 0.2, 0.5, 1.0, 3.0, 1e3] {
            let sigma = facet_slope_radians(ratio);
            let back = height_to_length_ratio(sigma).unwrap();
            let condition = libm::atan(2.0 * ratio) * (1.0 + 4.0 * ratio * ratio) / (2.0 * ratio);
            assert!((back / ratio - 1.0).abs() <= (8.0 + 5.0 * condition) * EPSILON, "{ratio} {back}");
            let widths =
                Widths::from_facet_slope(InvertibleFacetSlope::new(sigma.to_degrees()).unwrap_or_else(
                    |_| InvertibleFacetSlope::new(bounds::FACET_SLOPE_INVERTIBLE.min).unwrap(),
                ));
            if sigma.to_degrees() >= bounds::FACET_SLOPE_INVERTIBLE.min {
                let back = widths.height_to_length.get();
                assert!((back / ratio - 1.0).abs() <= (8.0 + 8.0 * condition) * EPSILON, "{ratio} {back}");
            }
        }
    }

    #[test]
    fn the_inverse_ends_at_the_last_double_below_its_pole() {
        // π/(2√2) = 1.1107207345395915 + 3.63e-17: the nearest double still has a ratio,
        // 1/(2·√2·3.63e-17), the next one has none.
        let last = 1.1107207345395915;
        let ratio = height_to_length_ratio(last).unwrap();
        let expected = 0.5 / (3.630684828065212e-17 * core::f64::consts::SQRT_2);
        assert!((ratio / expected - 1.0).abs() < 1e-14, "{ratio} {expected}");
        assert_eq!(height_to_length_ratio(last.next_up()), None);
        assert_eq!(height_to_length_ratio(f64::NAN), None);
        assert_eq!(height_to_length_ratio(f64::INFINITY), None);
        // The same in degrees: 90/√2 lies 2.35e-15 below the double that follows the bound.
        let bound = bounds::FACET_SLOPE_INVERTIBLE.max;
        assert_eq!(bound.next_up(), 63.63961030678928);
        let ratio =
            Widths::from_facet_slope(InvertibleFacetSlope::new(bound).unwrap()).height_to_length.get();
        let rest = (63.63961030678928 - bound - 2.351880546728529e-15) * core::f64::consts::SQRT_2;
        assert!((ratio / (0.5 / rest.to_radians()) - 1.0).abs() < 1e-14, "{ratio}");
    }

    #[test]
    fn every_query_names_the_same_surface() {
        let from_heights = heights(0.2, 4.0);
        let from_alpha = Widths::from_beckmann_alpha(BeckmannAlpha::new(0.1).unwrap());
        assert_eq!(from_heights, from_alpha);
        let slope = InvertibleFacetSlope::new(from_heights.facet_slope.get()).unwrap();
        let back = Widths::from_facet_slope(slope);
        // 4 ε for the width, 8 ε for the inverse, whose condition is below 1.01 here.
        assert!((back.rms_slope.get() / from_heights.rms_slope.get() - 1.0).abs() < 16.0 * EPSILON);
    }
}
