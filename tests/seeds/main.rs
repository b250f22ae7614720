//! What the fuzz targets do, on their committed seeds and on what little changes make of them: without the nightly
//! compiler that fuzzing itself needs. `UPDATE_SEEDS=1` writes them.

mod made;
#[path = "../../fuzz/src/planner.rs"]
#[expect(unreachable_pub, reason = "a module of the library that the targets link")]
mod planner;
#[path = "../../fuzz/src/scenes.rs"]
#[expect(unreachable_pub, reason = "a module of the library that the targets link")]
mod scenes;
#[path = "../../fuzz/src/service.rs"]
#[expect(unreachable_pub, reason = "a module of the library that the targets link")]
mod service;
#[path = "../../fuzz/src/targets.rs"]
#[expect(unreachable_pub, reason = "a module of the library that the targets link")]
mod targets;

use arbitrary::{Arbitrary as _, Unstructured};
use std::fs;
use std::path::Path;

/// Changed copies of each seed.
const COPIES: usize = 60;
/// Scenes that are planned.
const SCENES: usize = 4000;

/// Pseudo-random numbers, the same in every run: xorshift.
struct Random(u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        self.0
    }

    fn below(&mut self, end: usize) -> usize {
        usize::try_from(self.next() % end.max(1) as u64).expect("below a usize")
    }

    fn byte(&mut self) -> u8 {
        self.next().to_le_bytes()[3]
    }
}

/// Cut, with a byte changed, a stretch repeated or taken out.
fn changed(seed: &[u8], random: &mut Random) -> Vec<u8> {
    let mut bytes = seed.to_vec();
    let (first, second) = (random.below(bytes.len()), random.below(bytes.len()));
    let stretch = first.min(second)..first.max(second).min(first.min(second) + 40);
    match random.below(5) {
        0 => bytes.truncate(first),
        1 => drop(bytes.drain(stretch)),
        2 => bytes.extend_from_within(stretch),
        3 => bytes.insert(first, random.byte()),
        _ if bytes.is_empty() => {}
        _ => bytes[first] = random.byte(),
    }
    bytes
}

#[test]
fn seeds_and_what_becomes_of_them_are_answered() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("fuzz/seeds");
    if std::env::var_os("UPDATE_SEEDS").is_some() {
        made::write_all(&folder).expect("a folder to write to");
    }
    let mut random = Random(0x9e37_79b9_7f4a_7c15);
    for (name, target) in targets::TARGETS {
        let mut seeds = 0;
        for entry in fs::read_dir(folder.join(name)).expect("seeds").flatten() {
            let seed = fs::read(entry.path()).expect("a file");
            target(&seed);
            for _ in 0..COPIES {
                target(&changed(&seed, &mut random));
            }
            seeds += 1;
        }
        assert!(seeds >= 2, "{name}: {seeds} seeds");
    }
}

#[test]
fn what_is_planned_is_what_is_done() {
    let mut random = Random(0x2545_f491_4f6c_dd1d);
    let mut accepted = 0;
    for _ in 0..SCENES {
        let bytes: Vec<_> = (0..200).map(|_| random.byte()).collect();
        let scene = scenes::Scene::arbitrary(&mut Unstructured::new(&bytes)).expect("enough bytes");
        accepted += usize::from(planner::plan(&scene));
    }
    println!("{accepted} of {SCENES} scenes were accepted");
    assert!(accepted > SCENES / 50, "{accepted} of {SCENES} scenes were accepted");
}
