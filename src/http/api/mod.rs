//! One file a resource: wire types, handler and its `OpenAPI` note.

pub(super) mod albedo;
pub(super) mod answer;
pub(super) mod diagrams;
pub(super) mod documents;
pub(super) mod examples;
mod figure_links;
pub(super) mod figures;
pub(super) mod health;
pub(super) mod image_irradiance;
pub(super) mod light;
pub(super) mod limits;
pub(super) mod materials;
pub(super) mod plan;
pub(super) mod problems;
pub(super) mod radiance;
pub(super) mod responses;
pub(super) mod roughness;
mod scene;
mod sensor;
mod spike;
mod sweep;
pub(super) mod tradeoff;

/// The body of the request that the program suggests when it starts.
pub(super) const FIRST_REQUEST: &str = examples::FIRST;
