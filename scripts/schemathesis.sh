#!/bin/sh
# Runs every check of schemathesis against the release binary, first open to anybody, then with a key, for some three
# minutes at most; or against the service at REFLECTANCE_URL, once. Findings end it with a status other than 0. The tool
# lives in a virtual environment under target/.
set -eu
cd "$(dirname "$0")/.."

VERSION=4.32.0
SECONDS_AT_MOST=${1:-100}
SECONDS_WITH_KEY=${2:-50}
venv=target/schemathesis
if [ ! -x "$venv/bin/schemathesis" ]; then
    # Debian keeps venv in a package of its own.
    python3 -m venv "$venv" || { apt-get update && apt-get install -y python3-venv && python3 -m venv "$venv"; }
    "$venv/bin/pip" install --quiet "schemathesis==$VERSION"
fi

config=$PWD/scripts/schemathesis.toml
notes=$(mktemp -d)
server=
trap 'kill $server 2>/dev/null || true; rm -rf "$notes"' EXIT INT TERM

# fuzz URL SECONDS [HEADER]
fuzz() {
    # From there, so that the tool keeps its notes under target/ too.
    (
        cd "$venv"
        timeout $(($2 + 30)) ./bin/schemathesis --config-file "$config" run "$1/openapi.json" \
            --checks all --max-time "$2" ${3:+-H "$3"}
    )
}

if [ -n "${REFLECTANCE_URL:-}" ]; then
    fuzz "$REFLECTANCE_URL" "$SECONDS_AT_MOST"
    exit
fi

if [ -z "${REFLECTANCE_BINARY:-}" ]; then
    cargo build --release --quiet
    REFLECTANCE_BINARY=$PWD/target/release/reflectance
fi

# check SECONDS [HEADER [FLAG...]]: starts the service with the flags, and checks what it answers with the header.
check() {
    seconds=$1
    header=${2:-}
    shift; [ $# -eq 0 ] || shift
    : >"$notes/said"
    "$REFLECTANCE_BINARY" --listen 127.0.0.1:0 --log-level warn "$@" >"$notes/said" &
    server=$!
    until grep -q '^Try:' "$notes/said"; do
        kill -0 $server
        sleep 0.1
    done
    url=$(sed -n 's|.* on \(http://[^/ ]*\).*|\1|p' "$notes/said")
    fuzz "$url" "$seconds" "$header"
    kill -0 $server
    kill $server
    wait $server || true
}

echo "schemathesis: without keys"
check "$SECONDS_AT_MOST"
echo "schemathesis: with a key"
key=0123456789abcdef0123456789abcdef
echo "tester $key" >"$notes/keys"
check "$SECONDS_WITH_KEY" "Authorization: Bearer $key" --api-keys-file "$notes/keys"
