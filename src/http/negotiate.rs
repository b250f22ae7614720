//! Content negotiation by the `Accept` header, RFC 9110 section 12.5.1.

use super::encode::rows::RowFormat;
use super::plot::Picture;
use super::problem::{Kind, Problem};
use axum::extract::FromRequestParts;
use axum::http::request::Parts;
use axum::http::{HeaderMap, header};

/// The request headers that choose among the representations of a tabular answer: the value of `Vary`.
pub(crate) const VARY: &str = "accept";

/// A representation that an answer can take.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Format {
    Json,
    Csv,
    Arrow,
    Npy,
    Picture(Picture),
}

impl Format {
    /// What every tabular answer is offered as, the preferred one first.
    pub(crate) const TABULAR: [Self; 4] = [Self::Json, Self::Csv, Self::Arrow, Self::Npy];

    /// What a diagram is offered as: the same, and drawn.
    pub(crate) const DRAWABLE: [Self; 6] = [
        Self::Json,
        Self::Csv,
        Self::Arrow,
        Self::Npy,
        Self::Picture(Picture::Svg),
        Self::Picture(Picture::Png),
    ];

    /// The media type without parameters.
    pub(crate) const fn media_type(self) -> &'static str {
        match self {
            Self::Json => "application/json",
            Self::Csv => "text/csv",
            Self::Arrow => "application/vnd.apache.arrow.stream",
            Self::Npy => "application/x-npy",
            Self::Picture(Picture::Svg) => "image/svg+xml",
            Self::Picture(Picture::Png) => "image/png",
        }
    }

    /// The value of `Content-Type`.
    pub(crate) const fn content_type(self) -> &'static str {
        match self {
            Self::Csv => "text/csv; charset=utf-8; header=present",
            other => other.media_type(),
        }
    }

    /// Other names of the media type: NumPy's format has no registered one.
    const fn aliases(self) -> &'static [&'static str] {
        match self {
            Self::Npy => &["application/npy", "application/x-numpy"],
            _ => &[],
        }
    }

    /// Which picture it is.
    pub(crate) const fn picture(self) -> Option<Picture> {
        if let Self::Picture(picture) = self { Some(picture) } else { None }
    }

    /// How its rows are written; answers as JSON and pictures are not made of rows.
    pub(crate) const fn row_format(self) -> Option<RowFormat> {
        match self {
            Self::Json | Self::Picture(_) => None,
            Self::Csv => Some(RowFormat::Csv),
            Self::Arrow => Some(RowFormat::Arrow),
            Self::Npy => Some(RowFormat::Npy),
        }
    }

    /// Which format a media type names, in lower case and without parameters.
    pub(crate) fn named(essence: &str) -> Option<Self> {
        Self::TABULAR.into_iter().find(|format| format.names().any(|name| name == essence))
    }

    fn names(self) -> impl Iterator<Item = &'static str> {
        std::iter::once(self.media_type()).chain(self.aliases().iter().copied())
    }
}

/// Lets a request pass that accepts JSON.
pub(crate) struct JsonOnly;

impl<S: Sync> FromRequestParts<S> for JsonOnly {
    type Rejection = Problem;

    async fn from_request_parts(parts: &mut Parts, _: &S) -> Result<Self, Problem> {
        negotiate(&parts.headers, &[Format::Json]).map(|_| Self)
    }
}

/// What a table is answered as.
pub(crate) struct Tabular(pub(crate) Format);

impl<S: Sync> FromRequestParts<S> for Tabular {
    type Rejection = Problem;

    async fn from_request_parts(parts: &mut Parts, _: &S) -> Result<Self, Problem> {
        negotiate(&parts.headers, &Format::TABULAR).map(Self)
    }
}

/// What a diagram is answered as.
pub(crate) struct Drawable(pub(crate) Format);

impl<S: Sync> FromRequestParts<S> for Drawable {
    type Rejection = Problem;

    async fn from_request_parts(parts: &mut Parts, _: &S) -> Result<Self, Problem> {
        negotiate(&parts.headers, &Format::DRAWABLE).map(Self)
    }
}

