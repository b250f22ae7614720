//! What the kernel says about this process; 0 where it says nothing.

use rustix::time::{ClockId, clock_gettime};
use std::time::Duration;

/// Bytes of memory that the process holds.
pub(super) fn memory() -> u64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find_map(|line| line.strip_prefix("VmRSS:"));
    let kibibytes = line.and_then(|line| line.split_whitespace().next()?.parse::<u64>().ok());
    kibibytes.unwrap_or(0) << 10
}

/// Open file descriptors, the one of the list itself left out.
pub(super) fn descriptors() -> usize {
    std::fs::read_dir("/proc/self/fd").map_or(0, Iterator::count).saturating_sub(1)
}

/// Processor time of all threads.
pub(super) fn processor_time() -> Duration {
    let time = clock_gettime(ClockId::ProcessCPUTime);
    let nanoseconds = u32::try_from(time.tv_nsec).unwrap_or(0);
    Duration::new(u64::try_from(time.tv_sec).unwrap_or(0), nanoseconds)
}

#[cfg(test)]
mod tests {
    use super::{descriptors, memory, processor_time};

    #[test]
    fn a_process_holds_something() {
        assert!(memory() > 1 << 16 && descriptors() >= 3 && !processor_time().is_zero());
    }
}
