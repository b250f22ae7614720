//! One connection, from its first byte to its end.

use super::Protocol;
use super::activity::Activity;
use super::answer::BUFFER;
use super::doors::{Doors, Inside, Stage};
use super::exchange::Service;
use super::stream::{Stream, Wire};
use super::tls::{HTTP_2, Tls};
use super::watch::{Phase, Times, Watch};
use crate::http::app::App;
use crate::http::edge::Edge;
use axum::extract::Request;
use hyper::body::Incoming;
use hyper::server::conn::{http1, http2};
use hyper::service::service_fn;
use hyper_util::rt::{TokioExecutor, TokioIo, TokioTimer};
use std::io;
use std::net::SocketAddr;
use std::pin::pin;
use std::sync::Arc;
use std::time::Duration;
use tokio::io::{AsyncReadExt as _, AsyncWriteExt as _};
use tokio::net::TcpStream;
use tokio::time::timeout;

/// What a client sends first that speaks HTTP/2, RFC 9113 section 3.4.
const PREFACE: &[u8] = b"PRI * HTTP/2.0\r\n\r\nSM\r\n\r\n";
/// Between two looks at a preface that is not complete yet.
const LOOK_AGAIN: Duration = Duration::from_millis(5);
/// The content type of a TLS handshake record, RFC 8446 section 5.1.
const HANDSHAKE: u8 = 22;
/// For whoever speaks HTTP where HTTPS is spoken.
const NOT_TLS: &[u8] = b"HTTP/1.1 400 Bad Request\r\nconnection: close\r\ncontent-type: text/plain\r\n\
    content-length: 35\r\n\r\nthis port speaks HTTPS: use https:/\n";
/// What is read and written of HTTP/1 at once, at least.
const PIECE: usize = 64 << 10;
/// Requests that a client may have under way on one connection of HTTP/2.
const STREAMS: u32 = 100;
/// Streams that a client may open and reset before they are looked at.
const RESETS: usize = 20;
/// Answers to a client's mistakes that are kept on one connection of HTTP/2.
const ERRORS: usize = 256;
/// After an answer that did not wait for the rest of its request: how long that rest may pause while it is read and
/// dropped.
const LINGER: Duration = Duration::from_secs(2);

/// What every connection shares.
pub(super) struct Server {
    app: App,
    doors: Arc<Doors>,
    edge: Edge,
    tls: Option<Arc<Tls>>,
    times: Times,
    http1: http1::Builder,
    http2: http2::Builder<TokioExecutor>,
}

impl Server {
    pub(super) fn new(app: App, edge: Edge, tls: Option<Arc<Tls>>) -> Self {
        let limits = *app.limits();
        let head = usize::try_from(limits.head_bytes).unwrap_or(usize::MAX);
        let mut http1 = http1::Builder::new();
        // The time that a head may take is kept by the watch.
        http1.header_read_timeout(None).max_header_size(head).max_buf_size(head.max(PIECE));
        let mut http2 = http2::Builder::new(TokioExecutor::new());
        http2
            .timer(TokioTimer::new())
            // Beyond the limit there is an answer that says so, and beyond this there is none.
            .max_header_list_size(u32::try_from(head.saturating_mul(2)).unwrap_or(u32::MAX))
            .max_concurrent_streams(STREAMS)
            .max_pending_accept_reset_streams(RESETS)
            .max_local_error_reset_streams(ERRORS)
            .max_send_buf_size(BUFFER)
            .keep_alive_interval(limits.stall_time)
            .keep_alive_timeout(limits.stall_time);
        let (doors, times) = (Arc::clone(app.doors()), Times::of(&limits));
        Self { app, doors, edge, tls, times, http1, http2 }
    }

    pub(super) fn doors(&self) -> &Arc<Doors> {
        &self.doors
    }

    /// Serves one connection to its end.
    pub(super) async fn connection(self: Arc<Self>, socket: TcpStream, peer: SocketAddr, inside: Inside) {
        // Answers are written whole: waiting to fill a segment only delays the small ones.
        if let Err(error) = socket.set_nodelay(true) {
            tracing::debug!(%error, "TCP_NODELAY was refused");
        }
        let activity = Activity::new();
        let watch = self.watch(&activity);
        // Nothing is set up for a client that says nothing.
        let first = first(&socket, self.tls.is_some());
        let Some(Ok(Some(first))) = watch.drive(Phase::Waiting, pin!(first), |_| ()).await else {
            return tracing::debug!(%peer, "a client left or was let go before it said a word");
        };
        tracing::trace!(%peer, ?first, "a connection begins");
        // On the heap: a connection that waits is then as small as it can be.
        Box::pin(self.begun(socket, peer, first, activity)).await;
        drop(inside);
    }

    fn watch<'a>(&'a self, activity: &'a Activity) -> Watch<'a> {
        Watch { activity, doors: &self.doors, times: self.times }
    }

