//! What the values of flags may be; every refusal says what is accepted.

use std::fmt::Display;
use std::num::NonZeroU32;
use std::str::FromStr;
use std::time::Duration;

/// A whole number between two.
pub(super) fn whole<N: FromStr + PartialOrd + Display + Copy>(
    text: &str,
    least: N,
    most: N,
) -> Result<N, String> {
    text.parse()
        .ok()
        .filter(|number| (&least..=&most).contains(&number))
        .ok_or_else(|| format!("expected a whole number from {least} to {most}"))
}

/// A number of bytes between 1 KiB and 4 GiB.
pub(super) fn size(text: &str) -> Result<u64, String> {
    whole(text, 1 << 10, 1 << 32)
}

/// A number of things, at least one.
pub(super) fn count(text: &str) -> Result<usize, String> {
    whole(text, 1, 1 << 20)
}

/// A number of things, at least one, that is part of a rate.
pub(super) fn nonzero(text: &str) -> Result<NonZeroU32, String> {
    whole(text, 1, 1_000_000).and_then(|number: u32| NonZeroU32::new(number).ok_or_else(String::new))
}

/// A positive number of seconds up to a day.
pub(super) fn seconds(text: &str) -> Result<Duration, String> {
    between(text, 0.001)
}

/// A number of seconds up to a day, 0 among them.
pub(super) fn seconds_or_none(text: &str) -> Result<Duration, String> {
    between(text, 0.0)
}

fn between(text: &str, least: f64) -> Result<Duration, String> {
    text.parse::<f64>()
        .ok()
        .filter(|seconds| (least..=86_400.0).contains(seconds))
        .map(Duration::from_secs_f64)
        .ok_or_else(|| format!("expected a number from {least} to 86400"))
}

/// An origin as browsers send it, or `*` for any.
pub(super) fn origin(text: &str) -> Result<String, String> {
    let host = text.strip_prefix("https://").or_else(|| text.strip_prefix("http://"));
    let plain = |host: &str| {
        !host.is_empty()
            && host
                .bytes()
                .all(|byte| byte.is_ascii_lowercase() || byte.is_ascii_digit() || b".-:[]".contains(&byte))
            && host.parse::<axum::http::uri::Authority>().is_ok()
    };
    if text == "*" || host.is_some_and(plain) {
        return Ok(text.to_owned());
    }
    Err("expected * or an origin in lower case without a path, like https://example.org or http://localhost:3000"
        .to_owned())
}

/// Where a collector of spans listens.
pub(super) fn collector(text: &str) -> Result<String, String> {
    let expected = || "expected http://host:port, with a path before /v1/traces if there is one".to_owned();
    let address = text.trim_end_matches('/');
    let uri: axum::http::Uri = address.parse().map_err(|_| expected())?;
    let plain = uri.scheme_str() == Some("http") && uri.host().is_some_and(|host| !host.is_empty());
    if plain && uri.query().is_none() { Ok(address.to_owned()) } else { Err(expected()) }
}

/// Where a service is reached.
pub(super) fn base_url(text: &str) -> Result<axum::http::Uri, String> {
    let uri: Option<axum::http::Uri> = text.parse().ok();
    uri.filter(|uri| {
        let known = matches!(uri.scheme_str(), Some("http" | "https"));
        let host =
            uri.authority().is_some_and(|host| !host.host().is_empty() && !host.as_str().contains('@'));
        known && host && uri.query().is_none()
    })
    .ok_or_else(|| {
        "expected http://host:port or https://host:port, with a path before /readyz if there is one"
            .to_owned()
    })
}
