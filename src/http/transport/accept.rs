//! Accepting connections, and leaving without losing one that was accepted.

use super::connection::Server;
use super::doors::{Doors, Stage};
use super::signals::{Order, Signals};
use std::io;
use std::net::SocketAddr;
use std::sync::Arc;
use std::time::Duration;
use tokio::net::{TcpListener, TcpStream};
use tokio::time::Instant;

/// After a failed accept (out of file descriptors, say) wait rather than spin.
const PAUSE: Duration = Duration::from_millis(50);
/// Between two lines in the log that say the same.
const ONCE_IN: Duration = Duration::from_mins(1);
/// Between two times of tidying up.
const TIDY: Duration = Duration::from_secs(5);
/// The time that connections take to end that are cut off.
const CUT_TIME: Duration = Duration::from_secs(1);

/// Takes connections in.
pub(super) struct Accept {
    listener: TcpListener,
    server: Arc<Server>,
    full: Seldom,
    failed: Seldom,
}

impl Accept {
    pub(super) fn new(listener: TcpListener, server: Arc<Server>) -> Self {
        Self { listener, server, full: Seldom::default(), failed: Seldom::default() }
    }

    /// Takes connections in for ever.
    pub(super) async fn run(&mut self) {
        let doors = Arc::clone(self.server.doors());
        loop {
            if !doors.have_room() {
                if self.full.is_due() {
                    let connections = doors.connections();
                    tracing::warn!(connections, "at the limit of connections: more wait to be accepted");
                }
                doors.until(Doors::have_room).await;
            }
            match self.listener.accept().await {
                Ok((socket, peer)) => take(&self.server, socket, peer),
                // The client left before it was its turn.
                Err(error) if error.kind() == io::ErrorKind::ConnectionAborted => {}
                Err(error) => {
                    if self.failed.is_due() {
                        tracing::warn!(%error, "accept failed");
                    }
                    tokio::time::sleep(PAUSE).await;
                }
            }
        }
    }

    /// Takes in whoever waits, and closes the door behind them.
    fn close(self) -> io::Result<()> {
        let listener = self.listener.into_std()?;
        loop {
            match listener.accept() {
                Ok((socket, peer)) => {
                    socket.set_nonblocking(true)?;
                    take(&self.server, TcpStream::from_std(socket)?, peer);
                }
                Err(error) if error.kind() == io::ErrorKind::ConnectionAborted => {}
                Err(error) if error.kind() == io::ErrorKind::WouldBlock => return Ok(()),
                Err(error) => return Err(error),
            }
        }
    }
}

fn take(server: &Arc<Server>, socket: TcpStream, peer: SocketAddr) {
    let inside = server.doors().enter();
    tokio::spawn(Arc::clone(server).connection(socket, peer, inside));
}

/// Something that is said once in a while.
#[derive(Debug, Default)]
struct Seldom(Option<Instant>);

impl Seldom {
    fn is_due(&mut self) -> bool {
        let now = Instant::now();
        let due = self.0.is_none_or(|last| now >= last + ONCE_IN);
        if due {
            self.0 = Some(now);
        }
        due
    }
}

/// How the service leaves.
#[derive(Clone, Copy, Debug)]
pub(super) struct Stopping {
    /// Between the order to drain and the end of accepting.
    pub(super) delay: Duration,
    /// For what is in flight then.
    pub(super) timeout: Duration,
}

/// Serves until it is told to leave and what was in flight is done. Says whether all of it was.
pub(super) async fn serve(
    mut accept: Accept,
    mut signals: Signals,
    stopping: Stopping,
    reload: impl Fn(),
    tidy: impl Fn(),
) -> bool {
    let mut tidying = tokio::time::interval(TIDY);
    let doors = Arc::clone(accept.server.doors());
    let drain = loop {
        tokio::select! {
            () = accept.run() => {},
            order = signals.next() => match order {
                Order::Reload => reload(),
                Order::Drain => break true,
                Order::Stop => break false,
            },
            _ = tidying.tick() => tidy(),
        }
    };
    if drain && !stopping.delay.is_zero() {
        let seconds = stopping.delay.as_secs_f64();
        tracing::info!(seconds, "stopping: no longer ready, still serving");
        doors.turn_to(Stage::Draining);
        tokio::select! {
            () = accept.run() => {},
            () = tokio::time::sleep(stopping.delay) => {},
            () = signals.leave() => return cut(&doors).await,
        }
    }
    // First, so that whoever is taken in now knows.
    doors.turn_to(Stage::Closing);
    if let Err(error) = accept.close() {
        tracing::warn!(%error, "connections that waited to be accepted may be lost");
    }
    tracing::info!(connections = doors.connections(), "stopping: finishing what is in flight");
    tokio::select! {
        () = doors.until(|doors| doors.connections() == 0) => {
            tracing::info!("stopped");
            !doors.have_cut()
        }
        () = tokio::time::sleep(stopping.timeout) => cut(&doors).await,
        () = signals.leave() => cut(&doors).await,
    }
}

/// Ends at once. Says whether nothing was under way.
async fn cut(doors: &Doors) -> bool {
    doors.turn_to(Stage::Cutting);
    let gone = doors.until(|doors| doors.connections() == 0);
    let all = tokio::time::timeout(CUT_TIME, gone).await.is_ok() && !doors.have_cut();
    if all {
        tracing::info!("stopped");
    } else {
        tracing::warn!("stopped with requests unfinished");
    }
    all
}
