//! Elementary functions without branches or tables, so that a loop over them becomes vector
//! instructions. Only sums, products, quotients, roots and comparisons of doubles, never a fused
//! multiply-add: every instruction set gives the same bits.

use core::f64::consts::{FRAC_PI_2, FRAC_PI_4};

/// 3·2^51: adding and subtracting it rounds a double of magnitude below 2^51 to the nearest integer,
/// which is left in the low bits of the sum.
const ROUNDER: f64 = 6_755_399_441_055_744.0;
/// ln 2 in two parts, the first with 21 trailing zero bits: its products with integers below 2^21 are exact.
pub(super) const LN2_HIGH: f64 = f64::from_bits(0x3fe6_2e42_fee0_0000);
pub(super) const LN2_LOW: f64 = 1.908_214_929_270_587_8e-10;

/// e^x = `significand` · 2^`exponent`.
#[derive(Clone, Copy, Debug)]
pub struct Exponential {
    /// Between 0.707 and 1.415.
    pub significand: f64,
    /// A whole number.
    pub exponent: f64,
    /// `significand` − 1 without its rounding.
    less_one: f64,
}

/// e^x for |x| < 1e15, relative error below (2 + |x|) ε, most of it the rounding of x itself.
#[inline(always)]
pub fn exp(x: f64) -> Exponential {
    let exponent = (x * core::f64::consts::LOG2_E + ROUNDER) - ROUNDER;
    let r = (x - exponent * LN2_HIGH) - exponent * LN2_LOW;
    // |r| ≤ 0.3466: the first power left out, r^14/14!, is below 5e-18. Even and odd powers apart: two
    // short chains of operations instead of a long one.
    let z = r * r;
    let even = 0.5
        + z * (1.0 / 24.0
            + z * (1.0 / 720.0 + z * (1.0 / 40_320.0 + z * (1.0 / 3_628_800.0 + z * (1.0 / 479_001_600.0)))));
    let odd = 1.0 / 6.0
        + z * (1.0 / 120.0
            + z * (1.0 / 5040.0
                + z * (1.0 / 362_880.0 + z * (1.0 / 39_916_800.0 + z * (1.0 / 6_227_020_800.0)))));
    let tail = even + r * odd;
    let less_one = r + z * tail;
    Exponential { significand: 1.0 + less_one, exponent, less_one }
}

impl Exponential {
    /// The value, for exponents from −1022 to 1023.
    #[inline(always)]
    pub fn value(self) -> f64 {
        self.significand * power_of_two(self.exponent)
    }

    /// e^x − 1 with a relative error below 4 ε, for x from −700 to 700.
    #[inline(always)]
    pub fn minus_one(self) -> f64 {
        let scale = power_of_two(self.exponent);
        scale * self.less_one + (scale - 1.0)
    }
}

/// 2^k for a whole k from −1022 to 1023.
#[inline(always)]
pub fn power_of_two(k: f64) -> f64 {
    // The low bits of the sum are k + 1023; the rest is shifted out.
    f64::from_bits(((k + 1023.0) + ROUNDER).to_bits() << 52)
}

/// `significand` · 2^`exponent` for any whole exponent: 0 or infinite beyond f64's range.
/// Rounded once, subnormal results twice.
#[inline(always)]
pub fn scale(significand: f64, exponent: f64) -> f64 {
    let k = exponent.clamp(-2100.0, 2100.0);
    let half = (k * 0.5 + ROUNDER) - ROUNDER;
    let quarter = (half * 0.5 + ROUNDER) - ROUNDER;
    let step = power_of_two(quarter);
    let rest = half - quarter;
    let other = k - half;
    let other_quarter = (other * 0.5 + ROUNDER) - ROUNDER;
    significand
        * step
        * power_of_two(rest)
        * power_of_two(other_quarter)
        * power_of_two(other - other_quarter)
}

