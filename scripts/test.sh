#!/usr/bin/env bash
# Every check of the project, on a bare Debian-like machine with rustup, python3 and the package registries, some 25 minutes
# on two processors. What waits, downloads or keeps one processor busy runs beside the rest. The last line counts the tests
# of all parts.
set -euo pipefail
cd "$(dirname "$0")/.."

DENY=0.20.2
step() { printf '\n== %s (%d s)\n' "$*" "$SECONDS"; }
logs=$PWD/target/check
mkdir -p "$logs"
log=$logs/results
: >"$log"
declare -A beside=()
trap 'kill "${beside[@]}" 2>/dev/null || true' EXIT
# begin NAME COMMAND...: runs it beside what follows. await NAME: waits for it, shows what it said, and fails as it did.
begin() {
    local name=$1
    shift
    "$@" >"$logs/$name" 2>&1 &
    beside[$name]=$!
}
await() {
    local status=0
    wait "${beside[$1]}" || status=$?
    unset "beside[$1]"
    step "$1 is through"
    # Not that every test passed: nothing may be left to show.
    { grep -v '^test .* ok$' "$logs/$1" || true; } | tail -n 200
    return "$status"
}
# Steps that are not cargo's tests count as one each.
passes() { echo "test result: ok. 1 passed; 0 failed; 0 ignored;" >>"$log"; }

export PATH="$PWD/target/tools/bin:$PATH"
deny() {
    cargo deny --version 2>/dev/null | grep -q "$DENY" && return
    nice cargo install cargo-deny --version "$DENY" --locked --debug --jobs 1 --root target/tools --target-dir target/tools/build
    # A gigabyte that nothing needs any more.
    rm -rf target/tools/build
}
# What the steps at the end need, and would fetch themselves.
tools() {
    local missing=() package
    for package in chromium nodejs npm haproxy buildah podman runc netavark aardvark-dns iptables binutils curl python3-venv; do
        dpkg-query -W -f '${Status}' "$package" 2>/dev/null | grep -q ' installed' || missing+=("$package")
    done
    # Another Node.js than Debian's serves as well.
    command -v npm >/dev/null && missing=($(printf '%s\n' "${missing[@]}" | grep -vx -e nodejs -e npm || true))
    ((${#missing[@]})) || return 0
    apt-get update -qq && DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends "${missing[@]}"
}
# All tests of cargo but those of tests/faults, which wait most of the time.
tests() {
    local targets=(--lib --bins --examples) path name
    for path in tests/*; do
        name=$(basename "$path" .rs)
        [[ $name != faults && (-f $path/main.rs || $path == *.rs) ]] && targets+=(--test "$name")
    done
    cargo test --no-fail-fast "${targets[@]}"
}

begin tools tools
step "format"
cargo fmt --check
cargo fmt --check --manifest-path fuzz/Cargo.toml
step "the core stands alone"
cargo check --lib --no-default-features
begin lints cargo clippy --all-targets -- -D warnings
step "the release binary"
# Static, as in the container: built once, and what everything below runs.
REFLECTANCE_RELEASE=$(scripts/static.sh --bin reflectance)
export REFLECTANCE_RELEASE
# The faults are the release binary's: what it does with memory and time is what counts.
export REFLECTANCE_BINARY=$REFLECTANCE_RELEASE/reflectance
await lints
begin deny deny
step "tests"
cargo test --no-run
begin faults cargo test --test faults
tests 2>&1 | tee -a "$log"
await faults
cat "$logs/faults" >>"$log"
begin documentation env RUSTDOCFLAGS="-D warnings" cargo doc --no-deps --quiet
step "the service against its own document, without keys and with"
scripts/schemathesis.sh 70 30
passes
await documentation
await deny
step "licences, duplicates, sources"
# Advisories are asked for where GitHub can be reached, which holds their list: cargo deny check advisories.
cargo deny check licenses bans sources
passes
await tools
# It writes the large requests of the soak, which are the same from any build.
mkdir -p "$REFLECTANCE_RELEASE/examples"
cp target/debug/examples/floors "$REFLECTANCE_RELEASE/examples/"
begin soak scripts/soak.sh 60
step "three replicas behind a balancer: one killed, all restarted"
scripts/replicas.sh
passes
step "examples and generated clients"
scripts/clients.sh | tee -a "$log"
step "the container"
scripts/container.sh --binary "$REFLECTANCE_BINARY" | tee -a "$log"
await soak
passes
step "the page in a browser"
scripts/browser.sh --binary "$REFLECTANCE_BINARY" | tee -a "$log"
step "the end"

awk '/^test result:/ { passed += $4; failed += $6; ignored += $8 }
     END { printf "\n%d passed, %d failed, %d skipped\n", passed, failed, ignored; exit failed > 0 || passed == 0 }' "$log"
