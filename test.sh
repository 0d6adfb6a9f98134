#!/bin/bash
# ./test.sh            builds with warnings as errors and runs every test
# ./test.sh LABEL      only the tests with that label: fast, slow, oracle, golden
# ./test.sh sanitize   the fast tests under the address and undefined-behaviour sanitizers
# The last line counts the tests. Missing Debian packages are installed first.
set -euo pipefail

self=$(readlink -f -- "${BASH_SOURCE[0]}")
root=${self%/*}
# shellcheck source=cmake/setup.sh
. "$root/cmake/setup.sh"
what=${1:-all}
jobs=$(nproc)

# build_tests FOLDER TARGET OPTION...: ./meshwind goes on in the folder "release".
build_tests() {
    local folder=$1 target=$2
    shift 2
    install_packages build test
    [[ $folder == asan ]] || prepare_page
    configure "$folder" -DMESHWIND_TESTS=ON -DMESHWIND_WERROR=ON -DMESHWIND_PCH=tests \
        "-DMESHWIND_VIEWER=$page" "$@"
    echo "building the tests in build/$folder ..." >&2
    run_logged "$root/build/$folder/build.log" ninja -C "$root/build/$folder" "$target"
}

# run_tests FOLDER CTEST_OPTION...: an empty selection is a failure, not a success.
run_tests() {
    local folder=$1
    shift
    local log=$root/build/$folder/ctest.log
    export MESHWIND_HOME=$root
    if ! ctest --test-dir "$root/build/$folder" --output-on-failure --no-tests=error -j "$jobs" \
        "$@" >"$log" 2>&1; then
        grep -vE '^ *[0-9]+/[0-9]+ Test .* Passed|^ +Start ' "$log" || true
        exit 1
    fi
    grep -E '^(Label Time Summary|[a-z]+ += |Total Test time)' "$log" || true
    grep -E 'tests passed, 0 tests failed out of' "$log"
}

case $what in
all)
    with_lock build_tests release all
    run_tests release
    ;;
sanitize)
    install_packages sanitize
    # Clang: it builds instrumented code twice as fast as GCC does, and sees the sources with other eyes.
    with_lock build_tests asan fast_tests -DCMAKE_BUILD_TYPE=Debug -DCMAKE_CXX_FLAGS_DEBUG="-O1 -g1" \
        -DCMAKE_CXX_COMPILER=clang++-14 -DMESHWIND_SANITIZE=address,undefined -DMESHWIND_PCH=all
    run_tests asan -L '^fast$'
    ;;
fast | slow | oracle | golden)
    with_lock build_tests release all
    run_tests release -L "^$what\$"
    ;;
*)
    sed -n '2,5s/^# //p' "$self"
    exit 2
    ;;
esac
