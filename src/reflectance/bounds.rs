//! The one table of input ranges. Constructors in [`super::quantity`], error messages, the
//! `OpenAPI` schema and the tests all read it.

use core::fmt;

/// A closed interval that an input has to lie in, with the name and unit it is spoken of.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    /// What the number is, in the field's words.
    pub name: &'static str,
    /// Unit, or the empty string for a pure number.
    pub unit: &'static str,
    /// Smallest accepted value.
    pub min: f64,
    /// Largest accepted value.
    pub max: f64,
}

impl Bounds {
    const fn new(name: &'static str, unit: &'static str, min: f64, max: f64) -> Self {
        Self { name, unit, min, max }
    }

    /// Whether `value` is accepted; never true for NaN or an infinity.
    pub const fn contains(&self, value: f64) -> bool {
        value >= self.min && value <= self.max
    }
}

/// "a number from 0 to 90 degrees"
impl fmt::Display for Bounds {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "a number from {} to {}", Short(self.min), Short(self.max))?;
        if !self.unit.is_empty() {
            write!(f, " {}", self.unit)?;
        }
        Ok(())
    }
}

/// Prints 1e-60 rather than sixty zeros.
struct Short(f64);

impl fmt::Display for Short {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let size = self.0.abs();
        if size == 0.0 || (1e-3..1e6).contains(&size) {
            write!(f, "{}", self.0)
        } else {
            write!(f, "{:e}", self.0)
        }
    }
}

/// Any length: the ratio of two of them squared stays far inside f64, so g and x never overflow.
pub const LENGTH: Bounds = Bounds::new("length", "micrometres", 1e-60, 1e60);
/// Any area: the squares of [`LENGTH`].
pub const AREA: Bounds = Bounds::new("area", "square micrometres", 1e-120, 1e120);
/// Zenith angle of the source.
pub const THETA_I: Bounds = Bounds::new("zenith angle of the source", "degrees", 0.0, 90.0);
/// Zenith angle of the viewer; negative means the same zenith at azimuth + 180.
pub const THETA_R: Bounds = Bounds::new("zenith angle of the viewer", "degrees", -90.0, 90.0);
/// Azimuth of the viewer; 0 is the half plane that holds the mirror direction.
pub const PHI_R: Bounds = Bounds::new("azimuth of the viewer", "degrees", -360.0, 360.0);
/// σ_α of (58).
pub const FACET_SLOPE: Bounds = Bounds::new("facet slope", "degrees", 1e-12, 1e3);
/// Angle between the optical axis and the ray to the surface element (γ of figure 10).
pub const OFF_AXIS: Bounds = Bounds::new("off-axis angle", "degrees", 0.0, 89.0);
/// Half angle of the cone that a receiver of finite size takes the mean over.
pub const RECEIVER_HALF_ANGLE: Bounds = Bounds::new("half angle of the receiver", "degrees", 1e-60, 90.0);
/// Directions, at all wavelengths and over all curves together, around which one request takes the mean over a receiver's cone:
/// each takes from a tenth of a millisecond to a quarter of a second.
pub const MAX_RECEIVED: usize = 10_000;
/// Real part n of the complex refractive index n − ik.
pub const INDEX_N: Bounds = Bounds::new("refractive index n", "", 1e-9, 1e9);
/// Extinction coefficient k of the complex refractive index n − ik.
pub const INDEX_K: Bounds = Bounds::new("extinction coefficient k", "", 0.0, 1e9);
/// A share: albedo, polarization weight.
pub const FRACTION: Bounds = Bounds::new("fraction", "", 0.0, 1.0);
/// Irradiance of the beam on a plane normal to it.
pub const IRRADIANCE: Bounds = Bounds::new("irradiance", "W m^-2", 1e-100, 1e100);
/// c·a_f of (71).
pub const SPECULAR_SCALE: Bounds = Bounds::new("specular scale", "sr^-1", 0.0, 1e100);
/// Strengths C and K of (74) and (80).
pub const STRENGTH: Bounds = Bounds::new("component strength", "", 0.0, 1e100);
/// σ_s of the Gaussian that stands for the spike in (74) and (80).
pub const SPIKE_WIDTH: Bounds = Bounds::new("width of the spike", "degrees", 1e-12, 1e3);
/// Relative tolerance of an answer.
pub const TOLERANCE: Bounds = Bounds::new("relative tolerance", "", 1e-15, 0.1);
/// Beckmann's α = tan α₀ = 2σ_h/T, or the ratio σ_h/T.
pub const SLOPE_RATIO: Bounds = Bounds::new("slope", "", 1e-120, 1e120);
/// σ_α as (79) can invert it: below 90°/√2.
pub const FACET_SLOPE_INVERTIBLE: Bounds =
    Bounds::new("facet slope that (79) can invert", "degrees", 1e-12, 63.63961030678927);
/// σ_h/T of which F′ is averaged over the slopes: beyond, the normals crowd at the horizon.
pub const SLOPE_AVERAGED: Bounds = Bounds::new("rms height over correlation length", "", 1e-121, 4.0);
/// The same as a facet slope: (79) takes 58.6° to σ_h/T = 3.9988.
pub const FACET_SLOPE_AVERAGED: Bounds =
    Bounds::new("facet slope that F′ is averaged over", "degrees", 1e-12, 58.6);
/// Sources' zeniths, over all curves of a diagram, for which one request averages F′ over the slopes: each takes about a
/// millisecond.
pub const MAX_AVERAGED: usize = 500;
/// Ends of a sweep; a negative zenith lies on the other side of the normal.
pub const SWEEP_ANGLE: Bounds = Bounds::new("swept zenith angle", "degrees", -90.0, 90.0);
/// Step of a sweep.
pub const SWEEP_STEP: Bounds = Bounds::new("sweep step", "degrees", 1e-6, 180.0);
/// The relative tolerance of a caller who names none.
pub const DEFAULT_TOLERANCE: f64 = 1e-9;
/// The relative tolerance of an albedo where none is named.
pub const DEFAULT_ALBEDO_TOLERANCE: f64 = 1e-6;
/// Incidences of one albedo request that a service can be set to accept.
pub const MAX_INCIDENCES: usize = 100_000;
/// Those that it accepts unless it is.
pub const DEFAULT_INCIDENCES: usize = 1000;
/// Directions in one request.
pub const MAX_DIRECTIONS: usize = 1_000_000;
/// Points along one sweep.
pub const MAX_SWEEP_POINTS: usize = 1_000_000;
/// Rows of one diagram: points times fixed angles.
pub const MAX_ROWS: usize = 10_000_000;
/// Fixed angles of one diagram.
pub const MAX_CURVES: usize = 100;
/// Wavelengths of one spectrum.
pub const MAX_WAVELENGTHS: usize = 1_000;
/// Series of one diagram: fixed angles times wavelengths.
pub const MAX_SERIES: usize = 10_000;
