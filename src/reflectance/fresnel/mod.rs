//! Fresnel's laws (24), (25) for a relative complex refractive index, their energies (62) and the mix (63).
//!
//! The magnetic permeabilities on both sides are taken as equal, so that the report's Y is the relative index
//! (errata E10). Each energy comes with a bound of its absolute error that holds for cosines and sines
//! known to [`ANGLE_ERROR`]: relative accuracy is lost next to Brewster's angle, the critical angle and n = 1,
//! and the bound says how much.

use super::degrees::SinCos;
use super::estimate::Estimate;
use super::numeric::{EPSILON, scaled::Scaled};

mod complex;
mod index;
pub(super) mod lanes;
mod polarization;

pub use complex::Complex;
pub use index::{ANGLE_ERROR, RefractiveIndex};
pub use polarization::{NotNormalized, Polarization};

/// What the surface is made of.
#[derive(Clone, Copy, Debug, PartialEq, Hash)]
pub enum Medium {
    /// Y → ∞ in (24), (25): F_para = 1 and F_perp = −1 at every angle.
    PerfectConductor,
    /// A dielectric (k = 0) or a metal.
    Index(RefractiveIndex),
}

/// The sign of i in the fields' time factor, which decides which of n ∓ ik is passive (errata E5).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TimeFactor {
    /// e^{+iωt}, as in (10): passive media are n − ik.
    Positive,
    /// e^{−iωt}, as in (21): passive media are n + ik.
    Negative,
}

/// Field reflection coefficients (24) and (25).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fields {
    /// F_para
    pub parallel: Complex,
    /// F_perp
    pub perpendicular: Complex,
}

/// A reflected share of energy and the bound of its absolute error.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Energy {
    /// Between 0 and 1.
    pub value: f64,
    /// |value − exact| is not larger.
    pub error: f64,
}

impl Energy {
    /// All of it, exactly.
    pub const ONE: Self = Self { value: 1.0, error: 0.0 };
    /// Some of it.
    pub const UNKNOWN: Self = Self { value: 0.5, error: 0.5 };
    /// None of it, exactly.
    pub const ZERO: Self = Self { value: 0.0, error: 0.0 };

    /// A share lies between 0 and 1, and so does its error. The smallest normal number covers what underflowed.
    #[inline(always)]
    fn new(value: f64, error: f64) -> Self {
        Self { value: value.min(1.0), error: (error + f64::MIN_POSITIVE).min(1.0) }
    }
}

impl From<Energy> for Estimate {
    fn from(energy: Energy) -> Self {
        let least = Scaled::new((energy.value - energy.error).max(0.0));
        Self { value: Scaled::new(energy.value), error: Scaled::new(energy.error), least }
    }
}

/// Energy reflectances (62).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Energies {
    /// F′_para
    pub parallel: Energy,
    /// F′_perp
    pub perpendicular: Energy,
}

impl Energies {
    /// Nothing is reflected: there is no surface.
    pub const NONE: Self = Self { parallel: Energy::ZERO, perpendicular: Energy::ZERO };

    /// F′ of (63).
    #[inline(always)]
    pub fn mixed(&self, polarization: Polarization) -> Energy {
        let (h, v) = (polarization.h(), polarization.v());
        let value = h * self.parallel.value + v * self.perpendicular.value;
        // h + v may miss 1 by SUM_SLACK; two products and a sum.
        let rounding = if h == 1.0 || v == 1.0 { 0.0 } else { 3.0 * EPSILON * value };
        let mixed = Energy::new(value, h * self.parallel.error + v * self.perpendicular.error + rounding);
        // Nothing is nothing exactly.
        Energy { value: mixed.value, error: if *self == Self::NONE { 0.0 } else { mixed.error } }
    }
}

impl Medium {
    /// F′ of (63) at an angle of incidence between 0 and 90°.
    pub fn reflectance(&self, incidence: SinCos, polarization: Polarization) -> Energy {
        match self {
            // h + v is 1 by meaning, if not in the last digit.
            Self::PerfectConductor => Energy::ONE,
            Self::Index(index) => index.energies(incidence).mixed(polarization),
        }
    }

    /// The energies (62).
    pub fn energies(&self, incidence: SinCos) -> Energies {
        match self {
            Self::PerfectConductor => Energies { parallel: Energy::ONE, perpendicular: Energy::ONE },
            Self::Index(index) => index.energies(incidence),
        }
    }

    /// The field coefficients (24), (25).
    pub fn fields(&self, incidence: SinCos, time_factor: TimeFactor) -> Fields {
        match self {
            Self::PerfectConductor => Fields {
                parallel: Complex { re: 1.0, im: 0.0 },
                perpendicular: Complex { re: -1.0, im: 0.0 },
            },
            Self::Index(index) => index.fields(incidence, time_factor),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{Energy, Medium, Polarization, RefractiveIndex, TimeFactor};
    use crate::reflectance::degrees::SinCos;
    use crate::reflectance::numeric::EPSILON;
    use crate::reflectance::quantity::{IndexK, IndexN, Quantity};

    fn index(n: f64, k: f64) -> RefractiveIndex {
        RefractiveIndex { n: IndexN::new(n).unwrap(), k: IndexK::new(k).unwrap() }
    }

    #[test]
    fn fields_square_to_energies_and_are_conjugate() {
        for (n, k) in [(1.5, 0.0), (0.66, 0.0), (0.2, 3.4), (2.0, 1e-3)] {
            for angle in [0.0, 20.0, 50.0, 80.0] {
                let (medium, incidence) = (Medium::Index(index(n, k)), SinCos::of_degrees(angle));
                let (below, above) = (
                    medium.fields(incidence, TimeFactor::Positive),
                    medium.fields(incidence, TimeFactor::Negative),
                );
                let energies = medium.energies(incidence);
                for (a, b, energy) in [
                    (below.parallel, above.parallel, energies.parallel),
                    (below.perpendicular, above.perpendicular, energies.perpendicular),
                ] {
                    assert_eq!((a.re, a.im), (b.re, -b.im));
                    let square = a.re * a.re + a.im * a.im;
                    // Two different roundings of one product of seven factors.
                    let slack = energy.error + 30.0 * EPSILON * energy.value;
                    assert!((square - energy.value).abs() <= slack, "{n} {k} {angle}");
                }
            }
        }
    }

    #[test]
    fn the_perfect_conductor_turns_the_perpendicular_field_round() {
        let fields = Medium::PerfectConductor.fields(SinCos::of_degrees(33.0), TimeFactor::Positive);
        assert_eq!((fields.parallel.re, fields.perpendicular.re), (1.0, -1.0));
        let mix = Polarization::unpolarized();
        assert_eq!(Medium::PerfectConductor.reflectance(SinCos::of_degrees(33.0), mix), Energy::ONE);
    }
}
