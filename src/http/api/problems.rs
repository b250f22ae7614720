//! `GET /problems` and `GET /problems/{slug}`: what the `type` of a problem document points at.

use super::responses::{GetProblems, list};
use crate::http::encode::json;
use crate::http::input::query::NoQuery;
use crate::http::link::{Known, linked};
use crate::http::negotiate::JsonOnly;
use crate::http::problem::{Kind, Problem};
use axum::extract::Path;
use axum::extract::rejection::PathRejection;
use axum::response::Response;
use serde::Serialize;
use std::collections::BTreeMap;
use utoipa::openapi::{RefOr, Response as Documented};
use utoipa::{IntoResponses, ToSchema};

/// A type of problem.
#[derive(Serialize, ToSchema)]
pub(crate) struct ProblemType {
    /// The reference that problem documents carry.
    #[serde(rename = "type")]
    #[schema(example = "/problems/content-too-large")]
    kind: String,
    /// The type in words.
    #[schema(example = "The body is larger than the limit")]
    title: &'static str,
    /// The HTTP status that it comes with.
    #[schema(example = 413)]
    status: u16,
    /// When it occurs, and what to do about it.
    about: &'static str,
}

/// Every type of problem.
#[derive(Serialize, ToSchema)]
pub(crate) struct ProblemTypes {
    /// By status.
    problems: Vec<ProblemType>,
}

impl ProblemType {
    fn of(kind: Kind) -> Self {
        Self {
            kind: kind.reference(),
            title: kind.title(),
            status: kind.status().as_u16(),
            about: about(kind),
        }
    }
}

const fn about(kind: Kind) -> &'static str {
    match kind {
        Kind::MalformedJson => {
            "The body does not follow the grammar of JSON (RFC 8259). The detail says in which line and column it \
             stops to."
        }
        Kind::MalformedQuery => {
            "The query is not application/x-www-form-urlencoded UTF-8, or has more parameters than any request \
             needs."
        }
        Kind::MalformedColumns => {
            "The body is not a CSV file, an Arrow IPC stream or a NumPy array as its media type says. The detail says \
             where it stops to be."
        }
        Kind::BadRequest => "The request does not follow HTTP, or a path or header cannot be read.",
        Kind::BodyUnreadable => {
            "The body ended before its announced length, or is not whole and valid in the content coding that it \
             is declared in. Send it again."
        }
        Kind::NotFound => "No resource has this path. /openapi.json lists those that exist.",
        Kind::MethodNotAllowed => {
            "The resource exists and answers other methods: the header Allow lists them."
        }
        Kind::NotAcceptable => {
            "None of the media types that the header Accept lists is offered here; the detail lists those that are."
        }
        Kind::RequestTimeout => {
            "The body did not arrive within the time that the detail names. Send it again."
        }
        Kind::ContentTooLarge => {
            "The body, as sent or expanded, is longer than the limit that the detail names. Send it in parts; \
             /v1/limits lists the limits."
        }
        Kind::HeadTooLarge => {
            "The head of the request, its target and all its header fields, is longer than the limit that the detail \
             names. What is long belongs into a body: every resource with a long query answers POST as well."
        }
        Kind::UnsupportedMediaType => {
            "The header Content-Type names a media type that the resource does not read; the detail lists those \
             that it does."
        }
        Kind::UnsupportedCoding => {
            "The header Content-Encoding names a content coding that is not read, or several. The header \
             Accept-Encoding of the answer lists those that are."
        }
        Kind::InvalidRequest => {
            "The request could be read, but fields are missing, unknown, out of range or at odds with each other. \
             `errors` points at every one, with what would have been accepted; /v1/limits lists the ranges."
        }
        Kind::Unauthorized => {
            "The service answers those who have a key: send it as `Authorization: Bearer` and the key. Those who \
             run the service give out keys."
        }
        Kind::RateLimited => {
            "The client made more requests than it may. The header Retry-After says in how many seconds the next \
             one is answered."
        }
        Kind::Internal => {
            "A defect of the service. Its log has the cause; the same request will fail again until it is mended."
        }
        Kind::TooSlow => {
            "The answer was not ready in time. Ask for fewer directions at once, or later, when the service has \
             less to do."
        }
        Kind::Overloaded => {
            "The service has as much work as it takes on. Nothing was done for this request: ask again after the \
             seconds that the header Retry-After names."
        }
        Kind::Stopping => {
            "The service was told to stop and finishes what is in flight. Ask again: a balancer sends the request elsewhere."
        }
        Kind::CpuTime => {
            "The answer would take more processor time than a request may; the detail names the limit. Ask for \
             fewer directions at once, or for a cheaper method."
        }
    }
}

/// No problem of that name.
pub(crate) struct NoProblem;

impl IntoResponses for NoProblem {
    fn responses() -> BTreeMap<String, RefOr<Documented>> {
        list(&[(Kind::NotFound, "There is no such type of problem; the detail lists those that there are.")])
    }
}

/// Every type of problem.
#[utoipa::path(
    get,
    operation_id = "problems",
    path = "/problems",
    tag = "reference",
    responses(
        (status = 200, description = "What can go wrong, by status.", body = ProblemTypes),
        (status = 304, description = "The client has this answer already."),
        GetProblems
    )
)]
pub(crate) async fn index(_: JsonOnly, known: Known, _: NoQuery) -> Result<Response, Problem> {
    linked(&known, &"/problems", async {
        let mut kinds = Kind::ALL;
        kinds.sort_by_key(|kind| kind.status());
        let problems = kinds.into_iter().map(ProblemType::of).collect();
        json::response(&ProblemTypes { problems }, 8 << 10)
    })
    .await
}

/// One type of problem: what the `type` of a problem document points at.
#[utoipa::path(
    get,
    path = "/problems/{slug}",
    tag = "reference",
    params(("slug" = String, Path, description = "The last segment of the type.", example = "content-too-large")),
    responses(
        (status = 200, description = "What it means.", body = ProblemType),
        (status = 304, description = "The client has this answer already."),
        NoProblem,
        GetProblems
    )
)]
pub(crate) async fn problem(
    _: JsonOnly,
    known: Known,
    slug: Result<Path<String>, PathRejection>,
    _: NoQuery,
) -> Result<Response, Problem> {
    // A name that is not UTF-8 is the name of no problem.
    let kind = slug.ok().and_then(|Path(slug)| Kind::ALL.into_iter().find(|kind| kind.slug() == slug));
    let kind = kind.ok_or_else(no_problem)?;
    linked(&known, &("/problems", kind.slug()), async { json::response(&ProblemType::of(kind), 1 << 10) })
        .await
}

fn no_problem() -> Problem {
    let slugs = Kind::ALL.map(Kind::slug).join(", ");
    Problem::new(Kind::NotFound, format!("There is no such type of problem. There are: {slugs}"))
}

#[cfg(test)]
mod tests {
    use super::{Kind, about};
    use std::collections::BTreeSet;

    #[test]
    fn every_type_has_a_name_of_its_own_and_says_what_it_is() {
        let slugs: BTreeSet<_> = Kind::ALL.map(Kind::slug).into();
        assert_eq!(slugs.len(), Kind::ALL.len());
        for kind in Kind::ALL {
            assert!(about(kind).len() > 40, "{kind:?}");
            assert!(kind.status().as_u16() >= 400);
        }
    }
}
