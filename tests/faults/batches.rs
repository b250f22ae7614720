//! A hundred of the largest requests at once.

use crate::alone;
use crate::client::{many, post_json, small};
use crate::load::Small;
use crate::process::Service;
use std::collections::BTreeMap;
use std::thread;
use std::time::{Duration, Instant};

const BATCHES: usize = 100;

#[test]
fn a_hundred_maximal_batches_leave_the_service_as_it_was() {
    let _alone = alone();
    let mut service = Service::start(&[]);
    // Warm: what it keeps for good it has by now.
    for _ in 0..200 {
        assert_eq!(service.ask(&small()).status, 200);
    }
    let idle = service.settled_memory();
    let request = post_json("/v1/radiance", &many(1_000_000));
    let small = Small::begin(&service.address);
    let begin = Instant::now();
    let mut peak = idle;
    let mut counts: BTreeMap<u16, usize> = BTreeMap::new();
    thread::scope(|scope| {
        let batch = || {
            let mut connection = service.connect();
            // One that is turned away may be told so before it has sent all.
            let sent = connection.send(&request);
            let answer = connection.answer_dropped();
            answer.unwrap_or_else(|error| panic!("{error}, after sending {sent:?}"))
        };
        let batches: Vec<_> = (0..BATCHES).map(|_| scope.spawn(batch)).collect();
        while !batches.iter().all(thread::ScopedJoinHandle::is_finished) {
            peak = peak.max(service.memory());
            thread::sleep(Duration::from_millis(10));
        }
        for batch in batches {
            let answer = batch.join().expect("an answer");
            if answer.status == 503 {
                assert!(answer.header("retry-after").is_some(), "{}", answer.head);
            }
            *counts.entry(answer.status).or_default() += 1;
        }
    });
    let taken = begin.elapsed();
    let times = small.end();
    let end = Instant::now();
    // The allocator gives back within a second or two; a thread that read bodies ends after ten without any.
    while service.memory() > 1.2 * idle && end.elapsed() < Duration::from_secs(20) {
        thread::sleep(Duration::from_millis(100));
    }
    let (after, later) = (service.memory(), end.elapsed());
    println!(
        "{BATCHES} batches of 1,000,000 directions: {counts:?} within {taken:.1?}; memory {idle:.1} MiB, peak {peak:.1}, \
         {after:.1} {later:.1?} afterwards; beside them {times}"
    );
    assert!(counts.keys().all(|status| matches!(status, 200 | 503)), "{counts:?}");
    assert!(counts.get(&200).is_some_and(|count| *count >= 8), "{counts:?}");
    assert!(after <= 1.2 * idle, "{after} MiB after, {idle} before");
    service.lives();
}
