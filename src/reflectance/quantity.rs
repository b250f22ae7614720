//! The numbers that go into the models, parsed once: a value of one of these types lies in its
//! [`Bounds`], and nothing past this point checks it again.

use super::bounds::{self, Bounds};
use core::fmt;
use core::hash::{Hash, Hasher};

/// A number outside its bounds (NaN and infinities included).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OutOfBounds {
    /// What was given.
    pub value: f64,
    /// What would have been accepted.
    pub bounds: &'static Bounds,
}

impl fmt::Display for OutOfBounds {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} {} is outside: expected {}", self.bounds.name, self.value, self.bounds)
    }
}

impl core::error::Error for OutOfBounds {}

/// A type that a bounded number parses into.
pub trait Quantity: Sized + Copy {
    /// The accepted range.
    const BOUNDS: &'static Bounds;

    /// Accepts a number inside [`Self::BOUNDS`].
    fn new(value: f64) -> Result<Self, OutOfBounds>;

    /// The number.
    fn get(self) -> f64;
}

macro_rules! quantities {
    ($($(#[$doc:meta])* $name:ident in $bounds:ident;)*) => {$(
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
        #[repr(transparent)]
        pub struct $name(f64);

        /// By the bits: -0 and 0, which are equal, may be answered with their own sign.
        impl Hash for $name {
            fn hash<H: Hasher>(&self, state: &mut H) {
                state.write_u64(self.0.to_bits());
            }
        }

        impl Quantity for $name {
            const BOUNDS: &'static Bounds = &bounds::$bounds;

            fn new(value: f64) -> Result<Self, OutOfBounds> {
                if Self::BOUNDS.contains(value) {
                    Ok(Self(value))
                } else {
                    Err(OutOfBounds { value, bounds: Self::BOUNDS })
                }
            }

            #[inline]
            fn get(self) -> f64 {
                self.0
            }
        }

        impl $name {
            /// The number, in the unit of its bounds.
            #[inline]
            pub const fn get(self) -> f64 {
                self.0
            }
        }
    )*};
}

quantities! {
    /// θ_i, degrees.
    SourceZenith in THETA_I;
    /// θ_r, degrees; negative means the same zenith at azimuth + 180°.
    ViewerZenith in THETA_R;
    /// φ_r, degrees.
    Azimuth in PHI_R;
    /// λ, micrometres.
    Wavelength in LENGTH;
    /// σ_h, micrometres: the standard deviation of the Gaussian height density (4).
    RmsHeight in LENGTH;
    /// T, micrometres: the distance at which the autocorrelation (5) falls to 1/e.
    CorrelationLength in LENGTH;
    /// Any other length, micrometres.
    Length in LENGTH;
    /// An area, square micrometres.
    Area in AREA;
    /// σ_α, degrees: the width of the density exp(−α²/2σ_α²) of the facet slope angle α, (58).
    /// As a density per solid angle it carries the scale c of (58).
    FacetSlope in FACET_SLOPE;
    /// `σ_α` that (79) can turn into `σ_h`/T, degrees.
    InvertibleFacetSlope in FACET_SLOPE_INVERTIBLE;
    /// Beckmann's tan α₀ = 2`σ_h`/T, (77).
    BeckmannAlpha in SLOPE_RATIO;
    /// σ_h/T of which F′ can be averaged over the slopes.
    AveragedRatio in SLOPE_AVERAGED;
    /// γ of figure 10, degrees.
    OffAxis in OFF_AXIS;
    /// β, degrees: half the angle under which the surface sees a receiver of finite size.
    ReceiverHalfAngle in RECEIVER_HALF_ANGLE;
    /// n of n − ik.
    IndexN in INDEX_N;
    /// k of n − ik.
    IndexK in INDEX_K;
    /// A share between 0 and 1.
    Fraction in FRACTION;
    /// Irradiance of the beam on a plane normal to it.
    Irradiance in IRRADIANCE;
    /// c·a_f of (71), per steradian.
    SpecularScale in SPECULAR_SCALE;
    /// C or K of (74), (80).
    Strength in STRENGTH;
    /// σ_s of section 5.1, degrees: the width of exp(−((θ_i − θ_r)² + φ_r²)/2σ_s²).
    SpikeWidth in SPIKE_WIDTH;
    /// Relative tolerance.
    Tolerance in TOLERANCE;
    /// An end of a sweep, degrees.
    SweepAngle in SWEEP_ANGLE;
    /// The step of a sweep, degrees.
    SweepStep in SWEEP_STEP;
}

impl Fraction {
    /// None of it.
    pub const ZERO: Self = Self(0.0);
    /// Half of it.
    pub const HALF: Self = Self(0.5);
    /// All of it.
    pub const ONE: Self = Self(1.0);
}

impl Tolerance {
    /// The finest that may be asked for.
    pub const FINEST: Self = Self(bounds::TOLERANCE.min);
    /// From the coarsest on, those that measurements of the trade of speed for accuracy are made at.
    pub const STEPS: [Self; 5] = [Self(1e-1), Self(1e-3), Self(1e-6), Self(1e-9), Self(1e-12)];
}

#[cfg(test)]
mod tests {
    use super::{Quantity, RmsHeight, SourceZenith};

    #[test]
    fn bounds_are_inclusive_and_refuse_what_is_not_a_number() {
        assert!(SourceZenith::new(0.0).is_ok());
        assert!(SourceZenith::new(90.0).is_ok());
        for value in [-1e-300, 90.00000000000001, f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            assert!(SourceZenith::new(value).is_err(), "{value}");
        }
        assert!(RmsHeight::new(0.0).is_err());
    }

    #[test]
    fn the_message_says_what_would_have_been_accepted() {
        let message = SourceZenith::new(91.0).unwrap_err().to_string();
        assert!(message.contains("from 0 to 90 degrees"), "{message}");
        let message = RmsHeight::new(0.0).unwrap_err().to_string();
        assert!(message.contains("from 1e-60 to 1e60 micrometres"), "{message}");
    }
}
