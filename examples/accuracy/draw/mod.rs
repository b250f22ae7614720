//! The pictures, as SVG.

mod front;
mod maps;
mod style;

pub(crate) use front::front;
pub(crate) use maps::{choices, errors};
