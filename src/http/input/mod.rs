//! From bytes to checked values, with every error at once.
//!
//! [`node`] reads JSON into a tree whose arrays of numbers are `Vec<f64>`s, [`plain`] most of it faster; [`wire`] turns the tree
//! into values of the core's types and notes each thing that is wrong with a pointer to it; [`object`]
//! declares the fields of an object once, for reading and for the `OpenAPI` schema.

pub(crate) mod medium;
pub(crate) mod node;
pub(crate) mod object;
mod plain;
pub(crate) mod query;
pub(crate) mod reader;
pub(crate) mod values;
pub(crate) mod wire;
