//! How long a connection may do what it does: the one place that ends it.

use super::activity::{Activity, now};
use super::doors::{Doors, Stage};
use super::milliseconds;
use crate::http::app::Limits;
use std::future::poll_fn;
use std::pin::{Pin, pin};
use std::task::Poll;
use std::time::Duration;
use tokio::task::coop::has_budget_remaining;
use tokio::time::{Instant, Sleep};

/// Once the service closes: how long a connection may be silent before it counts as idle. A client that sends one
/// request after the other is never silent for so long, and none of its requests finds a closed connection.
const QUIET: u64 = 1000;
/// How long a connection keeps its buffers after an answer.
const KEPT: u64 = 5000;
/// The clock that is read is coarser than the one that wakes.
const COARSE: u64 = 5;

/// What is driven.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Phase {
    /// Until the first bytes, or the next; a handshake.
    Waiting,
    /// Requests one after the other.
    Http1,
    /// Requests side by side.
    Http2,
}

/// The time limits of connections, in milliseconds.
#[derive(Clone, Copy, Debug)]
pub(super) struct Times {
    idle: u64,
    stall: u64,
    answer: u64,
}

/// What to do with a connection.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Verdict {
    /// Look again at this time.
    Wait(u64),
    /// It is idle and may end, or go to sleep.
    End,
    /// It ends at once.
    Cut(&'static str),
}

impl Times {
    pub(super) fn of(limits: &Limits) -> Self {
        Self {
            idle: milliseconds(limits.idle_time),
            stall: milliseconds(limits.stall_time),
            answer: milliseconds(limits.answer_time),
        }
    }

    /// Whatever begins after `now` is not due before the shortest of the limits.
    fn judge(&self, activity: &Activity, phase: Phase, stage: Stage, now: u64) -> Verdict {
        let mut next = now + self.idle.min(self.stall).min(self.answer);
        if let Some(since) = activity.blocked_since() {
            if now >= since + self.stall {
                return Verdict::Cut("the client took nothing of its answer");
            }
            next = next.min(since + self.stall);
        }
        if let Some(since) = activity.answering_since() {
            if now >= since + self.answer {
                return Verdict::Cut("an answer took too long to send");
            }
            next = next.min(since + self.answer);
        }
        if !activity.is_idle() {
            return Verdict::Wait(next);
        }
        let since = activity.idle_since();
        let idle = since + self.idle;
        if phase == Phase::Http1 && activity.head_begun() {
            let late = now >= idle;
            return if late { Verdict::Cut("a head took too long") } else { Verdict::Wait(next.min(idle)) };
        }
        let rest = match phase {
            _ if stage >= Stage::Closing => idle.min(since + QUIET),
            Phase::Http1 => idle.min(since + KEPT),
            Phase::Waiting | Phase::Http2 => idle,
        };
        if now >= rest { Verdict::End } else { Verdict::Wait(next.min(rest)) }
    }
}

/// A connection under watch.
pub(super) struct Watch<'a> {
    pub(super) activity: &'a Activity,
    pub(super) doors: &'a Doors,
    pub(super) times: Times,
}

impl Watch<'_> {
    /// Drives a future to its end, unless time runs out. `end` asks it to end by itself.
    pub(super) async fn drive<F: Future>(
        &self,
        phase: Phase,
        mut future: Pin<&mut F>,
        mut end: impl FnMut(Pin<&mut F>),
    ) -> Option<F::Output> {
        let begun_at = self.doors.stage().min(Stage::Draining);
        let mut sleep = pin!(tokio::time::sleep(Duration::ZERO));
        let mut asked: Option<Asked> = None;
        loop {
            let mut changed = pin!(self.doors.changed());
            changed.as_mut().enable();
            let stage = self.doors.stage();
            let now = now();
            if stage == Stage::Cutting {
                if !self.activity.is_idle() || phase == Phase::Http1 && self.activity.head_begun() {
                    self.doors.note_cut();
                }
                return None;
            }
            let verdict = self.times.judge(self.activity, phase, stage, now);
            let mut wake = match verdict {
                Verdict::Cut(reason) => {
                    tracing::debug!(reason, "a connection was let go");
                    return None;
                }
                Verdict::End if phase == Phase::Waiting => return None,
                Verdict::End if phase == Phase::Http1 => {
                    end(future.as_mut());
                    now + QUIET
                }
                Verdict::End => now,
                Verdict::Wait(until) => until,
            };
            if phase == Phase::Http2 && (stage > begun_at || verdict == Verdict::End || asked.is_some()) {
                let asked = asked.get_or_insert_with(|| {
                    end(future.as_mut());
                    Asked { moves: self.activity.moves(), moved_at: now, busy_at: now }
                });
                if asked.is_ignored(self.activity, now, self.times.stall) {
                    return None;
                }
                wake = now + QUIET;
            }
            sleep.as_mut().reset(Instant::now() + Duration::from_millis(wake.saturating_sub(now) + COARSE));
            let ended = self.once(future.as_mut(), sleep.as_mut(), changed.as_mut(), stage).await;
            if ended.is_some() {
                return ended;
            }
        }
    }

    /// Until the future ends, or something else is to be looked at.
    ///
    /// The timer and the word of a new stage are polled until they know whom to wake; from then on it costs next
    /// to nothing to ask whether they did.
    async fn once<F: Future>(
        &self,
        mut future: Pin<&mut F>,
        mut sleep: Pin<&mut Sleep>,
        mut changed: Pin<&mut tokio::sync::futures::Notified<'_>>,
        stage: Stage,
    ) -> Option<F::Output> {
        let mut known = false;
        poll_fn(|cx| {
            if let Poll::Ready(ended) = future.as_mut().poll(cx) {
                return Poll::Ready(Some(ended));
            }
            if !known {
                // Without budget a timer is not asked at all, and the task is woken again.
                known = has_budget_remaining();
                if sleep.as_mut().poll(cx).is_ready() || changed.as_mut().poll(cx).is_ready() {
                    return Poll::Ready(None);
                }
            }
            if sleep.is_elapsed() || self.doors.stage() != stage { Poll::Ready(None) } else { Poll::Pending }
        })
        .await
    }
}

/// A connection of HTTP/2 was asked to end. It waits for the client to confirm that it heard of the end, and a
/// client that is gone never does.
struct Asked {
    moves: u64,
    /// When something last moved, and when a request was last under way.
    moved_at: u64,
    busy_at: u64,
}

impl Asked {
    /// Whether nothing is under way, and nothing has moved for a while or what moves leads to nothing.
    fn is_ignored(&mut self, activity: &Activity, now: u64, stall: u64) -> bool {
        if activity.moves() != self.moves {
            (self.moves, self.moved_at) = (activity.moves(), now);
        }
        if !activity.is_idle() {
            (self.moved_at, self.busy_at) = (now, now);
        }
        now >= self.moved_at + QUIET || now >= self.busy_at + stall
    }
}
