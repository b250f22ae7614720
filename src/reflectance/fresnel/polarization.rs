//! The shares of the two polarizations, (63) and (64).

use crate::reflectance::numeric::EPSILON;
use crate::reflectance::quantity::Fraction;
use core::fmt;

/// Shares h and v of the incident energy that are polarized parallel and perpendicular to the plane of incidence
/// *of the facet*, (63), (64); energies, not amplitudes (errata E35).
#[derive(Clone, Copy, Debug, PartialEq, Hash)]
pub struct Polarization {
    parallel: Fraction,
    perpendicular: Fraction,
}

/// h + v of (64) is not 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NotNormalized {
    /// h + v
    pub sum: f64,
}

impl fmt::Display for NotNormalized {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "the shares of parallel and perpendicular light add up to {}: expected 1", self.sum)
    }
}

impl core::error::Error for NotNormalized {}

/// Two decimal fractions that add up to 1, each rounded to f64, miss it by 2 ε at most, and their sum by 1 ε more.
const SUM_SLACK: f64 = 4.0 * EPSILON;

impl Polarization {
    /// h and v as given; they must add up to 1.
    pub fn mix(h: Fraction, v: Fraction) -> Result<Self, NotNormalized> {
        let sum = h.get() + v.get();
        if (sum - 1.0).abs() <= SUM_SLACK {
            Ok(Self { parallel: h, perpendicular: v })
        } else {
            Err(NotNormalized { sum })
        }
    }

    /// h = v = 1/2.
    pub fn unpolarized() -> Self {
        Self { parallel: Fraction::HALF, perpendicular: Fraction::HALF }
    }

    /// h = 1.
    pub fn parallel() -> Self {
        Self { parallel: Fraction::ONE, perpendicular: Fraction::ZERO }
    }

    /// v = 1.
    pub fn perpendicular() -> Self {
        Self { parallel: Fraction::ZERO, perpendicular: Fraction::ONE }
    }

    /// The share polarized parallel to the plane of incidence.
    #[inline(always)]
    pub fn h(self) -> f64 {
        self.parallel.get()
    }

    /// The share polarized perpendicular to it.
    #[inline(always)]
    pub fn v(self) -> f64 {
        self.perpendicular.get()
    }
}

#[cfg(test)]
mod tests {
    use super::Polarization;
    use crate::reflectance::quantity::{Fraction, Quantity};

    #[test]
    fn shares_add_up_to_one() {
        let share = |value| Fraction::new(value).unwrap();
        for (h, v) in [(0.1, 0.9), (0.7, 0.3), (1.0, 0.0), (1.0 / 3.0, 2.0 / 3.0)] {
            assert!(Polarization::mix(share(h), share(v)).is_ok(), "{h} {v}");
        }
        let refused = Polarization::mix(share(0.5), share(0.4)).unwrap_err();
        assert!(refused.to_string().contains("add up to 0.9"), "{refused}");
    }
}
