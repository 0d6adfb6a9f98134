#!/usr/bin/env python3
"""Makes the reference from what the program and the schemas say of themselves.

    docs/make_reference.py [--program build/release/cli/meshwind]          writes the files
    docs/make_reference.py --check [--program ...]                         only compares: exit 1 and names of stale files

docs/reference/commands.md, docs/meshwind.1 and cli/meshwind.bash come from `meshwind --help` and the --help of each
command, the schemas in data/schema and docs/reference/job.md and machine.md from `meshwind validate --schema`. Nothing in these
files is written by hand.
"""
import argparse
import json
import pathlib
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "docs"))
sys.dont_write_bytecode = True

from reference_help import read_commands  # noqa: E402
from reference_pages import bash_completion, commands_page, manual_page  # noqa: E402
from reference_schema import schema_page  # noqa: E402


def made_files(program):
    """Texts by file name."""
    commands, version = read_commands(program)
    job_schema, machine_schema = (
        subprocess.run([str(program), "validate", "--schema", kind], check=True, capture_output=True, text=True).stdout
        for kind in ("job", "machine"))
    return {
        "data/schema/job.schema.json": job_schema,
        "data/schema/machine.schema.json": machine_schema,
        "docs/reference/commands.md": commands_page(commands),
        "docs/reference/job.md": schema_page(
            json.loads(job_schema), "job.schema.json", "Job file",
            "`meshwind validate JOB.json` checks a file. What the keys do is told in "
            "[files](../files.md#job), [winding](../winding.md) and [post](../post.md)."),
        "docs/reference/machine.md": schema_page(
            json.loads(machine_schema), "machine.schema.json", "Machine file",
            "`meshwind validate MACHINE.json` checks a file. `machines/six_axis.json` is an example with notes; "
            "[a machine of your own](../how-to/own_machine.md) goes through one step by step."),
        "docs/meshwind.1": manual_page(commands, version),
        "cli/meshwind.bash": bash_completion(commands),
    }


def main():
    parser = argparse.ArgumentParser(description="Makes the reference pages, the manual page and the completion.")
    parser.add_argument("--program", default=ROOT / "build/release/cli/meshwind", help="the built meshwind")
    parser.add_argument("--check", action="store_true", help="write nothing; fail where a file is stale")
    arguments = parser.parse_args()
    stale = []
    for name, text in made_files(arguments.program).items():
        path = ROOT / name
        if path.is_file() and path.read_text(encoding="utf-8") == text:
            continue
        stale.append(name)
        if not arguments.check:
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(text, encoding="utf-8")
    for name in stale:
        print(f"{name} is stale: run docs/make_reference.py" if arguments.check else f"wrote {name}")
    return 1 if stale and arguments.check else 0


if __name__ == "__main__":
    sys.exit(main())
