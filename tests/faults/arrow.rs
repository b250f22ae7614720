//! Column bodies that are broken: the streams of a real writer, cut and with bits turned over.

use crate::alone;
use crate::client::{Connection, QUERY, post};
use crate::load::Small;
use crate::process::Service;
use arrow_array::{ArrayRef, Float64Array, RecordBatch};
use arrow_ipc::writer::StreamWriter;
use std::collections::BTreeMap;
use std::sync::Arc;

const ARROW: &str = "application/vnd.apache.arrow.stream";

/// A stream of directions, in several batches.
fn stream(batches: usize) -> Vec<u8> {
    let column = |factor: f64| {
        let angles = (0..20).map(|index| f64::from(index) * factor);
        Arc::new(Float64Array::from_iter_values(angles)) as ArrayRef
    };
    let batch = RecordBatch::try_from_iter([
        ("theta_i_deg", column(4.0)),
        ("theta_r_deg", column(3.0)),
        ("phi_r_deg", column(18.0)),
    ])
    .expect("columns of one length");
    let mut writer = StreamWriter::try_new(Vec::new(), &batch.schema()).expect("memory");
    for _ in 0..batches {
        writer.write(&batch).expect("memory");
    }
    writer.finish().expect("memory");
    writer.into_inner().expect("memory")
}

/// An npy file of directions.
fn npy() -> Vec<u8> {
    let mut head = "{'descr': [('theta_i_deg', '<f8'), ('theta_r_deg', '<f8')], 'fortran_order': False, \
                    'shape': (20,), }"
        .to_owned();
    while !(10 + head.len() + 1).is_multiple_of(64) {
        head.push(' ');
    }
    head.push('\n');
    let length = u16::try_from(head.len()).expect("a short head");
    let mut file = b"\x93NUMPY\x01\x00".to_vec();
    file.extend(length.to_le_bytes());
    file.extend(head.as_bytes());
    for angle in 0..20 {
        file.extend(f64::from(angle).to_le_bytes());
        file.extend(f64::from(2 * angle).to_le_bytes());
    }
    file
}

fn csv() -> Vec<u8> {
    let rows: Vec<String> = (0..20).map(|angle| format!("{angle},{},0.5\r\n", 2 * angle)).collect();
    let rows = rows.concat();
    format!("theta_i_deg,theta_r_deg,phi_r_deg\r\n{rows}").into_bytes()
}

/// Sends one, on a connection that is kept.
fn status(connection: &mut Connection, service: &Service, media_type: &str, body: &[u8]) -> u16 {
    let path = format!("/v1/radiance?{QUERY}");
    let request = post(&path, &format!("content-type: {media_type}\r\n"), body);
    connection.send(&request).expect("it reads");
    let answer = connection.answer().expect("an answer");
    if answer.closes() {
        *connection = service.connect();
    }
    if answer.status >= 400 {
        // Every one of them says what is wrong.
        assert!(!answer.problem(answer.status).is_empty());
    }
    answer.status
}

#[test]
fn broken_columns_are_refused() {
    let _alone = alone();
    let mut service = Service::start(&[]);
    service.lives();
    let idle = service.memory();
    let small = Small::begin(&service.address);
    let mut connection = service.connect();
    for (media_type, body) in [(ARROW, stream(2)), ("application/x-npy", npy()), ("text/csv", csv())] {
        let mut counts: BTreeMap<u16, usize> = BTreeMap::new();
        let mut send = |body: &[u8]| status(&mut connection, &service, media_type, body);
        assert_eq!(send(&body), 200, "{media_type}");
        for length in 0..body.len() {
            *counts.entry(send(&body[..length])).or_default() += 1;
        }
        // Every bit of the first part, which holds lengths, offsets and types, then some of the rest.
        let bits = (0..8 * body.len()).filter(|bit| *bit < 8 * 700 || bit % 29 == 0);
        for bit in bits {
            let mut broken = body.clone();
            broken[bit / 8] ^= 1 << (bit % 8);
            *counts.entry(send(&broken)).or_default() += 1;
        }
        // Lengths that no memory holds, at every place where one may stand.
        for at in (0..body.len().min(1500).saturating_sub(8)).step_by(4) {
            for value in [u64::MAX, u64::MAX >> 1, 1 << 40, 1 << 31, (1 << 31) - 1] {
                let mut broken = body.clone();
                broken[at..at + 8].copy_from_slice(&value.to_le_bytes());
                *counts.entry(send(&broken)).or_default() += 1;
            }
        }
        println!("broken {media_type}: {counts:?}");
        assert!(counts.keys().all(|status| matches!(status, 200 | 400 | 413 | 415 | 422)), "{counts:?}");
    }
    let after = service.settled_memory();
    println!("broken columns: memory {idle:.1} MiB, afterwards {after:.1}; beside them {}", small.end());
    assert!(after - idle < 20.0);
    service.lives();
}
