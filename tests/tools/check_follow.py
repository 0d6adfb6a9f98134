#!/usr/bin/env python3
"""check_follow.py: each line under "Follow the tow" in CONTRIBUTING.md names a function, or a class made there, that its header
declares. Exit 1 with the line where one does not.
"""
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
BLOCK = re.compile(r"<!-- follow -->\n```text\n(.*?)```", re.DOTALL)
LINE = re.compile(r"(\S+\.h) .*?(\w+)\(")


def main():
    lines = [line for block in BLOCK.findall((ROOT / "CONTRIBUTING.md").read_text(encoding="utf-8")) for line in block.splitlines()]
    wrong = 0
    for line in lines:
        found = LINE.match(line)
        header = ROOT / found.group(1) if found else None
        if header is None or not header.is_file() or not re.search(rf"\b{found.group(2)}\(", header.read_text(encoding="utf-8")):
            print(f"CONTRIBUTING.md: not so any more: {line}", file=sys.stderr)
            wrong += 1
    return 1 if wrong or not lines else 0


if __name__ == "__main__":
    sys.exit(main())
