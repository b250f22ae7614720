//! From a configuration to a port that is served.

use super::{Service, Signals};
use crate::config::Config;
use tokio::net::TcpListener;

/// Connections that may wait to be accepted, if the system allows as many.
const BACKLOG: i32 = 4096;

/// Listens as configured, says so by `greet`, and serves until told to stop. Says whether nothing was cut off; an error is
/// one line about a configuration that cannot be served.
pub async fn run(config: &Config, greet: impl FnOnce(&str) -> std::io::Result<()>) -> Result<bool, String> {
    let service = Service::prepare(config)?;
    let bound = TcpListener::bind(&config.listen).await;
    // Anew with a longer queue: where it is full, clients wait for seconds or are forgotten.
    let queued = bound
        .and_then(|listener| rustix::net::listen(&listener, BACKLOG).map(|()| listener).map_err(Into::into));
    let listener = queued.map_err(|error| {
        let reason = "set by --listen or REFLECTANCE_LISTEN; see --help";
        format!("cannot listen on {}: {error} ({reason})", config.listen)
    })?;
    let address = listener
        .local_addr()
        .map_err(|error| format!("cannot tell the address of {}: {error}", config.listen))?;
    let signals = Signals::catch().map_err(|error| format!("cannot catch signals: {error}"))?;
    if greet(&crate::http::greeting(service.scheme(), address)).is_err() {
        return Ok(false);
    }
    Ok(service.serve(listener, signals).await)
}
