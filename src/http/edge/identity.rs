//! Names of requests: `X-Request-Id`, and the trace that a request is part of.

use axum::http::{HeaderMap, HeaderName, HeaderValue};
use std::hash::{BuildHasher as _, Hasher as _, RandomState};
use std::num::NonZeroU64;
use std::sync::atomic::{AtomicU64, Ordering};

/// Names a request in the answer, in the log and in what a client reports.
pub(super) const REQUEST_ID: HeaderName = HeaderName::from_static("x-request-id");
/// The trace of a request, W3C Trace Context.
pub(super) const TRACEPARENT: HeaderName = HeaderName::from_static("traceparent");
/// Longest name that is taken from a client.
const LONGEST: usize = 128;

/// A source of names that no two requests share: a counter from a random start, scrambled so that names of two
/// processes do not look alike.
#[derive(Debug)]
pub(super) struct Names(AtomicU64);

impl Names {
    pub(super) fn new() -> Self {
        // The only source of randomness in the standard library.
        Self(AtomicU64::new(RandomState::new().build_hasher().finish()))
    }

    /// The next number of 64 bits, never 0; by SplitMix64, a bijection of the counter.
    pub(super) fn next(&self) -> NonZeroU64 {
        loop {
            let state = self.0.fetch_add(0x9e37_79b9_7f4a_7c15, Ordering::Relaxed);
            let mut mixed = (state ^ (state >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
            mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
            if let Some(name) = NonZeroU64::new(mixed ^ (mixed >> 31)) {
                return name;
            }
        }
    }

    /// The client's name for its request if it can stand in a log as it is, or a new one.
    pub(super) fn of_request(&self, headers: &HeaderMap) -> HeaderValue {
        match headers.get(&REQUEST_ID) {
            Some(given) if acceptable(given.as_bytes()) => given.clone(),
            _ => HeaderValue::from_bytes(&hex(self.next().get()))
                .unwrap_or(const { HeaderValue::from_static("0") }),
        }
    }
}

/// Visible ASCII without quotes and backslashes.
fn acceptable(name: &[u8]) -> bool {
    (1..=LONGEST).contains(&name.len())
        && name.iter().all(|byte| byte.is_ascii_graphic() && !matches!(byte, b'"' | b'\'' | b'\\'))
}

/// 16 digits.
pub(super) fn hex(number: u64) -> [u8; 16] {
    let mut digits = [0; 16];
    for (place, digit) in digits.iter_mut().enumerate() {
        let nibble = (number >> (60 - 4 * place)) & 15;
        *digit = b"0123456789abcdef"[usize::try_from(nibble).unwrap_or(0)];
    }
    digits
}

/// The trace that a request is part of, and the service's own span in it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Trace {
    /// 32 digits.
    pub(super) id: [u8; 32],
    /// The caller's span, 16 digits; none where the trace begins here.
    pub(super) parent: Option<[u8; 16]>,
    /// The service's own span.
    pub(super) span: NonZeroU64,
    /// Whether the caller records it.
    pub(super) sampled: bool,
}

impl Trace {
    /// The trace that the headers name. Of two or a malformed one none is believed, as the recommendation asks.
    pub(super) fn of_request(headers: &HeaderMap, names: &Names) -> Option<Self> {
        let mut given = headers.get_all(&TRACEPARENT).iter();
        let (first, second) = (given.next()?, given.next());
        if second.is_some() {
            return None;
        }
        let (id, parent, sampled) = parse(first.as_bytes())?;
        Some(Self { id, parent: Some(parent), span: names.next(), sampled })
    }

    /// A trace that begins here.
    pub(super) fn begin(names: &Names) -> Self {
        let mut id = [0; 32];
        id[..16].copy_from_slice(&hex(names.next().get()));
        id[16..].copy_from_slice(&hex(names.next().get()));
        Self { id, parent: None, span: names.next(), sampled: true }
    }

