#!/usr/bin/env python3
"""check_includes.py [ROOT]: a room includes only itself and the rooms above it in the map of
CONTRIBUTING.md, which names every folder with sources once; no room holds more than 20 units (header
and source of one name count once); each foreign library stands only where ALLOWED has it; who uses
what a header of COMMON has includes it, or a header of the project that does: every source gets
those compiled once, and would not miss them. Prints every breach; exit 1 when there is one."""
import fnmatch
import os
import pathlib
import re
import sys

MOST_UNITS = 20

# Start of the include, then the files that may have it (patterns). Other <a/b> includes are refused.
ALLOWED = [
    ("Eigen/Core", "*"),
    ("Eigen/Geometry", "*"),
    ("Eigen/", "*.cpp"),
    ("OpenMesh/", "mesh/*.cpp"),
    ("OpenMesh/", "mesh/repair/open_mesh*.h"),
    ("CGAL/", "geodesic/shortest_path.cpp"),
    ("CGAL/", "mesh/shapes/planar_delaunay.cpp"),
    ("CGAL/", "mesh/even/fair.cpp"),
    ("CGAL/", "mesh/repair/*.cpp"),
    ("embree3/", "mesh/ray_query.cpp"),
    ("flann/", "mesh/nearest.cpp"),
    ("assimp/", "mesh/io/import_assimp.cpp"),
    ("boost/math/quadrature/", "*.cpp"),
    ("boost/math/tools/", "core/roots.cpp"),
    ("boost/math/tools/", "mesh/shapes/shapes.cpp"),
    ("boost/numeric/odeint/", "study/path_reference.cpp"),
    ("nlohmann/", "core/text/key_table.h"),
    ("nlohmann/", "core/text/strict_json.cpp"),
    ("nlohmann/", "*_json.cpp"),
    ("nlohmann/", "pipeline/job/*"),
    ("nlohmann/", "report/*"),
    ("nlohmann/", "cli/commands.cpp"),
    ("nlohmann/", "cli/program_commands.cpp"),
    ("CLI/", "cli/main.cpp"),
    ("CLI/", "cli/options.*"),
    ("pybind11/", "python/bindings/*"),
    ("tbb/", "core/parallel.cpp"),
    ("glpk.h", "core/linear_programme.cpp"),
    ("nettle/", "core/text/digest.cpp"),
    ("nettle/", "report/page/packed_page.cpp"),
    ("sys/", "*.cpp"),
]

# Headers that cmake/MeshwindLibrary.cmake has compiled once, and how it is seen that one is used.
NAMES = r"std::(?:{})\b(?!::)"
COMMON = {header: re.compile(pattern) for header, pattern in {
    "algorithm": NAMES.format(
        "sort|stable_sort|min|max|minmax|clamp|find|find_if|find_if_not|any_of|all_of|none_of|count|count_if|copy|copy_n|"
        "copy_if|fill|fill_n|reverse|rotate|transform|unique|lower_bound|upper_bound|equal_range|binary_search|partial_sort|"
        "nth_element|min_element|max_element|minmax_element|remove_if|replace|generate|partition|stable_partition|"
        "partition_point|is_sorted|equal|mismatch|search|merge|set_union|set_intersection|set_difference|includes|for_each|"
        "next_permutation|adjacent_find|lexicographical_compare"),
    "array": NAMES.format("array"),
    "cmath": NAMES.format(
        "sqrt|abs|sin|cos|tan|asin|acos|atan|atan2|pow|exp|log|log2|log10|floor|ceil|round|lround|llround|hypot|cbrt|fmod|"
        "remainder|isfinite|isnan|isinf|signbit|copysign|trunc|cosh|sinh|tanh|nextafter|ldexp|frexp|nearbyint|rint"),
    "filesystem": r"std::filesystem\b",
    "functional": NAMES.format("function|ref|cref|hash|greater|less|plus|invoke|reference_wrapper"),
    "map": NAMES.format("map|multimap"),
    "memory": NAMES.format("unique_ptr|make_unique|shared_ptr|make_shared|weak_ptr"),
    "optional": NAMES.format("optional|nullopt|make_optional"),
    "set": NAMES.format("set|multiset"),
    "span": NAMES.format("span"),
    "string": NAMES.format("string|to_string|stoi|stod|stoul|getline"),
    "vector": NAMES.format("vector"),
    "Eigen/Core": r"Eigen::",
    "Eigen/Geometry": r"\b(?:Isometry3d|Affine3d|Quaterniond|AngleAxisd|Translation3d|AlignedBox3d|Rotation2Dd)\b|"
                      r"\.(?:cross|unitOrthogonal)\(",
}.items()}
# Start of an include, and what comes with it.
BRINGS = [
    ("Eigen/", {"Eigen/Core"}),
    ("Eigen/SVD", {"Eigen/Geometry"}),
    ("filesystem", {"string"}),
    ("fstream", {"string"}),
    ("iostream", {"string"}),
    ("sstream", {"string"}),
    ("nlohmann/json.hpp", {"algorithm", "array", "functional", "map", "memory", "string", "vector"}),
    ("CLI/", {"algorithm", "functional", "map", "memory", "optional", "set", "string", "vector"}),
]


