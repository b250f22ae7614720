//! What a batch costs at least: decoding its angles, evaluating them, encoding the answer's numbers, each alone on
//! one thread. `scripts/load.sh` sets the service beside the sum.
//!
//! `floors bodies DIRECTORY COUNT` writes one request of so many directions in every format;
//! `floors measure DIRECTORY COUNT ROUNDS` prints the processor seconds of each part, one JSON object a round.

mod batch;
mod bodies;

use batch::{angles, directions, scene};
use reflectance::reflectance::directions::Directions;
use reflectance::reflectance::evaluate::{Evaluation, Output, Quantity, evaluate};
use reflectance::reflectance::scene::Scene;
use rustix::time::{ClockId, clock_gettime};
use serde::{Deserialize, Serialize};
use std::hint::black_box;
use std::path::Path;

type Failure = Box<dyn std::error::Error + Send + Sync>;

fn main() -> Result<(), Failure> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    match arguments.iter().map(String::as_str).collect::<Vec<_>>()[..] {
        ["bodies", directory, count] => bodies::write(Path::new(directory), &angles(count.parse()?)),
        ["measure", directory, count, rounds] => {
            measure(Path::new(directory), count.parse()?, rounds.parse()?)
        }
        _ => Err("usage: floors bodies DIRECTORY COUNT | floors measure DIRECTORY COUNT ROUNDS".into()),
    }
}

/// What is read of a request: its angles.
#[derive(Deserialize)]
struct Request {
    geometry: Geometry,
}

#[derive(Deserialize)]
#[expect(clippy::struct_field_names, reason = "as the request has them")]
struct Geometry {
    theta_i_deg: Vec<f64>,
    theta_r_deg: Vec<f64>,
    phi_r_deg: Vec<f64>,
}

/// Processor seconds of each part, once.
#[derive(Serialize)]
struct Parts {
    decode: f64,
    decode_short: f64,
    kernel: f64,
    encode: f64,
}

fn measure(directory: &Path, count: usize, rounds: usize) -> Result<(), Failure> {
    let full = std::fs::read(directory.join(format!("{count}.json")))?;
    let short = std::fs::read(directory.join(format!("{count}.short.json")))?;
    let (scene, directions) = (scene()?, directions(&angles(count))?);
    // All on the one thread of a pool: the kernel shares its directions out among the threads that it finds.
    let alone = rayon::ThreadPoolBuilder::new().num_threads(1).build()?;
    alone.install(|| {
        let mut bytes = Vec::new();
        // The first round is to fill the caches and to size the buffer.
        for round in 0..=rounds {
            let parts = parts([&full, &short], &scene, &directions, &mut bytes)?;
            if round > 0 {
                println!("{}", serde_json::to_string(&parts)?);
            }
        }
        Ok(())
    })
}

fn parts(
    [full, short]: [&[u8]; 2],
    scene: &Scene,
    directions: &Directions,
    bytes: &mut Vec<u8>,
) -> Result<Parts, Failure> {
    let (decode, all_digits) = seconds(|| decoded(full));
    let (decode_short, six_decimals) = seconds(|| decoded(short));
    if all_digits? != directions.count() || six_decimals? != directions.count() {
        return Err("the bodies are not of this request".into());
    }
    let evaluated =
        || evaluate(black_box(scene), black_box(directions), Quantity::Radiance, Output::default());
    let (kernel, evaluation) = seconds(evaluated);
    bytes.clear();
    let (encode, encoding) = seconds(|| encoded(&evaluation, bytes));
    encoding?;
    Ok(Parts { decode, decode_short, kernel, encode })
}

/// The number of directions in a body.
fn decoded(body: &[u8]) -> Result<usize, serde_json::Error> {
    let Request { geometry } = serde_json::from_slice(black_box(body))?;
    black_box((&geometry.theta_i_deg, &geometry.phi_r_deg));
    Ok(geometry.theta_r_deg.len())
}

/// The answer's columns as JSON arrays, into memory that is there already.
fn encoded(evaluation: &Evaluation, bytes: &mut Vec<u8>) -> Result<(), serde_json::Error> {
    serde_json::to_writer(&mut *bytes, &evaluation.total)?;
    for component in &evaluation.components {
        serde_json::to_writer(&mut *bytes, &component.values)?;
    }
    serde_json::to_writer(&mut *bytes, &evaluation.relative_error_bound)?;
    black_box(bytes);
    Ok(())
}

/// Processor time of the calling thread.
fn seconds<T>(work: impl FnOnce() -> T) -> (f64, T) {
    let now = || {
        let time = clock_gettime(ClockId::ThreadCPUTime);
        time.tv_sec as f64 + time.tv_nsec as f64 * 1e-9
    };
    let before = now();
    let value = work();
    (now() - before, value)
}