    /// The header that passes it on.
    pub(super) fn header(&self) -> Option<HeaderValue> {
        let mut text = *b"00-00000000000000000000000000000000-0000000000000000-00";
        text[3..35].copy_from_slice(&self.id);
        text[36..52].copy_from_slice(&hex(self.span.get()));
        text[54] = if self.sampled { b'1' } else { b'0' };
        HeaderValue::from_bytes(&text).ok()
    }
}

/// `version-trace-parent-flags`. A later version may have more after the flags.
fn parse(text: &[u8]) -> Option<([u8; 32], [u8; 16], bool)> {
    let (fields, more) = text.split_at_checked(55)?;
    let (version, id, parent, flags) = (&fields[..2], &fields[3..35], &fields[36..52], &fields[53..]);
    let dashes = [fields[2], fields[35], fields[52]] == *b"---";
    let digits = [version, id, parent, flags].into_iter().flatten().all(|digit| lower_hex(*digit));
    let known = match version {
        b"ff" => false,
        b"00" => more.is_empty(),
        _ => more.is_empty() || more[0] == b'-',
    };
    let nonzero = |field: &[u8]| field.iter().any(|digit| *digit != b'0');
    if !(dashes && digits && known && nonzero(id) && nonzero(parent)) {
        return None;
    }
    // Bit 0 is the lowest of the last digit, and the digits' codes are odd where the digits are.
    let last = flags[1];
    let sampled = if last.is_ascii_digit() { last & 1 == 1 } else { (last - b'a') & 1 == 1 };
    Some((id.try_into().ok()?, parent.try_into().ok()?, sampled))
}

fn lower_hex(byte: u8) -> bool {
    byte.is_ascii_digit() || (b'a'..=b'f').contains(&byte)
}

#[cfg(test)]
mod tests {
    use super::{Names, REQUEST_ID, TRACEPARENT, Trace, hex};
    use axum::http::{HeaderMap, HeaderValue};
    use std::collections::HashSet;

    const GIVEN: &str = "00-4bf92f3577b34da6a3ce929d0e0e4736-00f067aa0ba902b7-01";

    fn headers(name: &axum::http::HeaderName, values: &[&[u8]]) -> HeaderMap {
        let mut headers = HeaderMap::new();
        for value in values {
            headers.append(name, HeaderValue::from_bytes(value).unwrap());
        }
        headers
    }

    #[test]
    fn a_name_is_kept_if_it_can_stand_in_a_log() {
        let names = Names::new();
        let of = |name: &[u8]| names.of_request(&headers(&REQUEST_ID, &[name]));
        for good in [&b"a"[..], b"0123-abc_~!", &[b'x'; 128]] {
            assert_eq!(of(good), good);
        }
        for bad in [&b""[..], b"a b", b"a\"b", b"it's", b"a\\b", b"\xff", b"a\tb", &[b'x'; 129]] {
            let made = of(bad);
            assert_eq!((made.len(), made != bad), (16, true), "{bad:?}");
        }
    }

    #[test]
    fn names_differ() {
        let names = Names::new();
        let made: HashSet<_> = (0..10_000).map(|_| names.next()).collect();
        assert_eq!(made.len(), 10_000);
        assert_eq!(&hex(0x0123_4567_89ab_cdef), b"0123456789abcdef");
    }

    #[test]
    fn a_trace_is_passed_on_with_a_span_of_ones_own() {
        let names = Names::new();
        let trace = Trace::of_request(&headers(&TRACEPARENT, &[GIVEN.as_bytes()]), &names).unwrap();
        assert_eq!((&trace.id[..], trace.sampled), (&GIVEN.as_bytes()[3..35], true));
        assert_eq!(&trace.parent.unwrap(), b"00f067aa0ba902b7");
        let header = trace.header().unwrap();
        let passed = header.to_str().unwrap();
        assert_eq!((&passed[..36], &passed[52..]), (&GIVEN[..36], "-01"));
        assert_ne!(passed[36..52], GIVEN[36..52]);
    }

    #[test]
    fn flags_and_later_versions_are_read() {
        let names = Names::new();
        let of = |text: &str| Trace::of_request(&headers(&TRACEPARENT, &[text.as_bytes()]), &names);
        for (flags, sampled) in [("00", false), ("02", false), ("03", true), ("0a", false), ("fb", true)] {
            assert_eq!(of(&format!("{}{flags}", &GIVEN[..53])).unwrap().sampled, sampled, "{flags}");
        }
        assert!(of(&format!("cc{}-more", &GIVEN[2..])).is_some());
    }

    #[test]
    fn a_malformed_trace_is_ignored() {
        let names = Names::new();
        let zero_id = format!("00-{}{}", "0".repeat(32), &GIVEN[35..]);
        let zero_parent = format!("{}{}-01", &GIVEN[..36], "0".repeat(16));
        for bad in [
            "",
            "00",
            &GIVEN[..54],
            &GIVEN.to_uppercase(),
            &format!("ff{}", &GIVEN[2..]),
            &format!("{GIVEN}-more"),
            &format!("cc{}more", &GIVEN[2..]),
            &GIVEN.replace('-', "_"),
            &zero_id,
            &zero_parent,
        ] {
            let headers = headers(&TRACEPARENT, &[bad.as_bytes()]);
            assert_eq!(Trace::of_request(&headers, &names), None, "{bad}");
        }
        let twice = headers(&TRACEPARENT, &[GIVEN.as_bytes(), GIVEN.as_bytes()]);
        assert_eq!(Trace::of_request(&twice, &names), None);
    }
}
