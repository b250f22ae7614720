//! What a connection is doing, in a few words of memory that its parts write without a lock: the stream notes what
//! moves, the requests note that they are there, and the connection's own task looks at it now and then.

use rustix::time::{ClockId, clock_gettime};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU64, AtomicUsize, Ordering};

/// A time in milliseconds of a clock that only goes forwards, right to a few milliseconds and almost free to read.
pub(super) fn now() -> u64 {
    let time = clock_gettime(ClockId::MonotonicCoarse);
    let whole = u64::try_from(time.tv_sec).unwrap_or(0).saturating_mul(1000);
    // Zero stands for never.
    (whole + u64::try_from(time.tv_nsec).unwrap_or(0) / 1_000_000).max(1)
}

/// What one connection is doing. Times are those of [`now`].
#[derive(Debug)]
pub(super) struct Activity {
    /// Requests whose answers are not complete.
    in_flight: AtomicUsize,
    /// When the last of them was, or the connection began.
    idle_since: AtomicU64,
    /// When the answer that is being sent began, or 0; of HTTP/1, which sends one at a time.
    answering_since: AtomicU64,
    /// Since when the client takes nothing of what is to be sent, or 0.
    blocked_since: AtomicU64,
    /// Counts what moved, either way.
    moves: AtomicU64,
    /// Bytes of a request's head have arrived and the rest has not.
    head_begun: AtomicBool,
    /// The next read of an idle connection finds its end.
    let_go: AtomicBool,
    /// A request was answered before all of it was read.
    unread: AtomicBool,
    /// The client has ended its side.
    left: AtomicBool,
}

impl Activity {
    pub(super) fn new() -> Arc<Self> {
        Arc::new(Self {
            in_flight: AtomicUsize::new(0),
            idle_since: AtomicU64::new(now()),
            answering_since: AtomicU64::new(0),
            blocked_since: AtomicU64::new(0),
            moves: AtomicU64::new(0),
            head_begun: AtomicBool::new(false),
            let_go: AtomicBool::new(false),
            unread: AtomicBool::new(false),
            left: AtomicBool::new(false),
        })
    }

    /// A request's head has arrived.
    pub(super) fn begin(self: &Arc<Self>) -> Exchange {
        self.in_flight.fetch_add(1, Ordering::Relaxed);
        self.head_begun.store(false, Ordering::Relaxed);
        self.let_go.store(false, Ordering::Relaxed);
        Exchange(Arc::clone(self))
    }

    /// The head of an answer is there.
    pub(super) fn answering(&self) {
        self.answering_since.store(now(), Ordering::Relaxed);
    }

    /// Bytes were read by whoever serves the connection.
    pub(super) fn read(&self) {
        if self.in_flight.load(Ordering::Relaxed) == 0 {
            self.head_begun.store(true, Ordering::Relaxed);
        }
    }

    /// The client sends no more.
    pub(super) fn leave(&self) {
        self.left.store(true, Ordering::Relaxed);
    }

    /// Bytes moved on the socket.
    pub(super) fn moved(&self) {
        self.moves.store(self.moves.load(Ordering::Relaxed).wrapping_add(1), Ordering::Relaxed);
    }

    /// Bytes were taken by the socket.
    pub(super) fn sent(&self) {
        self.moved();
        if self.blocked_since.load(Ordering::Relaxed) != 0 {
            self.blocked_since.store(0, Ordering::Relaxed);
        }
    }

    /// The socket takes no more.
    pub(super) fn blocked(&self) {
        if self.blocked_since.load(Ordering::Relaxed) == 0 {
            self.blocked_since.store(now(), Ordering::Relaxed);
        }
    }

    /// Makes the next read find the end of an idle connection, if no byte has arrived by then.
    pub(super) fn let_go(&self) {
        self.let_go.store(true, Ordering::Relaxed);
    }

    /// Takes that back: something is there to be read.
    pub(super) fn stay(&self) {
        self.let_go.store(false, Ordering::Relaxed);
    }

    /// A request's body was dropped before its end.
    pub(super) fn leave_unread(&self) {
        self.unread.store(true, Ordering::Relaxed);
    }

    pub(super) fn has_unread(&self) -> bool {
        self.unread.load(Ordering::Relaxed)
    }

    /// Whether a read that finds no bytes is the end: nothing is under way, and nothing waits to be sent. Not where
    /// the client itself made an end.
    pub(super) fn is_over(&self) -> bool {
        self.let_go.load(Ordering::Relaxed)
            && !self.left.load(Ordering::Relaxed)
            && self.is_idle()
            && !self.head_begun()
            && self.blocked_since().is_none()
    }

    pub(super) fn is_idle(&self) -> bool {
        self.in_flight.load(Ordering::Acquire) == 0
    }

    pub(super) fn head_begun(&self) -> bool {
        self.head_begun.load(Ordering::Relaxed)
    }

    pub(super) fn idle_since(&self) -> u64 {
        self.idle_since.load(Ordering::Relaxed)
    }

    pub(super) fn moves(&self) -> u64 {
        self.moves.load(Ordering::Relaxed)
    }

    pub(super) fn answering_since(&self) -> Option<u64> {
        Some(self.answering_since.load(Ordering::Relaxed)).filter(|since| *since != 0)
    }

    pub(super) fn blocked_since(&self) -> Option<u64> {
        Some(self.blocked_since.load(Ordering::Relaxed)).filter(|since| *since != 0)
    }
}

/// A request whose answer is not complete; dropped with the answer's body, or with the client who left.
#[derive(Debug)]
pub(super) struct Exchange(Arc<Activity>);

impl Drop for Exchange {
    fn drop(&mut self) {
        let Self(activity) = self;
        activity.idle_since.store(now(), Ordering::Relaxed);
        activity.answering_since.store(0, Ordering::Relaxed);
        // After the times, for whoever sees the connection idle.
        activity.in_flight.fetch_sub(1, Ordering::Release);
    }
}

#[cfg(test)]
mod tests {
    use super::{Activity, now};

    #[test]
    fn a_connection_is_over_only_where_nothing_is_under_way() {
        let activity = Activity::new();
        assert!(!activity.is_over(), "nobody said so");
        activity.let_go();
        assert!(activity.is_over());
        activity.read();
        assert!(!activity.is_over(), "a head has begun");
        let exchange = activity.begin();
        activity.let_go();
        assert!(!activity.is_over(), "a request is in flight");
        activity.blocked();
        drop(exchange);
        assert!(!activity.is_over(), "its answer is not sent");
        activity.sent();
        assert!(activity.is_over());
        activity.leave();
        assert!(!activity.is_over(), "the client left by itself");
    }

    #[test]
    fn the_clock_goes_forwards() {
        let before = now();
        std::thread::sleep(std::time::Duration::from_millis(30));
        assert!(now() > before);
    }
}
