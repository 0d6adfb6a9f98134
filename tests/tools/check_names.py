#!/usr/bin/env python3
"""check_names.py [ROOT]: one name, one type.

Types outside unnamed namespaces have external linkage: two of one name put two inline destructors of one symbol into a
program, and the linker keeps one. Prints each type that is defined twice; exit 1 when there is one. Headers that do not
compile together are found by check_headers.sh.

The sources are formatted, so a definition at namespace scope begins a line, and unnamed namespaces open and close on
lines of their own.
"""
import pathlib
import re
import sys

FOLDERS = ["core", "mesh", "geodesic", "winding", "machines", "postproc", "study", "pipeline", "report",
           "cli"]
DEFINITION = re.compile(
    r"^(?:class|struct|union|enum class|enum struct|enum)\s+(?:alignas\([^)]*\)\s+)?(\w+)\b(?!::)[^;]*$")


def definitions(file):
    """Names and line numbers of the types that a file defines for the whole program."""
    hidden = False
    for number, line in enumerate(file.read_text(encoding="utf-8").splitlines(), start=1):
        if line.startswith("namespace {"):
            hidden = True
        elif line.strip() == "}  // namespace":
            hidden = False
        found = DEFINITION.match(line)
        if found and not hidden:
            yield found.group(1), number


def main():
    root = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else pathlib.Path(__file__).parents[2])
    places = {}
    for folder in FOLDERS:
        for file in sorted((root / folder).rglob("*")):
            if file.suffix in (".h", ".cpp"):
                for name, number in definitions(file):
                    places.setdefault(name, []).append(f"{file.relative_to(root)}:{number}")
    broken = False
    for name, where in sorted(places.items()):
        if len(where) > 1:
            print(f"{where[1]}: {name} is defined at {where[0]} already; rename one")
            broken = True
    print(f"{len(places)} types, each of its own name" if not broken else "types share names")
    return 1 if broken else 0


if __name__ == "__main__":
    sys.exit(main())
