#!/usr/bin/env bash
# Half load for so many seconds (60), a mix of everything that clients do: memory and descriptors must not grow.
# By hand before a release: scripts/soak.sh 1800.
set -euo pipefail
cd "$(dirname "$0")/.."
cargo build --release --quiet --bin reflectance --example floors
exec python3 scripts/load/soak.py "$@"
