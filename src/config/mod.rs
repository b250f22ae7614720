//! Flags and environment, parsed once into a typed [`Config`].

mod explain;
mod keys;
mod values;

pub use explain::explain;
pub use keys::{Key, KeysFile};

use crate::reflectance::bounds::{DEFAULT_INCIDENCES, MAX_DIRECTIONS, MAX_INCIDENCES, MAX_ROWS};
use clap::{Args, Parser, Subcommand, ValueEnum};
use std::num::NonZeroU32;
use std::path::PathBuf;
use std::time::Duration;
use values::{count, nonzero, seconds, seconds_or_none, size};

/// What the command line asks for.
#[derive(Debug, Parser)]
#[command(name = "reflectance", version, about, max_term_width = 100)]
pub struct Cli {
    /// A command; without one the service starts.
    #[command(subcommand)]
    pub command: Option<Command>,
    /// How the service runs.
    #[command(flatten)]
    pub config: Config,
}

/// Something to do instead of serving.
#[derive(Clone, Debug, Subcommand)]
pub enum Command {
    /// Print the `OpenAPI` document and exit
    Openapi,
    /// Ask a running service whether it is ready: exit code 0 if it is, 1 if not
    Health(Probe),
}

/// Whom to ask, and for how long.
#[derive(Clone, Debug, Args)]
pub struct Probe {
    /// Base URL of the service; when absent, the address of --listen or `REFLECTANCE_LISTEN` on this machine, by HTTPS if
    /// there is a certificate. No certificate is checked
    #[arg(long, value_name = "URL", value_parser = values::base_url)]
    pub url: Option<axum::http::Uri>,
    /// Seconds until no answer is one
    #[arg(long, default_value = "2", value_name = "SECONDS", allow_negative_numbers = true, value_parser = seconds)]
    pub timeout_seconds: Duration,
}

/// How the service runs. Every flag has an environment variable; the flag wins.
#[derive(Clone, Debug, Args)]
pub struct Config {
    /// Address and port to listen on; port 0 takes a free one
    #[arg(long, env = "REFLECTANCE_LISTEN", default_value = "127.0.0.1:8080", value_name = "ADDRESS:PORT")]
    pub listen: String,
    /// Who may ask, how often, and from which pages.
    #[command(flatten)]
    pub access: Access,
    /// What a request may be and take.
    #[command(flatten)]
    pub requests: Requests,
    /// What the service takes on at once.
    #[command(flatten)]
    pub capacity: Capacity,
    /// What connections may do.
    #[command(flatten)]
    pub connections: Connections,
    /// How it stops.
    #[command(flatten)]
    pub stopping: Stopping,
    /// What it says about itself.
    #[command(flatten)]
    pub telemetry: Telemetry,
}

/// Who may ask, how often, and from which pages.
#[derive(Clone, Debug, Args)]
#[command(next_help_heading = "Access")]
pub struct Access {
    /// File of bearer keys, one a line as `name key`; read again on SIGHUP. Without it anybody may ask
    #[arg(long, env = "REFLECTANCE_API_KEYS_FILE", value_name = "FILE", value_parser = KeysFile::open)]
    pub api_keys_file: Option<KeysFile>,
    /// Requests a second that one client (key, or address where there are no keys) may make on average. Without it,
    /// any number
    #[arg(long, env = "REFLECTANCE_RATE_LIMIT_PER_SECOND", value_name = "REQUESTS", allow_negative_numbers = true, value_parser = nonzero)]
    pub rate_limit_per_second: Option<NonZeroU32>,
    /// Requests that a client may make at once after a pause; the rate when absent
    #[arg(
        long,
        env = "REFLECTANCE_RATE_LIMIT_BURST",
        value_name = "REQUESTS", allow_negative_numbers = true,
        requires = "rate_limit_per_second",
        value_parser = nonzero
    )]
    pub rate_limit_burst: Option<NonZeroU32>,
    /// Origins whose pages may read answers (CORS), or `*`; given once each, or separated by commas
    #[arg(long, env = "REFLECTANCE_CORS_ORIGIN", value_name = "ORIGIN", value_delimiter = ',', value_parser = values::origin)]
    pub cors_origin: Vec<String>,
    /// Certificate chain, PEM: serves HTTPS alone; read again on SIGHUP
    #[arg(long, env = "REFLECTANCE_TLS_CERT", value_name = "FILE", requires = "tls_key")]
    pub tls_cert: Option<PathBuf>,
    /// Private key of the certificate, PEM
    #[arg(long, env = "REFLECTANCE_TLS_KEY", value_name = "FILE", requires = "tls_cert")]
    pub tls_key: Option<PathBuf>,
}

