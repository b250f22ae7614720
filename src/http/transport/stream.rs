//! The bytes of a connection, on the wire and within TLS, with a note of what moves.

use super::activity::Activity;
use super::refusal;
use crate::http::app::Limits;
use axum::body::Bytes;
use bytes::Buf as _;
use std::io;
use std::pin::Pin;
use std::sync::Arc;
use std::task::{Context, Poll, ready};
use tokio::io::{AsyncRead, AsyncWrite, ReadBuf};
use tokio::net::TcpStream;
use tokio_rustls::server::TlsStream;

/// The socket. Below TLS, so that it is the client's taking that is seen and not what a buffer took.
#[derive(Debug)]
pub(super) struct Wire {
    socket: TcpStream,
    activity: Arc<Activity>,
}

impl Wire {
    pub(super) fn new(socket: TcpStream, activity: Arc<Activity>) -> Self {
        Self { socket, activity }
    }

    fn note<T>(&self, result: Poll<io::Result<T>>) -> Poll<io::Result<T>> {
        match &result {
            Poll::Ready(Ok(_)) => self.activity.sent(),
            Poll::Pending => self.activity.blocked(),
            Poll::Ready(Err(_)) => {}
        }
        result
    }
}

impl AsyncRead for Wire {
    fn poll_read(mut self: Pin<&mut Self>, cx: &mut Context, buffer: &mut ReadBuf) -> Poll<io::Result<()>> {
        let result = Pin::new(&mut self.socket).poll_read(cx, buffer);
        if result.is_ready() {
            self.activity.moved();
        }
        result
    }
}

impl AsyncWrite for Wire {
    fn poll_write(mut self: Pin<&mut Self>, cx: &mut Context, bytes: &[u8]) -> Poll<io::Result<usize>> {
        let result = Pin::new(&mut self.socket).poll_write(cx, bytes);
        self.note(result)
    }

    fn poll_write_vectored(
        mut self: Pin<&mut Self>,
        cx: &mut Context,
        parts: &[io::IoSlice],
    ) -> Poll<io::Result<usize>> {
        let result = Pin::new(&mut self.socket).poll_write_vectored(cx, parts);
        self.note(result)
    }

    fn is_write_vectored(&self) -> bool {
        self.socket.is_write_vectored()
    }

    fn poll_flush(mut self: Pin<&mut Self>, cx: &mut Context) -> Poll<io::Result<()>> {
        Pin::new(&mut self.socket).poll_flush(cx)
    }

    fn poll_shutdown(mut self: Pin<&mut Self>, cx: &mut Context) -> Poll<io::Result<()>> {
        Pin::new(&mut self.socket).poll_shutdown(cx)
    }
}

/// With TLS or without: one type, so that the code that serves it is compiled once.
#[derive(Debug)]
enum Line {
    Plain(Wire),
    Tls(Box<TlsStream<Wire>>),
}

/// One of the two, as something to call the trait's methods on.
macro_rules! line {
    ($stream:expr, $name:ident => $call:expr) => {
        match &mut $stream.line {
            Line::Plain(wire) => {
                let $name = Pin::new(wire);
                $call
            }
            Line::Tls(stream) => {
                let $name = Pin::new(&mut **stream);
                $call
            }
        }
    };
}

/// What HTTP is spoken on.
#[derive(Debug)]
pub(super) struct Stream {
    line: Line,
    activity: Arc<Activity>,
    limits: Limits,
    /// What goes out instead of the bytes that were to be sent.
    instead: Bytes,
}

impl Stream {
    pub(super) fn plain(wire: Wire, limits: &Limits) -> Self {
        let activity = Arc::clone(&wire.activity);
        Self { line: Line::Plain(wire), activity, limits: *limits, instead: Bytes::new() }
    }

    pub(super) fn tls(stream: TlsStream<Wire>, limits: &Limits) -> Self {
        let activity = Arc::clone(&stream.get_ref().0.activity);
        Self { line: Line::Tls(Box::new(stream)), activity, limits: *limits, instead: Bytes::new() }
    }

    /// Sends the document for a head that was refused, if `bytes` begin the bare answer to one: says so once all
    /// of it is sent.
    fn poll_refusal(&mut self, cx: &mut Context, bytes: &[u8]) -> Poll<io::Result<bool>> {
        if self.instead.is_empty() {
            match refusal::of_http1(bytes, &self.limits) {
                Some(document) => self.instead = document.into(),
                None => return Poll::Ready(Ok(false)),
            }
        }
        while !self.instead.is_empty() {
            let instead = self.instead.clone();
            let sent = ready!(line!(self, line => line.poll_write(cx, &instead)))?;
            if sent == 0 {
                return Poll::Ready(Err(io::ErrorKind::WriteZero.into()));
            }
            self.instead.advance(sent);
        }
        Poll::Ready(Ok(true))
    }

    /// Resolves once there is something to read, or the client left.
    pub(super) async fn readable(&self) -> io::Result<()> {
        let wire = match &self.line {
            Line::Plain(wire) => wire,
            Line::Tls(stream) => stream.get_ref().0,
        };
        wire.socket.readable().await
    }
}

impl AsyncRead for Stream {
    /// An idle connection that was [let go](Activity::let_go) ends here: only after a look at the socket found
    /// nothing, so that no request is lost that had arrived.
    fn poll_read(mut self: Pin<&mut Self>, cx: &mut Context, buffer: &mut ReadBuf) -> Poll<io::Result<()>> {
        let before = buffer.filled().len();
        let result = line!(self, line => line.poll_read(cx, buffer));
        if result.is_pending() {
            if self.activity.is_over() {
                return Poll::Ready(Ok(()));
            }
        } else if buffer.filled().len() > before {
            self.activity.read();
        } else if buffer.remaining() > 0 {
            self.activity.leave();
        }
        result
    }
}

impl AsyncWrite for Stream {
    fn poll_write(mut self: Pin<&mut Self>, cx: &mut Context, bytes: &[u8]) -> Poll<io::Result<usize>> {
        if ready!(self.poll_refusal(cx, bytes))? {
            return Poll::Ready(Ok(bytes.len()));
        }
        line!(self, line => line.poll_write(cx, bytes))
    }

    fn poll_write_vectored(
        mut self: Pin<&mut Self>,
        cx: &mut Context,
        parts: &[io::IoSlice],
    ) -> Poll<io::Result<usize>> {
        if let Some(first) = parts.first()
            && ready!(self.poll_refusal(cx, first))?
        {
            return Poll::Ready(Ok(parts.iter().map(|part| part.len()).sum()));
        }
        line!(self, line => line.poll_write_vectored(cx, parts))
    }

    fn is_write_vectored(&self) -> bool {
        match &self.line {
            Line::Plain(wire) => wire.is_write_vectored(),
            Line::Tls(stream) => stream.is_write_vectored(),
        }
    }

    fn poll_flush(mut self: Pin<&mut Self>, cx: &mut Context) -> Poll<io::Result<()>> {
        line!(self, line => line.poll_flush(cx))
    }

    fn poll_shutdown(mut self: Pin<&mut Self>, cx: &mut Context) -> Poll<io::Result<()>> {
        line!(self, line => line.poll_shutdown(cx))
    }
}
