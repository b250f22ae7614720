//! Connections: accept, serve, and stop without cutting an answer short.
//!
//! A loop of our own rather than `axum::serve`, which sets no time limit on a request's head: a
//! client that sends one byte a minute would hold its connection for ever.

use super::router;
use crate::config::Config;
use axum::Router;
use hyper_util::rt::{TokioExecutor, TokioIo, TokioTimer};
use hyper_util::server::conn::auto::Builder;
use hyper_util::server::graceful::GracefulShutdown;
use hyper_util::service::TowerToHyperService;
use std::time::Duration;
use tokio::net::{TcpListener, TcpStream};

/// Largest request head: ample for the longest query that makes sense.
const MAX_HEAD_BYTES: usize = 64 << 10;
/// After a failed accept (out of file descriptors, say) wait rather than spin.
const ACCEPT_PAUSE: Duration = Duration::from_millis(50);

/// Serves until SIGTERM or Ctrl-C, then lets the requests in flight finish.
pub async fn serve(listener: TcpListener, config: &Config) {
    let router = router(config);
    let mut builder = Builder::new(TokioExecutor::new());
    builder
        .http1()
        .timer(TokioTimer::new())
        .header_read_timeout(config.request_timeout_seconds)
        .max_buf_size(MAX_HEAD_BYTES);
    builder
        .http2()
        .timer(TokioTimer::new())
        .max_header_list_size(u32::try_from(MAX_HEAD_BYTES).unwrap_or(u32::MAX))
        .keep_alive_interval(Some(config.request_timeout_seconds));
    let open = GracefulShutdown::new();
    let mut stop = std::pin::pin!(stop_signal());
    loop {
        tokio::select! {
            accepted = listener.accept() => match accepted {
                Ok((stream, _)) => connect(stream, &builder, &router, &open),
                Err(error) => {
                    tracing::warn!(%error, "accept failed");
                    tokio::time::sleep(ACCEPT_PAUSE).await;
                }
            },
            () = &mut stop => break,
        }
    }
    drop(listener);
    tracing::info!(connections = open.count(), "stopping: finishing what is in flight");
    tokio::select! {
        () = open.shutdown() => tracing::info!("stopped"),
        () = tokio::time::sleep(config.shutdown_timeout_seconds) => tracing::warn!("stopped with requests unfinished"),
    }
}

fn connect(stream: TcpStream, builder: &Builder<TokioExecutor>, router: &Router, open: &GracefulShutdown) {
    // Answers are written whole: waiting to fill a segment only delays the small ones.
    if let Err(error) = stream.set_nodelay(true) {
        tracing::debug!(%error, "TCP_NODELAY was refused");
    }
    let service = TowerToHyperService::new(router.clone());
    let connection = builder.serve_connection(TokioIo::new(stream), service).into_owned();
    let connection = open.watch(connection);
    tokio::spawn(async move {
        if let Err(error) = connection.await {
            tracing::debug!(error, "connection ended");
        }
    });
}

/// Resolves at SIGTERM or Ctrl-C. A signal that cannot be listened to never resolves.
async fn stop_signal() {
    let interrupt = async {
        if tokio::signal::ctrl_c().await.is_err() {
            std::future::pending::<()>().await;
        }
    };
    let terminate = async {
        match tokio::signal::unix::signal(tokio::signal::unix::SignalKind::terminate()) {
            Ok(mut signal) => {
                signal.recv().await;
            }
            Err(_) => std::future::pending().await,
        }
    };
    tokio::select! { () = interrupt => {}, () = terminate => {} }
}