def included_by(file, known):
    """All that a file includes, through headers of the project too."""
    if file not in known:
        known[file] = set()
        found = set()
        for kind, name in re.findall(r'^\s*#\s*include\s*([<"])([^>"]*)[>"]', file.read_text(), re.MULTILINE):
            if kind == "<":
                found.add(name)
                found.update(*(more for start, more in BRINGS if name.startswith(start)))
            else:
                found |= included_by(pathlib.Path(name), known) if pathlib.Path(name).exists() else set()
        known[file] = found
    return known[file]


def not_included(file, known):
    text = re.sub(r"//.*", "", file.read_text())
    for header, used in COMMON.items():
        found = used.search(text)
        if found and header not in included_by(file, known):
            yield f"{file}: {found[0]} without #include <{header}>"


def rooms_of(contributing):
    """Rooms in the order of the map: lines of the block behind <!-- rooms -->, a name first."""
    block = re.search(r"<!-- rooms -->\n```text\n(.*?)```", contributing.read_text(), re.DOTALL)
    return [line.split()[0].rstrip("/") for line in block[1].splitlines() if line.strip()]


def main():
    os.chdir(sys.argv[1] if len(sys.argv) > 1 else pathlib.Path(__file__).parents[2])
    rooms = rooms_of(pathlib.Path("CONTRIBUTING.md"))
    rank = {room: number for number, room in enumerate(rooms)}
    breaches = [f"CONTRIBUTING.md: {room} stands twice" for room in rooms if rooms.count(room) > 1]
    units = {room: set() for room in rooms}
    known = {}
    folders = sorted({room.split("/")[0] for room in rooms})
    for file in sorted(path for folder in folders for kind in ("*.h", "*.cpp")
                       for path in pathlib.Path(folder).rglob(kind)):
        room = file.parent.as_posix()
        if room not in rank:
            breaches.append(f"{file}: its folder is not in the map of CONTRIBUTING.md")
            continue
        units[room].add(file.stem)
        breaches += not_included(file, known)
        for number, line in enumerate(file.read_text().splitlines(), 1):
            include = re.match(r'\s*#\s*include\s*([<"])([^>"]*/[^>"]*)[>"]', line)
            if not include:
                continue
            name = include[2]
            if include[1] == '"':
                other = os.path.dirname(name)
                if rank.get(other, len(rooms)) > rank[room]:
                    breaches.append(f"{file}:{number}: {room} stands before {other}: {line}")
            elif not any(name.startswith(start) and fnmatch.fnmatch(file.as_posix(), pattern)
                         for start, pattern in ALLOWED):
                breaches.append(f"{file}:{number}: not allowed here: {line}")
    for room, names in units.items():
        if not names:
            breaches.append(f"CONTRIBUTING.md: {room} holds no source")
        elif len(names) > MOST_UNITS:
            breaches.append(f"{room}: {len(names)} units, at most {MOST_UNITS}")
    print("\n".join(breaches), end="\n" if breaches else "")
    return 1 if breaches else 0


if __name__ == "__main__":
    sys.exit(main())
