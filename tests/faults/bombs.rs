//! Compressed bodies that expand to far more than the limit.

use crate::alone;
use crate::client::{SCENE, post};
use crate::load::Small;
use crate::process::Service;
use std::io::Write;
use std::thread;
use std::time::Instant;

/// How much they expand to: four times the limit.
const EXPANDED: usize = 256 << 20;

/// A piece of JSON that is nothing but space.
static SPACE: [u8; 1 << 20] = [b' '; 1 << 20];

fn gzip(write: impl FnOnce(&mut dyn Write)) -> Vec<u8> {
    let mut encoder = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::fast());
    write(&mut encoder);
    encoder.finish().expect("memory")
}

fn brotli(write: impl FnOnce(&mut dyn Write)) -> Vec<u8> {
    let mut packed = Vec::new();
    let mut encoder = brotli::CompressorWriter::new(&mut packed, 64 << 10, 5, 22);
    write(&mut encoder);
    drop(encoder);
    packed
}

fn zstd(write: impl FnOnce(&mut dyn Write)) -> Vec<u8> {
    let mut encoder = zstd::Encoder::new(Vec::new(), 1).expect("memory");
    write(&mut encoder);
    encoder.finish().expect("memory")
}

/// A frame that wants a window of 2 GiB before it says anything.
fn wide_zstd() -> Vec<u8> {
    // Magic number; a frame descriptor without size, checksum or dictionary; window 2^(10 + 21); one raw
    // block, the last, of two bytes.
    vec![0x28, 0xb5, 0x2f, 0xfd, 0x00, 21 << 3, 0x11, 0x00, 0x00, b'{', b'}']
}

fn request(encoding: &str, body: &[u8]) -> Vec<u8> {
    post("/v1/radiance", &format!("content-type: application/json\r\ncontent-encoding: {encoding}\r\n"), body)
}

#[test]
fn bombs_cost_no_more_than_the_limit() {
    let _alone = alone();
    let mut service = Service::start(&[]);
    service.lives();
    let idle = service.memory();
    let small = Small::begin(&service.address);
    let bomb = |out: &mut dyn Write| {
        for _ in 0..EXPANDED >> 20 {
            out.write_all(&SPACE).expect("memory");
        }
    };
    let mut peak = idle;
    for (encoding, packed) in [("gzip", gzip(bomb)), ("br", brotli(bomb)), ("zstd", zstd(bomb))] {
        let request = request(encoding, &packed);
        let begin = Instant::now();
        let detail = service.ask(&request).problem(413);
        let alone = begin.elapsed();
        assert!(detail.contains("67108864"), "{detail}");
        // And twenty at once.
        let begin = Instant::now();
        thread::scope(|scope| {
            let askers: Vec<_> = (0..20).map(|_| scope.spawn(|| service.ask(&request).status)).collect();
            while !askers.iter().all(thread::ScopedJoinHandle::is_finished) {
                peak = peak.max(service.memory());
                thread::sleep(std::time::Duration::from_millis(5));
            }
            for asker in askers {
                let status = asker.join().expect("an answer");
                // Refused, or sent away because the others are at work.
                assert!(matches!(status, 413 | 503), "{status}");
            }
        });
        println!(
            "{encoding} bomb of {} bytes for {EXPANDED}: {alone:.2?} alone, 20 at once {:.2?}, peak {peak:.0} MiB",
            packed.len(),
            begin.elapsed()
        );
    }
    let after = service.settled_memory();
    println!(
        "bombs: memory {idle:.1} MiB, peak {peak:.1}, afterwards {after:.1}; beside them {}",
        small.end()
    );
    // As many as may be at work at once by default, each with the limit of 64 MiB in hand, as much that it grew out of and
    // that the allocator keeps for a second, and beside it the largest window, 16 MiB, and half as much again.
    assert!(peak - idle < 8.0 * (64.0 + 64.0 + 24.0), "{peak}");
    service.lives();
}

#[test]
fn a_packed_body_that_is_broken_is_refused() {
    let _alone = alone();
    let mut service = Service::start(&[]);
    let scene = format!(r#"{{{SCENE},"geometry":{{"theta_i_deg":30,"theta_r_deg":30}}}}"#);
    let write = |out: &mut dyn Write| out.write_all(scene.as_bytes()).expect("memory");
    for (encoding, packed) in [("gzip", gzip(write)), ("br", brotli(write)), ("zstd", zstd(write))] {
        assert_eq!(service.ask(&request(encoding, &packed)).status, 200, "{encoding}");
        for length in [0, 1, 5, packed.len() / 2, packed.len() - 1] {
            service.ask(&request(encoding, &packed[..length])).problem(400);
        }
        for bit in 0..8 * packed.len() {
            let mut broken = packed.clone();
            broken[bit / 8] ^= 1 << (bit % 8);
            let status = service.ask(&request(encoding, &broken)).status;
            // A flipped bit in the frame's head may change nothing, one in the text may still be JSON.
            assert!(matches!(status, 200 | 400 | 413 | 415 | 422), "{encoding} bit {bit}: {status}");
        }
        service.ask(&request(encoding, b"not packed at all, by no means")).problem(400);
    }
    service.ask(&request("zstd", &wide_zstd())).problem(400);
    for encoding in ["compress", "gzip, gzip", "gzip, br", "x-unknown"] {
        service.ask(&request(encoding, &gzip(write))).problem(415);
    }
    service.lives();
}
