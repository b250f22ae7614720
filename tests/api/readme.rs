//! The README shows what the service really answers.

use crate::server::Server;
use serde_json::Value;

const README: &str = include_str!("../../README.md");

/// A block of the page between its fence of this language and the next fence.
fn blocks<'a>(language: &str) -> Vec<(usize, &'a str)> {
    let fence = format!("```{language}\n");
    README
        .match_indices(&fence)
        .map(|(at, fence)| {
            let rest = &README[at + fence.len()..];
            (at, &rest[..rest.find("\n```").expect("a closing fence")])
        })
        .collect()
}

/// Whether an answer is the one shown, where "…" stands for any number, or once in an array for some elements.
fn is_as_shown(got: &Value, shown: &Value) -> bool {
    match (got, shown) {
        (Value::Number(_), Value::String(any)) if any == "…" => true,
        (Value::Array(got), Value::Array(shown)) => {
            let all = |got: &[Value], shown: &[Value]| {
                got.len() == shown.len() && got.iter().zip(shown).all(|(got, shown)| is_as_shown(got, shown))
            };
            let Some(gap) = shown.iter().position(|shown| shown == "…") else { return all(got, shown) };
            let (before, after) = (&shown[..gap], &shown[gap + 1..]);
            got.len() >= shown.len()
                && all(&got[..gap], before)
                && all(&got[got.len() - after.len()..], after)
        }
        (Value::Object(got), Value::Object(shown)) => {
            got.len() == shown.len()
                && shown.iter().all(|(name, shown)| got.get(name).is_some_and(|got| is_as_shown(got, shown)))
        }
        _ => got == shown,
    }
}

#[test]
fn only_what_is_left_out_may_differ() {
    let matches = |got: &str, shown: &str| {
        let parse = |text| serde_json::from_str(text).expect("JSON");
        is_as_shown(&parse(got), &parse(shown))
    };
    let got = r#"{"a": [{"t": 1.5, "m": "x"}, {"t": 2, "m": "y"}]}"#;
    for shown in [
        got,
        r#"{"a": [{"t": "…", "m": "x"}, "…"]}"#,
        r#"{"a": ["…", {"t": "…", "m": "y"}]}"#,
        r#"{"a": ["…"]}"#,
    ] {
        assert!(matches(got, shown), "{shown}");
    }
    for shown in [
        r#"{"a": [{"t": "…", "m": "…"}, "…"]}"#,
        r#"{"a": [{"t": "…", "m": "x"}]}"#,
        r#"{"a": [{"m": "x"}, "…"]}"#,
        r#"{"a": ["…", {"t": 3, "m": "y"}]}"#,
        r#"{"a": [{"t": 1.5, "m": "x"}, {"t": 2, "m": "y"}, "…"]}"#,
        r#"{"a": "…"}"#,
        "{}",
    ] {
        assert!(!matches(got, shown), "{shown}");
    }
}

#[test]
fn every_request_gets_the_answer_shown() {
    let server = Server::start();
    let requests = blocks("sh");
    let mut answers = blocks("json");
    answers.extend(blocks("csv"));
    answers.sort_unstable();
    assert_eq!((requests.len(), answers.len()), (8, 8));
    for ((_, request), (_, shown)) in requests.into_iter().zip(answers) {
        let path = request.split("http://127.0.0.1:8080").nth(1).expect("a path");
        let path = &path[..path.find(['\'', ' ']).unwrap_or(path.len())];
        let response = match request.split_once("-d '") {
            Some((_, body)) => server.post(path, body.trim_end_matches('\'').to_owned()),
            None if request.contains("text/csv") => {
                server.request("GET", path).header("accept", "text/csv").send().expect("an answer")
            }
            None => server.get(path),
        };
        assert_eq!(response.status(), 200, "{request}");
        let text = response.text().expect("text");
        if request.contains("text/csv") {
            // The lines of CSV end in CR LF.
            assert_eq!(text.replace("\r\n", "\n").trim_end(), shown);
        } else {
            let (got, shown): (Value, Value) =
                (serde_json::from_str(&text).expect("JSON"), serde_json::from_str(shown).expect("JSON"));
            assert!(is_as_shown(&got, &shown), "{request}: {got}");
        }
    }
}
