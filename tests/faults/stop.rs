//! SIGTERM under load.

use crate::alone;
use crate::client::{Connection, many, post_json, small};
use crate::process::Service;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread;
use std::time::{Duration, Instant};

/// How the clients' requests went.
#[derive(Default)]
struct Tally {
    answered: AtomicUsize,
    otherwise: AtomicUsize,
    failed: AtomicUsize,
    /// Failed as the first of a connection, when the port was closed.
    late: AtomicUsize,
}

impl Tally {
    fn counts(&self) -> [usize; 4] {
        [&self.answered, &self.otherwise, &self.failed, &self.late].map(|count| count.load(Ordering::Relaxed))
    }
}

/// Asks until the port is closed. A connection that the server said it would close is not used again.
fn keep_asking(address: &str, request: &[u8], tally: &Tally) {
    while let Ok(mut connection) = Connection::open(address) {
        for place in 0.. {
            let answer = connection.send(request).and_then(|()| connection.answer_dropped());
            let count = match &answer {
                Ok(answer) if answer.status == 200 => &tally.answered,
                Ok(_) => &tally.otherwise,
                Err(_) if place == 0 && Connection::open(address).is_err() => &tally.late,
                Err(_) => &tally.failed,
            };
            count.fetch_add(1, Ordering::Relaxed);
            if answer.map_or(true, |answer| answer.closes()) {
                break;
            }
        }
    }
}

#[test]
fn a_stop_under_load_fails_no_accepted_request() {
    let _alone = alone();
    let mut service = Service::start(&["--drain-delay-seconds", "1", "--shutdown-timeout-seconds", "20"]);
    let address = service.address.clone();
    let tally = Tally::default();
    let (small, large) = (small(), post_json("/v1/radiance", &many(20_000)));
    let (status, taken) = thread::scope(|scope| {
        for client in 0..32 {
            let request = if client % 8 == 0 { &large } else { &small };
            let (address, tally) = (&address, &tally);
            scope.spawn(move || keep_asking(address, request, tally));
        }
        thread::sleep(Duration::from_secs(1));
        service.terminate();
        let begin = Instant::now();
        (service.ended(Duration::from_secs(25)), begin.elapsed())
    });
    let [answered, otherwise, failed, late] = tally.counts();
    println!(
        "SIGTERM under load: {answered} answered, {otherwise} answered otherwise, {failed} failed, {late} late; \
         ended after {taken:.2?}, {status}"
    );
    assert!(answered > 100);
    assert_eq!((otherwise, failed), (0, 0));
    // The system may finish a handshake between the last accept and the close of the port: nobody accepted that one.
    assert!(late <= 1, "{late}");
    assert_eq!(status.code(), Some(0));
}
