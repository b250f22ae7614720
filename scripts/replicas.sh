#!/usr/bin/env bash
# Three replicas behind the balancer with docker/haproxy.cfg, on loopback: under load one is killed and all are restarted
# one after the other. No request may fail, and every answer must be the same whoever gave it. Some 20 seconds.
set -euo pipefail
cd "$(dirname "$0")/.."

if ! command -v haproxy >/dev/null; then
    apt-get update -qq && apt-get install -y -qq --no-install-recommends haproxy >&2
fi
if [[ -z ${REFLECTANCE_BINARY:-} ]]; then
    cargo build --release --quiet
    REFLECTANCE_BINARY=$PWD/target/release/reflectance
fi
export REFLECTANCE_BINARY
exec timeout 300 python3 scripts/replicas/main.py "$@"
