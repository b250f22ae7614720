//! Answers that are pure functions of their link: entity tags, how long they keep, and paths that name the version.

use super::coding::{Coding, Wanted};
use super::problem::{Kind, Problem};
use axum::body::Bytes;
use axum::extract::{FromRequestParts, Request};
use axum::http::request::Parts;
use axum::http::uri::PathAndQuery;
use axum::http::{HeaderValue, StatusCode, Uri, header};
use axum::response::{IntoResponse as _, Response};
use std::convert::Infallible;
use std::fmt::Write as _;
use std::hash::{DefaultHasher, Hash, Hasher as _};

/// The version that answers.
const VERSION: &str = env!("CARGO_PKG_VERSION");
/// What an answer depends on besides its link.
const VARY: HeaderValue = HeaderValue::from_static("accept, accept-encoding");

/// What a client that asked before already has, and what it would be sent.
pub(crate) struct Known {
    tags: Vec<HeaderValue>,
    coding: Option<Coding>,
    /// The path names the version: this answer never changes.
    is_versioned: bool,
    /// Only who has a key may see the answer: it is for no shared cache.
    is_private: bool,
}

/// Marks a request whose path named the version.
#[derive(Clone, Copy)]
struct Versioned;

impl<S: Sync> FromRequestParts<S> for Known {
    type Rejection = Infallible;

    async fn from_request_parts(parts: &mut Parts, _: &S) -> Result<Self, Infallible> {
        Ok(Self {
            tags: parts.headers.get_all(header::IF_NONE_MATCH).iter().cloned().collect(),
            coding: Wanted::of(&parts.headers).coding,
            is_versioned: parts.extensions.get::<Versioned>().is_some(),
            is_private: parts.headers.contains_key(header::AUTHORIZATION),
        })
    }
}

/// How long an answer is the same.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Lasts {
    /// As long as the version.
    Version,
    /// As long as the service runs as it was started.
    Run,
}

impl Known {
    /// Whether `If-None-Match` names this tag, compared weakly: `W/` does not matter.
    fn has(&self, tag: &str) -> bool {
        self.tags.iter().filter_map(|value| value.to_str().ok()).flat_map(|value| value.split(',')).any(
            |known| {
                let known = known.trim();
                known == "*" || known.strip_prefix("W/").unwrap_or(known) == tag
            },
        )
    }

    /// A strong tag: what is hashed tells answers apart, the suffix the forms in which one is sent. An answer that
    /// turns out too small to be packed has the suffix all the same: the tag is made before the answer.
    fn tag(&self, key: &impl Hash) -> String {
        let key = self::key(&(VERSION, key));
        let mut tag = String::with_capacity(24);
        // Writing to a string cannot fail.
        let _ = write!(tag, "\"{key:016x}");
        if let Some(coding) = self.coding {
            tag.push('-');
            tag.push_str(coding.name());
        }
        tag.push('"');
        tag
    }

    /// A new version may answer a link with other last digits: an hour, then ask again, unless the link says which.
    fn cache_control(&self, lasts: Lasts) -> HeaderValue {
        HeaderValue::from_static(match (lasts, self.is_versioned, self.is_private) {
            (Lasts::Run, _, false) => "public, no-cache",
            (Lasts::Run, _, true) => "private, no-cache",
            (Lasts::Version, true, false) => "public, max-age=31536000, immutable",
            (Lasts::Version, true, true) => "private, max-age=31536000, immutable",
            (Lasts::Version, false, false) => "public, max-age=3600",
            (Lasts::Version, false, true) => "private, max-age=3600",
        })
    }

    async fn answer(
        &self,
        tag: &str,
        lasts: Lasts,
        answer: impl Future<Output = Result<Response, Problem>>,
    ) -> Result<Response, Problem> {
        let mut response =
            if self.has(tag) { StatusCode::NOT_MODIFIED.into_response() } else { answer.await? };
        let headers = response.headers_mut();
        headers.insert(header::CACHE_CONTROL, self.cache_control(lasts));
        headers.insert(header::VARY, VARY);
        if let Ok(tag) = HeaderValue::from_str(tag) {
            headers.insert(header::ETAG, tag);
        }
        Ok(response)
    }
}

/// A key of so much: the same on every replica and after a restart, since nothing random goes into it.
pub(crate) fn key(of: &impl Hash) -> u64 {
    let mut hasher = DefaultHasher::new();
    of.hash(&mut hasher);
    hasher.finish()
}

/// An answer whose entity tag follows from its link: it is not made where the client has it already. The key is all
/// that the answer depends on besides the version: the resource, the format, and the request as it was understood, so
/// that links that mean the same have the same tag.
pub(crate) async fn linked(
    known: &Known,
    key: &impl Hash,
    answer: impl Future<Output = Result<Response, Problem>>,
) -> Result<Response, Problem> {
    known.answer(&known.tag(key), Lasts::Version, answer).await
}

/// A document that is the same for everybody and is there already.
pub(crate) async fn document(known: &Known, content_type: &'static str, body: &'static str) -> Response {
    sent(known, Lasts::Version, content_type, body).await
}

