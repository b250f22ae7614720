#!/usr/bin/env bash
# The clients: the programs in examples/, and those that openapi-python-client and openapi-typescript make of the document,
# against a service that this starts, or against the one at REFLECTANCE_URL (without keys). Types are checked as well.
# Some 30 seconds once the tools are under target/clients. The last line counts the tests.
set -euo pipefail
cd "$(dirname "$0")/.."

work=$PWD/target/clients
mkdir -p "$work"

missing=()
command -v curl >/dev/null || missing+=(curl)
# Debian 12 has 18, which does as well.
command -v node >/dev/null || missing+=(nodejs)
command -v npm >/dev/null || missing+=(npm)
if ((${#missing[@]})); then
    apt-get update -qq && apt-get install -y -qq --no-install-recommends "${missing[@]}" >&2
fi

# The tools, once for each list of their versions.
wanted=$(cat examples/python/requirements.txt tests/clients/requirements.txt tests/clients/package.json | sha256sum)
if [[ $(cat "$work/complete" 2>/dev/null) != "$wanted" ]]; then
    rm -rf "$work/complete" "$work/venv" "$work/node"
    # Debian keeps venv in a package of its own.
    python3 -m venv "$work/venv" || { apt-get install -y -qq python3-venv >&2 && python3 -m venv "$work/venv"; }
    "$work/venv/bin/pip" install --quiet --disable-pip-version-check \
        -r examples/python/requirements.txt -r tests/clients/requirements.txt &
    python=$!
    mkdir -p "$work/node"
    cp tests/clients/package.json "$work/node"
    npm install --prefix "$work/node" --silent --no-audit --no-fund >&2
    wait $python
    echo "$wanted" >"$work/complete"
fi
export PATH=$work/venv/bin:$PATH

servers=()
trap '((${#servers[@]})) && kill "${servers[@]}" || true' EXIT
# start FLAG...: a service of its own on a free port; sets url.
start() {
    local said=$work/said.${#servers[@]}
    : >"$said"
    "$REFLECTANCE_BINARY" --listen 127.0.0.1:0 --log-level warn "$@" >"$said" &
    servers+=($!)
    until grep -q '^Try:' "$said"; do
        kill -0 "${servers[-1]}"
        sleep 0.05
    done
    url=$(sed -n 's|.* on \(http://[^/ ]*\).*|\1|p' "$said")
}

export REFLECTANCE_KEY=0123456789abcdef0123456789abcdef
if [[ -n ${REFLECTANCE_URL:-} ]]; then
    open=$REFLECTANCE_URL
    keyed=$REFLECTANCE_URL
    export REFLECTANCE_OPEN=1
else
    if [[ -z ${REFLECTANCE_BINARY:-} ]]; then
        cargo build --release --quiet
        REFLECTANCE_BINARY=$PWD/target/release/reflectance
    fi
    start
    open=$url
    echo "tester $REFLECTANCE_KEY" >"$work/keys"
    start --api-keys-file "$work/keys"
    keyed=$url
fi

echo "clients: generate and check types"
curl --fail --silent --show-error "$open/openapi.json" >"$work/openapi.json"
rm -rf "$work/python" && mkdir -p "$work/python"
# From there, so that its caches stay there too.
(
    cd "$work/python"
    openapi-python-client generate --path "$work/openapi.json" --output-path reflectance_client --meta none \
        --config "$OLDPWD/tests/clients/generator.yaml" --fail-on-warning
    cp "$OLDPWD/tests/clients/test_generated.py" .
    mypy --strict --follow-imports=silent test_generated.py
) &
python=$!
(
    cd "$work/node"
    npx openapi-typescript "$work/openapi.json" --output document.d.ts
    cp "$OLDPWD/tests/clients/generated.test.ts" "$OLDPWD/tests/clients/tsconfig.json" .
    npx tsc
)
wait $python

passed=0
# counted PATTERN COMMAND...: runs tests and adds up how many passed; any failure ends the script.
counted() {
    local pattern=$1 said
    shift
    said=$("$@" 2>&1) || { echo "$said"; exit 1; }
    passed=$((passed + $(sed -n "s/$pattern/\1/p" <<<"$said")))
}
echo "clients: examples"
REFLECTANCE_URL=$open counted '^Ran \([0-9]*\) tests\{0,1\} in.*' python tests/clients/test_examples.py
echo "clients: generated, Python"
REFLECTANCE_URL=$keyed counted '^Ran \([0-9]*\) tests\{0,1\} in.*' python "$work/python/test_generated.py"
echo "clients: generated, TypeScript"
REFLECTANCE_URL=$keyed counted '^# pass \([0-9]*\)$' node --test --test-reporter=tap "$work/node/generated.test.js"
echo "test result: ok. $passed passed; 0 failed; 0 ignored;"
