//! HTTP/2 by its frames: what a client may do that a library for clients does not.

use crate::server::{Server, in_flight};
use crate::wire::connect;
use std::io::{Read as _, Write as _};
use std::net::TcpStream;
use std::time::Duration;

const DATA: u8 = 0;
const HEADERS: u8 = 1;
const RST_STREAM: u8 = 3;
const SETTINGS: u8 = 4;
const PING: u8 = 6;
const GOAWAY: u8 = 7;
const WINDOW_UPDATE: u8 = 8;
const END_STREAM: u8 = 1;
const ACK: u8 = 1;
const END_HEADERS: u8 = 4;

/// More than any test takes of it.
const LONG: &str = "/v1/diagrams?model=beckmann_spizzichino&rms_height_um=1&correlation_length_um=4\
    &wavelength_um=0.5&method=series&sweep=theta_r_deg&from_deg=-90&to_deg=90&points=1000000&at_deg=10";

struct Client(TcpStream);

#[derive(Debug)]
struct Frame {
    kind: u8,
    flags: u8,
    stream: u32,
    payload: Vec<u8>,
}

impl Client {
    /// Begins a connection with these settings.
    fn new(server: &Server, settings: &[u8]) -> Self {
        let mut client = Self(connect(server.address()));
        client.0.write_all(b"PRI * HTTP/2.0\r\n\r\nSM\r\n\r\n").unwrap();
        client.send(SETTINGS, 0, 0, settings);
        client
    }

    fn send(&mut self, kind: u8, flags: u8, stream: u32, payload: &[u8]) {
        let length = u32::try_from(payload.len()).unwrap().to_be_bytes();
        let frame = [&length[1..], &[kind, flags], &stream.to_be_bytes(), payload].concat();
        self.0.write_all(&frame).unwrap();
    }

    /// A request by RFC 7541, with nothing indexed but what the protocol's own table has.
    fn ask(&mut self, stream: u32, method: u8, path: &str, fields: &[(&str, &str)], flags: u8) {
        let mut head = vec![0x80 | method, 0x86, 0x04];
        string(&mut head, path);
        head.push(0x01);
        string(&mut head, "x");
        for (name, value) in fields {
            head.push(0);
            string(&mut head, name);
            string(&mut head, value);
        }
        self.send(HEADERS, END_HEADERS | flags, stream, &head);
    }

    fn get(&mut self, stream: u32, path: &str) {
        self.ask(stream, 2, path, &[], END_STREAM);
    }

    /// The next frame; none at the end of the connection.
    fn next(&mut self) -> Option<Frame> {
        let mut head = [0; 9];
        self.0.read_exact(&mut head).ok()?;
        let length = u32::from_be_bytes([0, head[0], head[1], head[2]]);
        let mut payload = vec![0; length as usize];
        self.0.read_exact(&mut payload).ok()?;
        let stream = u32::from_be_bytes([head[5], head[6], head[7], head[8]]);
        Some(Frame { kind: head[3], flags: head[4], stream, payload })
    }

    /// The next frame of a kind.
    fn await_frame(&mut self, kind: u8) -> Frame {
        loop {
            let frame = self.next().expect("a frame before the end");
            if frame.kind == kind {
                return frame;
            }
        }
    }

    /// Whether the other end answers.
    fn ping(&mut self) {
        self.send(PING, 0, 0, b"12345678");
        while self.await_frame(PING).flags & ACK == 0 {}
    }
}

fn string(head: &mut Vec<u8>, text: &str) {
    let mut length = text.len();
    if length < 127 {
        head.push(u8::try_from(length).unwrap());
    } else {
        head.push(127);
        length -= 127;
        while length >= 128 {
            head.push(u8::try_from(length % 128).unwrap() | 0x80);
            length /= 128;
        }
        head.push(u8::try_from(length).unwrap());
    }
    head.extend_from_slice(text.as_bytes());
}

/// Waits until so many requests are in flight.
fn until_in_flight(server: &Server, expected: usize) {
    for _ in 0..1000 {
        if in_flight(server) == expected {
            return;
        }
        std::thread::sleep(Duration::from_millis(10));
    }
    panic!("{} requests in flight instead of {expected}", in_flight(server));
}

#[test]
fn a_client_that_leaves_ends_its_request() {
    let server = Server::start();
    let mut client = Client::new(&server, &[]);
    client.get(1, LONG);
    client.get(3, LONG);
    until_in_flight(&server, 2);
    // One stream, and then the connection.
    client.send(RST_STREAM, 0, 1, &8u32.to_be_bytes());
    until_in_flight(&server, 1);
    client.ping();
    drop(client);
    until_in_flight(&server, 0);
    // The same over HTTP/1.
    let mut client = connect(server.address());
    crate::wire::send(&mut client, LONG).unwrap();
    until_in_flight(&server, 1);
    drop(client);
    until_in_flight(&server, 0);
}

#[test]
fn an_answer_whose_window_stays_closed_is_dropped() {
    let server = Server::with(&["--stall-timeout-seconds", "0.5"]);
    // SETTINGS_INITIAL_WINDOW_SIZE 0.
    let mut client = Client::new(&server, &[0, 4, 0, 0, 0, 0]);
    client.get(1, LONG);
    until_in_flight(&server, 1);
    client.ping();
    until_in_flight(&server, 0);
    // The rest of the connection is as it was.
    client.send(WINDOW_UPDATE, 0, 1, &1000u32.to_be_bytes());
    assert_eq!(client.await_frame(RST_STREAM).stream, 1);
    client.ping();
}

#[test]
fn a_request_in_flight_is_finished_before_the_connection_ends() {
    let mut server = Server::with(&["--drain-delay-seconds", "0"]);
    let mut client = Client::new(&server, &[]);
    let body = crate::server::scene().to_string();
    let length = body.len().to_string();
    let fields = [("content-type", "application/json"), ("content-length", &length)];
    client.ask(1, 3, "/v1/radiance", &fields, 0);
    until_in_flight(&server, 1);
    server.signal("TERM");
    client.await_frame(GOAWAY);
    client.send(DATA, END_STREAM, 1, body.as_bytes());
    assert_eq!(client.await_frame(HEADERS).stream, 1);
    let answer = client.await_frame(DATA);
    assert!(String::from_utf8(answer.payload).unwrap().contains("total"));
    drop(client);
    assert_eq!(server.end().0, Some(0));
}

#[test]
fn a_head_beyond_the_limit_is_told_the_limit() {
    let server = Server::with(&["--head-limit-bytes", "8192"]);
    let mut client = Client::new(&server, &[]);
    client.ask(1, 2, "/livez", &[("long", &"x".repeat(9000))], END_STREAM);
    let document = String::from_utf8(client.await_frame(DATA).payload).unwrap();
    assert!(document.contains("8192 bytes") && document.contains("431"), "{document}");
}
