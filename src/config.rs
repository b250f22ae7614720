//! Flags and environment, parsed once into a typed [`Config`].

use clap::error::{ContextKind, ContextValue};
use clap::{Args, CommandFactory as _, Parser, Subcommand, ValueEnum};
use std::time::Duration;

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
#[derive(Clone, Copy, Debug, Subcommand)]
pub enum Command {
    /// Print the `OpenAPI` document and exit
    Openapi,
}

/// How log lines look.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum LogFormat {
    /// For a terminal
    Human,
    /// One JSON object a line
    Json,
}

/// How the service runs. Every flag has an environment variable; the flag wins.
#[derive(Clone, Debug, Args)]
pub struct Config {
    /// Address and port to listen on; port 0 takes a free one
    #[arg(long, env = "REFLECTANCE_LISTEN", default_value = "127.0.0.1:8080", value_name = "ADDRESS:PORT")]
    pub listen: String,
    /// Largest request body, in bytes
    #[arg(
        long,
        env = "REFLECTANCE_BODY_LIMIT_BYTES",
        default_value_t = 64 << 20,
        value_name = "BYTES",
        allow_negative_numbers = true,
        value_parser = bytes
    )]
    pub body_limit_bytes: u64,
    /// Seconds a request may take, from its head to its answer
    #[arg(
        long,
        env = "REFLECTANCE_REQUEST_TIMEOUT_SECONDS",
        default_value = "60",
        value_name = "SECONDS",
        allow_negative_numbers = true,
        value_parser = seconds
    )]
    pub request_timeout_seconds: Duration,
    /// Seconds that requests in flight are given to finish after SIGTERM or Ctrl-C; the exit code is 1 if they did
    /// not
    #[arg(
        long,
        env = "REFLECTANCE_SHUTDOWN_TIMEOUT_SECONDS",
        default_value = "30",
        value_name = "SECONDS",
        allow_negative_numbers = true,
        value_parser = seconds
    )]
    pub shutdown_timeout_seconds: Duration,
    /// How log lines look
    #[arg(long, env = "REFLECTANCE_LOG_FORMAT", value_enum, default_value_t = LogFormat::Human)]
    pub log_format: LogFormat,
    /// What is logged: off, error, warn, info, debug or trace
    #[arg(long, env = "REFLECTANCE_LOG_LEVEL", default_value = "info", value_name = "LEVEL")]
    pub log_level: tracing::level_filters::LevelFilter,
}

/// Parses a number of bytes between 1 KiB and 4 GiB.
fn bytes(text: &str) -> Result<u64, String> {
    text.parse()
        .ok()
        .filter(|bytes| (1 << 10..=1 << 32).contains(bytes))
        .ok_or_else(|| "expected a whole number from 1024 to 4294967296".to_owned())
}

/// Parses a positive number of seconds up to a day.
fn seconds(text: &str) -> Result<Duration, String> {
    text.parse::<f64>()
        .ok()
        .filter(|seconds| (0.001..=86_400.0).contains(seconds))
        .map(Duration::from_secs_f64)
        .ok_or_else(|| "expected a number from 0.001 to 86400".to_owned())
}

/// What is wrong with the command line or the environment, in one line: the library's own first line, the
/// values there are, the variable that may have set it, and where to read more.
pub fn explain(error: &clap::Error) -> String {
    let text = error.to_string();
    let mut line = text.lines().next().unwrap_or_default().trim_start_matches("error: ").to_owned();
    if let Some(ContextValue::Strings(values)) = error.get(ContextKind::ValidValue)
        && !values.is_empty()
    {
        line.push_str(": expected one of ");
        line.push_str(&values.join(", "));
    }
    if let Some(ContextValue::String(flag)) = error.get(ContextKind::InvalidArg) {
        let name = flag.split_whitespace().next().unwrap_or_default().trim_start_matches("--");
        let command = Cli::command();
        let argument = command.get_arguments().find(|argument| argument.get_long() == Some(name));
        if let Some(variable) = argument.and_then(|argument| argument.get_env()) {
            line.push_str(" (also set by ");
            line.push_str(&variable.to_string_lossy());
            line.push(')');
        }
    }
    line.push_str("; see --help");
    line
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
            ["--log-format", "xml"],
            ["--log-level", "loud"],
        ] {
            assert!(Cli::try_parse_from(["reflectance", wrong[0], wrong[1]]).is_err(), "{wrong:?}");
        }
        let cli = Cli::try_parse_from(["reflectance", "--log-format", "json"]).unwrap();
        assert_eq!(cli.config.log_format, LogFormat::Json);
    }
}
