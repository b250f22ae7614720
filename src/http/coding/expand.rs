//! Request bodies that arrive in a content coding, expanded up to a limit.

use super::Coding;
use crate::http::app::App;
use crate::http::compute::admission::Turn;
use crate::http::compute::job::Job;
use crate::http::compute::too_slow;
use crate::http::problem::{Kind, Problem};
use crate::http::edge::Deadline;
use axum::body::Bytes;
use axum::http::{HeaderMap, header};
use brotli::reader::StandardAlloc;
use brotli::{BrotliDecompressStream, BrotliResult, BrotliState};
use bytes::Buf as _;
use bytes::buf::Reader;
use flate2::bufread::MultiGzDecoder;
use std::io::{self, Read};
use tokio::time::timeout_at;
use zstd::stream::read::Decoder as ZstdDecoder;

/// Bytes that are expanded in one piece of work: less than a millisecond.
const PIECE: usize = 256 << 10;
/// Bytes that are expanded where they are: as many as are read of a body before it has to wait for its turn. A bomb
/// gets no further.
const INLINE: usize = 64 << 10;
/// 8 MiB, the largest window of zstd over HTTP (RFC 9659): a frame may claim 2 GiB.
const ZSTD_LOG_WINDOW: u32 = 23;

/// The coding of a body; refuses those that are not offered, and more than one.
pub(crate) fn coding(headers: &HeaderMap) -> Result<Option<Coding>, Problem> {
    let mut found = None;
    for value in headers.get_all(header::CONTENT_ENCODING) {
        for name in value.to_str().unwrap_or("?").split(',').map(str::trim) {
            if name.is_empty() || name.eq_ignore_ascii_case("identity") {
                continue;
            }
            let Some(coding) = Coding::find(name) else {
                return Err(unsupported(&format!("a body in the coding \"{name}\"")));
            };
            if found.replace(coding).is_some() {
                return Err(unsupported("a body in several codings"));
            }
        }
    }
    Ok(found)
}

fn unsupported(what: &str) -> Problem {
    let detail = format!("{what} is not read; accepted: one of {}, or none", Coding::LIST);
    Problem::new(Kind::UnsupportedCoding, detail)
}

/// A body expanded. What is small is expanded at once; the rest in turn, on the pool for large work, in pieces, and
/// no further when the client leaves.
pub(crate) async fn body(
    app: &App,
    deadline: Deadline,
    turn: &mut Option<Turn>,
    coding: Coding,
    packed: Bytes,
) -> Result<Bytes, Problem> {
    let limit = app.limits().expanded_body_bytes;
    let mut expander = Expander::new(coding, packed, limit)?;
    if expander.expand(INLINE)? {
        return Ok(expander.out.into());
    }
    if turn.is_none() {
        *turn = Some(app.admission().turn().await?);
    }
    timeout_at(deadline.at, in_pieces(app, expander)).await.unwrap_or_else(|_| Err(too_slow(deadline)))
}

async fn in_pieces(app: &App, mut expander: Expander) -> Result<Bytes, Problem> {
    let (job, _abandon) = Job::new(app.limits().cpu_time);
    loop {
        let piece = move || expander.expand(PIECE).map(|is_whole| (is_whole, expander));
        let (is_whole, after) = app
            .pool()
            .run(&job, piece)
            .await
            .map_err(|_| if job.is_exhausted() { cpu_time(app) } else { Problem::internal() })??;
        if is_whole {
            return Ok(after.out.into());
        }
        expander = after;
    }
}

fn cpu_time(app: &App) -> Problem {
    let limit = app.limits().cpu_time.as_secs_f64();
    let detail =
        format!("expanding the body took more than {limit} s, the limit of a request's processor time");
    Problem::new(Kind::CpuTime, detail)
}

/// A body that is being expanded.
struct Expander {
    coding: Coding,
    decoder: Decoder,
    out: Vec<u8>,
    limit: usize,
}

enum Decoder {
    Zstd(ZstdDecoder<'static, Reader<Bytes>>),
    Brotli(Box<Brotli>),
    Gzip(MultiGzDecoder<Reader<Bytes>>),
}

impl Expander {
    fn new(coding: Coding, packed: Bytes, limit: u64) -> Result<Self, Problem> {
        let decoder = match coding {
            Coding::Zstd => zstd(packed).map(Decoder::Zstd).map_err(|error| Problem::unwritten(&error))?,
            Coding::Brotli => Decoder::Brotli(Box::new(Brotli::new(packed))),
            Coding::Gzip => Decoder::Gzip(MultiGzDecoder::new(packed.reader())),
        };
        let limit = usize::try_from(limit).unwrap_or(usize::MAX);
        Ok(Self { coding, decoder, out: Vec::new(), limit })
    }

