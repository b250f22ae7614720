//! A value with an absolute error bound, both with exponents that cannot run out.

use super::numeric::{EPSILON, scaled::Scaled};

/// |exact − value| ≤ error and exact ≥ least.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Estimate {
    /// The value; infinite or NaN where the model has no finite one.
    pub value: Scaled,
    /// Bound of its absolute error.
    pub error: Scaled,
    /// Lower bound of the exact value, 0 or positive: what the error is relative to. It is not
    /// value − error where a named method is far off a value that is known.
    pub least: Scaled,
}

impl Estimate {
    /// Exactly zero.
    pub const ZERO: Self = Self { value: Scaled::ZERO, error: Scaled::ZERO, least: Scaled::ZERO };
    /// A limit that diverges.
    pub const INFINITE: Self = Self { value: Scaled::INFINITY, error: Scaled::INFINITY, least: Scaled::ZERO };
    /// No value.
    pub const UNDEFINED: Self = Self { value: Scaled::NAN, error: Scaled::NAN, least: Scaled::NAN };

    /// A value known within a factor e^{±`log_error`}; for a small one that is the relative error.
    pub fn within(value: Scaled, log_error: f64) -> Self {
        Self { value, error: value.spread(log_error), least: value.lowered(log_error) }
    }

    /// Allows for what changes the exact value by a factor e^{±`log_error`} at most.
    #[must_use]
    pub fn widened(self, log_error: f64) -> Self {
        Self {
            value: self.value,
            error: self.error + (self.value + self.error).spread(log_error),
            least: self.least.lowered(log_error),
        }
    }

    /// `self` times a factor that has an error of its own.
    #[must_use]
    pub fn times(self, factor: Self) -> Self {
        let exact_zero = |e: Self| e.value.is_zero() && e.error.is_zero();
        if exact_zero(self) || exact_zero(factor) {
            let finite = self.value.is_finite() && factor.value.is_finite();
            return if finite { Self::ZERO } else { Self::UNDEFINED };
        }
        Self {
            value: self.value * factor.value,
            error: self.value * factor.error + self.error * factor.value + self.error * factor.error,
            least: self.least * factor.least,
        }
    }

    /// `self` times an exact factor.
    #[must_use]
    pub fn scaled_by(self, factor: Scaled) -> Self {
        Self { value: self.value * factor, error: self.error * factor, least: self.least * factor }
    }

    /// The sum; the bounds add, and the rounding of the sum.
    #[must_use]
    pub fn plus(self, other: Self) -> Self {
        if other.value.is_zero() && other.error.is_zero() {
            return self;
        }
        let value = self.value + other.value;
        Self { value, error: self.error + other.error + value * EPSILON, least: self.least + other.least }
    }

    /// The sum of those that are there.
    pub fn total(parts: &[Option<Self>]) -> Self {
        parts.iter().flatten().fold(Self::ZERO, |total, &part| total.plus(part))
    }

    /// error/least: 0 for an exact value, infinite where nothing is known to be there.
    pub fn relative_error(self) -> f64 {
        if self.error.is_zero() { 0.0 } else { (self.error / self.least).to_f64() }
    }
}
