//! One file a resource: wire types, handler and its `OpenAPI` note.

pub(super) mod documents;
pub(super) mod health;

/// The body of the request that the program suggests when it starts.
pub(super) const FIRST_REQUEST: &str = "{}";