    /// Expands so many bytes more; true once that was all.
    fn expand(&mut self, bytes: usize) -> Result<bool, Problem> {
        let Self { coding, decoder, out, limit } = self;
        let end = out.len().saturating_add(bytes);
        // One byte past the limit tells a body that ends there from one that does not.
        let most = limit.saturating_add(1);
        while out.len() < end {
            let filled = out.len();
            if filled == out.capacity() {
                // Twice as much, but never more than may be: this is what a bomb costs.
                out.reserve_exact(filled.max(8 << 10).min(most - filled));
            }
            out.resize(out.capacity().min(end).min(most), 0);
            let free = &mut out[filled..];
            let read = match decoder {
                Decoder::Zstd(decoder) => decoder.read(free),
                Decoder::Brotli(decoder) => decoder.read(free),
                Decoder::Gzip(decoder) => decoder.read(free),
            };
            let read = read.map_err(|error| corrupt(*coding, &error))?;
            out.truncate(filled + read);
            if out.len() > *limit {
                let detail = format!("the limit of a body, expanded, is {limit} bytes");
                return Err(Problem::new(Kind::ContentTooLarge, detail));
            }
            if read == 0 {
                return Ok(true);
            }
        }
        Ok(false)
    }
}

fn corrupt(coding: Coding, error: &io::Error) -> Problem {
    tracing::debug!(%error, "a body could not be expanded");
    let detail = format!("the body is not whole and valid {}, as its Content-Encoding says", coding.name());
    Problem::new(Kind::BodyUnreadable, detail)
}

fn zstd(packed: Bytes) -> io::Result<ZstdDecoder<'static, Reader<Bytes>>> {
    let mut decoder = ZstdDecoder::with_buffer(packed.reader())?;
    decoder.window_log_max(ZSTD_LOG_WINDOW)?;
    Ok(decoder)
}

/// Brotli as RFC 7932 has it: the library's own reader also takes streams with windows of 1 GiB, and its end for the
/// end of the body.
struct Brotli {
    state: BrotliState<StandardAlloc, StandardAlloc, StandardAlloc>,
    packed: Bytes,
    is_whole: bool,
}

impl Brotli {
    fn new(packed: Bytes) -> Self {
        let alloc = StandardAlloc::default;
        Self { state: BrotliState::new_strict(alloc(), alloc(), alloc()), packed, is_whole: false }
    }

