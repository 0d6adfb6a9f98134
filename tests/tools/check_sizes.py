#!/usr/bin/env python3
"""check_sizes.py [ROOT]: the longest files, functions and classes of the sources, in lines.

Prints the worst five of each; exit code 1 where one is longer than a reader takes in at a look (MOST).
The sources are formatted: what ends a body is a brace on a line of its own, indented as the line that begins it.
"""
import pathlib
import re
import sys

FOLDERS = ["core", "mesh", "geodesic", "winding", "machines", "postproc", "study", "pipeline", "report", "cli", "python"]
MOST = {"file": 500, "function": 60, "class": 150}
SHOWN = 5
TYPE = re.compile(r"(?:template <.*> )?(?:class|struct|union)\s+(?:alignas\([^)]*\)\s+)?(\w+)")
FUNCTION = re.compile(r"([~\w:]+|operator\S+)\s*\(")
NO_BODY = re.compile(r"(?:namespace|enum|extern|using|typedef|static_assert)\b|[}\])#/]")


def bodies(lines):
    """(kind, name, number of the first line, length) of each type, and of each function at namespace or class scope."""
    open_bodies = []  # (indent, kind, name, number)
    head = None  # of a declaration that may go on: (text, number)
    for number, line in enumerate(lines, start=1):
        text = line.lstrip(" ")
        indent = len(line) - len(text)
        if open_bodies and indent == open_bodies[-1][0] and text.startswith("}"):
            _, kind, name, first = open_bodies.pop()
            yield kind, name, first, number - first + 1
            continue
        if not text or (open_bodies and open_bodies[-1][1] == "function"):
            continue
        scope = open_bodies[-1][0] + 4 if open_bodies else 0
        if indent == scope and not text.startswith("//"):
            head = (text, number)
        if head is None or not text.endswith("{"):
            continue
        whole, first = head
        head = None
        if TYPE.match(whole):
            open_bodies.append((scope, "class", TYPE.match(whole).group(1), first))
        elif not NO_BODY.match(whole) and FUNCTION.search(whole):
            open_bodies.append((scope, "function", FUNCTION.search(whole).group(1), first))


def main():
    root = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else pathlib.Path(__file__).parents[2])
    sizes = {kind: [] for kind in MOST}
    for folder in FOLDERS:
        for file in sorted((root / folder).rglob("*")):
            if file.suffix in (".h", ".cpp"):
                lines = file.read_text(encoding="utf-8").splitlines()
                place = file.relative_to(root)
                sizes["file"].append((len(lines), f"{place}"))
                for kind, name, number, length in bodies(lines):
                    sizes[kind].append((length, f"{place}:{number}: {name}"))
    too_long = 0
    for kind, most in MOST.items():
        sizes[kind].sort(reverse=True)
        over = sum(length > most for length, _ in sizes[kind])
        too_long += over
        print(f"{kind}: {len(sizes[kind])}, {over} of more than {most} lines")
        for length, place in sizes[kind][:SHOWN]:
            print(f"  {length:4} {place}")
    return 1 if too_long else 0


if __name__ == "__main__":
    sys.exit(main())