impl Access {
    /// Requests of one client in a second, and at once after a pause, if they are limited.
    pub(crate) fn rate_limit(&self) -> Option<[NonZeroU32; 2]> {
        let rate = self.rate_limit_per_second?;
        Some([rate, self.rate_limit_burst.unwrap_or(rate)])
    }
}

/// What a request may be and take.
#[derive(Clone, Debug, Args)]
#[command(next_help_heading = "Limits of a request")]
pub struct Requests {
    /// Largest request body, in bytes, as sent
    #[arg(long, env = "REFLECTANCE_BODY_LIMIT_BYTES", default_value_t = 64 << 20, value_name = "BYTES", allow_negative_numbers = true, value_parser = size)]
    pub body_limit_bytes: u64,
    /// Largest request body, in bytes, once it is decompressed
    #[arg(long, env = "REFLECTANCE_EXPANDED_BODY_LIMIT_BYTES", default_value_t = 64 << 20, value_name = "BYTES", allow_negative_numbers = true, value_parser = size)]
    pub expanded_body_limit_bytes: u64,
    /// Largest request head, in bytes
    #[arg(long, env = "REFLECTANCE_HEAD_LIMIT_BYTES", default_value_t = 64 << 10, value_name = "BYTES", allow_negative_numbers = true, value_parser = head_size)]
    pub head_limit_bytes: u64,
    /// Most directions in one request
    #[arg(long, env = "REFLECTANCE_DIRECTION_LIMIT", default_value_t = MAX_DIRECTIONS, value_name = "COUNT", allow_negative_numbers = true, value_parser = directions)]
    pub direction_limit: usize,
    /// Most rows of one diagram: points times fixed angles
    #[arg(long, env = "REFLECTANCE_ROW_LIMIT", default_value_t = MAX_ROWS, value_name = "COUNT", allow_negative_numbers = true, value_parser = rows)]
    pub row_limit: usize,
    /// Most incidences of one albedo request
    #[arg(long, env = "REFLECTANCE_INCIDENCE_LIMIT", default_value_t = DEFAULT_INCIDENCES, value_name = "COUNT", allow_negative_numbers = true, value_parser = incidences)]
    pub incidence_limit: usize,
    /// Seconds from a request's head to the beginning of its answer
    #[arg(long, env = "REFLECTANCE_REQUEST_TIMEOUT_SECONDS", default_value = "60", value_name = "SECONDS", allow_negative_numbers = true, value_parser = seconds)]
    pub request_timeout_seconds: Duration,
    /// Seconds that sending an answer may take
    #[arg(long, env = "REFLECTANCE_ANSWER_TIMEOUT_SECONDS", default_value = "600", value_name = "SECONDS", allow_negative_numbers = true, value_parser = seconds)]
    pub answer_timeout_seconds: Duration,
    /// Seconds of processor time that one request may take
    #[arg(long, env = "REFLECTANCE_CPU_LIMIT_SECONDS", default_value = "60", value_name = "SECONDS", allow_negative_numbers = true, value_parser = seconds)]
    pub cpu_limit_seconds: Duration,
}

/// What the service takes on at once.
#[derive(Clone, Debug, Args)]
#[command(next_help_heading = "Capacity")]
pub struct Capacity {
    /// Most requests in flight; more are shed with 503
    #[arg(long, env = "REFLECTANCE_IN_FLIGHT_LIMIT", default_value_t = 1024, value_name = "COUNT", allow_negative_numbers = true, value_parser = count)]
    pub in_flight_limit: usize,
    /// Most large requests (bodies over 64 KiB, or more than a millisecond of work) at work at once
    #[arg(long, env = "REFLECTANCE_LARGE_REQUEST_LIMIT", default_value_t = 8, value_name = "COUNT", allow_negative_numbers = true, value_parser = count)]
    pub large_request_limit: usize,
    /// Most large requests that wait for their turn; more are shed with 503
    #[arg(long, env = "REFLECTANCE_QUEUE_LIMIT", default_value_t = 32, value_name = "COUNT", allow_negative_numbers = true, value_parser = queue)]
    pub queue_limit: usize,
    /// Seconds after which a large request that waits is shed with 503
    #[arg(long, env = "REFLECTANCE_QUEUE_TIMEOUT_SECONDS", default_value = "5", value_name = "SECONDS", allow_negative_numbers = true, value_parser = seconds)]
    pub queue_timeout_seconds: Duration,
    /// Threads for large work; as many as there are processors when absent
    #[arg(long, env = "REFLECTANCE_POOL_THREADS", value_name = "COUNT", allow_negative_numbers = true, value_parser = threads)]
    pub pool_threads: Option<usize>,
}

