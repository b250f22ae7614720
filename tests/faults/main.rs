//! The started binary against clients that are slow, gone, lying or many: it lives, answers the others, and gives
//! back what it took. Each test prints what it measured (`--nocapture` shows it).

mod arrow;
mod batches;
mod bombs;
mod client;
mod crowd;
mod lies;
mod load;
mod process;
mod slow;
mod stop;
mod vanish;

use std::sync::{Mutex, MutexGuard, PoisonError};

/// One at a time: they measure, and share two processors with what they measure.
static ALONE: Mutex<()> = Mutex::new(());

/// Held through a test. One that failed does not keep the next from running.
fn alone() -> MutexGuard<'static, ()> {
    ALONE.lock().unwrap_or_else(PoisonError::into_inner)
}