    fn read(&mut self, free: &mut [u8]) -> io::Result<usize> {
        let (mut packed, mut taken) = (self.packed.len(), 0);
        let (mut room, mut written, mut total) = (free.len(), 0, 0);
        if self.is_whole {
            return if packed == 0 { Ok(0) } else { Err(io::ErrorKind::InvalidData.into()) };
        }
        let result = BrotliDecompressStream(
            &mut packed,
            &mut taken,
            &self.packed,
            &mut room,
            &mut written,
            free,
            &mut total,
            &mut self.state,
        );
        self.packed.advance(taken);
        match result {
            BrotliResult::ResultSuccess => {
                self.is_whole = true;
                if written == 0 { self.read(free) } else { Ok(written) }
            }
            BrotliResult::NeedsMoreOutput => Ok(written),
            BrotliResult::NeedsMoreInput if written > 0 => Ok(written),
            BrotliResult::NeedsMoreInput => Err(io::ErrorKind::UnexpectedEof.into()),
            BrotliResult::ResultFailure => Err(io::ErrorKind::InvalidData.into()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::pack::whole;
    use super::{Coding, Expander, PIECE, ZSTD_LOG_WINDOW, coding};
    use crate::http::problem::{Kind, Problem};
    use axum::http::{HeaderMap, HeaderValue, header};
    use std::io::Write as _;

    /// All of a body, as the service expands it.
    fn expand(coding: Coding, packed: &[u8], limit: u64) -> Result<Vec<u8>, Problem> {
        let mut expander = Expander::new(coding, packed.to_vec().into(), limit)?;
        while !expander.expand(PIECE)? {}
        Ok(expander.out)
    }

    fn kind(result: Result<Vec<u8>, Problem>) -> Kind {
        result.map(|bytes| bytes.len()).unwrap_err().kind
    }

    #[test]
    fn what_was_packed_is_expanded_to_the_byte() {
        let text: Vec<u8> =
            (0..300_000_u32).flat_map(|i| (f64::from(i) / 7.0).to_string().into_bytes()).collect();
        for coding in Coding::ALL {
            for length in [0, 1, 1000, PIECE - 1, PIECE, text.len()] {
                let packed = whole(coding, &text[..length]).unwrap();
                assert!(length < 1000 || packed.len() < length * 2 / 3, "{coding:?} {length}");
                assert!(
                    expand(coding, &packed, length as u64).unwrap() == text[..length],
                    "{coding:?} {length}"
                );
            }
        }
    }

    #[test]
    fn a_bomb_costs_no_more_than_the_limit() {
        for coding in Coding::ALL {
            let bomb = whole(coding, &vec![b' '; 32 << 20]).unwrap();
            let limit = 1 << 20;
            let mut expander = Expander::new(coding, bomb.into(), limit).unwrap();
            let problem = loop {
                match expander.expand(PIECE) {
                    Ok(is_whole) => assert!(!is_whole, "{coding:?}"),
                    Err(problem) => break problem,
                }
            };
            assert_eq!(problem.kind, Kind::ContentTooLarge);
            assert!(problem.detail.contains("1048576 bytes"), "{}", problem.detail);
            assert!(expander.out.capacity() <= (1 << 20) + 1, "{coding:?}: {}", expander.out.capacity());
        }
    }

    #[test]
    fn the_limit_itself_is_accepted() {
        for coding in Coding::ALL {
            let packed = whole(coding, &[b' '; 5000]).unwrap();
            assert_eq!(expand(coding, &packed, 5000).unwrap().len(), 5000);
            assert_eq!(kind(expand(coding, &packed, 4999)), Kind::ContentTooLarge);
        }
    }

    #[test]
    fn what_is_cut_short_or_corrupt_or_goes_on_is_refused() {
        let text = b"{\"model\": \"lambertian\", \"surface\": {\"diffuse_albedo\": 0.5}}".repeat(50);
        for coding in Coding::ALL {
            let packed = whole(coding, &text).unwrap();
            for length in [0, 1, packed.len() / 2, packed.len() - 1] {
                assert_eq!(
                    kind(expand(coding, &packed[..length], 1 << 20)),
                    Kind::BodyUnreadable,
                    "{coding:?} {length}"
                );
            }
            let followed = [&packed[..], b"more"].concat();
            assert_eq!(kind(expand(coding, &followed, 1 << 20)), Kind::BodyUnreadable, "{coding:?}");
            assert_eq!(kind(expand(coding, b"{\"model\": 1}", 1 << 20)), Kind::BodyUnreadable, "{coding:?}");
            // Any one bit: refused or not, nothing worse happens.
            for bit in 0..packed.len() * 8 {
                let mut wrong = packed.clone();
                wrong[bit / 8] ^= 1 << (bit % 8);
                let result = expand(coding, &wrong, 1 << 20).map_err(|problem| problem.kind);
                assert!(matches!(result, Ok(_) | Err(Kind::BodyUnreadable | Kind::ContentTooLarge)));
            }
        }
    }

    #[test]
    fn several_members_of_gzip_and_frames_of_zstd_are_one_body() {
        for coding in [Coding::Gzip, Coding::Zstd] {
            let packed = [whole(coding, b"one ").unwrap(), whole(coding, b"body").unwrap()].concat();
            assert_eq!(expand(coding, &packed, 100).unwrap(), b"one body");
        }
    }

    #[test]
    fn a_window_larger_than_http_allows_is_refused() {
        let packed = |log_window: u32| {
            let mut encoder = zstd::stream::write::Encoder::new(Vec::new(), 1).unwrap();
            encoder.window_log(log_window).unwrap();
            encoder.write_all(b"{}").unwrap();
            encoder.finish().unwrap()
        };
        assert_eq!(expand(Coding::Zstd, &packed(ZSTD_LOG_WINDOW), 100).unwrap(), b"{}");
        assert_eq!(kind(expand(Coding::Zstd, &packed(ZSTD_LOG_WINDOW + 1), 100)), Kind::BodyUnreadable);
    }

    #[test]
    fn one_coding_that_is_offered() {
        let of = |value: &'static str| {
            let mut headers = HeaderMap::new();
            headers.insert(header::CONTENT_ENCODING, HeaderValue::from_static(value));
            coding(&headers).map_err(|problem| problem.kind)
        };
        assert_eq!(coding(&HeaderMap::new()).unwrap(), None);
        for (value, expected) in [
            ("", Ok(None)),
            ("identity", Ok(None)),
            ("GZIP", Ok(Some(Coding::Gzip))),
            ("x-gzip", Ok(Some(Coding::Gzip))),
            ("identity, br", Ok(Some(Coding::Brotli))),
            ("zstd", Ok(Some(Coding::Zstd))),
            ("gzip, gzip", Err(Kind::UnsupportedCoding)),
            ("deflate", Err(Kind::UnsupportedCoding)),
        ] {
            assert_eq!(of(value), expected, "{value}");
        }
    }
}
