#!/bin/sh
# From a checkout on Debian 12 or 13 to a picture, or to the results of all tests, in one command:
#
#   ./setup.sh render   installs what is needed, builds, renders a sample scene to out/
#   ./setup.sh test     installs what is needed, builds, runs all tests
#   ./setup.sh deps     only installs, with the tools of .ci/run too
#
# Packages are installed as root, or through sudo, and only when some are missing. On other systems
# install their likes (docs/building.md) and go on from there.
set -eu
cd "$(dirname "$0")"

build_packages="build-essential cmake ninja-build pkg-config
    libembree-dev libtinygltf-dev libopenimageio-dev libopencolorio-dev libjansson-dev
    libdraco-dev libmeshoptimizer-dev libzstd-dev zlib1g-dev libastcenc-dev libtinyobjloader-dev
    libcmocka-dev
    openimageio-tools"
check_packages="clang-format python3 gnuplot-nox"

say() {
    printf '\n== %s\n' "$*"
}

fail() {
    printf 'setup.sh: %s\n' "$*" >&2
    exit 1
}

is_installed() {
    [ "$(dpkg-query -W -f='${db:Status-Status}' "$1" 2>/dev/null)" = installed ]
}

as_root() {
    if [ "$(id -u)" -eq 0 ]; then
        env DEBIAN_FRONTEND=noninteractive "$@"
    else
        sudo env DEBIAN_FRONTEND=noninteractive "$@"
    fi
}

# install_packages NAME...: those that are missing.
install_packages() {
    command -v dpkg-query >/dev/null || fail "this is no Debian; see docs/building.md"
    missing=
    for package in "$@"; do
        is_installed "$package" || missing="$missing $package"
    done
    [ -n "$missing" ] || return 0
    [ "$(id -u)" -eq 0 ] || command -v sudo >/dev/null ||
        fail "neither root nor sudo; missing packages:$missing"
    say "Installing:$missing"
    as_root apt-get update
    # shellcheck disable=SC2086 # one word per package
    as_root apt-get install -y --no-install-recommends $missing
}

# build TARGET...
build() {
    say "Building in build/release"
    cmake --preset release
    cmake --build build/release --parallel "$(nproc)" --target "$@"
}

render_sample() {
    say "Rendering sample_scenes/caustic_box.glb"
    mkdir -p out
    build/release/bin/ppm-render -s 512x512 -n 64 -o out/caustic_box.exr -o out/caustic_box.png \
        sample_scenes/caustic_box.glb
    say "Done: out/caustic_box.exr out/caustic_box.png"
}

run_tests() {
    say "Testing"
    ctest --test-dir build/release --output-on-failure --parallel "$(nproc)"
}

# shellcheck disable=SC2086 # the lists are words
case "${1-}" in
render)
    install_packages $build_packages
    build ppm-render
    render_sample
    ;;
test)
    install_packages $build_packages
    build all
    run_tests
    ;;
deps)
    install_packages $build_packages $check_packages
    ;;
*)
    fail "usage: ./setup.sh render|test|deps"
    ;;
esac
