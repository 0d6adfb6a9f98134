#!/bin/bash
# check_headers.sh [together]: all headers compile together in one source, so no name stands for two things; and, without
# "together", each compiles alone. What cmake/MeshwindLibrary.cmake compiles once for all is compiled once here too: that a
# header includes what it uses of it, check_includes.py sees. Exit 1 when something does not compile.
set -euo pipefail
cd "$(dirname -- "${BASH_SOURCE[0]}")/../.."

folders=(core mesh geodesic winding machines postproc study pipeline report cli)
flags=(-std=c++20 -Wall -Wextra -Wshadow -Wconversion -Werror -I. -isystem /usr/include/eigen3
    -isystem /usr/include/opencascade)
mapfile -t headers < <(find "${folders[@]}" -name '*.h' | LC_ALL=C sort)
broken=0
# The reader of CAD files is a program of its own: Open CASCADE has names that OpenMesh takes for others.
mapfile -t ours < <(printf '%s\n' "${headers[@]}" | grep -v '^mesh/brep/occt/')
printf '#include "%s"\n' "${ours[@]}" | c++ "${flags[@]}" -fsyntax-only -x c++ - || broken=1
if [[ ${1:-} == together ]]; then
    echo "${#headers[@]} headers together"
    exit "$broken"
fi

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mapfile -t common < <(sed -n '/target_precompile_headers($/,/)$/p' cmake/MeshwindLibrary.cmake | grep -o '<[A-Za-z/]*>')
((${#common[@]} > 10)) || { echo "cmake/MeshwindLibrary.cmake is read wrongly"; exit 1; }
printf '#include %s\n' "${common[@]}" >"$work/common.h"
clang++-14 "${flags[@]}" -fpch-instantiate-templates -x c++-header "$work/common.h" -o "$work/common.pch"
printf '%s\0' "${headers[@]}" | xargs -0 -P "$(nproc)" -I '{}' \
    clang++-14 "${flags[@]}" -Wno-pragma-once-outside-header -Wno-unused-const-variable -include-pch "$work/common.pch" -fsyntax-only -x c++ '{}' || broken=1
echo "${#headers[@]} headers together, and each alone"
exit "$broken"