/// The exponent of a normal x, a whole number, and its significand in [√½, √2).
#[inline(always)]
fn parts(x: f64) -> (f64, f64) {
    // √½, down to which the significand goes: adding 1 − √½ to the exponent's field brings it there.
    const LEAST: u64 = 0x3fe6_a09e_667f_3bcd;
    const OFFSET: u64 = 0x3ff0_0000_0000_0000 - LEAST;
    let bits = x.to_bits().wrapping_add(OFFSET);
    let significand = f64::from_bits((bits & 0x000f_ffff_ffff_ffff) + LEAST);
    (unbiased(bits >> 52), significand)
}

/// The exponent that a double holds as `field`: below 2^52, which takes it into its low bits.
#[inline(always)]
fn unbiased(field: u64) -> f64 {
    f64::from_bits(field | 0x4330_0000_0000_0000) - (4_503_599_627_370_496.0 + 1023.0)
}

/// ln x for a normal x, relative error below 3 ε.
#[inline(always)]
pub fn ln(x: f64) -> f64 {
    let (exponent, m) = parts(x);
    let f = m - 1.0;
    let s = f / (m + 1.0);
    let z = s * s;
    // |s| ≤ 0.1716: the first power left out is below 1e-17 of the first.
    let series = z
        * (1.0 / 3.0
            + z * (1.0 / 5.0
                + z * (1.0 / 7.0
                    + z * (1.0 / 9.0
                        + z * (1.0 / 11.0
                            + z * (1.0 / 13.0 + z * (1.0 / 15.0 + z * (1.0 / 17.0 + z * (1.0 / 19.0)))))))));
    // 2s = f − s f: the rounding of s enters by the small second part only.
    exponent * LN2_HIGH + (f - (s * f - (2.0 * s * series + exponent * LN2_LOW)))
}

/// ln(1 + z) for 0 ≤ z < 1e290 to 1e-3, relative down to z = 1e-12; below, to 2 ε.
#[inline(always)]
pub fn ln_1p_roughly(z: f64) -> f64 {
    let (exponent, m) = parts(1.0 + z);
    let s = (m - 1.0) / (m + 1.0);
    exponent * core::f64::consts::LN_2 + 2.0 * s * (1.0 + s * s * (1.0 / 3.0))
}

/// sin and cos of an angle in degrees, |angle| ≤ 720, reduced exactly: cos 90° is 0.
/// Relative error of either below 3 ε.
#[inline(always)]
pub fn sin_cos_degrees(angle: f64) -> (f64, f64) {
    // π/180 = its double + this.
    const DEGREE_LOW: f64 = 2.948_652_270_870_168_7e-19;
    let turned = angle * (1.0 / 90.0) + ROUNDER;
    // Exact: by Sterbenz's lemma, or because the quarter is 0.
    let r = angle - 90.0 * (turned - ROUNDER);
    let z = r * r;
    // The coefficients are (π/180)^k/k!. First powers left out: r^17/17! and r^18/18!, below 6e-17 and 2e-18.
    let sin_tail = DEGREE_LOW
        + z * (-8.860_961_557_012_98e-7
            + z * (1.349_601_623_163_255e-11
                + z * (-9.788_384_861_617_728e-17
                    + z * (4.141_267_417_257_320_6e-22
                        + z * (-1.146_820_177_537_901_6e-27
                            + z * (2.239_367_970_775_196_7e-33
                                + z * (-3.248_335_681_954_942e-39 + z * 3.637_866_301_611_077e-45)))))));
    let sin = r * 0.017_453_292_519_943_295 + r * sin_tail;
    let cos = 1.0
        + z * (-1.523_087_098_933_543e-4
            + z * (3.866_323_851_562_994e-9
                + z * (-3.925_831_985_743_095e-14
                    + z * (2.135_494_303_594_986e-19
                        + z * (-7.227_875_163_670_209e-25
                            + z * (1.667_982_335_528_525e-30
                                + z * (-2.791_738_875_266_523_8e-36 + z * 3.543_384_553_758_068_6e-42)))))));
    let quarter = turned.to_bits();
    let odd = quarter & 1 == 1;
    let (a, b) = if odd { (cos, sin) } else { (sin, cos) };
    let sin_sign = (quarter & 2) << 62;
    let cos_sign = (quarter.wrapping_add(1) & 2) << 62;
    // + 0: a zero is +0 whatever the quarter, and 1/cos 90° is +∞.
    (f64::from_bits(a.to_bits() ^ sin_sign) + 0.0, f64::from_bits(b.to_bits() ^ cos_sign) + 0.0)
}

