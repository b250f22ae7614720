//! The errors that operations have in common, for the document.

use crate::http::problem::{Document, Kind, PROBLEM_JSON};
use axum::http::StatusCode;
use std::collections::BTreeMap;
use utoipa::openapi::header::HeaderBuilder;
use utoipa::openapi::schema::{ObjectBuilder, Type};
use utoipa::openapi::{ContentBuilder, Ref, RefOr, Response, ResponseBuilder};
use utoipa::{IntoResponses, ToSchema};

/// Of an operation that takes JSON.
pub(crate) struct PostProblems;

impl IntoResponses for PostProblems {
    fn responses() -> BTreeMap<String, RefOr<Response>> {
        list(&[
            (Kind::MalformedJson, "The body is not JSON; the detail says in which line and column."),
            (Kind::NotAcceptable, "No accepted media type is offered; the detail lists those that are."),
            (Kind::RequestTimeout, "The request did not arrive in time."),
            (
                Kind::ContentTooLarge,
                "The body, as sent or expanded, is larger than the limit, which the detail names.",
            ),
            (
                Kind::UnsupportedMediaType,
                "The body is of a media type or in a content coding that is not read; the detail lists those that are.",
            ),
            (Kind::InvalidRequest, "Fields are out of range or inconsistent: `errors` points at every one."),
            (
                Kind::HeadTooLarge,
                "Target and fields of the request are larger than the limit, which the detail names.",
            ),
            (Kind::TooSlow, "The answer was not ready within the time limit."),
        ])
    }
}

/// Of an operation that takes a query.
pub(crate) struct GetProblems;

impl IntoResponses for GetProblems {
    fn responses() -> BTreeMap<String, RefOr<Response>> {
        list(&[
            (Kind::MalformedQuery, "The query is not readable."),
            (Kind::NotAcceptable, "No accepted media type is offered; the detail lists those that are."),
            (
                Kind::InvalidRequest,
                "Parameters are out of range or inconsistent: `errors` points at every one.",
            ),
            (
                Kind::HeadTooLarge,
                "Target and fields of the request are larger than the limit, which the detail names.",
            ),
            (Kind::TooSlow, "The answer was not ready within the time limit."),
        ])
    }
}

pub(crate) fn list(problems: &[(Kind, &str)]) -> BTreeMap<String, RefOr<Response>> {
    problems
        .iter()
        .map(|&(kind, description)| {
            let schema = Ref::from_schema_name(Document::name());
            let content = ContentBuilder::new().schema(Some(schema)).build();
            let mut response = ResponseBuilder::new().description(description).content(PROBLEM_JSON, content);
            if kind == Kind::Unauthorized {
                let challenge = HeaderBuilder::new()
                    .schema(Some(ObjectBuilder::new().schema_type(Type::String)))
                    .description(Some("How to show a key."))
                    .build();
                response = response.header("WWW-Authenticate", challenge);
            }
            if matches!(kind.status(), StatusCode::TOO_MANY_REQUESTS | StatusCode::SERVICE_UNAVAILABLE) {
                let seconds = ObjectBuilder::new().schema_type(Type::Integer).minimum(Some(0));
                let header = HeaderBuilder::new()
                    .schema(Some(seconds))
                    .description(Some("Seconds after which to ask again."))
                    .build();
                response = response.header("Retry-After", header);
            }
            if kind == Kind::UnsupportedMediaType {
                let codings = ObjectBuilder::new().schema_type(Type::String);
                let header = HeaderBuilder::new()
                    .schema(Some(codings))
                    .description(Some("Where it is the content coding: those that are read."))
                    .build();
                response = response.header("Accept-Encoding", header);
            }
            (kind.status().as_u16().to_string(), response.build().into())
        })
        .collect()
}
