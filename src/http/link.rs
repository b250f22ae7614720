//! Answers that are pure functions of their link: an entity tag, and how long they keep.

use super::problem::Problem;
use axum::extract::FromRequestParts;
use axum::http::request::Parts;
use axum::http::{HeaderMap, HeaderValue, StatusCode, header};
use axum::response::{IntoResponse as _, Response};
use std::convert::Infallible;
use std::hash::{DefaultHasher, Hasher as _};

/// A new version of the service may answer a link with other last digits: an hour, then ask again.
const CACHE_CONTROL: HeaderValue = HeaderValue::from_static("public, max-age=3600");

/// What a client that asked before already has.
pub(crate) struct Known(Vec<String>);

impl<S: Sync> FromRequestParts<S> for Known {
    type Rejection = Infallible;

    async fn from_request_parts(parts: &mut Parts, _: &S) -> Result<Self, Infallible> {
        Ok(Self(tags(&parts.headers)))
    }
}

/// The entity tags of `If-None-Match`, compared weakly: `W/` does not matter.
fn tags(headers: &HeaderMap) -> Vec<String> {
    headers
        .get_all(header::IF_NONE_MATCH)
        .iter()
        .filter_map(|value| value.to_str().ok())
        .flat_map(|value| value.split(','))
        .map(|tag| tag.trim().trim_start_matches("W/").to_owned())
        .collect()
}

/// An answer whose entity tag follows from its link: it is not made where the client has it already.
pub(crate) async fn linked(
    known: &Known,
    key: &str,
    answer: impl Future<Output = Result<Response, Problem>>,
) -> Result<Response, Problem> {
    let tag = entity_tag(format!("{} {key}", env!("CARGO_PKG_VERSION")).as_bytes());
    let mut response = if known.0.iter().any(|k| *k == tag || k == "*") {
        StatusCode::NOT_MODIFIED.into_response()
    } else {
        answer.await?
    };
    let headers = response.headers_mut();
    headers.insert(header::CACHE_CONTROL, CACHE_CONTROL);
    headers.insert(header::VARY, HeaderValue::from_static("accept"));
    if let Ok(tag) = HeaderValue::from_str(&tag) {
        headers.insert(header::ETAG, tag);
    }
    Ok(response)
}

/// A body with its entity tag.
pub(crate) fn tagged(known: &Known, content_type: &'static str, body: Vec<u8>) -> Response {
    let tag = entity_tag(&body);
    let mut response = if known.0.iter().any(|k| *k == tag || k == "*") {
        StatusCode::NOT_MODIFIED.into_response()
    } else {
        ([(header::CONTENT_TYPE, content_type)], body).into_response()
    };
    let headers = response.headers_mut();
    headers.insert(header::CACHE_CONTROL, CACHE_CONTROL);
    headers.insert(header::VARY, HeaderValue::from_static("accept"));
    if let Ok(tag) = HeaderValue::from_str(&tag) {
        headers.insert(header::ETAG, tag);
    }
    response
}

/// A strong tag: equal bytes have equal tags, and 64 bits tell different ones apart.
fn entity_tag(body: &[u8]) -> String {
    let mut hasher = DefaultHasher::new();
    hasher.write(body);
    format!("\"{:016x}\"", hasher.finish())
}

#[cfg(test)]
mod tests {
    use super::{Known, tagged};
    use axum::http::{StatusCode, header};

    #[test]
    fn what_is_known_is_not_sent_again() {
        let first = tagged(&Known(Vec::new()), "text/csv", b"a,b".to_vec());
        assert_eq!(first.status(), StatusCode::OK);
        let tag = first.headers()[header::ETAG].to_str().unwrap().to_owned();
        for known in [tag.clone(), "*".to_owned()] {
            let again = tagged(&Known(vec![known]), "text/csv", b"a,b".to_vec());
            assert_eq!(again.status(), StatusCode::NOT_MODIFIED);
            assert_eq!(again.headers()[header::ETAG], tag);
        }
        assert_eq!(tagged(&Known(vec![tag]), "text/csv", b"a,c".to_vec()).status(), StatusCode::OK);
    }
}
