//! From answers to bytes, one file an encoding.

pub(crate) mod csv;
pub(crate) mod json;
pub(crate) mod numbers;
pub(crate) mod table;
