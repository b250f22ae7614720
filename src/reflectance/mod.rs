//! The report's models in f64, each value with the bound of its error.
//!
//! Numbers are parsed once, into the types of [`quantity`]; past that point nothing can fail.
//! Errors are stated in units of ε = 2⁻⁵³, the largest relative error of one rounding.

pub mod bounds;
pub mod degrees;
pub mod fresnel;
pub mod geometry;
pub mod lambertian;
pub mod numeric;
pub mod quantity;
pub mod roughness;
pub mod shadowing;

/// ε = 2⁻⁵³: the largest relative error of one rounding to nearest.
pub const UNIT_ROUNDOFF: f64 = f64::EPSILON / 2.0;
