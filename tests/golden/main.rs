//! The oracle's values against the core and, over HTTP, against the started binary.
//! `cargo test --test golden -- --nocapture` prints the worst error of every quantity.

mod accuracy;
mod condition;
mod family;
mod fresnel;
mod measure;
mod roughness;
mod table;

#[test]
fn docs_accuracy_is_up_to_date() {
    accuracy::hold(&[&fresnel::MEASURED, &roughness::MEASURED]);
}