/// What connections may do.
#[derive(Clone, Debug, Args)]
#[command(next_help_heading = "Connections")]
pub struct Connections {
    /// Most connections; more wait until one ends
    #[arg(long, env = "REFLECTANCE_CONNECTION_LIMIT", default_value_t = 20_000, value_name = "COUNT", allow_negative_numbers = true, value_parser = count)]
    pub connection_limit: usize,
    /// Seconds that a connection may wait for the head of a request, the first or the next
    #[arg(long, env = "REFLECTANCE_IDLE_TIMEOUT_SECONDS", default_value = "75", value_name = "SECONDS", allow_negative_numbers = true, value_parser = seconds)]
    pub idle_timeout_seconds: Duration,
    /// Seconds after which a client that takes nothing of its answer, or sends nothing of its body, is let go
    #[arg(long, env = "REFLECTANCE_STALL_TIMEOUT_SECONDS", default_value = "30", value_name = "SECONDS", allow_negative_numbers = true, value_parser = seconds)]
    pub stall_timeout_seconds: Duration,
}

/// How it stops.
#[derive(Clone, Debug, Args)]
#[command(next_help_heading = "Stopping")]
pub struct Stopping {
    /// Seconds between SIGTERM, when /readyz turns to 503, and the end of accepting connections: the time that a
    /// balancer takes to notice
    #[arg(long, env = "REFLECTANCE_DRAIN_DELAY_SECONDS", default_value = "1", value_name = "SECONDS", allow_negative_numbers = true, value_parser = seconds_or_none)]
    pub drain_delay_seconds: Duration,
    /// Seconds that requests in flight are then given to finish; the exit code is 1 if they did not
    #[arg(long, env = "REFLECTANCE_SHUTDOWN_TIMEOUT_SECONDS", default_value = "30", value_name = "SECONDS", allow_negative_numbers = true, value_parser = seconds)]
    pub shutdown_timeout_seconds: Duration,
}

/// What it says about itself.
#[derive(Clone, Debug, Args)]
#[command(next_help_heading = "Telemetry")]
pub struct Telemetry {
    /// How log lines look
    #[arg(long, env = "REFLECTANCE_LOG_FORMAT", value_enum, default_value_t = LogFormat::Human)]
    pub log_format: LogFormat,
    /// What is logged: off, error, warn, info, debug or trace
    #[arg(long, env = "REFLECTANCE_LOG_LEVEL", default_value = "info", value_name = "LEVEL")]
    pub log_level: tracing::level_filters::LevelFilter,
    /// Where spans go as OTLP over HTTP, as http://collector:4318; without it none are made
    #[arg(long, env = "OTEL_EXPORTER_OTLP_ENDPOINT", value_name = "URL", value_parser = values::collector)]
    pub otlp_endpoint: Option<String>,
}

/// How log lines look.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum LogFormat {
    /// For a terminal
    Human,
    /// One JSON object a line
    Json,
}

fn head_size(text: &str) -> Result<u64, String> {
    values::whole(text, 8 << 10, 1 << 20)
}

fn directions(text: &str) -> Result<usize, String> {
    values::whole(text, 1, MAX_DIRECTIONS)
}

fn rows(text: &str) -> Result<usize, String> {
    values::whole(text, 1, MAX_ROWS)
}

fn incidences(text: &str) -> Result<usize, String> {
    values::whole(text, 1, MAX_INCIDENCES)
}

fn queue(text: &str) -> Result<usize, String> {
    values::whole(text, 0, 1 << 20)
}

fn threads(text: &str) -> Result<usize, String> {
    values::whole(text, 1, 1024)
}

#[cfg(test)]
mod tests {
    use super::{Cli, LogFormat};
    use clap::{CommandFactory, Parser};

    #[test]
    fn the_command_line_is_consistent() {
        Cli::command().debug_assert();
    }

    #[test]
    fn flags_are_checked() {
        for wrong in [
            ["--body-limit-bytes", "10"],
            ["--request-timeout-seconds", "0"],
            ["--request-timeout-seconds", "NaN"],
            ["--direction-limit", "1000001"],
            ["--queue-limit", "-1"],
            ["--rate-limit-per-second", "0"],
            ["--tls-cert", "alone.pem"],
            ["--log-format", "xml"],
            ["--log-level", "loud"],
            ["--api-keys-file", "/nowhere/keys"],
            ["--cors-origin", "example.org"],
            ["--cors-origin", "https://example.org/"],
            ["--cors-origin", "https://Example.org"],
            ["--cors-origin", "https://a b"],
            ["--cors-origin", "https://example.org,null"],
            ["--otlp-endpoint", "https://collector:4318"],
            ["--otlp-endpoint", "collector:4318"],
            ["--otlp-endpoint", "http://"],
        ] {
            assert!(Cli::try_parse_from(["reflectance", wrong[0], wrong[1]]).is_err(), "{wrong:?}");
        }
        let cli = Cli::try_parse_from(["reflectance", "--log-format", "json"]).unwrap();
        assert_eq!(cli.config.telemetry.log_format, LogFormat::Json);
    }
}
