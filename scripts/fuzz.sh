#!/usr/bin/env bash
# Fuzzes every target for so many seconds (120 when not said), two at a time, with the address sanitizer. What is found
# ends it with a status other than 0 and lies in fuzz/artifacts/. Wants a nightly compiler: rustup toolchain install
# nightly. Inputs that were worth keeping stay in target/corpus/; a crash that was mended belongs into fuzz/seeds/,
# which tests/seeds.rs sends in every run of the tests.
#
#   scripts/fuzz.sh [seconds-per-target [target...]]
set -euo pipefail
cd "$(dirname "$0")/.."

VERSION=0.13.2
seconds=${1:-120}
[ $# -eq 0 ] || shift
export PATH="$PWD/target/tools/bin:$PATH"
if ! cargo fuzz --version 2>/dev/null | grep -q "$VERSION"; then
    cargo install cargo-fuzz --version "$VERSION" --locked --debug --root target/tools --target-dir target/tools/build
fi

fuzz() { cargo +nightly fuzz "$1" --target-dir "$PWD/target/fuzz" "${@:2}"; }
fuzz build
targets=("$@")
[ ${#targets[@]} -gt 0 ] || mapfile -t targets < <(cargo +nightly fuzz list)

run() {
    mkdir -p "target/corpus/$1"
    seeds=()
    [ ! -d "fuzz/seeds/$1" ] || seeds=("fuzz/seeds/$1")
    log="target/corpus/$1.log"
    # The pool of threads lives as long as the process: not a leak.
    if fuzz run "$1" "target/corpus/$1" "${seeds[@]}" -- \
        -max_total_time="$seconds" -timeout=20 -rss_limit_mb=4096 -max_len=4096 -detect_leaks=0 >"$log" 2>&1; then
        echo "$1: $(grep -E '^Done|stat::number_of_executed_units' "$log" | tail -n 1), $(grep -o 'cov: [0-9]*' "$log" | tail -n 1), clean"
    else
        echo "$1: FAILED, see $log"
        tail -n 40 "$log"
        return 1
    fi
}
export -f run fuzz
export seconds
printf '%s\n' "${targets[@]}" | xargs -P 2 -I '{}' bash -c 'run {}'
