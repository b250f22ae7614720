//! Numerical building blocks, each with a stated error.

pub mod cubature;
pub mod dispatch;
pub mod elementary;
pub mod erfc_integral;
pub mod lobe_series;
pub mod quadrature;
pub mod scaled;
pub mod sinc;

/// 2⁻⁵³: half a unit in the last place of 1, the largest relative error of one rounding.
pub const EPSILON: f64 = f64::EPSILON / 2.0;
