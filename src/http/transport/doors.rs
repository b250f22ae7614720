//! Whether the service takes connections, how many there are, and the word to all of them when that changes.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU8, AtomicUsize, Ordering};
use tokio::sync::Notify;
use tokio::sync::futures::Notified;

/// How far the service is on its way out.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[repr(u8)]
pub(super) enum Stage {
    /// Not at all.
    Open,
    /// Clients are told to go elsewhere, and are served.
    Draining,
    /// No more connections; those that there are end once they are idle.
    Closing,
    /// What is not done is cut off.
    Cutting,
}

/// What the connections and the service's state know of each other.
#[derive(Debug)]
pub(crate) struct Doors {
    stage: AtomicU8,
    changed: Notify,
    open: AtomicUsize,
    /// How many there may be.
    limit: usize,
    left: Notify,
    cut: AtomicBool,
}

impl Doors {
    pub(crate) fn new(limit: usize) -> Arc<Self> {
        Arc::new(Self {
            stage: AtomicU8::new(Stage::Open as u8),
            changed: Notify::new(),
            open: AtomicUsize::new(0),
            limit,
            left: Notify::new(),
            cut: AtomicBool::new(false),
        })
    }

    /// Whether the service is on its way out and no more requests should come to it.
    pub(crate) fn are_closing(&self) -> bool {
        self.stage() != Stage::Open
    }

    /// Connections that there are.
    pub(crate) fn connections(&self) -> usize {
        self.open.load(Ordering::Relaxed)
    }

    pub(super) fn stage(&self) -> Stage {
        match self.stage.load(Ordering::Acquire) {
            0 => Stage::Open,
            1 => Stage::Draining,
            2 => Stage::Closing,
            _ => Stage::Cutting,
        }
    }

    /// Tells every connection.
    pub(super) fn turn_to(&self, stage: Stage) {
        self.stage.store(stage as u8, Ordering::Release);
        self.changed.notify_waiters();
    }

    /// Resolves when the stage changes, from when it is enabled.
    pub(super) fn changed(&self) -> Notified<'_> {
        self.changed.notified()
    }

    /// Counts a connection in.
    pub(super) fn enter(self: &Arc<Self>) -> Inside {
        self.open.fetch_add(1, Ordering::Relaxed);
        Inside(Arc::clone(self))
    }

    /// Whether one more may come in.
    pub(super) fn have_room(&self) -> bool {
        self.connections() < self.limit
    }

    /// Resolves once `condition` holds, which is asked when the last connection has left, and when one has from
    /// the limit.
    pub(super) async fn until(&self, condition: impl Fn(&Self) -> bool) {
        while !condition(self) {
            self.left.notified().await;
        }
    }

    /// A connection had to be cut off in the middle of a request.
    pub(super) fn note_cut(&self) {
        self.cut.store(true, Ordering::Relaxed);
    }

    /// Whether any was.
    pub(super) fn have_cut(&self) -> bool {
        self.cut.load(Ordering::Relaxed)
    }
}

/// A connection's place; it leaves when this is dropped.
#[derive(Debug)]
pub(super) struct Inside(Arc<Doors>);

impl Drop for Inside {
    fn drop(&mut self) {
        let before = self.0.open.fetch_sub(1, Ordering::Relaxed);
        if before == 1 || before >= self.0.limit {
            // There is one who waits, and one word is kept for it.
            self.0.left.notify_one();
        }
    }
}
