//! The service against input that nobody would think of: what each target does, and what has to hold.

pub mod planner;
pub mod scenes;
pub mod service;
pub mod targets;
