//! The choice of a content coding by `Accept-Encoding`, RFC 9110 section 12.5.3.

use super::Coding;
use axum::http::{HeaderMap, header};

/// How a client wants its answer.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Wanted {
    /// In this coding, if it is worth it.
    pub(crate) coding: Option<Coding>,
    /// Not as it is, however small.
    pub(crate) always: bool,
}

/// The weights that a header gives.
#[derive(Default)]
struct Weights {
    named: [Option<f32>; Coding::ALL.len()],
    identity: Option<f32>,
    rest: Option<f32>,
}

impl Wanted {
    /// The heaviest coding on offer; among equals the one that costs least. A client that names no coding gets none,
    /// and one that refuses all, the answer as it is included, gets the answer as it is.
    pub(crate) fn of(headers: &HeaderMap) -> Self {
        // Most programs send none: nothing to do for them.
        if !headers.contains_key(header::ACCEPT_ENCODING) {
            return Self::default();
        }
        Weights::of(headers).best()
    }

    /// Whether a client takes answers in this coding, be there others that it likes better.
    pub(crate) fn takes(headers: &HeaderMap, coding: Coding) -> bool {
        let weights = Weights::of(headers);
        weights.named[coding as usize].or(weights.rest).is_some_and(|weight| weight > 0.0)
    }
}

impl Weights {
    fn of(headers: &HeaderMap) -> Self {
        let mut weights = Self::default();
        for value in headers.get_all(header::ACCEPT_ENCODING) {
            value.to_str().unwrap_or_default().split(',').for_each(|item| weights.note(item));
        }
        weights
    }

    fn note(&mut self, item: &str) {
        let Some((name, weight)) = parse(item) else { return };
        let place = if name == "*" {
            &mut self.rest
        } else if name.eq_ignore_ascii_case("identity") {
            &mut self.identity
        } else if let Some(coding) = Coding::find(name) {
            &mut self.named[coding as usize]
        } else {
            return;
        };
        *place = Some(weight);
    }

    fn best(&self) -> Wanted {
        // What is not listed is still acceptable as it is, after everything that is listed.
        let identity = self.identity.unwrap_or(0.0);
        let mut best: Option<(Coding, f32)> = None;
        for coding in Coding::ALL {
            let weight = self.named[coding as usize].or(self.rest).unwrap_or(0.0);
            if weight > 0.0 && weight >= identity && best.is_none_or(|(_, most)| weight > most) {
                best = Some((coding, weight));
            }
        }
        let always = self.identity.or(self.rest) == Some(0.0);
        let coding = best.map(|(coding, _)| coding);
        Wanted { coding, always: always && coding.is_some() }
    }
}

/// Name and weight of one item.
fn parse(item: &str) -> Option<(&str, f32)> {
    let (name, parameters) = item.split_once(';').unwrap_or((item, ""));
    let mut weight = 1.0;
    for parameter in parameters.split(';') {
        if let Some((name, value)) = parameter.split_once('=')
            && name.trim().eq_ignore_ascii_case("q")
        {
            weight = value.trim().parse::<f32>().ok().filter(|q| (0.0..=1.0).contains(q))?;
        }
    }
    Some((name.trim(), weight))
}

#[cfg(test)]
mod tests {
    use super::{Coding, Wanted};
    use axum::http::{HeaderMap, HeaderValue, header};

    fn wanted(accept: &'static str) -> Wanted {
        let mut headers = HeaderMap::new();
        headers.insert(header::ACCEPT_ENCODING, HeaderValue::from_static(accept));
        Wanted::of(&headers)
    }

    #[test]
    fn the_heaviest_coding_is_taken_and_the_cheapest_among_equals() {
        use Coding::{Brotli, Gzip, Zstd};
        assert_eq!(Wanted::of(&HeaderMap::new()), Wanted::default());
        for (accept, coding) in [
            ("", None),
            ("gzip", Some(Gzip)),
            ("gzip, deflate, br", Some(Brotli)),
            ("gzip, deflate, br, zstd", Some(Zstd)),
            ("X-GZIP;q=0.5 , BR ; Q=0.4", Some(Gzip)),
            ("zstd;q=0.1, gzip;q=0.2", Some(Gzip)),
            ("zstd;q=0, *", Some(Brotli)),
            ("*", Some(Zstd)),
            ("*;q=0", None),
            ("identity", None),
            ("identity, gzip;q=0.9", None),
            ("identity;q=0.5, gzip;q=0.9", Some(Gzip)),
            ("identity, gzip", Some(Gzip)),
            ("compress, deflate", None),
            ("gzip;q=2", None),
            ("gzip;q=nan", None),
            (",;q=1,gzip;level=9", Some(Gzip)),
        ] {
            assert_eq!(wanted(accept).coding, coding, "{accept}");
        }
    }

    #[test]
    fn an_answer_as_it_is_can_be_refused_if_there_is_another() {
        for (accept, always) in [
            ("gzip", false),
            ("gzip, identity;q=0", true),
            ("gzip, *;q=0", true),
            ("gzip, identity;q=0.1, *;q=0", false),
            ("identity;q=0", false),
        ] {
            assert_eq!(wanted(accept).always, always, "{accept}");
        }
    }

    #[test]
    fn a_coding_is_taken_beside_others() {
        for (accept, takes) in [
            ("gzip, deflate, br, zstd", true),
            ("*", true),
            ("gzip;q=0.1, zstd", true),
            ("zstd", false),
            ("gzip;q=0, *", false),
            ("", false),
            ("*;q=0", false),
        ] {
            let mut headers = HeaderMap::new();
            headers.insert(header::ACCEPT_ENCODING, HeaderValue::from_static(accept));
            assert_eq!(Wanted::takes(&headers, Coding::Gzip), takes, "{accept}");
        }
        assert!(!Wanted::takes(&HeaderMap::new(), Coding::Gzip));
    }

    #[test]
    fn several_headers_are_one_list() {
        let mut headers = HeaderMap::new();
        headers.append(header::ACCEPT_ENCODING, HeaderValue::from_static("gzip"));
        headers.append(header::ACCEPT_ENCODING, HeaderValue::from_static("zstd"));
        assert_eq!(Wanted::of(&headers).coding, Some(Coding::Zstd));
    }
}
