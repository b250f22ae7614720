//! The oracle's values against the core and, over HTTP, against the started binary.
//! `cargo test --test golden -- --nocapture` prints the worst error of every quantity.

mod accuracy;
mod family;
mod measure;
mod table;
