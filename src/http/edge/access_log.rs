//! One line a request, written by hand: the general formatter takes ten times the instructions, which is more than
//! everything else around a request together.

use super::known::Known;
use super::record::Outcome;
use crate::config::{LogFormat, Telemetry};
use crate::logs::SINK;
use std::io::Write as _;
use std::time::{SystemTime, UNIX_EPOCH};
use tracing::level_filters::LevelFilter;

/// Bytes of a path that are logged; longer ones are cut.
const LONGEST_PATH: usize = 512;

/// How the lines look; none where they are not wanted.
#[derive(Clone, Copy, Debug)]
pub(super) struct AccessLog(Option<LogFormat>);

impl AccessLog {
    pub(super) fn new(telemetry: &Telemetry) -> Self {
        Self((telemetry.log_level >= LevelFilter::INFO).then_some(telemetry.log_format))
    }

    /// Writes the line of a request.
    pub(super) fn write(self, known: &Known, outcome: &Outcome) {
        match self.0 {
            Some(LogFormat::Json) => SINK.line(|line| json(line, known, outcome)),
            Some(LogFormat::Human) => SINK.line(|line| human(line, known, outcome)),
            None => {}
        }
    }
}

fn json(line: &mut Vec<u8>, known: &Known, outcome: &Outcome) {
    line.reserve(512);
    line.extend_from_slice(b"{\"timestamp\":\"");
    timestamp(line, SystemTime::now());
    line.extend_from_slice(b"\",\"level\":\"INFO\",\"message\":\"request\"");
    text(line, b"method", known.method.as_str());
    text(line, b"path", cut(known.path()));
    text(line, b"route", &known.route.pattern);
    number(line, b"status", u64::from(outcome.status));
    number(line, b"microseconds", outcome.microseconds());
    number(line, b"bytes", outcome.bytes);
    if outcome.cut {
        line.extend_from_slice(b",\"cut\":true");
    }
    // A name that was accepted, or made, needs no escapes.
    line.extend_from_slice(b",\"request_id\":\"");
    line.extend_from_slice(known.id.as_bytes());
    line.push(b'"');
    if let Some(trace) = &known.trace {
        line.extend_from_slice(b",\"trace_id\":\"");
        line.extend_from_slice(&trace.id);
        line.push(b'"');
    }
    text(line, b"client", known.client());
    if outcome.directions > 0 {
        number(line, b"directions", outcome.directions as u64);
    }
    if let Some(problem) = &outcome.problem {
        text(line, b"problem", problem);
    }
    line.extend_from_slice(b"}\n");
}

fn human(line: &mut Vec<u8>, known: &Known, outcome: &Outcome) {
    timestamp(line, SystemTime::now());
    line.extend_from_slice(b"  INFO request ");
    line.extend_from_slice(known.method.as_str().as_bytes());
    line.push(b' ');
    escaped(line, cut(known.path()));
    line.push(b' ');
    decimal(line, u64::from(outcome.status));
    line.push(b' ');
    decimal(line, outcome.microseconds());
    line.extend_from_slice(" µs ".as_bytes());
    decimal(line, outcome.bytes);
    line.extend_from_slice(if outcome.cut { b" B, cut; " } else { b" B; " });
    if outcome.directions > 0 {
        decimal(line, outcome.directions as u64);
        line.extend_from_slice(b" directions; ");
    }
    line.extend_from_slice(known.client().as_bytes());
    line.push(b' ');
    line.extend_from_slice(known.id.as_bytes());
    if let Some(trace) = &known.trace {
        line.extend_from_slice(b" trace ");
        line.extend_from_slice(&trace.id);
    }
    if let Some(problem) = &outcome.problem {
        line.extend_from_slice(b": ");
        escaped(line, problem);
    }
    line.push(b'\n');
}

fn cut(path: &str) -> &str {
    &path[..path.floor_char_boundary(LONGEST_PATH)]
}

fn key(line: &mut Vec<u8>, name: &[u8]) {
    line.extend_from_slice(b",\"");
    line.extend_from_slice(name);
    line.extend_from_slice(b"\":");
}

fn text(line: &mut Vec<u8>, name: &[u8], value: &str) {
    key(line, name);
    line.push(b'"');
    escaped(line, value);
    line.push(b'"');
}

fn number(line: &mut Vec<u8>, name: &[u8], value: u64) {
    key(line, name);
    decimal(line, value);
}

