//! What the `OpenAPI` document says beyond its operations.

use super::api::examples::{BODIES, LINKS};
use super::edge;
use super::problem::Document;
use super::routes;
use utoipa::openapi::example::ExampleBuilder;
use utoipa::openapi::info::{InfoBuilder, LicenseBuilder};
use utoipa::openapi::path::ParameterBuilder;
use utoipa::openapi::server::ServerBuilder;
use utoipa::openapi::tag::TagBuilder;
use utoipa::openapi::{OpenApi, OpenApiBuilder, RefOr};
use utoipa::{PartialSchema as _, ToSchema as _};

const DESCRIPTION: &str = "\
Surface reflection after Nayar, Ikeuchi and Kanade, *Surface Reflection: Physical and Geometrical Perspectives* \
(CMU-RI-TR-89-7, 1989): radiance and BRDF by component, each value with an error bound that holds.

Angles are in degrees and are reduced exactly: 90 is grazing, cos 90° is 0. Lengths are in micrometres; only \
their ratios matter. A value that is infinite or undefined is `null`, and `diagnostics` says why. A value below \
the smallest 64-bit float is 0; its true size is in the `log10_…` arrays. Numbers in parentheses are the \
equations of the report.

Errors are `application/problem+json` (RFC 9457), all offending fields at once, each with a JSON Pointer; the \
`type` leads to what each means, and `/v1/limits` says what is accepted.

Answers to GET carry an entity tag that follows from what is asked for, in whatever words, and the version. Answers \
and bodies may be in the content codings zstd, br and gzip.";

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
        .servers(Some([
            ServerBuilder::new().url("/").description(Some("The version that is served.")).build(),
            ServerBuilder::new()
                .url(concat!("/", env!("CARGO_PKG_VERSION")))
                .description(Some("This version or none: GET answers under it never change."))
                .build(),
        ]))
        .tags(Some([
            tag("reflection", "Radiance and BRDF of a surface in given directions."),
            tag("diagrams", "Tabulated diagrams and the report's figures."),
            tag("roughness", "Measures of roughness and what they mean for the models."),
            tag("materials", "n and k of materials by wavelength, and where they come from."),
            tag("reference", "What the service says about itself."),
            tag("operations", "For those who run it."),
        ]))
        .build()
}

/// What can only be said once every operation is there: the problem document, and the examples.
pub(super) fn complete(mut document: OpenApi) -> OpenApi {
    let mut schemas = vec![(Document::name().into_owned(), Document::schema())];
    Document::schemas(&mut schemas);
    document.components.get_or_insert_default().schemas.extend(schemas);
    edge::complete_document(&mut document);
    for example in BODIES {
        let operation = document.paths.paths.get_mut(example.path).and_then(|item| item.post.as_mut());
        let content =
            operation.and_then(|operation| operation.request_body.as_mut()).and_then(|body| match body {
                RefOr::T(body) => body.content.get_mut("application/json"),
                RefOr::Ref(_) => None,
            });
        if let (Some(RefOr::T(content)), Ok(value)) =
            (content, serde_json::from_str::<serde_json::Value>(example.body))
        {
            let shown = ExampleBuilder::new().summary(example.summary).value(Some(value)).build();
            content.examples.insert(example.name.to_owned(), shown.into());
        }
    }
    for link in LINKS {
        let operation = document.paths.paths.get_mut(link.path).and_then(|item| item.get.as_mut());
        for parameter in operation.and_then(|operation| operation.parameters.as_mut()).into_iter().flatten() {
            let RefOr::T(parameter) = parameter else { continue };
            let shown = link.values.iter().find(|(name, _)| *name == parameter.name);
            if let Some(value) = shown.and_then(|(_, value)| serde_json::from_str(value).ok()) {
                *parameter = ParameterBuilder::from(parameter.clone()).example(Some(value)).build();
            }
        }
    }
    document
}

/// The document as the service serves it and the repository keeps it.
pub fn openapi_json() -> String {
    // The document is made of strings and finite numbers, which always serialize.
    let mut json = routes::document().to_pretty_json().unwrap_or_default();
    json.push('\n');
    json
}
