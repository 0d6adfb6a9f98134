#!/usr/bin/env python3
"""Links of the Markdown pages lead somewhere: files exist, and so do the headings that #anchors name.

    check_links.py [ROOT]
"""
import pathlib
import re
import sys


def text_of(page):
    """The page without code, where brackets mean something else."""
    text = re.sub(r"^```.*?^```$", lambda m: "\n" * m[0].count("\n"), page.read_text(encoding="utf-8"), flags=re.S | re.M)
    text = re.sub(r"^    .*$", "", text, flags=re.M)
    return text


def anchors_of(page):
    """As GitHub names them."""
    anchors = set()
    for heading in re.findall(r"^#+ (.+)$", text_of(page), flags=re.M):
        words = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", heading).lower()
        anchor = re.sub(r"[^\w\- ]", "", words).strip().replace(" ", "-")
        number = 0
        while (anchor if not number else f"{anchor}-{number}") in anchors:
            number += 1
        anchors.add(anchor if not number else f"{anchor}-{number}")
    return anchors


def main():
    root = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else pathlib.Path(__file__).parent / "../..").resolve()
    broken = 0
    pages = [*root.glob("*.md"), *root.glob("docs/**/*.md"), *root.glob("data/**/*.md")]
    for page in sorted(pages):
        text = re.sub(r"`[^`\n]*`", lambda m: " " * len(m[0]), text_of(page))
        for link in re.finditer(r"\]\(([^)\s]+)\)", text):
            target, _, anchor = link[1].partition("#")
            if re.match(r"[a-z]+:", link[1]):
                continue
            file = (page.parent / target).resolve() if target else page
            wrong = ""
            if not file.exists():
                wrong = "there is no such file"
            elif anchor and file.suffix == ".md" and anchor not in anchors_of(file):
                wrong = "there is no such heading"
            if wrong:
                broken += 1
                print(f"{page.relative_to(root)}:{text.count(chr(10), 0, link.start()) + 1}: {link[1]}: {wrong}")
    return 1 if broken else 0


if __name__ == "__main__":
    sys.exit(main())
