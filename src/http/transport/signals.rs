//! What the operator says to the process.

use std::io;
use tokio::signal::unix::{Signal, SignalKind, signal};

/// The signals, caught from when this is made: before the service says that it listens, so that it can be told
/// to stop from then on.
pub(super) struct Signals {
    interrupt: Signal,
    terminate: Signal,
    hangup: Signal,
}

/// What a signal asks for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Order {
    /// SIGTERM: leave, with time for clients and balancers to notice.
    Drain,
    /// SIGINT: leave as soon as what is in flight is done.
    Stop,
    /// SIGHUP: read the files again.
    Reload,
}

impl Signals {
    /// Within a runtime.
    pub(super) fn catch() -> io::Result<Self> {
        Ok(Self {
            interrupt: signal(SignalKind::interrupt())?,
            terminate: signal(SignalKind::terminate())?,
            hangup: signal(SignalKind::hangup())?,
        })
    }

    /// The next of them.
    pub(super) async fn next(&mut self) -> Order {
        tokio::select! {
            _ = self.terminate.recv() => Order::Drain,
            _ = self.interrupt.recv() => Order::Stop,
            _ = self.hangup.recv() => Order::Reload,
        }
    }

    /// The next that asks to leave.
    pub(super) async fn leave(&mut self) {
        tokio::select! { _ = self.terminate.recv() => {}, _ = self.interrupt.recv() => {} }
    }
}
