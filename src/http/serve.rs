//! Connections: accept, serve, and stop without cutting an answer short.
//!
//! A loop of our own rather than `axum::serve`, which sets no time limit on a request's head: a
//! client that sends one byte a minute would hold its connection for ever.

use super::app::App;
use super::connection::{Activity, Protocol, Watched, protocol};
use super::edge::Edge;
use super::service;
use crate::config::Config;
use hyper_util::rt::{TokioExecutor, TokioIo, TokioTimer};
use hyper_util::server::conn::auto::Builder;
use hyper_util::server::graceful::{GracefulShutdown, Watcher};
use hyper_util::service::TowerToHyperService;
use std::net::SocketAddr;
use std::sync::Arc;
use std::time::Duration;
use tokio::net::{TcpListener, TcpStream};
use tokio::signal::unix::{Signal, SignalKind, signal};
use tokio::sync::watch;

/// Largest request head: ample for the longest query that makes sense.
const MAX_HEAD_BYTES: usize = 64 << 10;
/// After a failed accept (out of file descriptors, say) wait rather than spin.
const ACCEPT_PAUSE: Duration = Duration::from_millis(50);
/// Once the service stops: how long a connection may be silent before it counts as idle.
const QUIET: Duration = Duration::from_secs(1);

/// Serves until one of the signals, then lets the requests in flight finish. Says whether all did.
pub async fn serve(listener: TcpListener, mut signals: StopSignals, config: &Config) -> bool {
    let app = App::new(config);
    let (stopping, stopped) = watch::channel(false);
    let server = Arc::new(Server {
        edge: service(&app),
        http1: http1(config),
        http2: http2(config),
        patience: config.requests.request_timeout_seconds,
        app: app.clone(),
    });
    let open = GracefulShutdown::new();
    let mut tidy = tokio::time::interval(Duration::from_secs(5));
    let Ok(mut hangup) = signal(SignalKind::hangup()) else { return false };
    let mut stop = std::pin::pin!(signals.received());
    loop {
        tokio::select! {
            accepted = listener.accept() => match accepted {
                Ok((stream, peer)) => {
                    tokio::spawn(Arc::clone(&server).connection(stream, peer, open.watcher(), stopped.clone()));
                }
                Err(error) => {
                    tracing::warn!(%error, "accept failed");
                    tokio::time::sleep(ACCEPT_PAUSE).await;
                }
            },
            () = &mut stop => break,
            _ = hangup.recv() => match app.edge().reload() {
                Some(Ok(keys)) => tracing::info!(keys, "keys were read again"),
                Some(Err(error)) => tracing::error!(error, "the old keys stay"),
                None => tracing::info!("nothing to read again"),
            },
            _ = tidy.tick() => app.edge().tidy(),
        }
    }
    app.edge().drain();
    drop(listener);
    stopping.send_replace(true);
    tracing::info!(connections = open.count(), "stopping: finishing what is in flight");
    let all = tokio::select! {
        () = open.shutdown() => {
            tracing::info!("stopped");
            true
        }
        () = tokio::time::sleep(config.stopping.shutdown_timeout_seconds) => {
            tracing::warn!("stopped with requests unfinished");
            false
        }
    };
    let _ = tokio::task::spawn_blocking(move || app.edge().finish()).await;
    all
}

fn http1(config: &Config) -> Builder<TokioExecutor> {
    let mut builder = Builder::new(TokioExecutor::new()).http1_only();
    builder
        .http1()
        .timer(TokioTimer::new())
        .header_read_timeout(config.requests.request_timeout_seconds)
        .max_buf_size(MAX_HEAD_BYTES);
    builder
}

fn http2(config: &Config) -> Builder<TokioExecutor> {
    let mut builder = Builder::new(TokioExecutor::new()).http2_only();
    builder
        .http2()
        .timer(TokioTimer::new())
        .max_header_list_size(u32::try_from(MAX_HEAD_BYTES).unwrap_or(u32::MAX))
        .keep_alive_interval(Some(config.requests.request_timeout_seconds));
    builder
}

/// What every connection shares.
struct Server {
    app: App,
    edge: Edge,
    http1: Builder<TokioExecutor>,
    http2: Builder<TokioExecutor>,
    patience: Duration,
}

impl Server {
    /// Serves one connection to its end.
    async fn connection(
        self: Arc<Self>,
        stream: TcpStream,
        peer: SocketAddr,
        watcher: Watcher,
        stopped: watch::Receiver<bool>,
    ) {
        // Answers are written whole: waiting to fill a segment only delays the small ones.
        if let Err(error) = stream.set_nodelay(true) {
            tracing::debug!(%error, "TCP_NODELAY was refused");
        }
        // The library would wait for the first bytes without limit.
        let first = tokio::select! {
            first = tokio::time::timeout(self.patience, protocol(&stream)) => first,
            () = quiet_after(stopped.clone()) => return,
        };
        let protocol = match first {
            Ok(Ok(Some(protocol))) => protocol,
            Ok(Ok(None)) => return,
            Ok(Err(error)) => return tracing::debug!(%error, "connection ended"),
            Err(_) => return tracing::debug!("a client did not begin in time"),
        };
        let activity = Activity::new();
        let stream = TokioIo::new(Watched { stream, activity: activity.clone() });
        let service = TowerToHyperService::new(self.edge.of(peer));
        let builder = if protocol == Protocol::Http1 { &self.http1 } else { &self.http2 };
        let connection = watcher.watch(builder.serve_connection(stream, service).into_owned());
        tokio::select! {
            ended = connection => if let Err(error) = ended {
                tracing::debug!(error, "connection ended");
            },
            () = self.idle(&activity, stopped), if protocol == Protocol::Http2 => {
                tracing::debug!("a silent client was let go");
            }
        }
    }

    /// Resolves once the service stops, no request is being answered and nothing moved here for [`QUIET`].
    ///
    /// An idle connection of HTTP/1 closes by itself. One of HTTP/2 waits for the client to confirm that it
    /// heard of the end, and a client that is gone never does.
    async fn idle(&self, activity: &Activity, stopped: watch::Receiver<bool>) {
        quiet_after(stopped).await;
        while self.app.edge().in_flight() > 0 || activity.last().elapsed() < QUIET {
            tokio::time::sleep(QUIET / 10).await;
        }
    }
}

/// Resolves [`QUIET`] after the service was told to stop.
async fn quiet_after(mut stopped: watch::Receiver<bool>) {
    // An error means that the sender is gone: the service stops all the same.
    let _ = stopped.wait_for(|stopped| *stopped).await;
    tokio::time::sleep(QUIET).await;
}

/// SIGTERM and Ctrl-C, caught from when this is made: before the service says that it listens, so that it can be told
/// to stop from then on.
pub struct StopSignals {
    interrupt: Signal,
    terminate: Signal,
}

impl StopSignals {
    /// Within a runtime.
    pub fn catch() -> std::io::Result<Self> {
        Ok(Self { interrupt: signal(SignalKind::interrupt())?, terminate: signal(SignalKind::terminate())? })
    }

    /// Resolves at the first of either.
    async fn received(&mut self) {
        tokio::select! { _ = self.interrupt.recv() => {}, _ = self.terminate.recv() => {} }
    }
}
