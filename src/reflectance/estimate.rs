//! A value with an absolute error bound, both with exponents that cannot run out.

use super::numeric::{EPSILON, scaled::Scaled};

/// |exact − value| ≤ error.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Estimate {
    /// The value; infinite or NaN where the model has no finite one.
    pub value: Scaled,
    /// Bound of its absolute error.
    pub error: Scaled,
}

impl Estimate {
    /// Exactly zero.
    pub const ZERO: Self = Self { value: Scaled::ZERO, error: Scaled::ZERO };
    /// A limit that diverges.
    pub const INFINITE: Self = Self { value: Scaled::INFINITY, error: Scaled::INFINITY };
    /// No value.
    pub const UNDEFINED: Self = Self { value: Scaled::NAN, error: Scaled::NAN };

    /// A value known within a factor e^{±`log_error`}; for a small one that is the relative error.
    pub fn within(value: Scaled, log_error: f64) -> Self {
        let relative =
            if log_error < 1.0 { Scaled::new(libm::expm1(log_error)) } else { Scaled::exp(log_error) };
        Self { value, error: value * relative }
    }

    /// `self` times a factor that has an error of its own.
    #[must_use]
    pub fn times(self, factor: Self) -> Self {
        if self.value.is_zero() && self.error.is_zero() || factor.value.is_zero() && factor.error.is_zero() {
            return Self::ZERO;
        }
        Self {
            value: self.value * factor.value,
            error: self.value * factor.error + self.error * factor.value + self.error * factor.error,
        }
    }

    /// `self` times an exact factor.
    #[must_use]
    pub fn scaled_by(self, factor: Scaled) -> Self {
        Self { value: self.value * factor, error: self.error * factor }
    }

    /// The sum; the bounds add, and the rounding of the sum.
    #[must_use]
    pub fn plus(self, other: Self) -> Self {
        if other.value.is_zero() && other.error.is_zero() {
            return self;
        }
        let value = self.value + other.value;
        Self { value, error: self.error + other.error + value * EPSILON }
    }

    /// error/value: 0 for an exact zero, infinite for a zero that is not exact.
    pub fn relative_error(self) -> f64 {
        if self.error.is_zero() { 0.0 } else { (self.error / self.value).to_f64() }
    }
}
