#!/bin/bash
# check_headers.sh [ROOT]: every header compiles alone. Where a source file includes it before all else, compiling that
# file shows it, and nothing is left to do; the others are compiled here. Exit 1 when one does not compile.
set -euo pipefail
cd "${1:-"$(dirname -- "${BASH_SOURCE[0]}")/../.."}"

folders=(core mesh geodesic winding machines postproc study cli)
first=$(find "${folders[@]}" -name '*.cpp' -exec grep -m 1 -h '^ *# *include' {} \; | sort -u)
broken=0
alone=0
while read -r header; do
    [[ $'\n'$first$'\n' != *$'\n'"#include \"$header\""$'\n'* ]] || continue
    alone=$((alone + 1))
    c++ -std=c++20 -Wall -Wextra -Wshadow -Wconversion -Werror -fsyntax-only -I. -isystem /usr/include/eigen3 \
        -x c++ - <<<"#include \"$header\"" || broken=1
done < <(find "${folders[@]}" -name '*.h' | LC_ALL=C sort)
echo "$alone headers that no source file includes first"
exit "$broken"
