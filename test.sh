#!/bin/bash
# ./test.sh            builds with warnings as errors and runs every test
# ./test.sh LABEL      only the tests with that label: fast, slow, oracle, golden
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

# build_instrumented TARGET: one build for the sanitizers and for libFuzzer, by Clang: it builds instrumented code twice as
# fast as GCC does, and sees the sources with other eyes.
build_instrumented() {
    install_packages sanitize
    build_tests asan "$1" -DCMAKE_BUILD_TYPE=Debug -DCMAKE_CXX_FLAGS_DEBUG="-O1 -g1" -DCMAKE_CXX_COMPILER=clang++-14 \
        -DMESHWIND_SANITIZE=fuzzer-no-link,address,undefined -DMESHWIND_PCH=all
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

# fuzz_harness NAME SECONDS SEED: the committed corpus and what earlier runs added in build/; stops at the first find.
# Memory: a reader may take 1 GB; the address sanitizer's shadow and red zones add about as much again, its freed memory 64 MB.
fuzz_harness() {
    local name=$1 seconds=$2 seed=$3 folder=$root/build/asan/fuzz
    local log=$folder/$name.log
    mkdir -p "$folder/corpus/$name" "$folder/found"
    if ! ASAN_OPTIONS=quarantine_size_mb=64 UBSAN_OPTIONS=print_stacktrace=1 \
        "$root/build/asan/tests/fuzz/${name}_fuzz" "-max_total_time=$seconds" "-seed=$seed" -timeout=10 -rss_limit_mb=2048 \
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
    with_lock build_tests release all
    run_tests release
    ;;
sanitize)
    with_lock build_instrumented fast_tests
    run_tests asan -L '^fast$'
    ;;
fuzz)
    with_lock build_instrumented fuzz_harnesses
    mapfile -t harnesses < <(cd "$root/tests/fuzz/corpus" && printf '%s\n' *)
    share=$((${2:-60} / ${#harnesses[@]}))
    for harness in "${harnesses[@]}"; do
        fuzz_harness "$harness" "$((share > 0 ? share : 1))" "${3:-0}" # 0: another one each time
    done
    ;;
fast | slow | oracle | golden)
    with_lock build_tests release all
    run_tests release -L "^$what\$"
    ;;
*)
    sed -n '2,6s/^# //p' "$self"
    exit 2
    ;;
esac
