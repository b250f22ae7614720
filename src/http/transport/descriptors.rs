//! File descriptors: a connection each.

use rustix::process::{Resource, Rlimit, getrlimit, setrlimit};

/// Descriptors for everything but connections: the listening socket, the runtime's own, files that are read.
const OTHERS: u64 = 64;

/// Raises the soft limit to the hard one, and warns where that is not enough for so many connections.
pub(super) fn raise(connections: usize) {
    let Rlimit { current, maximum } = getrlimit(Resource::Nofile);
    if current != maximum
        && let Err(error) = setrlimit(Resource::Nofile, Rlimit { current: maximum, maximum })
    {
        tracing::warn!(%error, "the limit of open files was not raised");
    }
    let wanted = connections as u64 + OTHERS;
    // None stands for as many as one likes.
    if let Some(files) = getrlimit(Resource::Nofile).current
        && files < wanted
    {
        tracing::warn!(
            files,
            connections,
            "the limit of open files (ulimit -n) is below what --connection-limit may take: {files} < {wanted}"
        );
    }
}
