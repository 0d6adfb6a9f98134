#!/usr/bin/env python3
"""check_public.py [ROOT]: installed is what users of the library need, the lists HEADERS of meshwind_library:
headers that programs of this project include (CALLERS) or the table of docs/how-to/pipeline.md names, and what
these headers include. Every other header stands under INTERNAL. Prints every breach with its mend; exit 1 when
there is one."""
import os
import pathlib
import re
import sys

CALLERS = ["cli", "python/bindings", "tests/consumer"]
TABLE = "docs/how-to/pipeline.md"


def lists(cmake):
    """Headers of HEADERS and of INTERNAL in a meshwind_library; None where there is none."""
    library = re.search(r"^meshwind_library\((.*?)\)", cmake.read_text(), re.DOTALL | re.MULTILINE)
    if not library:
        return None
    found = {"HEADERS": set(), "INTERNAL": set()}
    within = None
    for word in library[1].split():
        if re.fullmatch("[A-Z]+", word):
            within = found.get(word)
        elif within is not None:
            within.add((cmake.parent / word).as_posix())
    return found


def included(file):
    """Place and name of each header of the project that a file includes."""
    for number, line in enumerate(file.read_text().splitlines(), 1):
        include = re.match(r'\s*#\s*include\s*"([^"]*)"', line)
        if include:
            yield f"{file}:{number}", include[1]


def asked_for():
    """Place and name of each header that users start from."""
    table = re.search(r"<!-- headers -->\n(.*?)(\n\n|\Z)", pathlib.Path(TABLE).read_text(), re.DOTALL)
    for name in re.findall(r"`([^`]*\.h)`", table[1]):
        yield TABLE, name
    for folder in CALLERS:
        for file in sorted(pathlib.Path(folder).rglob("*.*")):
            if file.suffix in (".h", ".cpp"):
                yield from (found for found in included(file) if os.path.dirname(found[1]) != folder)


def main():
    os.chdir(sys.argv[1] if len(sys.argv) > 1 else pathlib.Path(__file__).parents[2])
    breaches = []
    public = {}  # header: the list's file
    for cmake in sorted(pathlib.Path(".").glob("*/CMakeLists.txt")):
        found = lists(cmake)
        if found is None:
            continue
        public.update({header: cmake for header in found["HEADERS"]})
        for header in sorted(map(str, cmake.parent.rglob("*.h"))):
            own = all(not (folder / "CMakeLists.txt").exists()
                      for folder in pathlib.Path(header).parents if cmake.parent in folder.parents)
            if own and header not in found["HEADERS"] | found["INTERNAL"]:
                breaches.append(f"{header}: in no list: put it under INTERNAL of {cmake}")

    needed = set()
    open_ends = list(asked_for())
    while open_ends:
        place, name = open_ends.pop()
        if name not in public:
            breaches.append(f"{place}: {name} is not installed: declare what is used of it (class X;), "
                            f"or move it to HEADERS of {name.split('/')[0]}/CMakeLists.txt")
        elif name not in needed:
            needed.add(name)
            open_ends += included(pathlib.Path(name))
    for header in sorted(set(public) - needed):
        breaches.append(f"{public[header]}: {header} is installed, but no user needs it: move it to INTERNAL, "
                        f"or name it in the table of {TABLE}")
    print("\n".join(sorted(breaches)), end="\n" if breaches else "")
    return 1 if breaches else 0


if __name__ == "__main__":
    sys.exit(main())
