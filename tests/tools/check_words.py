#!/usr/bin/env python3
"""Whether summaries say only what a reader can look up: each word is in docs/terms.md or among the plain ones below.

    check_words.py SUMMARY.txt ...

Numbers, names of files and units are passed over. A word of the trade belongs into docs/terms.md; only what everybody
understands may be added here. Exit code 1 where one is neither.
"""
import re
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]

PLAIN = set("""
a acceleration all along apart base begins bridges central clear covered coverage either even fixed four front hobby jumps keep keeps
lay limit limits max middle min new none plies read regular ring rings robot scatter six speeds steep thick too travel turned was
widest winder within frame
 alone and are around as asked at average axes axis back be before behind best beyond by can choice column
controller could count covered covers cut deg degrees does done each end ends fails file files first for found from full
given go goes hand has head here if in inside into is it its layer layers leave left less lie lies line longer
machine made makes mass material mean meet metre mm more most move moves named next no not nothing number of on one
only or order other out outside over page part passed path per place places plan point program programs rather reach
report reports rest same second seconds set share side single size smallest so speed start starting still stops
takes than that the their them then there they this though through time to together took total towards two under unit
until up used wall way what where which whole wide will with without work would written
assumed stated checks takes blocks
""".split())


def known_words():
    text = (ROOT / "docs/terms.md").read_text(encoding="utf-8").lower()
    words = set(re.findall(r"[a-z]+", text))
    return words | PLAIN | {word + "s" for word in words}


def words_of(text):
    for line in text.splitlines():
        if re.match(r"\s*(program|page|report|motion|rings|fibre file|written to)[^:]*:\s*\S*/", line):
            continue  # a path
        line = re.sub(r"\S*[/\\._]\S*[A-Za-z]\S*", " ", line)  # names of files, keys
        for word in re.findall(r"[A-Za-z][A-Za-z'-]*", line):
            yield from (part.lower() for part in re.split(r"['-]", word) if len(part) > 2)


def main():
    known = known_words()
    unknown = {}
    for name in sys.argv[1:]:
        for word in words_of(Path(name).read_text(encoding="utf-8")):
            if word not in known:
                unknown.setdefault(word, name)
    for word, name in sorted(unknown.items()):
        print(f"{name}: \"{word}\" is neither in docs/terms.md nor a plain word")
    print(f"words: {len(sys.argv) - 1} summaries, {len(unknown)} words that are not explained")
    return 1 if unknown or len(sys.argv) < 2 else 0


if __name__ == "__main__":
    sys.exit(main())
