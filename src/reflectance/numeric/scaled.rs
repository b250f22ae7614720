//! A number with an exponent that cannot run out: what lets the models pass through 1e-85351647.

use super::elementary::{LN2_HIGH, LN2_LOW};
use core::ops::{Add, Div, Mul};

/// `significand · 2^exponent`, the significand 0, infinite, NaN or of magnitude in [1, 2).
///
/// Products and quotients carry one rounding, like f64's own, at any magnitude. The exponent is
/// a whole number kept in f64: beyond 2^53 it loses last digits, as does the logarithm that it is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scaled {
    significand: f64,
    exponent: f64,
}

const EXPONENT_BITS: u64 = 0x7ff0_0000_0000_0000;
const ONE_BITS: u64 = 0x3ff0_0000_0000_0000;
/// log10(2) rounded to 32 bits, and the rest.
const LOG10_2_HIGH: f64 = f64::from_bits(0x3fd3_4413_5080_0000);
const LOG10_2_LOW: f64 = 1.145_110_089_802_183_8e-10;

impl Scaled {
    /// Exactly zero.
    pub const ZERO: Self = Self { significand: 0.0, exponent: 0.0 };
    /// Exactly one.
    pub const ONE: Self = Self { significand: 1.0, exponent: 0.0 };
    /// Positive infinity: a limit that diverges, not an overflow.
    pub const INFINITY: Self = Self { significand: f64::INFINITY, exponent: 0.0 };
    /// Undefined.
    pub const NAN: Self = Self { significand: f64::NAN, exponent: 0.0 };

    /// The exact value of `value`.
    pub fn new(value: f64) -> Self {
        Self { significand: value, exponent: 0.0 }.normalized()
    }

    /// `significand` · 2^`exponent`, the exponent a whole number.
    pub fn of_parts(significand: f64, exponent: f64) -> Self {
        Self { significand, exponent }.normalized()
    }

    /// e^`x` for any finite `x`: relative error below (1 + |x|) ε from the rounding of `x` itself.
    pub fn exp(x: f64) -> Self {
        if x.abs() < 700.0 {
            return Self::new(libm::exp(x));
        }
        if x.is_infinite() {
            return if x > 0.0 { Self::INFINITY } else { Self::ZERO };
        }
        let k = (x * core::f64::consts::LOG2_E).round();
        // Beyond 2^53 the remainder is noise of the exponent's own rounding.
        let rest = if k.abs() < 9e15 { (x - k * LN2_HIGH) - k * LN2_LOW } else { 0.0 };
        let mut e = Self::new(libm::exp(rest));
        e.exponent += k;
        e
    }

    fn normalized(self) -> Self {
        let bits = self.significand.to_bits();
        let biased = (bits & EXPONENT_BITS) >> 52;
        if biased == 0 {
            if self.significand == 0.0 {
                return Self { significand: self.significand, exponent: 0.0 };
            }
            let raised =
                Self { significand: self.significand * 2f64.powi(64), exponent: self.exponent - 64.0 };
            return raised.normalized();
        }
        if biased == 0x7ff {
            return Self { significand: self.significand, exponent: 0.0 };
        }
        Self {
            significand: f64::from_bits((bits & !EXPONENT_BITS) | ONE_BITS),
            exponent: self.exponent + (biased as f64 - 1023.0),
        }
    }

    /// `self · self`.
    #[must_use]
    pub fn squared(self) -> Self {
        self * self
    }

    /// self · (e^`log_error` − 1): how far a factor e^{±`log_error`} may carry a value.
    #[must_use]
    pub fn spread(self, log_error: f64) -> Self {
        if self.is_zero() {
            self
        } else if log_error < 1e-3 {
            // e^d − 1 < d + d²/2 · 1.001
            self * (log_error * (1.0 + log_error))
        } else if log_error < 1.0 {
            self * libm::expm1(log_error)
        } else {
            self * Self::exp(log_error)
        }
    }

    /// self · e^{−`log_error`}, or less: the least that a value known within a factor can be.
    #[must_use]
    pub fn lowered(self, log_error: f64) -> Self {
        // e^{−d} > 1 − d
        if log_error < 1e-3 { self * (1.0 - log_error) } else { self * Self::exp(-log_error) }
    }

    /// |self − other|.
    #[must_use]
    pub fn distance(self, other: Self) -> Self {
        let difference = self + Self { significand: -other.significand, exponent: other.exponent };
        Self { significand: difference.significand.abs(), exponent: difference.exponent }
    }

    /// The larger of two; `self` where they cannot be told apart.
    #[must_use]
    pub fn larger(self, other: Self) -> Self {
        if self.is_below(other) { other } else { self }
    }

    /// The smaller of two; `self` where they cannot be told apart.
    #[must_use]
    pub fn smaller(self, other: Self) -> Self {
        if other.is_below(self) { other } else { self }
    }

    fn is_below(self, other: Self) -> bool {
        (self + Self { significand: -other.significand, exponent: other.exponent }).is_negative()
    }

    /// `self^n` by repeated squaring; relative error at most n ε.
    #[must_use]
    pub fn powi(self, mut n: u32) -> Self {
        let (mut base, mut product) = (self, Self::ONE);
        while n > 0 {
            if n & 1 == 1 {
                product = product * base;
            }
            base = base.squared();
            n >>= 1;
        }
        product
    }

