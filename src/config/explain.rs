//! What is wrong with the command line, in one line.

use super::Cli;
use clap::CommandFactory as _;
use clap::error::{ContextKind, ContextValue};

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
