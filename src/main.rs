//! The `reflectance` service: arguments, logs, listen, serve until told to stop.

use clap::Parser as _;
use clap::error::ErrorKind;
use reflectance::config::{self, Cli, Command, Config};
use reflectance::http;
use reflectance::logs::Logs;
use std::io::Write as _;
use std::process::ExitCode;
use tokio::net::TcpListener;

/// Memory that was freed goes back to the system soon: `.cargo/config.toml` says how soon. The system's allocator keeps
/// what many large requests, or many connections, once needed.
#[global_allocator]
static ALLOCATOR: tikv_jemallocator::Jemalloc = tikv_jemallocator::Jemalloc;

/// Connections that may wait to be accepted, if the system allows as many.
const BACKLOG: i32 = 4096;

/// Steps of connections between two looks at what has arrived. A step of a large body takes a tenth of a millisecond, and
/// meanwhile small requests are not even seen.
const EVENT_INTERVAL: u32 = 8;

/// The exit code of a configuration that cannot be served.
const UNUSABLE: u8 = 2;

fn main() -> ExitCode {
    let cli = match Cli::try_parse() {
        Ok(cli) => cli,
        Err(error) if matches!(error.kind(), ErrorKind::DisplayHelp | ErrorKind::DisplayVersion) => {
            error.exit()
        }
        Err(error) => return fail(&config::explain(&error)),
    };
    match cli.command {
        Some(Command::Openapi) => print(&http::openapi_json()),
        None => serve(&cli.config),
    }
}

fn serve(config: &Config) -> ExitCode {
    let _logs = Logs::begin(&config.telemetry);
    let mut runtime = tokio::runtime::Builder::new_multi_thread();
    let runtime = match runtime.event_interval(EVENT_INTERVAL).enable_all().build() {
        Ok(runtime) => runtime,
        Err(error) => return fail(&format!("cannot start threads: {error}")),
    };
    let code = runtime.block_on(listen(config));
    // Dropping the runtime would wait for work that nobody is waiting for any more.
    runtime.shutdown_background();
    code
}

async fn listen(config: &Config) -> ExitCode {
    let service = match http::Service::prepare(config) {
        Ok(service) => service,
        Err(reason) => return fail(&reason),
    };
    let bound = TcpListener::bind(&config.listen).await;
    // Anew with a longer queue: where it is full, clients wait for seconds or are forgotten.
    let queued = bound
        .and_then(|listener| rustix::net::listen(&listener, BACKLOG).map(|()| listener).map_err(Into::into));
    let listener = match queued {
        Ok(listener) => listener,
        Err(error) => {
            let reason = "set by --listen or REFLECTANCE_LISTEN; see --help";
            return fail(&format!("cannot listen on {}: {error} ({reason})", config.listen));
        }
    };
    let address = match listener.local_addr() {
        Ok(address) => address,
        Err(error) => return fail(&format!("cannot tell the address of {}: {error}", config.listen)),
    };
    let signals = match http::Signals::catch() {
        Ok(signals) => signals,
        Err(error) => return fail(&format!("cannot catch signals: {error}")),
    };
    if print(&http::greeting(service.scheme(), address)) != ExitCode::SUCCESS {
        return ExitCode::FAILURE;
    }
    if service.serve(listener, signals).await { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}

/// Writes to standard output; a closed pipe is an exit code, not a panic.
fn print(text: &str) -> ExitCode {
    let mut out = std::io::stdout().lock();
    match out.write_all(text.as_bytes()).and_then(|()| out.flush()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(_) => ExitCode::FAILURE,
    }
}

fn fail(reason: &str) -> ExitCode {
    eprintln!("reflectance: {reason}");
    ExitCode::from(UNUSABLE)
}
