//! Connections that ask for nothing.

use crate::alone;
use crate::load::Small;
use crate::process::{Service, until};
use rustix::process::{Resource, getrlimit, setrlimit};
use std::net::TcpStream;
use std::time::{Duration, Instant};

const CROWD: usize = 10_000;
const STEP: usize = 1_000;

/// Lets this process, and those that it starts, open as many files as the system allows.
fn raise_descriptor_limit() {
    let mut limit = getrlimit(Resource::Nofile);
    limit.current = limit.maximum;
    setrlimit(Resource::Nofile, limit).expect("up to the maximum it may");
    let enough = limit.maximum.is_none_or(|most| most > CROWD as u64 + 500);
    assert!(
        enough,
        "this test wants {CROWD} descriptors and some, and the hard limit is {:?}",
        limit.maximum
    );
}

#[test]
fn ten_thousand_idle_connections_leave_room_for_others() {
    let _alone = alone();
    raise_descriptor_limit();
    let mut service = Service::start(&["--idle-timeout-seconds", "60"]);
    service.lives();
    let (idle, descriptors) = (service.memory(), service.descriptors());
    let small = Small::begin(&service.address);
    let begin = Instant::now();
    let mut crowd = Vec::with_capacity(CROWD);
    while crowd.len() < CROWD {
        // Fewer than the system lets wait to be accepted.
        for _ in 0..STEP {
            let index = crowd.len();
            let stream = TcpStream::connect(&service.address);
            crowd.push(stream.unwrap_or_else(|error| panic!("connection {index}: {error}")));
        }
        let here = descriptors + crowd.len();
        until(Duration::from_secs(20), "all are accepted", || service.descriptors() >= here);
    }
    let opened = begin.elapsed();
    let full = service.memory();
    // They are answered as well, if they ask after all.
    for mut stream in crowd.iter().step_by(1000) {
        use std::io::{Read as _, Write as _};
        stream.write_all(b"GET /livez HTTP/1.1\r\nhost: localhost\r\n\r\n").expect("it reads");
        let mut status = [0; 12];
        stream.read_exact(&mut status).expect("an answer");
        assert_eq!(&status, b"HTTP/1.1 200");
    }
    let times = small.end();
    drop(crowd);
    until(Duration::from_secs(20), "all are let go", || service.descriptors() <= descriptors + 2);
    let after = service.settled_memory();
    println!(
        "{CROWD} idle connections: open after {opened:.2?}, {:.1} KiB each; memory {idle:.1} MiB, {full:.1} with them, \
         {after:.1} afterwards; beside them {times}",
        (full - idle) * 1024.0 / CROWD as f64
    );
    assert!(full - idle < 100.0);
    service.lives();
}

#[test]
fn connections_over_the_limit_wait_for_their_turn() {
    let _alone = alone();
    let mut service = Service::start(&["--connection-limit", "20"]);
    let mut crowd: Vec<_> = (0..20).map(|_| service.connect()).collect();
    // Each is accepted once it is answered.
    for connection in &mut crowd {
        connection.send(&crate::client::small()).expect("it reads");
        assert_eq!(connection.answer().expect("an answer").status, 200);
    }
    let mut late = service.connect();
    late.send(&crate::client::small()).expect("the system takes it");
    late.patience(Duration::from_millis(300));
    let early = late.more();
    assert!(early.is_err(), "it was answered or turned away: {early:?}");
    drop(crowd);
    late.patience(Duration::from_secs(10));
    assert_eq!(late.answer().expect("an answer").status, 200);
    service.lives();
}
