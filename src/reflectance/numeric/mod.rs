//! Arithmetic and quadrature that the models share.

pub mod scaled;
