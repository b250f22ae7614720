//! The oracle's values against the core and, over HTTP, against the started binary.
//! `cargo test --test golden -- --nocapture` prints the worst error of every quantity.

mod accuracy;
mod api;
mod bs;
mod condition;
mod family;
mod ff;
mod fresnel;
mod image;
mod material;
mod measure;
mod roughness;
mod series;
mod server;
mod surface;
mod table;
mod ts;
mod waves;

#[test]
fn docs_accuracy_is_up_to_date() {
    accuracy::hold(&[
        &surface::MEASURED,
        &waves::MEASURED,
        &fresnel::MEASURED,
        &series::MEASURED,
        &bs::MEASURED,
        &ts::MEASURED,
        &roughness::MEASURED,
        &image::MEASURED,
        &ff::MEASURED,
        &api::MEASURED,
    ]);
}
