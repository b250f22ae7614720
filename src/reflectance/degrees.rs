//! Trigonometry of degrees with exact reduction: cos 90° is 0, 180° is exactly backwards, and
//! cos(90° − 1e-14°) has all its digits. Nothing here converts an angle to radians before it has
//! been brought within 45° of a multiple of 90°.

use super::numeric::elementary::sin_cos_degrees;

/// π/180 in two parts whose sum has 107 bits.
const DEGREE_HIGH: f64 = 0.017_453_292_519_943_295;
const DEGREE_LOW: f64 = 2.948_652_270_870_168_6e-19;

/// Sine and cosine of one angle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SinCos {
    /// sin
    pub sin: f64,
    /// cos
    pub cos: f64,
}

impl SinCos {
    /// Of an angle in degrees between −720 and 720. Relative error of either below 3 ε.
    #[inline(always)]
    pub fn of_degrees(angle: f64) -> Self {
        let (sin, cos) = sin_cos_degrees(angle);
        Self { sin, cos }
    }

    /// Of an angle in radians, taken as the exact double. For callers whose angles are radians
    /// (the oracle's are); the service itself speaks degrees.
    pub fn of_radians(angle: f64) -> Self {
        let (sin, cos) = libm::sincos(angle);
        Self { sin, cos }
    }
}

/// tan of an angle in degrees; infinite at exactly ±90.
pub fn tan(angle: f64) -> f64 {
    let SinCos { sin, cos } = SinCos::of_degrees(angle);
    sin / cos
}

/// The radians of an angle in degrees, rounded once.
pub fn to_radians(angle: f64) -> f64 {
    let high = angle * DEGREE_HIGH;
    high + (libm::fma(angle, DEGREE_HIGH, -high) + angle * DEGREE_LOW)
}

/// The degrees of an angle in radians, rounded twice at most.
pub fn from_radians(angle: f64) -> f64 {
    /// 180/π in two parts.
    const HIGH: f64 = 57.295_779_513_082_32;
    const LOW: f64 = -1.987_849_567_057_628_5e-15;
    let high = angle * HIGH;
    high + (libm::fma(angle, HIGH, -high) + angle * LOW)
}

#[cfg(test)]
mod tests {
    use super::{SinCos, from_radians, tan, to_radians};

    #[test]
    fn multiples_of_ninety_are_exact() {
        for (angle, sin, cos) in
            [(0.0, 0.0, 1.0), (90.0, 1.0, 0.0), (180.0, 0.0, -1.0), (270.0, -1.0, 0.0), (360.0, 0.0, 1.0)]
        {
            assert_eq!(SinCos::of_degrees(angle), SinCos { sin, cos });
            assert_eq!(SinCos::of_degrees(-angle), SinCos { sin: -sin, cos });
        }
        assert_eq!(tan(90.0), f64::INFINITY);
    }

    #[test]
    fn thirty_forty_five_sixty() {
        // Correctly rounded: sin 30° = 1/2, tan 45° = 1, cos 60° = 1/2.
        assert!((SinCos::of_degrees(30.0).sin - 0.5).abs() <= f64::EPSILON / 4.0);
        assert!((SinCos::of_degrees(60.0).cos - 0.5).abs() <= f64::EPSILON / 4.0);
        assert!((tan(45.0) - 1.0).abs() <= f64::EPSILON);
    }

    #[test]
    fn grazing_keeps_its_digits() {
        // 90 − 2^-46 degrees: the cosine is 2^-46 π/180 to the last bit or two.
        let off = 2f64.powi(-46);
        let expected = to_radians(off);
        let got = SinCos::of_degrees(90.0 - off).cos;
        assert!((got / expected - 1.0).abs() < 3e-16, "{got} {expected}");
    }

    #[test]
    fn radians_and_back() {
        for angle in [1e-300, 0.1, 1.0, 33.3, 89.999, 360.0] {
            assert!((from_radians(to_radians(angle)) / angle - 1.0).abs() < 4e-16);
        }
        assert_eq!(to_radians(180.0), core::f64::consts::PI);
    }
}
