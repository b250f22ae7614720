//! Bodies that are not as long as they say, and heads that say two things.

use crate::alone;
use crate::client::{Answer, SCENE};
use crate::process::Service;
use std::time::Duration;

const HEAD: &str = "POST /v1/radiance HTTP/1.1\r\nhost: localhost\r\ncontent-type: application/json\r\n";

fn scene() -> String {
    format!(r#"{{{SCENE},"geometry":{{"theta_i_deg":30,"theta_r_deg":30}}}}"#)
}

/// All answers to some bytes. Once there were `expected` of them the client says that it will send no more, and the
/// server has to close.
fn answers(service: &Service, bytes: &[u8], expected: usize) -> Vec<Answer> {
    let mut connection = service.connect();
    connection.patience(Duration::from_secs(5));
    // The server may have closed already.
    let _ = connection.send(bytes);
    let mut answers: Vec<_> = (0..expected).map_while(|_| connection.answer().ok()).collect();
    let _ = connection.finish();
    while let Ok(answer) = connection.answer() {
        answers.push(answer);
    }
    assert!(connection.is_closed(), "it stays open");
    answers
}

fn statuses(answers: &[Answer]) -> Vec<u16> {
    answers.iter().map(|answer| answer.status).collect()
}

#[test]
fn a_body_shorter_than_it_says_is_refused_or_ended() {
    let _alone = alone();
    let mut service = Service::start(&[]);
    let body = scene();
    for short_of in [1, 100, 1 << 20] {
        let request = format!("{HEAD}content-length: {}\r\n\r\n{body}", body.len() + short_of);
        let answers = answers(&service, request.as_bytes(), 0);
        assert!(matches!(statuses(&answers)[..], [] | [400]), "{answers:?}");
    }
    service.lives();
}

#[test]
fn what_follows_a_body_is_the_next_request_and_nothing_else() {
    let _alone = alone();
    let mut service = Service::start(&[]);
    let body = scene();
    // One character less: the JSON is cut, and the brace begins a request that is none.
    let request = format!("{HEAD}content-length: {}\r\n\r\n{body}", body.len() - 1);
    assert_eq!(statuses(&answers(&service, request.as_bytes(), 2)), [400, 400]);
    // The rest after a whole body.
    let request = format!("{HEAD}content-length: {}\r\n\r\n{body}and more", body.len());
    assert_eq!(statuses(&answers(&service, request.as_bytes(), 1)), [200]);
    let request = format!("{request}\r\n\r\n");
    assert_eq!(statuses(&answers(&service, request.as_bytes(), 2)), [200, 400]);
    // Two at once are two.
    let one = format!("{HEAD}content-length: {}\r\n\r\n{body}", body.len());
    assert_eq!(statuses(&answers(&service, one.repeat(2).as_bytes(), 2)), [200, 200]);
    service.lives();
}

#[test]
fn lengths_that_are_none_are_refused() {
    let _alone = alone();
    let mut service = Service::start(&[]);
    let body = scene();
    let length = body.len();
    for lengths in [
        "content-length: -1\r\n".to_owned(),
        "content-length: +5\r\n".to_owned(),
        "content-length: 1e3\r\n".to_owned(),
        "content-length: 0x10\r\n".to_owned(),
        "content-length: \r\n".to_owned(),
        "content-length: 99999999999999999999\r\n".to_owned(),
        format!("content-length: {length}\r\ncontent-length: {}\r\n", length - 1),
        format!("content-length: {length}, {}\r\n", length + 1),
        "transfer-encoding: chunked, gzip\r\n".to_owned(),
        "transfer-encoding: rot13\r\n".to_owned(),
    ] {
        let answers = answers(&service, format!("{HEAD}{lengths}\r\n{body}").as_bytes(), 1);
        // What follows on the connection is nobody's request.
        assert_eq!(statuses(&answers), [400], "{lengths}: {answers:?}");
    }
    service.lives();
}

#[test]
fn two_ways_to_tell_the_length_hide_no_second_request() {
    let _alone = alone();
    let mut service = Service::start(&[]);
    let hidden = "GET /v1/figures HTTP/1.1\r\nhost: localhost\r\n\r\n";
    // By the chunks the body is empty, and the rest would be a request of its own.
    let request = format!(
        "{HEAD}content-length: {}\r\ntransfer-encoding: chunked\r\n\r\n0\r\n\r\n{hidden}",
        5 + hidden.len()
    );
    let answers = answers(&service, request.as_bytes(), 1);
    assert_eq!(statuses(&answers), [400], "{answers:?}");
    service.lives();
}

#[test]
fn chunks_that_are_none_are_refused() {
    let _alone = alone();
    let mut service = Service::start(&["--body-limit-bytes", "100000"]);
    let head = format!("{HEAD}transfer-encoding: chunked\r\n\r\n");
    for chunks in [
        "zz\r\n{}\r\n0\r\n\r\n",
        "2\r\n{}x\r\n0\r\n\r\n",
        "ffffffffffffffffff\r\n{}",
        "-2\r\n{}\r\n0\r\n\r\n",
        "\r\n",
    ] {
        let answers = answers(&service, format!("{head}{chunks}").as_bytes(), 1);
        assert_eq!(statuses(&answers), [400], "{chunks:?}: {answers:?}");
    }
    for cut in ["ffffffffffffffff\r\n{}", "2;\r\n{}", "2\r\n{}\r\n", ""] {
        let answers = answers(&service, format!("{head}{cut}").as_bytes(), 0);
        assert!(matches!(statuses(&answers)[..], [] | [400]), "{cut:?}: {answers:?}");
    }
    // A chunk's extension without end.
    let endless = format!("{head}2;{}", "x".repeat(1 << 20));
    let refused = answers(&service, endless.as_bytes(), 1);
    assert!(matches!(statuses(&refused)[..], [] | [400]), "{refused:?}");
    // Many small chunks that go over the limit together.
    let chunk = format!("3e8\r\n{}\r\n", " ".repeat(1000));
    let long = format!("{head}{}0\r\n\r\n", chunk.repeat(101));
    let detail = answers(&service, long.as_bytes(), 1)[0].problem(413);
    assert!(detail.contains("100000"), "{detail}");
    service.lives();
}

#[test]
fn a_body_beyond_the_limit_is_refused_before_it_is_sent() {
    let _alone = alone();
    let mut service = Service::start(&[]);
    for length in [(64 << 20) + 1, u64::MAX / 2] {
        let mut connection = service.connect();
        let head = format!("{HEAD}content-length: {length}\r\nexpect: 100-continue\r\n\r\n");
        connection.send(head.as_bytes()).expect("it reads");
        let answer = connection.answer().expect("an answer");
        let detail = answer.problem(413);
        assert!(detail.contains("67108864"), "{detail}");
    }
    service.lives();
}

#[test]
fn heads_that_are_too_large_or_none_are_refused() {
    let _alone = alone();
    let mut service = Service::start(&["--head-limit-bytes", "16384"]);
    let get = |rest: &str| format!("GET /livez HTTP/1.1\r\nhost: localhost\r\n{rest}\r\n");
    let long = get(&format!("x: {}\r\n", "a".repeat(10_000)));
    assert_eq!(statuses(&answers(&service, long.as_bytes(), 1)), [200]);
    for (head, expected) in [
        (get(&format!("x: {}\r\n", "a".repeat(20_000))), 431),
        (get(&"x: y\r\n".repeat(5000)), 431),
        (format!("GET /{} HTTP/1.1\r\nhost: localhost\r\n\r\n", "a".repeat(20_000)), 414),
        (get("no colon\r\n"), 400),
        (get("a b: c\r\n"), 400),
        ("GET / HTTP/9.9\r\n\r\n".to_owned(), 400),
        ("\u{0}\u{1}\u{2}\u{3}\r\n\r\n".to_owned(), 400),
        // A client of TLS on the plain port.
        ("\u{16}\u{3}\u{1}\u{2}\u{0}\u{1}\u{0}\u{1}\u{fc}\u{3}\u{3}\r\n\r\n".to_owned(), 400),
    ] {
        let answers = answers(&service, head.as_bytes(), 1);
        let found = statuses(&answers);
        // 431 and 414 say the same of a head that is too large.
        let accepted = if expected == 400 { vec![400] } else { vec![414, 431] };
        assert!(found.len() == 1 && accepted.contains(&found[0]), "{found:?} to {head:.60}");
    }
    service.lives();
}
