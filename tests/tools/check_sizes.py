#!/usr/bin/env python3
"""check_sizes.py [ROOT]: the five longest files, functions and classes, in lines.

A reader takes in a file, a function or a class at one look as long as it is short. Exit 1 where one is longer than MOST says.
The sources are formatted, so the brace that ends a body is on a line of its own, indented as the line that begins it.
"""
import pathlib
import re
import sys

FOLDERS = ["core", "mesh", "geodesic", "winding", "machines", "postproc", "study", "pipeline", "report", "cli", "python"]
SHOWN = 5
MOST = {"file": 500, "function": 60, "class": 150}
TYPE = re.compile(r"^(?:template <.*> )?(?:class|struct|union)\s+(?:alignas\([^)]*\)\s+)?(\w+)")
NO_BODY = re.compile(r"^(?:namespace|enum|extern|using|typedef|if|for|while|switch|do|else|try|return|case|default|#)\b|^[}\])#/]")
NAME = re.compile(r"([~\w:]+|operator\S+)\s*\(")


def bodies(lines):
    """(kind, name, number of the first line, length) of each type, and of each function at namespace or class scope."""
    begun = []  # (indent, kind, name, number)
    head = None  # first line of a declaration that goes on: (indent, text, number)
    for number, line in enumerate(lines, start=1):
        text = line.lstrip(" ")
        indent = len(line) - len(text)
        if begun and indent == begun[-1][0] and text.startswith("}"):
            _, kind, name, first = begun.pop()
            yield kind, name, first, number - first + 1
            continue
        inside_function = begun and begun[-1][1] == "function"
        scope = begun[-1][0] + 4 if begun else 0
        if inside_function or not text:
            continue
        if indent == scope and not text.startswith(("//", "}")):
            head = (indent, text, number)
        if head is None or not line.rstrip().endswith("{"):
            continue
        whole = head[1]
        if TYPE.match(whole):
            begun.append((head[0], "class", TYPE.match(whole).group(1), head[2]))
        elif not NO_BODY.match(whole) and NAME.search(whole):
            begun.append((head[0], "function", NAME.search(whole).group(1), head[2]))
        head = None


def main():
    root = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else pathlib.Path(__file__).parents[2])
    sizes = {kind: [] for kind in MOST}
    for folder in FOLDERS:
        for file in sorted((root / folder).rglob("*")):
            if file.suffix not in (".h", ".cpp"):
                continue
            lines = file.read_text(encoding="utf-8").splitlines()
            place = file.relative_to(root)
            sizes["file"].append((len(lines), f"{place}"))
            for kind, name, number, length in bodies(lines):
                sizes[kind].append((length, f"{place}:{number}: {name}"))
    good = True
    for kind, most in MOST.items():
        sizes[kind].sort(reverse=True)
        over = sum(length > most for length, _ in sizes[kind])
        print(f"{kind}: {len(sizes[kind])}, {over} of more than {most} lines")
        for length, place in sizes[kind][:SHOWN]:
            print(f"  {length:4} {place}")
        good = good and not over
    return 0 if good else 1


if __name__ == "__main__":
    sys.exit(main())
