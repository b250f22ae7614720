//! Connections: their time limits, their number, and the end of the service.

use crate::server::Server;
use crate::wire::{connect, ends, get, receive, send};
use serde_json::Value;
use std::io::{ErrorKind, Read as _, Write as _};
use std::net::TcpStream;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Duration;

/// Work that takes far longer than any test waits.
const LONG: &str = "/v1/diagrams?model=beckmann_spizzichino&rms_height_um=1&correlation_length_um=4\
    &wavelength_um=0.5&method=series&sweep=theta_r_deg&from_deg=-90&to_deg=90&points=1000000&at_deg=10";

#[test]
fn a_connection_without_a_request_ends() {
    let server = Server::with(&["--idle-timeout-seconds", "0.3"]);
    // From the beginning, and after an answer.
    assert!(ends(&mut connect(server.address())));
    let mut used = connect(server.address());
    assert_eq!(get(&mut used, "/livez").unwrap().status, 200);
    assert!(ends(&mut used));
}

#[test]
fn a_head_that_comes_byte_by_byte_does_not_buy_time() {
    let server = Server::with(&["--idle-timeout-seconds", "0.5"]);
    let mut slow = connect(server.address());
    let mut sent = 0;
    // Each byte comes well within the limit.
    while slow.write_all(b"G").is_ok() {
        std::thread::sleep(Duration::from_millis(20));
        sent += 1;
        assert!(sent < 3000, "a minute was not enough");
    }
    assert_eq!(server.get("/livez").status(), 200);
}

#[test]
fn a_client_that_takes_nothing_of_its_answers_is_let_go() {
    let server = Server::with(&["--stall-timeout-seconds", "0.3"]);
    let mut stream = connect(server.address());
    let length = get(&mut stream, "/openapi.json").unwrap().body.len();
    // More than the buffers between the two hold.
    let requests = 200_000_000 / length;
    for _ in 0..requests {
        send(&mut stream, "/openapi.json").unwrap();
    }
    std::thread::sleep(Duration::from_secs(2));
    let mut taken = 0;
    let mut piece = vec![0; 1 << 16];
    loop {
        match stream.read(&mut piece) {
            Ok(0) => break,
            Ok(read) => taken += read,
            Err(error) if error.kind() == ErrorKind::ConnectionReset => break,
            Err(error) => panic!("the connection is held: {error}"),
        }
    }
    assert!(taken < requests * length, "nothing was cut");
}

#[test]
fn an_idle_connection_that_was_put_to_sleep_wakes_up() {
    let server = Server::start();
    let mut stream = connect(server.address());
    assert_eq!(get(&mut stream, "/livez").unwrap().status, 200);
    // Longer than its buffers are kept.
    std::thread::sleep(Duration::from_secs(6));
    assert_eq!(get(&mut stream, "/livez").unwrap().status, 200);
    // In two parts, too.
    std::thread::sleep(Duration::from_secs(6));
    stream.write_all(b"GET /livez HT").unwrap();
    std::thread::sleep(Duration::from_millis(50));
    stream.write_all(b"TP/1.1\r\nhost: x\r\n\r\n").unwrap();
    assert_eq!(receive(&mut stream).unwrap().status, 200);
}

#[test]
fn a_client_that_leaves_while_its_connection_sleeps_is_forgotten() {
    let server = Server::start();
    let connections = || {
        let text = server.get("/metrics").text().unwrap();
        let line = text.lines().find_map(|line| line.strip_prefix("reflectance_connections ")).unwrap();
        line.parse::<usize>().unwrap()
    };
    let mut sleeping: Vec<_> = (0..8).map(|_| connect(server.address())).collect();
    for stream in &mut sleeping {
        assert_eq!(get(stream, "/livez").unwrap().status, 200);
    }
    // Longer than its buffers are kept.
    std::thread::sleep(Duration::from_secs(6));
    assert!(connections() > 8);
    drop(sleeping);
    let mut looks = 0;
    // One is that of whoever asks.
    while connections() > 1 {
        looks += 1;
        assert!(looks < 1000, "{} connections are held", connections());
        std::thread::sleep(Duration::from_millis(10));
    }
}

#[test]
fn connections_beyond_the_limit_wait_for_their_turn() {
    let server = Server::with(&["--connection-limit", "2"]);
    let mut inside = [connect(server.address()), connect(server.address())];
    for stream in &mut inside {
        assert_eq!(get(stream, "/livez").unwrap().status, 200);
    }
    let mut outside = connect(server.address());
    send(&mut outside, "/livez").unwrap();
    outside.set_read_timeout(Some(Duration::from_millis(300))).unwrap();
    let error = receive(&mut outside).map(|answer| answer.status).unwrap_err();
    assert_eq!(error.kind(), ErrorKind::WouldBlock);
    let [first, _second] = inside;
    drop(first);
    outside.set_read_timeout(Some(Duration::from_mins(1))).unwrap();
    assert_eq!(receive(&mut outside).unwrap().status, 200);
}

/// Sends one request after the other on one connection until an answer says that it is the last: how many were
/// answered.
fn load(address: &str, path: &str) -> usize {
    let mut stream = connect(address);
    let mut answered = 0;
    loop {
        let answer = get(&mut stream, path).unwrap_or_else(|error| panic!("a request was lost: {error}"));
        assert!(answer.status == 200 || answer.status == 503, "{}", answer.status);
        answered += 1;
        if answer.is_last() {
            assert!(ends(&mut stream), "the last answer was not the last");
            return answered;
        }
    }
}

