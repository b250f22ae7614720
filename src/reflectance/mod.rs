//! The report's models in f64, each value with the bound of its error.
//!
//! Numbers are parsed once, into the types of [`quantity`]; past that point nothing can fail.
//! Errors are stated in units of ε = 2⁻⁵³ ([`numeric::EPSILON`]), the largest relative error of one rounding.

pub mod albedo;
pub mod beckmann_spizzichino;
mod block;
pub mod bounds;
pub mod columns;
mod cost;
pub mod degrees;
pub mod diagram;
pub mod directions;
mod envelope;
pub mod estimate;
pub mod evaluate;
pub mod facet_energy;
mod figure_scenes;
pub mod figures;
pub mod findings;
pub mod fresnel;
pub mod fresnel_average;
pub mod geometry;
pub mod image_irradiance;
mod kernel;
pub mod lambertian;
pub mod linear_image;
pub mod material;
pub mod model;
pub mod numeric;
pub mod outline;
pub mod plan;
pub mod quantity;
pub mod radiometry;
mod receiver;
mod region;
mod requirement;
pub mod roughness;
#[cfg(test)]
mod samples;
pub mod scattered_power;
pub mod scene;
pub mod shadowing;
mod source_energy;
mod strain;
pub mod stretch;
pub mod surface;
pub mod table;
pub mod torrance_sparrow;
pub mod tradeoff;
pub mod unified;
mod view;
pub mod waves;
