#!/bin/bash
# cmake/packages.sh [FOLDER]   a release in FOLDER [build/packages]: the sources as an archive, Debian packages (meshwind,
# libmeshwind-dev, meshwind-cad, python3-meshwind), and their checksums. The sources are those of the last commit.
set -euo pipefail

self=$(readlink -f -- "${BASH_SOURCE[0]}")
root=${self%/cmake/packages.sh}
# shellcheck source=cmake/setup.sh
. "$root/cmake/setup.sh"
target=$(realpath -m -- "${1:-$root/build/packages}")

build_all() {
    install_packages build cad python package
    prepare_page
    configure release "$root" "-DMESHWIND_VIEWER=$page" -DMESHWIND_CAD=ON -DMESHWIND_PYTHON=ON
    run_logged "$root/build/release/build.log" ninja -C "$root/build/release" meshwind_cli meshwind_cad meshwind_python
}

with_lock build_all
rm -rf "$target"
mkdir -p "$target"
run_logged "$root/build/packages.log" cpack --config "$root/build/release/CPackConfig.cmake" -B "$target"
rm -rf "$target/_CPack_Packages"
version=$(sed -n 's/^set(CPACK_PACKAGE_VERSION "\(.*\)")/\1/p' "$root/build/release/CPackConfig.cmake")
git -C "$root" archive --format=tar.gz --prefix="meshwind-$version/" -o "$target/meshwind-$version.tar.gz" HEAD
(cd "$target" && sha256sum -- * >SHA256SUMS && cat SHA256SUMS)
