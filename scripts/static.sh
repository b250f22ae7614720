#!/bin/sh
# Builds for release with the C library linked in, as the container has it, and prints the folder of what was built.
# Arguments go to cargo. Debian's libc6-dev has all that it takes.
set -eu
cd "$(dirname "$0")/.."
host=$(rustc -vV | sed -n 's/^host: //p')
# By naming the target: the flag is then for the program alone, not for the macros that the compiler loads.
RUSTFLAGS="-C target-feature=+crt-static" cargo build --release --target "$host" "$@" >&2
echo "$PWD/target/$host/release"
