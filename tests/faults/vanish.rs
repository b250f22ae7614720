//! Clients that leave before their answer is complete.

use crate::alone;
use crate::client::{QUERY, get, many, post_json};
use crate::process::{Service, until};
use std::thread;
use std::time::Duration;

/// Processor time that the service may take after its client left: ten milliseconds on each of two processors.
const ALLOWED: Duration = Duration::from_millis(20);

/// The processor time that it takes in the next half second.
fn taken_from_now(service: &Service) -> Duration {
    let before = service.work();
    thread::sleep(Duration::from_millis(500));
    service.work().since(&before)
}

/// Sends a request, leaves as soon as work has begun, and says what the service still took.
fn leave(service: &Service, request: &[u8], after: Duration) -> Duration {
    let before = service.work();
    let mut connection = service.connect();
    connection.send(request).expect("it reads");
    until(Duration::from_secs(20), "work begins", || {
        connection.discard();
        service.work().since(&before) > after
    });
    drop(connection);
    taken_from_now(service)
}

#[test]
fn a_client_that_leaves_takes_its_work_along() {
    let _alone = alone();
    let mut service = Service::start(&[]);
    service.lives();
    let batch = post_json("/v1/radiance", &many(1_000_000));
    let rows = "sweep=theta_r_deg&from_deg=-80&to_deg=80&points=1000000&at_deg=0,10,20,30,40,50,60,70,80,85";
    let link = format!("/v1/diagrams?{QUERY}&{rows}");
    let exhaustive = format!("{link}&method=series&relative_tolerance=1e-15");
    for (what, request, after) in [
        ("a batch that is being read", &batch, 30),
        ("a batch that is being computed", &batch, 150),
        ("a diagram of ten million rows", &get(&link, "accept: text/csv\r\n"), 200),
        ("the same as JSON", &get(&link, ""), 200),
        ("the same by the full series", &get(&exhaustive, "accept: text/csv\r\n"), 200),
    ] {
        let mut taken: Vec<_> =
            (0..3).map(|_| leave(&service, request, Duration::from_millis(after))).collect();
        taken.sort_unstable();
        println!("after a client left {what}, processor time in all: {taken:.1?}");
        // The machine is shared: the median.
        assert!(taken[1] < ALLOWED, "{what}: {taken:?}");
    }
    service.lives();
}

#[test]
fn clients_that_leave_in_crowds_leave_nothing_behind() {
    let _alone = alone();
    let mut service = Service::start(&[]);
    service.lives();
    let (idle, descriptors) = (service.memory(), service.descriptors());
    let request = post_json("/v1/radiance", &many(100_000));
    for round in 0..40 {
        let mut connections: Vec<_> = (0..10).map(|_| service.connect()).collect();
        for (index, connection) in connections.iter_mut().enumerate() {
            // Some leave in the middle of their own request.
            let end = if index % 3 == 0 { request.len() * index / 10 } else { request.len() };
            connection.send(&request[..end]).expect("it reads");
        }
        thread::sleep(Duration::from_millis(round));
    }
    until(Duration::from_secs(10), "all are let go", || service.descriptors() <= descriptors);
    let busy = taken_from_now(&service);
    let after = service.settled_memory();
    println!(
        "400 clients that left: memory {idle:.1} MiB, afterwards {after:.1}; busy for {busy:.1?} of 500 ms"
    );
    assert!(busy < Duration::from_millis(50), "{busy:?}");
    service.lives();
}
