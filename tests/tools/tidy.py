#!/usr/bin/env python3
"""tidy.py BUILD_FOLDER JOBS FOLDER...: clang-tidy over the library sources of these folders, many in one run.

Headers, Eigen's before all, are parsed and checked anew for each text. So sources of one library with the same flags are
read one after the other as one text, none beside another that defines the same name. Where the compiler complains of such
a text nevertheless, each half is checked by itself. Exit 1 when something is found.
"""
import concurrent.futures
import json
import pathlib
import re
import shlex
import subprocess
import sys

BATCH = 24  # sources at most
ROOT = pathlib.Path(__file__).resolve().parents[2]
# At the start of a line: a type, or a function or constant behind its type; members of classes have "::" instead.
DEFINED = re.compile(r"(?:struct|class|enum class|enum) (\w+)|using (\w+) =|(?!using|namespace)[\w:<>,&* ]*[\w>&*] "
                     r"[&*]?(\w+) ?[({=;\[]")
# Errors and warnings of the compiler itself may come of reading sources together.
OF_COMPILER = "[clang-diagnostic-"


def flags_of(entry):
    """The compiler's options but those that name this file, what comes of it, or headers compiled by GCC."""
    words = iter(shlex.split(entry["command"]))
    kept = []
    for word in words:
        if word in ("-o", "-MT", "-MF", "-c", "-include"):
            next(words)
        elif word.startswith(("-Winvalid-pch", "-Wno-")):  # of headers compiled by GCC
            continue
        elif word.startswith(("-D", "-U", "-I", "-O", "-W", "-f", "-std=")):
            kept.append(word)
        elif word == "-isystem":
            kept += [word, next(words)]
    return kept


def sources_of(file):
    """Those that CMake has compiled as one text, for this one."""
    if not file.name.startswith("unity_"):
        return [file]
    return [pathlib.Path(name) for name in re.findall(r'^#include "(.*)"', file.read_text(), re.MULTILINE)]


def names_in(source):
    found = (DEFINED.match(line) for line in source.read_text().splitlines() if line[:1].isalpha())
    return {next(filter(None, match.groups())) for match in found if match}


def batches_of(sources):
    """First fit: a source goes into the first batch that is not full and has none of its names."""
    batches = []
    for source in sources:
        names = names_in(source)
        for batch, known in batches:
            if len(batch) < BATCH and not known & names:
                batch.append(source)
                known |= names
                break
        else:
            batches.append(([source], names))
    return [batch for batch, _ in batches]


def tidy(source, flags, folders):
    filters = f"--header-filter=/({'|'.join(folders)})/([a-z_]+/)?[a-z_0-9]+\\.(h|cpp)$"
    run = subprocess.run(["clang-tidy-14", "--quiet", filters, str(source), "--", *flags], cwd=ROOT, text=True,
                         stdout=subprocess.PIPE, stderr=subprocess.PIPE)
    return run.returncode, run.stdout + (run.stderr if run.returncode else "")


def check(name, sources, flags, folders, scratch):
    """(exit code, words) of each run."""
    if len(sources) == 1:
        return [tidy(sources[0], flags, folders)]
    text = scratch / f"{name}.cpp"
    text.write_text("".join(f'#include "{source}"  // NOLINT(bugprone-suspicious-include)\n' for source in sources))
    code, said = tidy(text, flags, folders)
    if OF_COMPILER not in said:
        return [(code, said)]
    middle = len(sources) // 2
    return (check(name + "_1", sources[:middle], flags, folders, scratch) +
            check(name + "_2", sources[middle:], flags, folders, scratch))


def main():
    build, jobs, folders = pathlib.Path(sys.argv[1]), int(sys.argv[2]), sys.argv[3:]
    groups = {}
    for entry in json.loads((build / "compile_commands.json").read_text()):
        for source in sources_of(pathlib.Path(entry["file"])):
            if ROOT in source.parents and source.relative_to(ROOT).parts[0] in folders:
                groups.setdefault((source.relative_to(ROOT).parts[0], tuple(flags_of(entry))), []).append(source)
    if not groups:
        sys.exit("tidy: no sources")
    scratch = build / "tidy"
    scratch.mkdir(exist_ok=True)
    work = [(library, batch, flags) for (library, flags), sources in groups.items() for batch in batches_of(sources)]
    work.sort(key=lambda one: -len(one[1]))
    found = 0
    with concurrent.futures.ThreadPoolExecutor(jobs) as pool:
        runs = [pool.submit(check, f"{library}_{number}", batch, flags, folders, scratch)
                for number, (library, batch, flags) in enumerate(work)]
        for (library, batch, _), run in zip(work, runs):
            results = run.result()
            print(f"{library}: {len(batch)} sources in {len(results)} runs", flush=True)
            for code, said in results:
                if code:
                    found = 1
                    print(said)
    sys.exit(found)


if __name__ == "__main__":
    main()
