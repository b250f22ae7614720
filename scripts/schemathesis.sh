#!/bin/sh
# Runs every check of schemathesis against the release binary, for three minutes at most.
# Findings end it with a status other than 0. The tool lives in a virtual environment under target/.
set -eu
cd "$(dirname "$0")/.."

VERSION=4.32.0
SECONDS_AT_MOST=${1:-150}
venv=target/schemathesis
if [ ! -x "$venv/bin/schemathesis" ]; then
    # Debian keeps venv in a package of its own.
    python3 -m venv "$venv" || { apt-get update && apt-get install -y python3-venv && python3 -m venv "$venv"; }
    "$venv/bin/pip" install --quiet "schemathesis==$VERSION"
fi

cargo build --release --quiet
said=$(mktemp)
./target/release/reflectance --listen 127.0.0.1:0 --log-level warn >"$said" &
server=$!
trap 'kill $server 2>/dev/null || true; rm -f "$said"' EXIT INT TERM
until grep -q '^Try:' "$said"; do
    kill -0 $server
    sleep 0.1
done
url=$(sed -n 's|.* on \(http://[^/ ]*\).*|\1|p' "$said")

# From there, so that the tool keeps its notes under target/ too.
config=$PWD/scripts/schemathesis.toml
cd "$venv"
timeout 180 ./bin/schemathesis --config-file "$config" run "$url/openapi.json" \
    --checks all --max-time "$SECONDS_AT_MOST"
kill -0 $server
