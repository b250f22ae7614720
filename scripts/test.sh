#!/usr/bin/env bash
# Every check of the project, on a bare Debian-like machine with rustup, python3 and the package
# registries. The last line counts the tests of all parts.
set -euo pipefail
cd "$(dirname "$0")/.."

DENY=0.20.2
step() { printf '\n== %s (%d s)\n' "$*" "$SECONDS"; }
log=$(mktemp)
trap 'rm -f "$log"' EXIT
# Steps that are not cargo's tests count as one each.
passes() { echo "test result: ok. 1 passed; 0 failed; 0 ignored;" >>"$log"; }

export PATH="$PWD/target/tools/bin:$PATH"
deny() {
    cargo deny --version 2>/dev/null | grep -q "$DENY" && return
    nice cargo install cargo-deny --version "$DENY" --locked --debug --jobs 1 --root target/tools --target-dir target/tools/build
    # A gigabyte that nothing needs any more.
    rm -rf target/tools/build
}

step "format"
cargo fmt --check
cargo fmt --check --manifest-path fuzz/Cargo.toml
step "the core stands alone"
cargo check --lib --no-default-features
step "lints"
cargo clippy --all-targets -- -D warnings
step "the release binary"
# Static, as in the container: built once, and what everything below runs.
REFLECTANCE_RELEASE=$(scripts/static.sh --bin reflectance --example floors)
export REFLECTANCE_RELEASE
step "tests"
# The faults are the release binary's: what it does with memory and time is what counts.
export REFLECTANCE_BINARY=$REFLECTANCE_RELEASE/reflectance
cargo test --no-fail-fast 2>&1 | tee -a "$log"
step "documentation"
RUSTDOCFLAGS="-D warnings" cargo doc --no-deps --quiet
step "the service against its own document, without keys and with"
# Built beside it: the service and its tester keep one processor busy between them.
deny >target/deny.log 2>&1 &
deny=$!
scripts/schemathesis.sh 70 30
passes
step "licences, duplicates, sources"
wait $deny || { tail -n 20 target/deny.log; exit 1; }
# Advisories are asked for where GitHub can be reached, which holds their list: cargo deny check advisories.
cargo deny check licenses bans sources
passes
step "a minute at half load"
scripts/soak.sh 60
passes
step "three replicas behind a balancer: one killed, all restarted"
scripts/replicas.sh
passes
step "examples and generated clients"
scripts/clients.sh | tee -a "$log"
step "the page in a browser"
scripts/browser.sh --binary "$REFLECTANCE_BINARY" | tee -a "$log"
step "the container"
scripts/container.sh --binary "$REFLECTANCE_BINARY" | tee -a "$log"

awk '/^test result:/ { passed += $4; failed += $6; ignored += $8 }
     END { printf "\n%d passed, %d failed, %d skipped\n", passed, failed, ignored; exit failed > 0 || passed == 0 }' "$log"