fn decimal(line: &mut Vec<u8>, mut value: u64) {
    let mut digits = [0; 20];
    let mut first = digits.len();
    loop {
        first -= 1;
        digits[first] = digit(value % 10);
        value /= 10;
        if value == 0 {
            break;
        }
    }
    line.extend_from_slice(&digits[first..]);
}

fn digit(value: u64) -> u8 {
    b'0' + u8::try_from(value).unwrap_or(0)
}

/// As a JSON string has it, so that no client can forge a line.
fn escaped(line: &mut Vec<u8>, value: &str) {
    let plain = |byte: &u8| *byte >= 0x20 && *byte != b'"' && *byte != b'\\' && *byte != 0x7f;
    if value.as_bytes().iter().all(plain) {
        return line.extend_from_slice(value.as_bytes());
    }
    for byte in value.bytes() {
        if plain(&byte) {
            line.push(byte);
        } else {
            // Memory always takes it.
            let _ = write!(line, "\\u{byte:04x}");
        }
    }
}

/// `2026-11-22T10:20:30.123456Z`: days to a date of the proleptic Gregorian calendar in years that begin in March.
fn timestamp(line: &mut Vec<u8>, time: SystemTime) {
    let since = time.duration_since(UNIX_EPOCH).unwrap_or_default();
    let (days, second) = (since.as_secs() / 86_400, since.as_secs() % 86_400);
    let shifted = days + 719_468;
    let (era, day_of_era) = (shifted / 146_097, shifted % 146_097);
    let year_of_era = (day_of_era - day_of_era / 1460 + day_of_era / 36_524 - day_of_era / 146_096) / 365;
    let day_of_year = day_of_era - (365 * year_of_era + year_of_era / 4 - year_of_era / 100);
    let month_from_march = (5 * day_of_year + 2) / 153;
    let day = day_of_year - (153 * month_from_march + 2) / 5 + 1;
    let month = if month_from_march < 10 { month_from_march + 3 } else { month_from_march - 9 };
    let year = 400 * era + year_of_era + u64::from(month <= 2);

    let mut text = *b"0000-00-00T00:00:00.000000Z";
    for (first, last, mut value) in [
        (0, 3, year),
        (5, 6, month),
        (8, 9, day),
        (11, 12, second / 3600),
        (14, 15, second / 60 % 60),
        (17, 18, second % 60),
        (20, 25, u64::from(since.subsec_micros())),
    ] {
        for place in (first..=last).rev() {
            text[place] = digit(value % 10);
            value /= 10;
        }
    }
    line.extend_from_slice(&text);
}

#[cfg(test)]
mod tests {
    use super::{decimal, escaped, timestamp};
    use std::time::{Duration, UNIX_EPOCH};

    fn written(write: impl FnOnce(&mut Vec<u8>)) -> String {
        let mut line = Vec::new();
        write(&mut line);
        String::from_utf8(line).unwrap()
    }

    #[test]
    fn times_are_written_as_rfc_3339_has_them() {
        for (seconds, text) in [
            (0, "1970-01-01T00:00:00.000042Z"),
            (951_782_399, "2000-02-28T23:59:59.000042Z"),
            (951_782_400, "2000-02-29T00:00:00.000042Z"),
            (1_709_251_199, "2024-02-29T23:59:59.000042Z"),
            (1_735_689_599, "2024-12-31T23:59:59.000042Z"),
            (4_107_542_400, "2100-03-01T00:00:00.000042Z"),
        ] {
            let time = UNIX_EPOCH + Duration::from_secs(seconds) + Duration::from_micros(42);
            assert_eq!(written(|line| timestamp(line, time)), text);
        }
    }

    #[test]
    fn nothing_that_a_client_sends_ends_a_string_or_a_line() {
        for hostile in ["\"", "\\", "a\nb", "\u{7f}", "é\u{1}", "plain"] {
            let json = format!("\"{}\"", written(|line| escaped(line, hostile)));
            assert_eq!(serde_json::from_str::<String>(&json).unwrap(), hostile);
            assert!(!json.contains('\n'));
        }
    }

    #[test]
    fn numbers_are_written_whole() {
        for number in [0, 9, 10, 1_234_567_890, u64::MAX] {
            assert_eq!(written(|line| decimal(line, number)), number.to_string());
        }
    }
}
