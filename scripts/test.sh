#!/usr/bin/env bash
# Every check of the project, on a bare Debian-like machine with rustup, python3 and the package
# registries. The last line counts the tests of all parts.
set -euo pipefail
cd "$(dirname "$0")/.."

step() { printf '\n== %s\n' "$*"; }
log=$(mktemp)
trap 'rm -f "$log"' EXIT

step "format"
cargo fmt --check
step "the core stands alone"
cargo check --lib --no-default-features
step "lints"
cargo clippy --all-targets -- -D warnings
step "tests"
cargo test --no-fail-fast 2>&1 | tee "$log"
step "documentation"
RUSTDOCFLAGS="-D warnings" cargo doc --no-deps --quiet
step "the service against its own document"
cargo build --release
scripts/schemathesis.sh

awk '/^test result:/ { passed += $4; failed += $6; ignored += $8 }
     END { printf "\n%d passed, %d failed, %d skipped\n", passed, failed, ignored; exit failed > 0 || passed == 0 }' "$log"
