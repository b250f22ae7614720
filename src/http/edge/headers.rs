//! Headers that every answer carries.

use super::identity::{REQUEST_ID, TRACEPARENT};
use super::known::Known;
use super::route::Class;
use crate::config::Config;
use axum::http::header::{
    CONTENT_SECURITY_POLICY, REFERRER_POLICY, STRICT_TRANSPORT_SECURITY, X_CONTENT_TYPE_OPTIONS,
};
use axum::http::{HeaderMap, HeaderName, HeaderValue};

const RESOURCE_POLICY: HeaderName = HeaderName::from_static("cross-origin-resource-policy");

/// Data: nothing in it is to be run, loaded or framed.
const DATA: HeaderValue = HeaderValue::from_static("default-src 'none'; frame-ancestors 'none'");
/// The reference: scripts and styles of its own, pictures within them, requests to this service.
const PAGE: HeaderValue = HeaderValue::from_static(
    "default-src 'none'; script-src 'self'; style-src 'self' 'unsafe-inline'; img-src 'self' data:; \
     font-src 'self' data:; connect-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'",
);

/// What of them the configuration decides.
#[derive(Debug)]
pub(super) struct Headers {
    resource_policy: HeaderValue,
    transport_security: Option<HeaderValue>,
}

impl Headers {
    pub(super) fn new(config: &Config) -> Self {
        // Whoever lets other pages read answers lets them show pictures too.
        let policy = if config.access.cors_origin.is_empty() { "same-origin" } else { "cross-origin" };
        let secure = config.access.tls_cert.is_some();
        Self {
            resource_policy: HeaderValue::from_static(policy),
            transport_security: secure.then(|| HeaderValue::from_static("max-age=31536000")),
        }
    }

    /// Adds them to an answer.
    pub(super) fn add(&self, known: &Known, headers: &mut HeaderMap) {
        headers.reserve(8);
        headers.insert(REQUEST_ID, known.id.clone());
        if let Some(trace) = known.trace.as_ref().and_then(super::identity::Trace::header) {
            headers.insert(TRACEPARENT, trace);
        }
        headers.insert(X_CONTENT_TYPE_OPTIONS, const { HeaderValue::from_static("nosniff") });
        headers.insert(REFERRER_POLICY, const { HeaderValue::from_static("no-referrer") });
        headers.insert(RESOURCE_POLICY, self.resource_policy.clone());
        if !headers.contains_key(CONTENT_SECURITY_POLICY) {
            let page = known.route.class == Class::Open && known.route.pattern.starts_with("/docs");
            headers.insert(CONTENT_SECURITY_POLICY, if page { PAGE } else { DATA });
        }
        if let Some(policy) = &self.transport_security {
            headers.insert(STRICT_TRANSPORT_SECURITY, policy.clone());
        }
    }
}