/// The angle of (x, y) to the x axis in radians, for x and y not negative and not both 0. Relative error below 4 ε.
#[inline(always)]
pub fn angle(x: f64, y: f64) -> f64 {
    const TAN_22_5: f64 = core::f64::consts::SQRT_2 - 1.0;
    // π/2 = its double + this.
    const RIGHT_LOW: f64 = 6.123_233_995_736_766e-17;
    let is_middle = (y > TAN_22_5 * x) & (x > TAN_22_5 * y);
    let is_steep = y > x;
    // Turned back by 0°, 45° or 90°, so that |tan| is below tan 22.5°.
    let (near, far) = if is_steep { (-x, y) } else { (y, x) };
    let (quarter, low) = if is_steep { (FRAC_PI_2, RIGHT_LOW) } else { (0.0, 0.0) };
    let opposite = if is_middle { y - x } else { near };
    let adjacent = if is_middle { x + y } else { far };
    let turned = if is_middle { FRAC_PI_4 } else { quarter };
    let low = if is_middle { 0.5 * RIGHT_LOW } else { low };
    let z = opposite / adjacent;
    let w = z * z;
    let v = w * w;
    // arctan's series, its negative and its positive terms apart; the first left out, w^21/43, is below 2e-18.
    let negative = 1.0 / 3.0
        + v * (1.0 / 7.0
            + v * (1.0 / 11.0
                + v * (1.0 / 15.0
                    + v * (1.0 / 19.0
                        + v * (1.0 / 23.0
                            + v * (1.0 / 27.0 + v * (1.0 / 31.0 + v * (1.0 / 35.0 + v * (1.0 / 39.0)))))))));
    let positive = 1.0 / 5.0
        + v * (1.0 / 9.0
            + v * (1.0 / 13.0
                + v * (1.0 / 17.0
                    + v * (1.0 / 21.0
                        + v * (1.0 / 25.0
                            + v * (1.0 / 29.0 + v * (1.0 / 33.0 + v * (1.0 / 37.0 + v * (1.0 / 41.0)))))))));
    let series = w * (w * positive - negative);
    turned + (z + (z * series + low))
}

/// √(a² + b²) for magnitudes up to 1e150. Relative error 2 ε, by the four roundings that it has.
#[inline(always)]
pub fn hypotenuse(a: f64, b: f64) -> f64 {
    const SMALL: f64 = f64::from_bits((1023 - 400) << 52);
    const UP: f64 = f64::from_bits((1023 + 600) << 52);
    const DOWN: f64 = f64::from_bits((1023 - 600) << 52);
    let (a, b) = (a.abs(), b.abs());
    let large = if a > b { a } else { b };
    // A square that underflows beside one that does not is no loss; where both would, powers of two save them.
    let is_small = large < SMALL;
    let up = if is_small { UP } else { 1.0 };
    let down = if is_small { DOWN } else { 1.0 };
    let (a, b) = (a * up, b * up);
    (a * a + b * b).sqrt() * down
}

/// ⌊log₂ |x|⌋ for a normal x.
#[inline(always)]
pub fn binary_exponent(x: f64) -> f64 {
    unbiased((x.to_bits() >> 52) & 0x7ff)
}

#[cfg(test)]
mod tests {
    use super::{angle, binary_exponent, exp, hypotenuse, ln, ln_1p_roughly, scale, sin_cos_degrees};
    use crate::reflectance::numeric::EPSILON;

    /// libm's functions are good to an ulp, 2 ε, which adds to what is allowed here.
    const OF_LIBM: f64 = 2.0;

    fn near(got: f64, expected: f64, units: f64, at: f64) {
        let room = (units + OF_LIBM) * EPSILON * expected.abs();
        assert!((got - expected).abs() <= room, "{at}: {got} {expected}");
    }