    /// The nearest f64: correctly rounded, to a subnormal or 0 below the range, infinite above it.
    pub fn to_f64(self) -> f64 {
        if self.exponent > 1023.0 {
            self.significand * f64::INFINITY
        } else if self.exponent < -1080.0 {
            self.significand * 0.0
        } else if self.exponent < -1022.0 {
            #[expect(clippy::cast_possible_truncation, reason = "between -1080 and -1022")]
            let lift = self.exponent as i32 + 1000;
            self.significand * 2f64.powi(lift) * 2f64.powi(-1000)
        } else {
            #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "1 to 2046")]
            let biased = (self.exponent as i64 + 1023) as u64;
            self.significand * f64::from_bits(biased << 52)
        }
    }

    /// Natural logarithm; -∞ for zero.
    pub fn ln(self) -> f64 {
        self.exponent * LN2_HIGH + (self.exponent * LN2_LOW + libm::log(self.significand))
    }

    /// Decimal logarithm; -∞ for zero.
    pub fn log10(self) -> f64 {
        self.exponent * LOG10_2_HIGH + (self.exponent * LOG10_2_LOW + libm::log10(self.significand))
    }

    /// Whether the value is exactly zero.
    pub fn is_zero(self) -> bool {
        self.significand == 0.0
    }

    /// Whether the value is below zero.
    pub fn is_negative(self) -> bool {
        self.significand < 0.0
    }

    /// Whether there is no value.
    pub fn is_nan(self) -> bool {
        self.significand.is_nan()
    }

    /// Neither infinite nor undefined. A finite value may still lie beyond f64's range.
    pub fn is_finite(self) -> bool {
        self.significand.is_finite()
    }
}

impl Mul for Scaled {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        Self { significand: self.significand * other.significand, exponent: self.exponent + other.exponent }
            .normalized()
    }
}

impl Mul<f64> for Scaled {
    type Output = Self;
    fn mul(self, other: f64) -> Self {
        self * Self::new(other)
    }
}

impl Div for Scaled {
    type Output = Self;
    fn div(self, other: Self) -> Self {
        Self { significand: self.significand / other.significand, exponent: self.exponent - other.exponent }
            .normalized()
    }
}

impl Add for Scaled {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        if !self.is_finite() || !other.is_finite() {
            return Self::new(self.significand + other.significand);
        }
        if self.is_zero() {
            return other;
        }
        let (large, small) =
            if other.is_zero() || self.exponent >= other.exponent { (self, other) } else { (other, self) };
        let shift = small.exponent - large.exponent;
        if small.is_zero() || shift < -64.0 {
            return large;
        }
        #[expect(clippy::cast_possible_truncation, reason = "between -64 and 0")]
        let aligned = small.significand * 2f64.powi(shift as i32);
        Self { significand: large.significand + aligned, exponent: large.exponent }.normalized()
    }
}

#[cfg(test)]
mod tests {
    use super::Scaled;

    #[test]
    fn f64_survives_the_round_trip() {
        for value in [0.0, 5e-324, 2.5e-310, f64::MIN_POSITIVE, 0.1, 1.0, 3.0, 1e300, f64::MAX, -7.5e-321] {
            assert_eq!(Scaled::new(value).to_f64(), value);
        }
    }

    #[test]
    fn products_pass_below_and_above_the_range_of_f64() {
        let tiny = Scaled::new(1e-200) * 1e-200;
        assert_eq!(tiny.to_f64(), 0.0);
        assert!((tiny.log10() + 400.0).abs() < 1e-13);
        let back = tiny * 1e300 * 1e100;
        assert!((back.to_f64() - 1.0).abs() < 1e-15);
        assert_eq!((Scaled::new(1e200) * 1e200).to_f64(), f64::INFINITY);
        assert!((Scaled::new(1e200) * 1e200).is_finite());
    }

    #[test]
    fn subnormals_are_rounded_once() {
        // 1.5 · 2^-1074 lies halfway between 2^-1074 and 2 · 2^-1074: to even.
        let halfway = Scaled::new(1.5) * Scaled::new(5e-324);
        assert_eq!(halfway.to_f64(), 2.0 * 5e-324);
        assert_eq!((Scaled::new(0.49) * Scaled::new(5e-324)).to_f64(), 0.0);
        assert_eq!((Scaled::new(0.51) * Scaled::new(5e-324)).to_f64(), 5e-324);
    }

    #[test]
    fn exp_keeps_its_logarithm() {
        for x in [-1e9, -745.2, -1.0, 0.0, 3.5, 800.0, 1e12, -1e19] {
            let error = (Scaled::exp(x).ln() - x).abs();
            assert!(error <= 4.0 * f64::EPSILON * (1.0 + x.abs()), "{x}: {error}");
        }
    }

    #[test]
    fn sums_align_their_exponents() {
        let a = Scaled::exp(-2000.0);
        assert!(((a + a).ln() - (-2000.0 + 2f64.ln())).abs() < 1e-12);
        assert_eq!((Scaled::ONE + Scaled::exp(-100.0)).to_f64(), 1.0);
        assert_eq!((Scaled::ZERO + Scaled::new(2.0)).to_f64(), 2.0);
        assert_eq!(a.distance(a), Scaled::ZERO);
        assert_eq!(Scaled::new(3.0).distance(Scaled::new(5.0)).to_f64(), 2.0);
    }
}
