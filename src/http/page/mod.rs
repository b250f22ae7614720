//! The plotting page at `/`: its files are part of the program, packed when it is built.

use super::app::App;
use super::coding::{Coding, Wanted};
use super::edge::not_found;
use super::link::{Known, configured, lasting};
use super::problem::Problem;
use axum::Router;
use axum::body::Bytes;
use axum::extract::Path;
use axum::http::header::CONTENT_SECURITY_POLICY;
use axum::http::{HeaderMap, HeaderValue};
use axum::response::Response;
use axum::routing::get;
use flate2::read::GzDecoder;
use std::io::{self, Read as _};
use std::sync::Mutex;

/// A file of the page.
struct File {
    /// Behind the service's root, with a segment that follows from the content.
    path: &'static str,
    content_type: &'static str,
    /// gzip
    packed: &'static [u8],
}

include!(concat!(env!("OUT_DIR"), "/page.rs"));

/// The page itself, which names the files.
const HTML: &str = include_str!(concat!(env!("OUT_DIR"), "/index.html"));

/// Scripts and styles from files alone, requests to this service alone. The plot library makes an empty style element,
/// whose digest stands here, and fills it by script; and it sets style attributes.
const POLICY: HeaderValue = HeaderValue::from_static(
    "default-src 'none'; script-src 'self'; \
     style-src 'self' 'sha256-47DEQpj8HBSa+/TImW+5JCeuQeRkm5NMpJWZG3hSuFU='; style-src-attr 'unsafe-inline'; \
     img-src 'self' data: blob:; connect-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'",
);

/// The page and its files.
pub(super) fn routes() -> Router<App> {
    Router::new().route("/", get(page)).route("/assets/{*rest}", get(file))
}

/// The page may change with the program: it is asked for again each time, and not sent again if it is the same.
async fn page(known: Known) -> Response {
    let mut response = configured(&known, "text/html; charset=utf-8", HTML).await;
    response.headers_mut().insert(CONTENT_SECURITY_POLICY, POLICY);
    response
}

/// A file's name says what is in it: it keeps for ever.
async fn file(known: Known, headers: HeaderMap, Path(rest): Path<String>) -> Result<Response, Problem> {
    let file = FILES
        .iter()
        .find(|file| file.path.strip_prefix("assets/") == Some(rest.as_str()))
        .ok_or_else(not_found)?;
    if Wanted::takes(&headers, Coding::Gzip) {
        let body = Bytes::from_static(file.packed);
        return Ok(lasting(&known, file.path, file.content_type, Some(Coding::Gzip), body).await);
    }
    let body = file.expanded().map_err(|error| {
        tracing::error!(%error, path = file.path, "a file of the page cannot be unpacked");
        Problem::internal()
    })?;
    Ok(lasting(&known, file.path, file.content_type, None, body).await)
}

/// What was unpacked already: browsers all take gzip, so that this is mostly empty.
static EXPANDED: Mutex<Vec<(&str, Bytes)>> = Mutex::new(Vec::new());

impl File {
    /// As it is, for a client that does not take gzip; unpacked once.
    fn expanded(&self) -> io::Result<Bytes> {
        // Only this function locks it, and it does not panic.
        let mut expanded = EXPANDED.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
        if let Some((_, bytes)) = expanded.iter().find(|(path, _)| *path == self.path) {
            return Ok(bytes.clone());
        }
        let mut bytes = Vec::new();
        GzDecoder::new(self.packed).read_to_end(&mut bytes)?;
        let bytes = Bytes::from(bytes);
        expanded.push((self.path, bytes.clone()));
        Ok(bytes)
    }
}

#[cfg(test)]
mod tests {
    use super::{FILES, HTML};

    #[test]
    fn the_page_names_files_that_are_there() {
        let names: Vec<_> = HTML.split('"').filter(|text| text.starts_with("assets/")).collect();
        assert!(names.len() > 10, "{names:?}");
        for name in names {
            assert!(FILES.iter().any(|file| file.path == name), "{name}");
        }
        assert!(!HTML.contains("{assets}") && !HTML.contains("{plotly}") && !HTML.contains("{preloads}"));
    }

    #[test]
    fn files_unpack_to_what_they_were() {
        for file in FILES.iter().filter(|file| !file.path.ends_with("plotly.min.js")) {
            let name = file.path.rsplit('/').next().unwrap();
            let source =
                std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("src/http/page/assets").join(name);
            assert_eq!(file.expanded().unwrap(), std::fs::read(source).unwrap(), "{name}");
            assert!(std::ptr::eq(file.expanded().unwrap().as_ptr(), file.expanded().unwrap().as_ptr()));
        }
    }
}