    #[test]
    fn exponentials_and_logarithms() {
        for step in -7000..=7000 {
            let x = f64::from(step) * 0.1 + 1e-3;
            // Measured against 140 bits: 1.36 ε, expm1 2.2 ε, ln 1.5 ε.
            near(exp(x).value(), libm::exp(x), 2.0, x);
            if x > 0.0 {
                for x in [x * 0.01, -x * 0.01, -x.min(700.0)] {
                    near(exp(x).minus_one(), libm::expm1(x), 4.0, x);
                }
                near(ln(x), libm::log(x), 3.0, x);
                assert!((ln_1p_roughly(x) / libm::log1p(x) - 1.0).abs() < 1e-3, "{x}");
            }
            let power = libm::exp2(x);
            near(ln(power), libm::log(power), 3.0, power);
            assert_eq!(binary_exponent(power), x.floor(), "{x}");
        }
        assert!((ln_1p_roughly(1e-12) / 1e-12 - 1.0).abs() < 1e-3);
    }

    #[test]
    fn exponents_are_carried_beyond_the_range() {
        let e = exp(-1e6);
        assert!((e.exponent + 1e6 * core::f64::consts::LOG2_E).abs() <= 1.0);
        assert_eq!(scale(e.significand, e.exponent), 0.0);
        assert_eq!(scale(1.5, 3000.0), f64::INFINITY);
        for k in [-1074, -1030, -1022, -600, 0, 600, 1023] {
            assert_eq!(scale(1.0, f64::from(k)), 2f64.powi(k / 2) * 2f64.powi(k - k / 2), "{k}");
        }
    }

    #[test]
    fn angles_of_the_quadrant() {
        for step in 0..=90_000 {
            let degrees = f64::from(step) * 1e-3;
            let (y, x) = sin_cos_degrees(degrees);
            for size in [1.0, 1e-17, 1.7] {
                // Measured against 200 bits: 2.4 ε.
                near(angle(size * x, size * y), libm::atan2(size * y, size * x), 4.0, degrees);
            }
            let small = libm::exp10(-degrees);
            near(angle(1.9, small), libm::atan2(small, 1.9), 4.0, small);
        }
        assert_eq!(angle(0.0, 1.0), core::f64::consts::FRAC_PI_2);
        assert_eq!(angle(1.0, 0.0), 0.0);
        assert!(angle(0.0, 0.0).is_nan());
    }

    #[test]
    fn hypotenuses_of_any_size() {
        for step in 0..=6000 {
            let a = libm::exp10(f64::from(step - 4500) * 0.1);
            for ratio in [0.0, 1e-200, 1e-9, 0.3, 0.75, 1.0] {
                if a > 1e-307 && a < 1e150 {
                    near(hypotenuse(a, -ratio * a), libm::hypot(a, ratio * a), 2.0, a);
                    assert_eq!(hypotenuse(ratio * a, a), hypotenuse(a, ratio * a));
                }
            }
        }
        assert_eq!(hypotenuse(0.0, 0.0), 0.0);
        assert_eq!(hypotenuse(3e-324, 5e-324), libm::hypot(3e-324, 5e-324));
    }

    #[test]
    fn sines_and_cosines() {
        for step in -72_000..=72_000 {
            let angle = f64::from(step) * 0.01;
            let (sin, cos) = sin_cos_degrees(angle);
            // The remainder of 90° has no rounding but what the literal has.
            let rest = angle - 90.0 * (angle / 90.0).round();
            let (near_sin, near_cos) = libm::sincos(rest.to_radians());
            let (expected_sin, expected_cos) = match (angle / 90.0).round().rem_euclid(4.0) {
                0.0 => (near_sin, near_cos),
                1.0 => (near_cos, -near_sin),
                2.0 => (-near_sin, -near_cos),
                _ => (-near_cos, near_sin),
            };
            // Measured against 140 bits: 2.02 ε; to_radians rounds twice, which |x/tan x| ≤ 1 does not enlarge.
            near(sin, expected_sin, 3.0 + 2.0, angle);
            near(cos, expected_cos, 3.0 + 2.0, angle);
        }
    }
}
