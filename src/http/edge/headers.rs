//! Headers that every answer carries.

use super::identity::{REQUEST_ID, TRACEPARENT, Trace};
use super::known::Known;
use super::route::Class;
use crate::config::Config;
use axum::http::header::{
    CONTENT_SECURITY_POLICY, REFERRER_POLICY, STRICT_TRANSPORT_SECURITY, X_CONTENT_TYPE_OPTIONS,
};
use axum::http::{HeaderMap, HeaderName, HeaderValue};

const RESOURCE_POLICY: HeaderName = HeaderName::from_static("cross-origin-resource-policy");

/// Room for what most answers have besides.
const CAPACITY: usize = 16;

/// Data: nothing in it is to be run, loaded or framed.
const DATA: HeaderValue = HeaderValue::from_static("default-src 'none'; frame-ancestors 'none'");
/// The reference: scripts and styles of its own, pictures within them, requests to this service.
const PAGE: HeaderValue = HeaderValue::from_static(
    "default-src 'none'; script-src 'self'; style-src 'self' 'unsafe-inline'; img-src 'self' data:; \
     font-src 'self' data:; connect-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'",
);

/// They are put together once: to copy a map is cheaper than to fill one.
#[derive(Debug)]
pub(super) struct Headers {
    data: HeaderMap,
    page: HeaderMap,
}

impl Headers {
    pub(super) fn new(config: &Config) -> Self {
        Self { data: common(config, DATA), page: common(config, PAGE) }
    }

    /// Adds them to an answer, whose own headers stay as they are.
    pub(super) fn add(&self, known: &Known, headers: &mut HeaderMap) {
        let page = known.route.class == Class::Open && known.route.pattern.starts_with("/docs");
        let mut all = if page { self.page.clone() } else { self.data.clone() };
        all.insert(REQUEST_ID, known.id.clone());
        if let Some(trace) = known.trace.as_ref().and_then(Trace::header) {
            all.insert(TRACEPARENT, trace);
        }
        all.extend(std::mem::take(headers));
        *headers = all;
    }
}

fn common(config: &Config, policy: HeaderValue) -> HeaderMap {
    // Whoever lets other pages read answers lets them show pictures too.
    let resources = if config.access.cors_origin.is_empty() { "same-origin" } else { "cross-origin" };
    let mut headers = HeaderMap::with_capacity(CAPACITY);
    headers.insert(X_CONTENT_TYPE_OPTIONS, HeaderValue::from_static("nosniff"));
    headers.insert(REFERRER_POLICY, HeaderValue::from_static("no-referrer"));
    headers.insert(RESOURCE_POLICY, HeaderValue::from_static(resources));
    headers.insert(CONTENT_SECURITY_POLICY, policy);
    if config.access.tls_cert.is_some() {
        headers.insert(STRICT_TRANSPORT_SECURITY, HeaderValue::from_static("max-age=31536000"));
    }
    headers
}
