#!/usr/bin/env bash
# Half load for so many seconds (60), a mix of everything that clients do: memory and descriptors must not grow.
# By hand before a release: scripts/soak.sh 1800. REFLECTANCE_RELEASE names the folder of what was built already.
set -euo pipefail
cd "$(dirname "$0")/.."
if [[ -z ${REFLECTANCE_RELEASE:-} ]]; then
    cargo build --release --quiet --bin reflectance --example floors
fi
exec python3 scripts/load/soak.py "$@"
