//! Heads that are not read: too long, or not HTTP. The library below answers them with a bare status; here they get
//! the problem document that every other error has.

use crate::http::app::Limits;
use crate::http::problem::{Kind, PROBLEM_JSON, Problem};
use axum::http::{HeaderMap, Method, Uri};
use axum::response::Response;

/// What RFC 9113 section 6.5.2 counts for a field beyond its letters.
const FIELD: usize = 32;
/// A bare answer is not longer.
const BARE: usize = 256;

/// The document for a bare answer of the library, as HTTP/1 sends it; none for any other bytes.
pub(super) fn of_http1(sent: &[u8], limits: &Limits) -> Option<Vec<u8>> {
    let status = sent.strip_prefix(b"HTTP/1.1 4")?.get(..2)?;
    let head = sent.get(..sent.len().min(BARE))?;
    let bare = head.windows(21).any(|line| line.eq_ignore_ascii_case(b"\r\ncontent-length: 0\r\n"));
    let problem = match status {
        b"00" if bare => Problem::new(Kind::BadRequest, "the head of the request is not that of HTTP/1.1"),
        b"14" | b"31" if bare => head_too_large(limits),
        _ => return None,
    };
    let (status, body) = (problem.kind.status(), problem.document(""));
    let head = format!(
        "HTTP/1.1 {status}\r\ncontent-type: {PROBLEM_JSON}\r\ncontent-length: {length}\r\n\
         cache-control: no-store\r\nconnection: close\r\n\r\n",
        length = body.len()
    );
    Some([head.into_bytes(), body].concat())
}

/// The same for a head of HTTP/2, which the library reads up to twice the limit.
pub(super) fn of_http2(method: &Method, uri: &Uri, headers: &HeaderMap, limits: &Limits) -> Option<Response> {
    let fields = headers.iter().map(|(name, value)| name.as_str().len() + value.len() + FIELD);
    let target = uri.path_and_query().map_or(0, |path| path.as_str().len());
    let length = fields.sum::<usize>() + method.as_str().len() + target;
    (length as u64 > limits.head_bytes).then(|| head_too_large(limits).render(uri.path()))
}

fn head_too_large(limits: &Limits) -> Problem {
    let limit = limits.head_bytes;
    let detail = format!("the limit of a request's head, its target and all its fields, is {limit} bytes");
    Problem::new(Kind::HeadTooLarge, detail)
}
