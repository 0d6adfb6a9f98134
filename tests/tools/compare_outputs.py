#!/usr/bin/env python3
"""Tells whether two runs wrote the same: compare_outputs.py FOLDER_A FOLDER_B

All files must have the same names and bytes; in report.json the key "timing_s" may differ.
"""
import json
import pathlib
import sys


def content(file: pathlib.Path):
    if file.name != "report.json":
        return file.read_bytes()
    report = json.loads(file.read_text(encoding="utf-8"))
    report.pop("timing_s", None)
    return json.dumps(report)  # keeps the order of the keys


def main() -> int:
    a, b = (pathlib.Path(folder) for folder in sys.argv[1:3])
    names_a, names_b = (sorted(p.name for p in folder.iterdir()) for folder in (a, b))
    if names_a != names_b or not names_a:
        print(f"not the same files: {names_a} and {names_b}")
        return 1
    different = [name for name in names_a if content(a / name) != content(b / name)]
    for name in different:
        print(f"differs: {a / name} {b / name}")
    print(f"compared {len(names_a)} files, {len(different)} differ")
    return 1 if different else 0


sys.exit(main())
