#!/usr/bin/env bash
# The image, built and run for real on a Debian machine without a container engine, and held to what is promised of it.
#
#   scripts/container.sh                  the whole of docker/Dockerfile: half an hour on two cores
#   scripts/container.sh --binary FILE    around a static binary that there is already (scripts/static.sh): a minute
#
# Needs root. Installs buildah, podman and runc; the whole build stands on an image that is made here of Debian and this
# machine's compiler, in place of docker.io/library/rust. The last line counts the checks.
set -euo pipefail
cd "$(dirname "$0")/.."

binary=
[[ ${1:-} == --binary ]] && binary=$(realpath "$2")

missing=()
for tool in buildah podman runc strip curl; do
    command -v "$tool" >/dev/null || missing+=("$tool")
done
if ((${#missing[@]})); then
    apt-get update -qq
    DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends \
        buildah podman runc netavark aardvark-dns iptables binutils curl >&2
fi

work=$PWD/target/container
mkdir -p "$work"
rust=$(sed -n 's/^channel = "\(.*\)"/\1/p' rust-toolchain.toml)
grep -q "^ARG RUST=$rust\$" docker/Dockerfile || { echo "docker/Dockerfile has another compiler than rust-toolchain.toml"; exit 1; }

# A stand-in for the official image of the compiler: what it is based on, a C compiler, and the toolchain of this machine.
base() {
    local image=docker.io/library/rust:$rust-bookworm root=$work/root sysroot
    podman image exists "$image" && return
    command -v debootstrap >/dev/null || apt-get install -y -qq --no-install-recommends debootstrap >&2
    echo "container: a base image of Debian and rust $rust"
    rm -rf "$root"
    debootstrap --variant=minbase --include=gcc,libc6-dev,make,ca-certificates bookworm "$root" >"$work/debootstrap.log"
    sysroot=$(rustc --print sysroot)
    mkdir -p "$root/usr/local/cargo"
    # Whom this machine trusts, a proxy of its network perhaps among them.
    cp /etc/ssl/certs/ca-certificates.crt "$root/etc/ssl/certs/"
    cp -a "$sysroot/bin" "$sysroot/lib" "$root/usr/local/"
    tar -C "$root" -c . | podman import --quiet --change ENV=CARGO_HOME=/usr/local/cargo - "$image"
    rm -rf "$root"
}

arguments=(--isolation chroot --format docker --pull=never --file docker/Dockerfile --tag reflectance)
arguments+=(--build-arg "VERSION=$(sed -n 's/^version = "\(.*\)"/\1/p' Cargo.toml | head -n 1)")
arguments+=(--build-arg "REVISION=$(git rev-parse HEAD 2>/dev/null || echo unknown)")
if [[ -n $binary ]]; then
    mkdir -p "$work/given/out"
    strip -o "$work/given/out/reflectance" "$binary"
    arguments+=(--build-context "build=$work/given")
else
    base
    # So that a second build shows what the layer of dependencies saves.
    arguments+=(--layers)
fi
begin=$SECONDS
buildah build "${arguments[@]}" . >"$work/build.log" 2>&1 || { tail -n 30 "$work/build.log"; exit 1; }
echo "container: built in $((SECONDS - begin)) s"
[[ -n $binary ]] || tests=--all
exec python3 scripts/container/check.py ${tests:-}
