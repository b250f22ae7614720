//! What the report says in numbers, measured on the service's own diagrams: what holds and what fails.
//! `cargo test --test claims -- --nocapture docs` prints the page that docs/claims.md commits.

mod claim;
mod facets;
mod fixed_view;
mod gallery;
mod lobe;
mod map;
mod materials;
mod page;
mod series;
mod service;
mod spike;

#[test]
fn docs_claims_is_up_to_date() {
    page::hold(&[
        ("The specular spike", spike::all()),
        ("The specular lobe", lobe::all()),
        ("The lobe's series and its two approximations", series::all()),
        ("Facets", facets::all()),
        ("Fixed view, and the two roughness measures", fixed_view::all()),
    ]);
}
