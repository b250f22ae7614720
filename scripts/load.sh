#!/usr/bin/env bash
# The load test: what a request costs, each figure beside its floor and its limit. Loopback only, about ten minutes.
# Nothing else should run beside it. Options: --rounds N, --only MEASURE, --json FILE (scripts/load/main.py).
# Installs what is missing: wrk and valgrind by apt-get, FastAPI and NumPy into an environment under target/.
set -euo pipefail
cd "$(dirname "$0")/.."

missing=()
for tool in wrk valgrind; do
    command -v "$tool" >/dev/null || missing+=("$tool")
done
if ((${#missing[@]})); then
    apt-get update -qq && apt-get install -y -qq "${missing[@]}" >&2
fi

venv=target/load/venv
if [[ ! -e $venv/complete ]]; then
    # Debian keeps venv in a package of its own.
    python3 -m venv "$venv" || { apt-get install -y -qq python3-venv >&2 && python3 -m venv "$venv"; }
    "$venv/bin/pip" install --quiet fastapi==0.165.0 uvicorn==0.54.0 httptools==0.9.0 uvloop==0.23.0 numpy==2.4.6
    touch "$venv/complete"
fi

cargo build --release --quiet --bin reflectance --example hello --example floors
exec timeout 1800 "$venv/bin/python" scripts/load/main.py "$@"
