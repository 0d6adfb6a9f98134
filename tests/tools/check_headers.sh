#!/bin/bash
# check_headers.sh [ROOT]: every header compiles alone. Where a source file includes it before all else, compiling that
# file shows it, and nothing is left to do; the others are compiled here. All of them compile together in one source as
# well: no name stands for two things. Exit 1 when something does not compile.
set -euo pipefail
cd "${1:-"$(dirname -- "${BASH_SOURCE[0]}")/../.."}"

folders=(core mesh geodesic winding machines postproc study cli)
first=$(find "${folders[@]}" -name '*.cpp' -exec grep -m 1 -h '^ *# *include' {} \; | sort -u)
broken=0
alone=0
compile() {
    c++ -std=c++20 -Wall -Wextra -Wshadow -Wconversion -Werror -fsyntax-only -I. -isystem /usr/include/eigen3 -x c++ -
}
while read -r header; do
    [[ $'\n'$first$'\n' != *$'\n'"#include \"$header\""$'\n'* ]] || continue
    alone=$((alone + 1))
    compile <<<"#include \"$header\"" || broken=1
done < <(find "${folders[@]}" -name '*.h' | LC_ALL=C sort)
find "${folders[@]}" -name '*.h' | LC_ALL=C sort | sed 's/.*/#include "&"/' | compile || broken=1
echo "$alone headers that no source file includes first"
exit "$broken"