/// Signals the service while clients load it: every request is answered.
fn leave_under_load(signal: &str, flags: &[&str]) {
    let mut server = Server::with(flags);
    let address = server.address().to_owned();
    let answered = AtomicUsize::new(0);
    std::thread::scope(|scope| {
        let clients: Vec<_> = (0..32)
            .map(|client| {
                let path = if client % 2 == 0 { "/livez" } else { "/v1/figures/18" };
                let (address, answered) = (&address, &answered);
                scope.spawn(move || answered.fetch_add(load(address, path), Ordering::Relaxed))
            })
            .collect();
        std::thread::sleep(Duration::from_millis(300));
        server.signal(signal);
        for client in clients {
            client.join().unwrap();
        }
    });
    let (code, log) = server.end();
    assert_eq!(code, Some(0), "{log}");
    assert!(answered.into_inner() > 32);
}

#[test]
fn the_end_loses_no_request_of_clients_that_never_pause() {
    leave_under_load("TERM", &["--drain-delay-seconds", "0.3"]);
    leave_under_load("TERM", &["--drain-delay-seconds", "0"]);
    leave_under_load("INT", &[]);
}

#[test]
fn clients_that_wait_to_be_accepted_are_answered_before_the_end() {
    let mut server = Server::with(&["--drain-delay-seconds", "0"]);
    server.signal("STOP");
    let mut waiting: Vec<_> = (0..50).map(|_| connect(server.address())).collect();
    for stream in &mut waiting[..40] {
        send(stream, "/livez").unwrap();
    }
    server.signal("TERM");
    server.signal("CONT");
    // The request comes a moment after the connection.
    std::thread::sleep(Duration::from_millis(100));
    for stream in &mut waiting[40..] {
        send(stream, "/livez").unwrap();
    }
    // Some of the first may be answered before the signal is looked at.
    for (place, stream) in waiting.iter_mut().enumerate() {
        let answer = receive(stream).unwrap();
        assert_eq!((answer.status, answer.is_last() || place < 40), (200, true));
    }
    assert_eq!(server.end().0, Some(0));
}

#[test]
fn while_it_drains_the_service_answers_and_says_that_it_leaves() {
    let mut server = Server::with(&["--drain-delay-seconds", "1.5"]);
    let mut old = connect(server.address());
    let answer = get(&mut old, "/livez").unwrap();
    assert_eq!((answer.status, answer.is_last()), (200, false));
    server.signal("TERM");
    std::thread::sleep(Duration::from_millis(200));
    let mut new = connect(server.address());
    for stream in [&mut old, &mut new] {
        let answer = get(stream, "/livez").unwrap();
        assert_eq!((answer.status, answer.is_last()), (200, true));
    }
    assert_eq!(server.end().0, Some(0));
    assert_eq!(TcpStream::connect(server.address()).unwrap_err().kind(), ErrorKind::ConnectionRefused);
}

#[test]
fn a_second_signal_ends_at_once_and_says_what_was_cut() {
    for (path, code) in [(LONG, 1), ("/livez", 0)] {
        let mut server = Server::with(&["--drain-delay-seconds", "60", "--log-level", "warn"]);
        let mut stream = connect(server.address());
        // Another connection is answered after it: the first is under way, or idle.
        send(&mut stream, path).unwrap();
        std::thread::sleep(Duration::from_millis(100));
        assert_eq!(server.get("/livez").status(), 200);
        server.signal("TERM");
        std::thread::sleep(Duration::from_millis(100));
        server.signal("TERM");
        let (found, log) = server.end();
        assert_eq!(found, Some(code), "{path} {log}");
        assert_eq!(log.contains("unfinished"), code == 1, "{log}");
    }
}

#[test]
fn an_answer_given_before_the_body_was_read_arrives() {
    let server = Server::start();
    let mut stream = connect(server.address());
    let length = 20_000_000;
    write!(stream, "POST /nowhere HTTP/1.1\r\nhost: x\r\ncontent-length: {length}\r\n\r\n").unwrap();
    // The client listens only after it has sent everything.
    stream.write_all(&vec![b' '; length]).unwrap();
    let answer = receive(&mut stream).unwrap();
    assert_eq!((answer.status, answer.is_last()), (404, true));
}

#[test]
fn a_head_that_is_not_read_is_answered_with_a_problem() {
    let server = Server::with(&["--head-limit-bytes", "8192"]);
    let long = "x".repeat(9000);
    for (head, status, word) in [
        (format!("GET /{long} HTTP/1.1\r\nhost: x\r\n\r\n"), 431, "8192 bytes"),
        (format!("GET / HTTP/1.1\r\nhost: x\r\nlong: {long}\r\n\r\n"), 431, "8192 bytes"),
        (format!("GET / HTTP/1.1\r\nhost: x\r\n{}\r\n", "a: b\r\n".repeat(200)), 431, "8192 bytes"),
        ("GET / HTTP/1.1\r\nho st: x\r\n\r\n".to_owned(), 400, "HTTP/1.1"),
        ("no request at all\r\n\r\n".to_owned(), 400, "HTTP/1.1"),
    ] {
        let mut stream = connect(server.address());
        stream.write_all(head.as_bytes()).unwrap();
        let answer = receive(&mut stream).unwrap();
        assert_eq!((answer.status, answer.is_last()), (status, true));
        assert_eq!(answer.header("content-type"), Some("application/problem+json"));
        let document: Value = serde_json::from_slice(&answer.body).unwrap();
        assert_eq!(document["status"], status);
        assert!(document["detail"].as_str().unwrap().contains(word), "{document}");
        assert!(ends(&mut stream));
    }
    let just = "x".repeat(8000);
    let mut stream = connect(server.address());
    assert_eq!(get(&mut stream, &format!("/{just}")).unwrap().status, 404);
}