/// The best of `offered` (in order of preference among equals) for this `Accept`.
pub(crate) fn negotiate(headers: &HeaderMap, offered: &[Format]) -> Result<Format, Problem> {
    let ranges: Vec<Range> = headers
        .get_all(header::ACCEPT)
        .iter()
        .filter_map(|value| value.to_str().ok())
        .flat_map(|value| value.split(','))
        .filter_map(Range::parse)
        .collect();
    if ranges.is_empty() && !headers.contains_key(header::ACCEPT) {
        return offered.first().copied().ok_or_else(|| refuse(offered));
    }
    let mut best: Option<(Format, f32)> = None;
    for &format in offered {
        let weight = weight(&ranges, format);
        if weight > best.map_or(0.0, |(_, weight)| weight) {
            best = Some((format, weight));
        }
    }
    best.map(|(format, _)| format).ok_or_else(|| refuse(offered))
}

/// The weight of the most specific range that matches.
fn weight(ranges: &[Range], format: Format) -> f32 {
    ranges
        .iter()
        .filter(|range| range.matches(format))
        .max_by_key(|range| range.specificity())
        .map_or(0.0, |range| range.weight)
}

fn refuse(offered: &[Format]) -> Problem {
    let list = offered.iter().map(|format| format.media_type()).collect::<Vec<_>>().join(", ");
    Problem::new(Kind::NotAcceptable, format!("This resource is offered as: {list}"))
}

/// One media range of `Accept`.
struct Range {
    kind: String,
    subtype: String,
    weight: f32,
}

impl Range {
    fn parse(text: &str) -> Option<Self> {
        let mut parts = text.split(';');
        let (kind, subtype) = parts.next()?.trim().split_once('/')?;
        let mut weight = 1.0;
        for parameter in parts {
            if let Some((name, value)) = parameter.split_once('=')
                && name.trim().eq_ignore_ascii_case("q")
            {
                weight = value.trim().parse::<f32>().ok().filter(|q| (0.0..=1.0).contains(q))?;
            }
        }
        Some(Self { kind: kind.to_ascii_lowercase(), subtype: subtype.to_ascii_lowercase(), weight })
    }

    fn matches(&self, format: Format) -> bool {
        format.names().any(|name| {
            let (kind, subtype) = name.split_once('/').unwrap_or_default();
            (self.kind == "*" && self.subtype == "*")
                || (self.kind == kind && (self.subtype == "*" || self.subtype == subtype))
        })
    }

    fn specificity(&self) -> u8 {
        u8::from(self.kind != "*") + u8::from(self.subtype != "*")
    }
}

#[cfg(test)]
mod tests {
    use super::{Format, negotiate};
    use axum::http::{HeaderMap, HeaderValue, header};

    fn choose(accept: &'static str) -> Option<Format> {
        let mut headers = HeaderMap::new();
        headers.insert(header::ACCEPT, HeaderValue::from_static(accept));
        negotiate(&headers, &[Format::Json, Format::Csv]).ok()
    }

    #[test]
    fn the_heaviest_range_wins_and_the_most_specific_one_speaks() {
        assert_eq!(choose("*/*"), Some(Format::Json));
        assert_eq!(choose("text/csv"), Some(Format::Csv));
        assert_eq!(choose("TEXT/*, application/json;q=0.5"), Some(Format::Csv));
        assert_eq!(choose("application/json;q=0, */*"), Some(Format::Csv));
        assert_eq!(choose("text/csv;q=0.2, application/json;q=0.9"), Some(Format::Json));
        assert_eq!(choose("image/png"), None);
        assert_eq!(choose("nonsense"), None);
        assert_eq!(choose("*/*;q=0"), None);
        assert_eq!(negotiate(&HeaderMap::new(), &[Format::Csv]).ok(), Some(Format::Csv));
    }

    #[test]
    fn a_refusal_lists_what_is_offered() {
        let mut headers = HeaderMap::new();
        headers.insert(header::ACCEPT, HeaderValue::from_static("image/png"));
        let problem = negotiate(&headers, &[Format::Json, Format::Csv]).unwrap_err();
        assert!(problem.detail.contains("application/json, text/csv"), "{}", problem.detail);
    }
}
