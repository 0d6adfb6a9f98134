#!/bin/bash
# ./test.sh            builds with warnings as errors and runs every test
# ./test.sh LABEL      only the tests with that label: fast, slow, oracle, golden
# ./test.sh build      builds all of it, benchmarks too, and runs nothing
# ./test.sh sanitize   the fast tests under the address and undefined-behaviour sanitizers
# ./test.sh fuzz SECONDS [SEED]   random input under both, each harness of tests/fuzz for its share of the time [60]
# The last line counts the tests. Missing Debian packages are installed first.
set -euo pipefail

self=$(readlink -f -- "${BASH_SOURCE[0]}")
root=${self%/*}
# shellcheck source=cmake/setup.sh
. "$root/cmake/setup.sh"
what=${1:-all}
jobs=$(nproc)

# build_tests FOLDER SOURCE TARGETS OPTION...
build_tests() {
    local folder=$1 source=$2 targets=$3
    shift 3
    configure "$folder" "$source" -DMESHWIND_TESTS=ON -DMESHWIND_WERROR=ON "$@"
    echo "building the tests in build/$folder ..." >&2
    # shellcheck disable=SC2086
    run_logged "$root/build/$folder/build.log" ninja -C "$root/build/$folder" $targets
}

# build_release TARGETS: where ./meshwind builds, which then keeps to the warnings as errors of this.
build_release() {
    install_packages build test python cad
    prepare_page
    build_tests release "$root" "$1" -DMESHWIND_BENCH=ON -DMESHWIND_PYTHON=ON -DMESHWIND_CAD=ON "-DMESHWIND_VIEWER=$page"
}

# build_instrumented TARGETS: one build for the sanitizers and for libFuzzer, by Clang: it builds instrumented code twice as
# fast as GCC does, and sees the sources with other eyes. It is a Debug build, and one of tests/consumer with this project as
# a part of it: what a project that takes us by add_subdirectory has to build. Reports name functions, not lines: line tables
# take a sixth of the compiler's time; `cmake build/asan -DCMAKE_CXX_FLAGS_DEBUG="-O1 -g1"` adds them. Texts of
# eight sources took 22 CPU s instead of 30 with -fast-isel and without code for uses after a return, which are looked for
# only where a variable asks for it.
build_instrumented() {
    install_packages build test sanitize
    build_tests asan "$root/tests/consumer" "$1" "-DCONSUMER_TAKES=$root" -DCMAKE_BUILD_TYPE=Debug \
        -DCMAKE_CXX_FLAGS_DEBUG=-O1 -DCMAKE_CXX_COMPILER=clang++-14 -DMESHWIND_UNITY=16 \
        "-DCMAKE_CXX_FLAGS=-mllvm -fast-isel -fsanitize-address-use-after-return=never" \
        -DMESHWIND_SANITIZE=fuzzer-no-link,address,undefined
}

# run_tests FOLDER CTEST_OPTION...: an empty selection is a failure, not a success.
run_tests() {
    local folder=$root/build/$1
    shift
    local log=$folder/ctest.log
    export MESHWIND_HOME=$root
    if ! ctest --test-dir "$folder" --output-on-failure --no-tests=error -j "$jobs" \
        "$@" >"$log" 2>&1; then
        grep -vE '^ *[0-9]+/[0-9]+ Test .* Passed|^ +Start ' "$log" || true
        exit 1
    fi
    grep -E '^(Label Time Summary|[a-z]+ += |Total Test time)' "$log" || true
    grep -E 'tests passed, 0 tests failed out of' "$log"
}

# fuzz_harness NAME SECONDS SEED: the committed corpus and what earlier runs added in build/; stops at the first find.
# Seconds: the 10 that an input may take, ten times as long here. Memory: a reader may take 1 GB; the address sanitizer's
# shadow and red zones add about as much again, its freed memory 64 MB.
fuzz_harness() {
    local name=$1 seconds=$2 seed=$3 folder=$root/build/asan/fuzz
    local log=$folder/$name.log
    mkdir -p "$folder/corpus/$name" "$folder/found"
    if ! ASAN_OPTIONS=quarantine_size_mb=64 UBSAN_OPTIONS=print_stacktrace=1 \
        "$root/build/asan/meshwind/tests/fuzz/${name}_fuzz" "-max_total_time=$seconds" "-seed=$seed" -timeout=100 -rss_limit_mb=2048 \
        -malloc_limit_mb=1024 -max_len=4096 -print_final_stats=1 "-artifact_prefix=$folder/found/$name-" \
        "$folder/corpus/$name" "$root/tests/fuzz/corpus/$name" >"$log" 2>&1; then
        tail -n 40 "$log"
        echo "fuzz: $name FAILED, its input is in $folder/found (whole log: $log)"
        return 1
    fi
    echo "fuzz: $name $(sed -n 's/^stat::number_of_executed_units: *//p' "$log") inputs"
}

case $what in
all)
    with_lock build_release all
    run_tests release
    ;;
build)
    with_lock build_release all
    ;;
sanitize)
    with_lock build_instrumented 'fast_tests consumer'
    run_tests asan/meshwind -L '^fast$'
    # Many of GoogleTest's are one test of CTest there.
    awk '/^\[  PASSED  \]/ { tests += $4 } END { print tests " tests of GoogleTest passed in them" }' \
        "$root/build/asan/meshwind/Testing/Temporary/LastTest.log"
    ;;
fuzz)
    with_lock build_instrumented fuzz_harnesses
    mapfile -t harnesses < <(cd "$root/tests/fuzz/corpus" && printf '%s\n' *)
    share=$((${2:-60} / ${#harnesses[@]}))
    # One on each core.
    export -f fuzz_harness
    export root
    printf '%s\n' "${harnesses[@]}" | xargs -P "$jobs" -I '{}' bash -c \
        'fuzz_harness "$@"' fuzz '{}' "$((share > 0 ? share : 1))" "${3:-0}" # 0: another one each time
    ;;
fast)
    with_lock build_release fast_tests
    run_tests release -L '^fast$'
    ;;
slow | oracle | golden)
    with_lock build_release all
    run_tests release -L "^$what\$"
    ;;
*)
    sed -n '2,7s/^# //p' "$self"
    exit 2
    ;;
esac
