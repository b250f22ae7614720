#!/bin/sh
# Measures what docs/accuracy.md says, and writes its tables and pictures. Nothing else should run beside it: it takes times.
set -eu
cd "$(dirname "$0")/.."

UPDATE_ACCURACY=1 cargo test --quiet --test golden
cargo run --quiet --release --no-default-features --example accuracy
