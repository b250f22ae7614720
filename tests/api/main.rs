//! The service from outside: the real binary over real HTTP.

mod access;
mod albedo;
mod at_once;
mod bad_input;
mod caching;
mod command_line;
mod compression;
mod diagrams;
mod documents;
mod examples;
mod formats;
mod http2;
mod in_force;
mod limits;
mod plan;
mod properties;
mod protocol;
mod radiance;
mod readme;
mod secure;
mod server;
mod surfaces;
mod telemetry;
mod tradeoff;
mod transport;
mod wire;
