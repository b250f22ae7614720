//! Errors as clients see them: RFC 9457 problem documents.

use super::coding::Coding;
use super::input::node::excerpt;
use axum::body::Body;
use axum::http::{HeaderValue, StatusCode, header};
use axum::response::{IntoResponse, Response};
use serde::Serialize;
use utoipa::ToSchema;

/// Seconds after which a client may ask again that was refused for want of time: the work that was in its way
/// has its own time limit, but most of it ends far sooner.
const RETRY_AFTER: HeaderValue = HeaderValue::from_static("1");

/// The media type of every error.
pub(crate) const PROBLEM_JSON: &str = "application/problem+json";

/// What went wrong, one variant a problem type.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Kind {
    MalformedJson,
    MalformedQuery,
    MalformedColumns,
    BadRequest,
    BodyUnreadable,
    NotFound,
    MethodNotAllowed,
    NotAcceptable,
    RequestTimeout,
    ContentTooLarge,
    HeadTooLarge,
    UnsupportedMediaType,
    UnsupportedCoding,
    InvalidRequest,
    Unauthorized,
    RateLimited,
    Internal,
    TooSlow,
    Overloaded,
    Stopping,
    CpuTime,
}

impl Kind {
    /// Every kind, in the order of their declaration.
    pub(crate) const ALL: [Self; 21] = [
        Self::MalformedJson,
        Self::MalformedQuery,
        Self::MalformedColumns,
        Self::BadRequest,
        Self::BodyUnreadable,
        Self::NotFound,
        Self::MethodNotAllowed,
        Self::NotAcceptable,
        Self::RequestTimeout,
        Self::ContentTooLarge,
        Self::HeadTooLarge,
        Self::UnsupportedMediaType,
        Self::UnsupportedCoding,
        Self::InvalidRequest,
        Self::Unauthorized,
        Self::RateLimited,
        Self::Internal,
        Self::TooSlow,
        Self::Overloaded,
        Self::Stopping,
        Self::CpuTime,
    ];

    /// The last segment of `type`, the status and the title.
    const fn parts(self) -> (&'static str, StatusCode, &'static str) {
        match self {
            Self::MalformedJson => ("malformed-json", StatusCode::BAD_REQUEST, "The body is not JSON"),
            Self::MalformedQuery => ("malformed-query", StatusCode::BAD_REQUEST, "The query is not readable"),
            Self::MalformedColumns => (
                "malformed-columns",
                StatusCode::BAD_REQUEST,
                "The body is not in the format that it is declared as",
            ),
            Self::BadRequest => ("bad-request", StatusCode::BAD_REQUEST, "The request is not readable"),
            Self::BodyUnreadable => {
                ("body-unreadable", StatusCode::BAD_REQUEST, "The body could not be read")
            }
            Self::NotFound => ("not-found", StatusCode::NOT_FOUND, "There is nothing here"),
            Self::MethodNotAllowed => (
                "method-not-allowed",
                StatusCode::METHOD_NOT_ALLOWED,
                "This resource does not answer that method",
            ),
            Self::NotAcceptable => {
                ("not-acceptable", StatusCode::NOT_ACCEPTABLE, "None of the accepted media types is offered")
            }
            Self::RequestTimeout => {
                ("request-timeout", StatusCode::REQUEST_TIMEOUT, "The request did not arrive in time")
            }
            Self::ContentTooLarge => {
                ("content-too-large", StatusCode::PAYLOAD_TOO_LARGE, "The body is larger than the limit")
            }
            Self::HeadTooLarge => (
                "head-too-large",
                StatusCode::REQUEST_HEADER_FIELDS_TOO_LARGE,
                "The head of the request is larger than the limit",
            ),
            Self::UnsupportedMediaType => (
                "unsupported-media-type",
                StatusCode::UNSUPPORTED_MEDIA_TYPE,
                "The body is of a media type that is not accepted",
            ),
            Self::UnsupportedCoding => (
                "unsupported-content-coding",
                StatusCode::UNSUPPORTED_MEDIA_TYPE,
                "The body is packed in a way that is not read",
            ),
            Self::InvalidRequest => {
                ("invalid-request", StatusCode::UNPROCESSABLE_ENTITY, "The request has invalid fields")
            }
            Self::Unauthorized => ("unauthorized", StatusCode::UNAUTHORIZED, "A key is needed"),
            Self::RateLimited => {
                ("rate-limited", StatusCode::TOO_MANY_REQUESTS, "The client asked too often")
            }
            Self::Overloaded => {
                ("overloaded", StatusCode::SERVICE_UNAVAILABLE, "The service has as much work as it takes on")
            }
            Self::Stopping => ("stopping", StatusCode::SERVICE_UNAVAILABLE, "The service is about to stop"),
            Self::CpuTime => (
                "cpu-time-exceeded",
                StatusCode::UNPROCESSABLE_ENTITY,
                "The answer takes more processor time than a request may",
            ),
            Self::Internal => ("internal-error", StatusCode::INTERNAL_SERVER_ERROR, "Internal error"),
            Self::TooSlow => (
                "too-slow",
                StatusCode::SERVICE_UNAVAILABLE,
                "The answer was not ready within the time limit",
            ),
        }
    }

    /// The last segment of `type`.
    pub(crate) const fn slug(self) -> &'static str {
        self.parts().0
    }

    /// The HTTP status.
    pub(crate) const fn status(self) -> StatusCode {
        self.parts().1
    }

    /// The kind in words.
    pub(crate) const fn title(self) -> &'static str {
        self.parts().2
    }

    /// The value of `type`: a link to what the kind means.
    pub(crate) fn reference(self) -> String {
        format!("/problems/{}", self.slug())
    }
}

