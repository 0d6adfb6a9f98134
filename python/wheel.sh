#!/bin/bash
# python/wheel.sh [FOLDER]   builds the Python module and packs it, with machines and example meshes, into a wheel in
# FOLDER [build/wheel]; nothing is fetched but Debian packages that are missing. The last line names the wheel.
set -euo pipefail

self=$(readlink -f -- "${BASH_SOURCE[0]}")
root=${self%/python/wheel.sh}
# shellcheck source=cmake/setup.sh
. "$root/cmake/setup.sh"
target=$(realpath -m -- "${1:-$root/build/wheel}")
stage=$root/build/wheel.stage

build_module() {
    install_packages build python
    prepare_page
    configure release "$root" "-DMESHWIND_VIEWER=$page" -DMESHWIND_PYTHON=ON
    run_logged "$root/build/release/build.log" ninja -C "$root/build/release" meshwind_python
}

pack() {
    rm -rf "$stage"
    mkdir -p "$stage" "$target"
    cp -r "$root/build/release/python/"{meshwind,setup.py} "$stage"
    local share=$stage/meshwind/share
    mkdir -p "$share/machines" "$share/data"
    cp "$root"/machines/*.json "$share/machines"
    cp "$root/data/tee.stl" "$share/data"
    cp "$root/LICENSE" "$stage"
    (cd "$stage" && run_logged "$root/build/wheel.log" /usr/bin/python3 setup.py -q bdist_wheel -d "$target")
    rm -rf "$stage"
}

with_lock build_module
pack
wheels=("$target"/meshwind-*.whl)
echo "${wheels[-1]}"
