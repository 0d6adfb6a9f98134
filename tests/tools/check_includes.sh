#!/bin/bash
# check_includes.sh [ROOT]: a folder includes only itself and those before it, and each foreign library only where
# the list below allows it. Prints every include that breaks a rule; exit 1 when there is one.
set -euo pipefail
cd "${1:-"$(dirname -- "${BASH_SOURCE[0]}")/../.."}"

folders=(core mesh geodesic winding machines postproc study cli)

# Start of the include, then the files that may have it (a pattern). Other <a/b> includes are refused.
allowed='
Eigen/Core              *
Eigen/Geometry          *
Eigen/                  *.cpp
OpenMesh/               mesh/*.cpp
OpenMesh/               mesh/open_mesh.h
OpenMesh/               mesh/open_mesh_kernel.h
CGAL/                   geodesic/shortest_path.cpp
CGAL/                   mesh/planar_delaunay.cpp
CGAL/                   mesh/self_intersections.cpp
CGAL/                   mesh/*repair*.cpp
embree3/                mesh/ray_query.cpp
flann/                  mesh/nearest.cpp
assimp/                 mesh/import_assimp.cpp
boost/math/             *.cpp
boost/numeric/odeint/    study/path_reference.cpp
nlohmann/               machines/strict_json.cpp
nlohmann/               */*_json.cpp
nlohmann/               cli/report*.cpp
nlohmann/               cli/report*.h
nlohmann/               cli/commands.cpp
nlohmann/               cli/page_data.cpp
CLI/                    cli/main.cpp
tbb/                    core/parallel.cpp
nettle/                 cli/digest.cpp
nettle/                 cli/report_page.cpp
sys/                    *.cpp
'

rank_of() {
    local i
    for i in "${!folders[@]}"; do
        [[ ${folders[i]} != "$1" ]] || { echo "$i"; return; }
    done
    echo 99 # tests, bench: nobody may include them
}

may_include() {
    local header=$1 file=$2 start pattern
    while read -r start pattern; do
        # shellcheck disable=SC2053 # the pattern is one
        if [[ -n $start && $header == "$start"* && $file == $pattern ]]; then
            return 0
        fi
    done <<<"$allowed"
    return 1
}

broken=0
while IFS=: read -r file line text; do
    if [[ $text =~ \"([a-z_0-9]+)/[^\"]*\" ]]; then
        if (($(rank_of "${BASH_REMATCH[1]}") > $(rank_of "${file%%/*}"))); then
            echo "$file:$line: ${file%%/*} comes before ${BASH_REMATCH[1]}: $text"
            broken=1
        fi
    elif [[ $text =~ \<([^\>]*/[^\>]*)\> ]] && ! may_include "${BASH_REMATCH[1]}" "$file"; then
        echo "$file:$line: not allowed here: $text"
        broken=1
    fi
done < <(find "${folders[@]}" -name '*.h' -o -name '*.cpp' | LC_ALL=C sort | xargs -r grep -nH '^ *# *include')
exit "$broken"
