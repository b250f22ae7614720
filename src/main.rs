//! The `reflectance` service: arguments, logs, threads, exit codes.

use clap::Parser as _;
use clap::error::ErrorKind;
use reflectance::config::{self, Cli, Command, Config};
use reflectance::logs::Logs;
use reflectance::{health, http};
use std::io::{self, Write as _};
use std::process::ExitCode;

/// Memory that was freed goes back to the system soon: `.cargo/config.toml` says how soon. The system's allocator keeps
/// what many large requests, or many connections, once needed.
#[global_allocator]
static ALLOCATOR: tikv_jemallocator::Jemalloc = tikv_jemallocator::Jemalloc;

/// Steps of connections between two looks at what has arrived. A step of a large body takes a tenth of a millisecond, and
/// meanwhile small requests are not even seen.
const EVENT_INTERVAL: u32 = 8;

/// The exit code of a configuration that cannot be served.
const UNUSABLE: u8 = 2;

/// The exit code of a service that is not ready.
const NOT_READY: u8 = 1;

fn main() -> ExitCode {
    let cli = match Cli::try_parse() {
        Ok(cli) => cli,
        Err(error) if matches!(error.kind(), ErrorKind::DisplayHelp | ErrorKind::DisplayVersion) => {
            error.exit()
        }
        Err(error) => return fail(&config::explain(&error), UNUSABLE),
    };
    match cli.command {
        Some(Command::Openapi) => {
            print(&http::openapi_json()).map_or(ExitCode::FAILURE, |()| ExitCode::SUCCESS)
        }
        Some(Command::Health(probe)) => health::check(&cli.config, &probe)
            .map_or_else(|reason| fail(&reason, NOT_READY), |()| ExitCode::SUCCESS),
        None => serve(&cli.config),
    }
}

fn serve(config: &Config) -> ExitCode {
    let _logs = Logs::begin(&config.telemetry);
    let mut runtime = tokio::runtime::Builder::new_multi_thread();
    let runtime = match runtime.event_interval(EVENT_INTERVAL).enable_all().build() {
        Ok(runtime) => runtime,
        Err(error) => return fail(&format!("cannot start threads: {error}"), UNUSABLE),
    };
    let ended = runtime.block_on(http::run(config, print));
    // Dropping the runtime would wait for work that nobody is waiting for any more.
    runtime.shutdown_background();
    match ended {
        Ok(true) => ExitCode::SUCCESS,
        Ok(false) => ExitCode::FAILURE,
        Err(reason) => fail(&reason, UNUSABLE),
    }
}

/// Writes to standard output; a closed pipe is an exit code, not a panic.
fn print(text: &str) -> io::Result<()> {
    let mut out = io::stdout().lock();
    out.write_all(text.as_bytes())?;
    out.flush()
}

fn fail(reason: &str, code: u8) -> ExitCode {
    eprintln!("reflectance: {reason}");
    ExitCode::from(code)
}
