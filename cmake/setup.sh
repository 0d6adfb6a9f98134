# Sourced by ./meshwind, ./test.sh and .ci/run: packages, locking, building. Expects $root, the project's folder.
# shellcheck shell=bash
: "${root:?}"

fail() {
    echo "${0##*/}: $*" >&2
    exit 3
}

# run_logged LOG COMMAND...: quiet when it succeeds; else shows the end of the log and stops.
run_logged() {
    local log=$1
    shift
    mkdir -p "${log%/*}"
    if ! "$@" >"$log" 2>&1 </dev/null; then
        tail -n 40 "$log" >&2
        fail "failed: $* (whole log: $log)"
    fi
}

# with_lock COMMAND...: one process at a time for each checkout; the others wait.
with_lock() {
    mkdir -p "$root/build" || fail "cannot write to $root/build: copy the project to a folder of your own"
    exec 9>"$root/build/.lock"
    if ! flock --nonblock 9; then
        echo "${0##*/}: waiting for another build in $root" >&2
        flock 9
    fi
    "$@" 9>&-
    exec 9>&-
}

# The package names of the groups given.
packages_of() {
    local kind name group
    while read -r kind name; do
        for group in "$@"; do
            [[ $kind != "$group" ]] || echo "$name"
        done
    done <"$root/cmake/packages.txt"
}

# apt_install APT_GET_COMMAND...: installs the caller's `missing`.
apt_install() {
    # The lists may be absent or out of date: fetch them only when the first try fails.
    "$@" install "${missing[@]}" || { "$@" update && "$@" install "${missing[@]}"; }
}

# install_packages GROUP...: installs what is missing; asks nothing and changes nothing else.
install_packages() {
    command -v dpkg-query >/dev/null || return 0 # not Debian: CMake names what it misses
    local -a wanted missing=() root_runs=(env DEBIAN_FRONTEND=noninteractive apt-get -y -qq
        --no-install-recommends -o DPkg::Lock::Timeout=300)
    local status name
    mapfile -t wanted < <(packages_of "$@")
    status=$(dpkg-query -W -f='${Package} ${db:Status-Status}\n' "${wanted[@]}" 2>/dev/null || true)
    for name in "${wanted[@]}"; do
        [[ $'\n'$status$'\n' == *$'\n'"$name installed"$'\n'* ]] || missing+=("$name")
    done
    ((${#missing[@]})) || return 0
    if ((EUID != 0)); then
        if ! command -v sudo >/dev/null || ! { sudo -n true 2>/dev/null || [[ -t 0 && -t 2 ]]; }; then
            fail "missing packages; as root: apt-get install --no-install-recommends ${missing[*]}"
        fi
        [[ ! -t 2 ]] || sudo -v -p "sudo password to install ${#missing[@]} packages: " ||
            fail "missing packages; as root: apt-get install --no-install-recommends ${missing[*]}"
        root_runs=(sudo -n "${root_runs[@]}")
    fi
    echo "${0##*/}: installing ${#missing[@]} Debian packages once" >&2
    run_logged "$root/build/apt.log" apt_install "${root_runs[@]}"
}

# prepare_page: npm and the packages of the report page, `page` for CMake; where they cannot be had it says so, and the
# page is left out.
# shellcheck disable=SC2034
page=OFF
prepare_page() {
    command -v npm >/dev/null || install_packages page
    local log=$root/build/npm.log
    # shellcheck disable=SC2034
    if [[ $root/viewer/node_modules/.package-lock.json -nt $root/viewer/package-lock.json ]] ||
        (cd "$root/viewer" && npm ci --ignore-scripts --no-audit --no-fund && touch node_modules/.package-lock.json) \
            >"$log" 2>&1 </dev/null; then
        page=ON
    else
        echo "${0##*/}: report.html is left out: npm cannot fetch its packages (see $log)" >&2
    fi
}

# configure FOLDER SOURCE OPTION...: CMake with Ninja, several sources as one text, and lld and ccache where they are
# installed; a folder configured for another place is made anew.
configure() {
    local folder=$root/build/$1 source=$2 linker='' launcher=''
    shift 2
    if [[ -f $folder/CMakeCache.txt ]] &&
        ! grep -qxF "CMAKE_HOME_DIRECTORY:INTERNAL=$source" "$folder/CMakeCache.txt"; then
        rm -rf "$folder"
    fi
    ! command -v ld.lld >/dev/null || linker=-fuse-ld=lld
    if command -v ccache >/dev/null; then
        launcher=ccache
        # As precompiled headers want it.
        export CCACHE_DEPEND=${CCACHE_DEPEND:-1} \
            CCACHE_SLOPPINESS=${CCACHE_SLOPPINESS:-pch_defines,time_macros,include_file_mtime,include_file_ctime}
    fi
    run_logged "$folder/configure.log" cmake -S "$source" -B "$folder" -G Ninja -DCMAKE_BUILD_TYPE=Release \
        -DMESHWIND_UNITY=8 "-DCMAKE_CXX_COMPILER_LAUNCHER=$launcher" "-DCMAKE_EXE_LINKER_FLAGS=$linker" \
        "-DCMAKE_MODULE_LINKER_FLAGS=$linker" "$@"
}
