//! Arithmetic and quadrature that the models share.

pub mod quadrature;
pub mod scaled;
