//! What the `OpenAPI` document says beyond its operations.

use super::routes;
use utoipa::openapi::info::{InfoBuilder, LicenseBuilder};
use utoipa::openapi::tag::TagBuilder;
use utoipa::openapi::{OpenApi, OpenApiBuilder};

const DESCRIPTION: &str = "\
Surface reflection after Nayar, Ikeuchi and Kanade, *Surface Reflection: Physical and Geometrical Perspectives* \
(CMU-RI-TR-89-7, 1989): radiance and BRDF by component, each value with an error bound that holds.

Angles are in degrees and are reduced exactly: 90 is grazing, cos 90° is 0. Lengths are in micrometres; only \
their ratios matter. A value that is infinite or undefined is `null`, and `diagnostics` says why. A value below \
the smallest 64-bit float is 0; its true size is in the `log10_…` arrays. Numbers in parentheses are the \
equations of the report.

Errors are `application/problem+json` (RFC 9457), all offending fields at once, each with a JSON Pointer.";

/// Title, licence and tags.
pub(super) fn information() -> OpenApi {
    let tag =
        |name: &str, description: &str| TagBuilder::new().name(name).description(Some(description)).build();
    OpenApiBuilder::new()
        .info(
            InfoBuilder::new()
                .title("reflectance")
                .version(env!("CARGO_PKG_VERSION"))
                .description(Some(DESCRIPTION))
                .license(Some(
                    LicenseBuilder::new()
                        .name(env!("CARGO_PKG_LICENSE"))
                        .identifier(Some(env!("CARGO_PKG_LICENSE")))
                        .build(),
                ))
                .build(),
        )
        .tags(Some([
            tag("reflection", "Radiance and BRDF of a surface in given directions."),
            tag("diagrams", "Tabulated diagrams and the report's figures."),
            tag("roughness", "Measures of roughness and what they mean for the models."),
            tag("reference", "What the service says about itself."),
            tag("operations", "For those who run it."),
        ]))
        .build()
}

/// What can only be said once every operation is there.
pub(super) fn complete(document: OpenApi) -> OpenApi {
    document
}

/// The document as the service serves it and the repository keeps it.
pub fn openapi_json() -> String {
    // The document is made of strings and finite numbers, which always serialize.
    let mut json = routes::document().to_pretty_json().unwrap_or_default();
    json.push('\n');
    json
}
