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

#[test]
fn every_request_gets_the_answer_shown() {
    let server = Server::start();
    let requests = blocks("sh");
    let mut answers = blocks("json");
    answers.extend(blocks("csv"));
    answers.sort_unstable();
    assert_eq!((requests.len(), answers.len()), (5, 5));
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
            assert_eq!(got, shown, "{request}");
        }
    }
}
