#!/usr/bin/env python3
"""Walks through the pages as a newcomer would: runs every ```sh block of README.md, docs/tutorial.md and docs/how-to.

    walk.py [--program build/release/cli/meshwind] [--exact] [--outputs DIR] [--keep] [PAGE.md ...]

The commands run from top to bottom, a shell for each page, in a copy of the files that git tracks or would add, in a
temporary folder. Stops at the first command that fails and names page and line. A ```text block behind a ```sh block is
what it prints: its lines must be there in this order, numbers apart (with --exact numbers too); "..." stands for anything.
What cannot run here (installing, other people's files, a real machine) is fenced as ```console.

So that nothing is built again, the copy's build/release/cli/meshwind is a link to --program, with a stamp that says so;
./meshwind of the copy then starts it with the copy's data. With --fresh there is no such link and ./meshwind builds.
"""
import argparse
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
PAGES = ["README.md", "docs/tutorial.md"]
MARK = "\x1ewalk "  # begins the line that a block prints at its end
BEGIN = ("set -eEuo pipefail; trap 'code=$?; printf \"\\n\\x1efailed %d %d\\n\" \"$LINENO\" \"$code\"; exit \"$code\"' ERR")


def copy_of_project(folder):
    """What a clone would have, changes that are not committed included."""
    listed = subprocess.run(["git", "-C", ROOT, "ls-files", "-z", "--cached", "--others", "--exclude-standard"],
                            capture_output=True, check=False)
    if listed.returncode != 0:  # no clone: an unpacked archive
        shutil.copytree(ROOT, folder, ignore=shutil.ignore_patterns("build", "meshwind-out"))
        return
    for name in filter(None, listed.stdout.decode().split("\0")):
        source, target = ROOT / name, folder / name
        if source.is_file():
            target.parent.mkdir(parents=True, exist_ok=True)
            shutil.copy2(source, target)


def link_program(folder, program):
    """Makes ./meshwind of the folder start a program that is already built."""
    release = folder / "build/release"
    (release / "cli").mkdir(parents=True)
    (release / "cli/meshwind").symlink_to(pathlib.Path(program).resolve(strict=True))
    (release / ".built-from").write_text(f"{folder}\n", encoding="utf-8")


def blocks_of(page):
    """(language, number of the first line inside, lines) of each fenced block."""
    found, inside = [], None
    for number, line in enumerate(page.read_text(encoding="utf-8").split("\n"), 1):
        fence = re.fullmatch(r"```(\w*)", line)
        if not fence:
            if inside:
                inside[2].append(line)
        elif inside:
            found.append(inside)
            inside = None
        else:
            inside = (fence[1], number + 1, [])
    if inside:
        raise SystemExit(f"{page}: the block that begins in line {inside[1] - 1} has no end")
    return found


def pattern_of(line, exact):
    parts = []
    for part in re.split(r"(\.\.\.|\s+|(?<![\w.])[-+]?\d+(?:\.\d+)?(?:e[-+]?\d+)?)", line.strip()):
        if part == "...":
            parts.append(".*")
        elif part and not part.strip():
            parts.append(r"\s+")
        elif not exact and re.fullmatch(r"[-+]?\d+(?:\.\d+)?(?:e[-+]?\d+)?", part):
            parts.append(r"[-+]?\d+(?:\.\d+)?(?:e[-+]?\d+)?")
        else:
            parts.append(re.escape(part))
    return re.compile(r"\s*" + "".join(parts) + r"\s*")


def first_missing(expected, printed, exact):
    """Index of the first expected line that does not come, in order, among those printed; None if all do."""
    lines = iter(printed)
    for index, line in enumerate(expected):
        if line.strip() in ("", "..."):
            continue
        pattern = pattern_of(line, exact)
        if not any(pattern.fullmatch(p) for p in lines):
            return index
    return None


def walk(name, folder, environment, exact):
    """Runs the page's commands. Words of what went wrong, or None; and the number of blocks."""
    blocks = blocks_of(folder / name)
    runs = [b for b in blocks if b[0] == "sh"]
    if not runs:
        return None, 0
    # A script with the page's line numbers.
    script = [""] * (max(b[1] + len(b[2]) for b in runs) + 1)
    script[0] = BEGIN
    for _, first, lines in runs:
        script[first - 1:first - 1 + len(lines)] = lines
        script[first - 1 + len(lines)] = f"printf '\\n\\x1ewalk {first}\\n'"
    result = subprocess.run(["bash", "-c", "\n".join(script)], cwd=folder, env=environment, stdin=subprocess.DEVNULL,
                            stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False)
    if failed := re.search("\x1efailed (\\d+) (\\d+)", result.stdout):
        before = result.stdout[:failed.start()].split(MARK)[-1].strip().split("\n")[-20:]
        return f"{name}:{failed[1]}: exit code {failed[2]}\n  " + "\n  ".join(before), len(runs)
    if result.returncode != 0:
        return f"{name}: exit code {result.returncode}\n  " + result.stdout[-2000:], len(runs)
    printed, seen = {}, []
    for line in result.stdout.split("\n"):
        if line.startswith(MARK):
            printed[int(line[len(MARK):])] = seen
            seen = []
        else:
            seen.append(line)
    for run, after in zip(blocks, blocks[1:]):
        if (run[0], after[0]) == ("sh", "text"):
            missing = first_missing(after[2], printed[run[1]], exact)
            if missing is not None:
                return (f"{name}:{after[1] + missing}: the commands above do not print this line\n  "
                        + "\n  ".join(printed[run[1]][-30:])), len(runs)
    return None, len(runs)


def main():
    parser = argparse.ArgumentParser(description="Runs the commands of the pages in a copy of the project.")
    parser.add_argument("pages", nargs="*", help="README.md, docs/tutorial.md and docs/how-to/*.md where none is named")
    parser.add_argument("--program", default=ROOT / "build/release/cli/meshwind", help="the built meshwind")
    parser.add_argument("--fresh", action="store_true", help="let the copy build its own meshwind")
    parser.add_argument("--exact", action="store_true", help="compare the numbers that are shown, too")
    parser.add_argument("--outputs", type=pathlib.Path, help="where the copy's meshwind-out goes in the end")
    parser.add_argument("--keep", action="store_true", help="leave the copy where it is, and say where")
    options = parser.parse_args()
    pages = options.pages or PAGES + sorted(str(p.relative_to(ROOT)) for p in (ROOT / "docs/how-to").glob("*.md"))
    holder = pathlib.Path(tempfile.mkdtemp(prefix="meshwind-walk-")).resolve()
    try:
        folder, home = holder / "meshwind", holder / "home"
        home.mkdir()
        copy_of_project(folder)
        if not options.fresh:
            link_program(folder, options.program)
        environment = {k: v for k, v in os.environ.items() if not k.startswith(("MESHWIND_", "GIT_"))}
        environment.update(HOME=str(home), LC_ALL="C.UTF-8")
        for name in pages:
            begun = time.monotonic()
            wrong, count = walk(name, folder, environment, options.exact)
            if wrong:
                print(f"walk: {wrong}")
                return 1
            print(f"walk: {name}: {count} blocks, {time.monotonic() - begun:.0f} s", flush=True)
        if options.outputs:
            shutil.copytree(folder / "meshwind-out", options.outputs)
        return 0
    finally:
        if options.keep:
            print(f"walk: the copy is in {holder}")
        else:
            shutil.rmtree(holder)


if __name__ == "__main__":
    sys.exit(main())
