//! From answers to bytes, one file an encoding.

pub(crate) mod arrow;
pub(crate) mod csv;
pub(crate) mod flat;
pub(crate) mod json;
pub(crate) mod npy;
pub(crate) mod numbers;
pub(crate) mod rows;
pub(crate) mod table;
