#!/usr/bin/env python3
"""Whether the table of margins in docs/theory.md has the constants of core/margins.h, with their values."""
import re
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]


def main():
    code = {name: float(value) for name, value in
            re.findall(r"constexpr double (k\w+) = ([^;]+);", (ROOT / "core/margins.h").read_text())}
    page = {name: float(value) for value, name in
            re.findall(r"\| ([0-9.]+)(?: mm)? \| `(k\w+)` \|", (ROOT / "docs/theory.md").read_text())}
    wrong = [f"{name}: {code.get(name)} in core/margins.h, {page.get(name)} in docs/theory.md"
             for name in sorted(code.keys() | page.keys()) if code.get(name) != page.get(name)]
    print("\n".join(wrong) or f"margins: {len(code)} constants")
    return 1 if wrong or not code else 0


if __name__ == "__main__":
    sys.exit(main())