/// A document that depends on how the service was started.
pub(crate) async fn configured<B>(known: &Known, content_type: &'static str, body: B) -> Response
where
    B: AsRef<[u8]> + axum::response::IntoResponse,
{
    sent(known, Lasts::Run, content_type, body).await
}

/// A file whose path follows from its content, in this coding already or in none: it keeps for ever.
pub(crate) async fn lasting(
    known: &Known,
    path: &str,
    content_type: &'static str,
    coding: Option<Coding>,
    body: Bytes,
) -> Response {
    let known = Known {
        tags: known.tags.clone(),
        coding: coding.or(known.coding),
        is_versioned: true,
        is_private: known.is_private,
    };
    let answer = async {
        let mut response = ([(header::CONTENT_TYPE, content_type)], body).into_response();
        if let Some(coding) = coding {
            let name = HeaderValue::from_static(coding.name());
            response.headers_mut().insert(header::CONTENT_ENCODING, name);
        }
        Ok(response)
    };
    let answer = known.answer(&known.tag(&path), Lasts::Version, answer).await;
    answer.unwrap_or_else(axum::response::IntoResponse::into_response)
}

async fn sent<B>(known: &Known, lasts: Lasts, content_type: &'static str, body: B) -> Response
where
    B: AsRef<[u8]> + axum::response::IntoResponse,
{
    let tag = known.tag(&body.as_ref());
    let answer = async { Ok(([(header::CONTENT_TYPE, content_type)], body).into_response()) };
    known.answer(&tag, lasts, answer).await.unwrap_or_else(axum::response::IntoResponse::into_response)
}

/// Takes the version off a path that begins with it: every resource is also there under the version that answers,
/// and not under others.
pub(crate) fn take_version(request: &mut Request) -> Result<(), Problem> {
    let path = request.uri().path();
    // Most paths begin with a letter.
    if !path.as_bytes().get(1).is_some_and(u8::is_ascii_digit) {
        return Ok(());
    }
    let segment = path[1..].split('/').next().unwrap_or_default();
    if segment.split('.').count() != 3 || path.len() == segment.len() + 1 {
        return Ok(());
    }
    if segment != VERSION {
        let detail = format!("Version {VERSION} is served, under /{VERSION}/ and without a version.");
        return Err(Problem::new(Kind::NotFound, detail));
    }
    let rest = request.uri().path_and_query().map_or("/", PathAndQuery::as_str);
    if let Ok(uri) = rest[segment.len() + 1..].parse::<Uri>() {
        *request.uri_mut() = uri;
        request.extensions_mut().insert(Versioned);
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::{Known, Lasts, VERSION, document, take_version};
    use crate::http::coding::Coding;
    use axum::body::Body;
    use axum::extract::Request;
    use axum::http::{HeaderValue, StatusCode, header};

    fn known(tags: &[&str]) -> Known {
        let tags = tags.iter().map(|tag| HeaderValue::from_str(tag).unwrap()).collect();
        Known { tags, coding: None, is_versioned: false, is_private: false }
    }

    #[tokio::test]
    async fn what_is_known_is_not_sent_again() {
        let first = document(&known(&[]), "text/csv", "a,b").await;
        assert_eq!(first.status(), StatusCode::OK);
        let tag = first.headers()[header::ETAG].to_str().unwrap().to_owned();
        for tags in
            [&[tag.as_str()][..], &["*"], &[&format!("W/{tag}")], &["\"0\"", &format!("\"1\", {tag}")]]
        {
            let again = document(&known(tags), "text/csv", "a,b").await;
            assert_eq!(again.status(), StatusCode::NOT_MODIFIED, "{tags:?}");
            for name in [header::ETAG, header::VARY, header::CACHE_CONTROL] {
                assert_eq!(again.headers()[&name], first.headers()[&name]);
            }
        }
        for tags in [&["\"0\""][..], &[""], &[tag.trim_matches('"')]] {
            assert_eq!(document(&known(tags), "text/csv", "a,b").await.status(), StatusCode::OK, "{tags:?}");
        }
        assert_eq!(document(&known(&[&tag]), "text/csv", "a,c").await.status(), StatusCode::OK);
    }

    #[test]
    fn each_coding_has_its_own_tag() {
        let mut tags: Vec<_> = Coding::ALL
            .into_iter()
            .map(Some)
            .chain([None])
            .map(|coding| Known { coding, ..known(&[]) }.tag(&1))
            .collect();
        assert!(tags.iter().all(|tag| tag.starts_with('"') && tag.ends_with('"')), "{tags:?}");
        tags.dedup();
        assert_eq!(tags.len(), 4);
    }

    #[test]
    fn shared_caches_keep_only_what_anybody_may_see() {
        for is_versioned in [false, true] {
            for lasts in [Lasts::Version, Lasts::Run] {
                let private = Known { is_versioned, is_private: true, ..known(&[]) }.cache_control(lasts);
                assert!(private.to_str().unwrap().starts_with("private, "));
                let public = Known { is_versioned, ..known(&[]) }.cache_control(lasts);
                let text = public.to_str().unwrap();
                assert!(text.starts_with("public, "));
                assert_eq!(text.contains("immutable"), is_versioned && lasts == Lasts::Version);
            }
        }
    }

    #[test]
    fn a_path_may_begin_with_the_version() {
        let taken = |path: &str| {
            let mut request = Request::builder().uri(path).body(Body::empty()).unwrap();
            take_version(&mut request).map(|()| request.uri().to_string()).map_err(|problem| problem.detail)
        };
        for path in ["/v1/figures", "/", "/1/2", "/1.2.3", "/0.1/x", "/v1/figures/11a?x=1"] {
            assert_eq!(taken(path).unwrap(), path);
        }
        assert_eq!(
            taken(&format!("/{VERSION}/v1/figures/11a?log10=true")).unwrap(),
            "/v1/figures/11a?log10=true"
        );
        assert_eq!(taken(&format!("/{VERSION}/")).unwrap(), "/");
        assert!(taken("/999.0.0/v1/figures").unwrap_err().contains(VERSION));
    }
}
