//! Is any bound ever exceeded, and how idle are they? Every method of the lobe series against the
//! converged sum, over points drawn densely where methods end:
//!
//! `cargo run --release --example bounds -- 10000000`
//!
//! Exits with 1 if a bound is exceeded. A second argument is the seed.

mod census;
mod points;

use census::Census;
use std::process::ExitCode;

fn main() -> ExitCode {
    let mut arguments = std::env::args().skip(1).map(|a| a.parse::<u64>());
    let (Ok(count), Ok(seed)) =
        (arguments.next().unwrap_or(Ok(1_000_000)), arguments.next().unwrap_or(Ok(1)))
    else {
        eprintln!("usage: bounds [points [seed]]");
        return ExitCode::from(2);
    };
    let threads = std::thread::available_parallelism().map_or(1, |n| n.get() as u64);
    let census = std::thread::scope(|scope| {
        let workers: Vec<_> = (0..threads)
            .map(|i| scope.spawn(move || Census::take(count.div_ceil(threads), seed * threads + i)))
            .collect();
        workers.into_iter().filter_map(|worker| worker.join().ok()).reduce(|mut all, one| {
            all.merge(&one);
            all
        })
    });
    let Some(census) = census else {
        eprintln!("a thread failed");
        return ExitCode::from(2);
    };
    report(&census, count);
    if census.all().all(|seen| seen.violations == 0) { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}

fn report(census: &Census, count: u64) {
    println!(
        "{count} points; a method serves where its bound is 0.5 or less and its error above 1e-14. between: high/low\n"
    );
    println!(
        "| method | violations | points where it serves | largest error/bound | median bound/error | largest | at g, x |"
    );
    println!("| --- | --- | --- | --- | --- | --- | --- |");
    for seen in census.all() {
        let (worst, g, x) = seen.most_idle;
        let (name, median) = (&seen.name, seen.median());
        let (violations, share, useful) = (seen.violations, seen.largest_share, seen.useful);
        println!(
            "| {name} | {violations} | {useful} | {share:.4} | {median:.3} | {worst:.3e} | {g:e}, {x:e} |"
        );
    }
    for example in census.all().flat_map(|seen| &seen.examples) {
        println!("{example}");
    }
}
