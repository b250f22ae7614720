#!/usr/bin/env bash
# The page in headless Chromium against the release binary: browser.sh [--binary PATH] [TEST FILE...]. Chromium, Node and
# npm come from Debian where they are absent, the test tools from npm under target/browser. About a minute. The last line
# counts the tests.
set -euo pipefail
cd "$(dirname "$0")/.."

REFLECTANCE_BINARY=${REFLECTANCE_BINARY:-$PWD/target/release/reflectance}
if [[ ${1:-} == --binary ]]; then
    REFLECTANCE_BINARY=$(realpath "$2")
    shift 2
fi
[[ -x $REFLECTANCE_BINARY ]] || cargo build --release --quiet
export REFLECTANCE_BINARY

missing=()
command -v chromium >/dev/null || missing+=(chromium)
# Debian 12 has 18, which does as well.
command -v node >/dev/null || missing+=(nodejs)
command -v npm >/dev/null || missing+=(npm)
if ((${#missing[@]})); then
    apt-get update -qq && apt-get install -y -qq --no-install-recommends "${missing[@]}" >&2
fi
CHROMIUM=$(command -v chromium)
export CHROMIUM

work=$PWD/target/browser
mkdir -p "$work"
cp tests/browser/package.json tests/browser/package-lock.json "$work"
cp tests/browser/*.js "$work"
cd "$work"
# What is there already in the right version is not fetched again.
if ! cmp -s package-lock.json complete; then
    rm -f complete
    npm ci --silent --no-audit --no-fund >&2
    cp package-lock.json complete
fi
(($#)) || set -- *.test.js
status=0
node --test --test-reporter=spec --test-reporter-destination=stdout --test-reporter=tap --test-reporter-destination=said \
    "$@" || status=$?
passed=$(sed -n 's/^# pass \([0-9]*\)$/\1/p' said)
failed=$(sed -n 's/^# fail \([0-9]*\)$/\1/p' said)
echo "test result: $( ((status)) && echo FAILED || echo ok). ${passed:-0} passed; ${failed:-0} failed; 0 ignored;"
exit "$status"
