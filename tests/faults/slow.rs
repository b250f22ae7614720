//! Clients that send or read a little at a time, or nothing.

use crate::alone;
use crate::client::{Connection, QUERY, SCENE, get};
use crate::load::Small;
use crate::process::{Service, until};
use std::thread;
use std::time::{Duration, Instant};

/// Sends one byte a tick on every connection until the server has closed all of them; says how many still lived at
/// the end of the time, and when the last one ended.
fn drip(connections: &mut Vec<Connection>, bytes: &[u8], within: Duration) -> (usize, Duration) {
    let begin = Instant::now();
    let mut last = Duration::ZERO;
    for connection in connections.iter() {
        connection.patience(Duration::from_millis(1));
    }
    for byte in bytes.iter().cycle() {
        if connections.is_empty() || begin.elapsed() > within {
            break;
        }
        connections.retain_mut(|connection| connection.send(&[*byte]).is_ok() && !connection.is_closed());
        last = begin.elapsed();
        thread::sleep(Duration::from_millis(50));
    }
    (connections.len(), last)
}

#[test]
fn heads_that_drip_in_are_ended() {
    let _alone = alone();
    let mut service = Service::start(&["--idle-timeout-seconds", "2", "--request-timeout-seconds", "2"]);
    let small = Small::begin(&service.address);
    let mut connections: Vec<_> = (0..300).map(|_| service.connect()).collect();
    for connection in &mut connections {
        connection.send(b"GET /livez HTTP/1.1\r\nhost: localhost\r\nx-slow: ").expect("it reads");
    }
    let (living, last) = drip(&mut connections, b"a", Duration::from_secs(8));
    let times = small.end();
    println!("300 dripping heads: the last was ended after {last:.2?}; beside them {times}");
    assert_eq!(living, 0);
    service.lives();
}

#[test]
fn bodies_that_drip_in_or_stop_are_refused_by_name_of_the_limit() {
    let _alone = alone();
    let mut service = Service::start(&["--request-timeout-seconds", "2", "--stall-timeout-seconds", "1"]);
    let small = Small::begin(&service.address);
    let head = "POST /v1/radiance HTTP/1.1\r\nhost: localhost\r\ncontent-type: application/json\r\n\
                content-length: 100000\r\n\r\n{";
    let begin = Instant::now();
    thread::scope(|scope| {
        let stopped = scope.spawn(|| {
            let detail = service.ask(head.as_bytes()).problem(408);
            println!("a body that stopped: {:.2?}: {detail}", begin.elapsed());
            detail
        });
        let mut dripping = service.connect();
        dripping.send(head.as_bytes()).expect("it reads");
        // Not to the very end: a byte to a connection that is closed would be answered by its reset.
        while begin.elapsed() < Duration::from_millis(1800) {
            dripping.send(b" ").expect("it reads");
            thread::sleep(Duration::from_millis(50));
        }
        let detail = dripping.answer().expect("an answer").problem(408);
        println!("a body that drips: {:.2?}: {detail}", begin.elapsed());
        assert!(detail.contains("2 s"), "{detail}");
        let detail = stopped.join().expect("an answer");
        assert!(detail.contains("1 s"), "{detail}");
    });
    println!("beside them {}", small.end());
    service.lives();
}

#[test]
fn a_client_that_does_not_read_is_let_go_and_costs_little_memory() {
    let _alone = alone();
    let mut service = Service::start(&["--stall-timeout-seconds", "2"]);
    service.lives();
    let idle = service.memory();
    let small = Small::begin(&service.address);
    let descriptors = service.settled_descriptors();
    let path =
        format!("/v1/diagrams?{QUERY}&sweep=theta_r_deg&from_deg=-80&to_deg=80&points=1000000&at_deg=0,30");
    let mut readers: Vec<_> = (0..4).map(|_| service.connect()).collect();
    for reader in &mut readers {
        reader.send(&get(&path, "accept: text/csv\r\n")).expect("it reads");
    }
    until(Duration::from_secs(20), "all of them are accepted", || service.descriptors() >= descriptors + 4);
    let begin = Instant::now();
    let mut peak = idle;
    until(Duration::from_secs(40), "all of them are let go", || {
        peak = peak.max(service.memory());
        service.descriptors() <= descriptors
    });
    println!(
        "4 clients that read nothing of 2,000,000 rows: let go after {:.2?}, peak {:.0} MiB above {idle:.0}; \
         beside them {}",
        begin.elapsed(),
        peak - idle,
        small.end()
    );
    assert!(peak - idle < 200.0);
    for reader in &mut readers {
        assert!(reader.is_closed());
    }
    service.lives();
}

#[test]
fn one_request_after_the_other_may_be_slow_if_each_moves() {
    let _alone = alone();
    let service = Service::start(&["--idle-timeout-seconds", "1"]);
    let mut connection = service.connect();
    let body = format!(r#"{{{SCENE},"geometry":{{"theta_i_deg":30,"theta_r_deg":30}}}}"#);
    let request = crate::client::post_json("/v1/radiance", body.as_bytes());
    for _ in 0..4 {
        // In pieces, each within the limit.
        for part in request.chunks(request.len() / 3 + 1) {
            connection.send(part).expect("it reads");
            thread::sleep(Duration::from_millis(150));
        }
        assert_eq!(connection.answer().expect("an answer").status, 200);
        thread::sleep(Duration::from_millis(400));
    }
    // And is let go once it does not.
    connection.patience(Duration::from_secs(5));
    assert!(connection.is_closed());
}