// The last kind is the last of all: none is left out.
const _: () = assert!(Kind::ALL.len() == Kind::CpuTime as usize + 1);

/// What is wrong with a field. The names are stable.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, ToSchema)]
#[serde(rename_all = "snake_case")]
pub(crate) enum Code {
    /// A field that is needed is absent or null.
    Required,
    /// The JSON type is not one that the field takes.
    WrongType,
    /// The number is outside the field's range.
    OutOfRange,
    /// The resource has no such field.
    UnknownField,
    /// The word is not one of those that the field takes.
    UnknownValue,
    /// The field, parameter or list entry is given more than once.
    Duplicate,
    /// Arrays differ in length.
    UnequalLengths,
    /// The list has no entries.
    Empty,
    /// There are more entries than the limit.
    TooMany,
    /// Fields contradict each other.
    Inconsistent,
    /// A feature of the interface that this version does not answer yet.
    NotOffered,
    /// Stands for further errors of the same kind that are not listed one by one.
    More,
}

/// One offending field.
#[derive(Clone, Debug, Serialize, ToSchema)]
pub(crate) struct FieldError {
    /// JSON Pointer (RFC 6901) into the body; for a query, `/` and the parameter's name.
    #[schema(example = "/geometry/theta_i_deg")]
    pub(crate) pointer: String,
    /// What is wrong, for programs.
    pub(crate) code: Code,
    /// What is wrong and what would have been accepted, for people.
    #[schema(example = "zenith angle of the source 91 is outside: expected a number from 0 to 90 degrees")]
    pub(crate) detail: String,
}

/// An error on its way to the client. [`Problem::render`] makes the response once the request's
/// path is known.
#[derive(Clone, Debug)]
pub(crate) struct Problem {
    pub(crate) kind: Kind,
    pub(crate) detail: String,
    pub(crate) errors: Vec<FieldError>,
}

/// A problem document, RFC 9457.
#[derive(Serialize, ToSchema)]
#[schema(as = Problem)]
pub(crate) struct Document<'a> {
    /// A stable reference to the kind of problem.
    #[serde(rename = "type")]
    #[schema(example = "/problems/invalid-request")]
    kind: String,
    /// The kind in words.
    title: &'a str,
    /// The HTTP status code.
    #[schema(minimum = 400, maximum = 599)]
    status: u16,
    /// What happened this time.
    detail: &'a str,
    /// The path that was asked for.
    instance: &'a str,
    /// Every offending field.
    #[serde(skip_serializing_if = "<[FieldError]>::is_empty")]
    errors: &'a [FieldError],
}

impl Problem {
    pub(crate) fn new(kind: Kind, detail: impl Into<String>) -> Self {
        Self { kind, detail: detail.into(), errors: Vec::new() }
    }

    /// 422 with all that is wrong.
    pub(crate) fn invalid(errors: Vec<FieldError>) -> Self {
        let detail = match errors.as_slice() {
            [only] if only.pointer.is_empty() => only.detail.clone(),
            [only] => format!("{}: {}", excerpt(&only.pointer), only.detail),
            _ => format!("{} errors, each listed with a pointer to its field", errors.len()),
        };
        Self { kind: Kind::InvalidRequest, detail, errors }
    }

    /// 500, which says nothing else: what happened is for the log.
    pub(crate) fn internal() -> Self {
        Self::new(Kind::Internal, "The request was not answered. The cause is in the service's log.")
    }

    /// 500 for an answer that could not be written down; memory is the only way to fail.
    pub(crate) fn unwritten(error: &dyn std::error::Error) -> Self {
        tracing::error!(%error, "an answer could not be written");
        Self::internal()
    }

    /// Whether the request was refused because there is too much work.
    pub(crate) fn is_overload(&self) -> bool {
        self.kind == Kind::Overloaded
    }

    /// Kind and detail, for the log.
    pub(crate) fn summary(&self) -> String {
        format!("{}: {}", self.kind.parts().0, self.detail)
    }

    /// The document for a request to `path`.
    pub(crate) fn document(&self, path: &str) -> Vec<u8> {
        let document = Document {
            kind: self.kind.reference(),
            title: self.kind.title(),
            status: self.kind.status().as_u16(),
            detail: &self.detail,
            instance: path,
            errors: &self.errors,
        };
        // Strings and small integers always serialize; an empty body would still carry the status.
        serde_json::to_vec(&document).unwrap_or_default()
    }

    /// The response for a request to `path`, with `headers` that were already set (`Allow`).
    pub(crate) fn render(&self, path: &str) -> Response {
        let status = self.kind.status();
        let mut response = Response::new(Body::from(self.document(path)));
        *response.status_mut() = status;
        let headers = response.headers_mut();
        headers.insert(header::CONTENT_TYPE, HeaderValue::from_static(PROBLEM_JSON));
        headers.insert(header::CACHE_CONTROL, HeaderValue::from_static("no-store"));
        if self.kind == Kind::UnsupportedCoding {
            headers.insert(header::ACCEPT_ENCODING, HeaderValue::from_static(Coding::LIST));
        }
        if status == StatusCode::SERVICE_UNAVAILABLE {
            response.headers_mut().insert(header::RETRY_AFTER, RETRY_AFTER);
        }
        response
    }
}

impl IntoResponse for Problem {
    fn into_response(self) -> Response {
        let mut response = Response::new(Body::empty());
        *response.status_mut() = self.kind.status();
        response.extensions_mut().insert(self);
        response
    }
}
