#!/bin/sh
# The page in headless Chromium against the release binary: browser.sh [--binary PATH] [TEST FILE...]. Chromium, Node and
# npm come from Debian where they are absent, the test tools from npm under tests/browser/.
set -eu
cd "$(dirname "$0")/.."

REFLECTANCE_BINARY=$PWD/target/release/reflectance
if [ "${1:-}" = --binary ]; then
    REFLECTANCE_BINARY=$(realpath "$2")
    shift 2
elif [ ! -x "$REFLECTANCE_BINARY" ]; then
    cargo build --release
fi
export REFLECTANCE_BINARY

missing=
command -v chromium >/dev/null || missing="$missing chromium"
command -v node >/dev/null || missing="$missing nodejs"
command -v npm >/dev/null || missing="$missing npm"
if [ -n "$missing" ]; then
    apt-get update -qq
    # shellcheck disable=SC2086 # one word a package
    apt-get install -y -qq --no-install-recommends $missing >/dev/null
fi
CHROMIUM=$(command -v chromium)
export CHROMIUM

cd tests/browser
# What is there already in the right version is not fetched again.
if ! cmp -s package-lock.json node_modules/.installed; then
    npm ci --silent --no-audit --no-fund
    cp package-lock.json node_modules/.installed
fi
[ $# -gt 0 ] || set -- ./*.test.js
exec node --test --test-reporter=spec "$@"