    async fn begun(&self, mut socket: TcpStream, peer: SocketAddr, first: First, activity: Arc<Activity>) {
        let limits = self.app.limits();
        let plain = |socket| Stream::plain(Wire::new(socket, Arc::clone(&activity)), limits);
        let (stream, protocol) = match (&self.tls, first) {
            (Some(tls), First::Tls) => {
                let accept = tls.acceptor().accept(Wire::new(socket, Arc::clone(&activity)));
                match self.watch(&activity).drive(Phase::Waiting, pin!(accept), |_| ()).await {
                    Some(Ok(stream)) => {
                        let chosen = stream.get_ref().1.alpn_protocol();
                        let http2 = chosen == Some(HTTP_2);
                        (Stream::tls(stream, limits), if http2 { Protocol::Http2 } else { Protocol::Http1 })
                    }
                    Some(Err(error)) => return tracing::debug!(%error, "a handshake failed"),
                    None => return,
                }
            }
            (Some(_), _) => {
                // It goes into the socket's buffer or nowhere.
                let _ = socket.try_write(NOT_TLS);
                let _ = socket.shutdown().await;
                return;
            }
            (None, First::Http2) => (plain(socket), Protocol::Http2),
            (None, _) => (plain(socket), Protocol::Http1),
        };
        let service = Arc::new(Service {
            edge: self.edge.of(peer),
            doors: Arc::clone(&self.doors),
            limits: *limits,
            activity,
            protocol,
        });
        match protocol {
            Protocol::Http1 => self.http1(stream, &service).await,
            Protocol::Http2 => self.http2(stream, service).await,
        }
    }

    /// Requests one after the other. Between them, after a while, what serves them is dropped with its buffers,
    /// and made anew when there is something to read.
    async fn http1(&self, mut stream: Stream, service: &Arc<Service>) {
        let activity = &*service.activity;
        let watch = self.watch(activity);
        loop {
            let answer = Arc::clone(service);
            let answer = service_fn(move |request: Request<Incoming>| {
                Arc::clone(&answer).answer(answer.activity.begin(), request)
            });
            let mut served =
                Box::pin(self.http1.serve_connection(TokioIo::new(stream), answer).without_shutdown());
            let ended = watch.drive(Phase::Http1, served.as_mut(), |_| activity.let_go()).await;
            let parts = match ended {
                Some(Ok(parts)) => parts,
                Some(Err(error)) => return tracing::debug!(%error, "connection ended"),
                None => return,
            };
            drop(served);
            stream = parts.io.into_inner();
            if !activity.is_over() || !parts.read_buf.is_empty() {
                break;
            }
            match watch.drive(Phase::Waiting, pin!(stream.readable()), |_| ()).await {
                Some(Ok(())) => activity.stay(),
                _ => break,
            }
        }
        self.finish(stream, activity).await;
    }

    /// Ends a connection of HTTP/1.
    async fn finish(&self, mut stream: Stream, activity: &Activity) {
        let finish = async {
            timeout(LINGER, stream.shutdown()).await??;
            if activity.has_unread() {
                // Bytes that nobody takes make the end a reset, which can overtake the answer.
                let mut rest = vec![0; PIECE];
                while self.doors.stage() < Stage::Cutting
                    && timeout(LINGER, stream.read(&mut rest)).await?? > 0
                {}
            }
            io::Result::Ok(())
        };
        // A client that never stops sending is let go all the same.
        if let Ok(Err(error)) = timeout(self.app.limits().stall_time, finish).await {
            tracing::debug!(%error, "a connection did not end cleanly");
        }
    }

    /// Requests side by side.
    async fn http2(&self, stream: Stream, service: Arc<Service>) {
        let activity = Arc::clone(&service.activity);
        let answer = service_fn(move |request: Request<Incoming>| {
            Arc::clone(&service).answer(service.activity.begin(), request)
        });
        let mut served = Box::pin(self.http2.serve_connection(TokioIo::new(stream), answer));
        let end = http2::Connection::graceful_shutdown;
        if let Some(Err(error)) = self.watch(&activity).drive(Phase::Http2, served.as_mut(), end).await {
            tracing::debug!(%error, "connection ended");
        }
    }
}

/// What the first bytes speak.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum First {
    Http1,
    Http2,
    Tls,
}

/// What the first bytes speak; the bytes stay where they are. None if the client left without a word. Without a
/// time limit of its own.
async fn first(socket: &TcpStream, tls: bool) -> io::Result<Option<First>> {
    let mut first = [0; PREFACE.len()];
    loop {
        let length = socket.peek(&mut first).await?;
        if length == 0 {
            return Ok(None);
        }
        if tls {
            return Ok(Some(if first[0] == HANDSHAKE { First::Tls } else { First::Http1 }));
        }
        if !PREFACE.starts_with(&first[..length]) {
            return Ok(Some(First::Http1));
        }
        if length == PREFACE.len() {
            return Ok(Some(First::Http2));
        }
        // Bytes that are there make the next peek return at once: look again a little later.
        tokio::time::sleep(LOOK_AGAIN).await;
    }
}
