//! Connections: accept, secure, serve, and stop without cutting an answer short.
//!
//! A loop of our own rather than `axum::serve`, which sets no time limit on anything: a client that sends one byte
//! a minute, or takes one, would hold its connection for ever.

mod accept;
mod activity;
mod answer;
mod connection;
mod descriptors;
pub(super) mod doors;
mod exchange;
mod listen;
mod received;
mod refusal;
mod signals;
mod stream;
mod tls;
mod watch;

pub use listen::run;
use signals::Signals;

use super::app::App;
use super::service;
use crate::config::Config;
use accept::{Accept, Stopping};
use connection::Server;
use std::sync::Arc;
use std::time::Duration;
use tls::Tls;
use tokio::net::TcpListener;

/// The two protocols.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Protocol {
    Http1,
    Http2,
}

/// All that serving needs, checked before anything listens.
struct Service {
    app: App,
    tls: Option<Arc<Tls>>,
    connection_limit: usize,
    stopping: Stopping,
}

impl Service {
    /// Reads what the configuration names; an error is one line that says what cannot be used.
    fn prepare(config: &Config) -> Result<Self, String> {
        let tls = match (&config.access.tls_cert, &config.access.tls_key) {
            (Some(certificate), Some(key)) => Some(Arc::new(Tls::open(certificate, key)?)),
            _ => None,
        };
        Ok(Self {
            app: App::new(config),
            tls,
            connection_limit: config.connections.connection_limit,
            stopping: Stopping {
                delay: config.stopping.drain_delay_seconds,
                timeout: config.stopping.shutdown_timeout_seconds,
            },
        })
    }

    /// The scheme of its links.
    fn scheme(&self) -> &'static str {
        if self.tls.is_some() { "https" } else { "http" }
    }

    /// Serves until a signal says to leave, then lets the requests in flight finish. Says whether all did.
    async fn serve(self, listener: TcpListener, signals: Signals) -> bool {
        descriptors::raise(self.connection_limit);
        let server = Arc::new(Server::new(self.app.clone(), service(&self.app), self.tls.clone()));
        let accept = Accept::new(listener, server);
        let all =
            accept::serve(accept, signals, self.stopping, || self.reload(), || self.app.edge().tidy()).await;
        let app = self.app;
        // Spans go out by a request of their own, which may have to wait for the collector.
        if let Err(error) = tokio::task::spawn_blocking(move || app.edge().finish()).await {
            tracing::warn!(%error, "the last spans may be lost");
        }
        all
    }

    /// Reads again what may change while the service runs.
    fn reload(&self) {
        let tls = self.tls.as_deref().map(Tls::reload);
        match &tls {
            Some(Ok(())) => tracing::info!("certificate and key were read again"),
            Some(Err(error)) => tracing::error!(error, "the old certificate stays"),
            None => {}
        }
        match self.app.edge().reload() {
            Some(Ok(keys)) => tracing::info!(keys, "keys were read again"),
            Some(Err(error)) => tracing::error!(error, "the old keys stay"),
            None if tls.is_none() => tracing::info!("nothing to read again"),
            None => {}
        }
    }
}

/// A time limit as the connections count.
fn milliseconds(time: Duration) -> u64 {
    u64::try_from(time.as_millis()).unwrap_or(u64::MAX / 4)
}
