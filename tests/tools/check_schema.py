#!/usr/bin/env python3
"""Checks a JSON Schema against a conformance corpus and against the files shipped with the project.

    check_schema.py SCHEMA.json MANIFEST.csv [VALID.json ...]

The manifest's last column says what the schema must do with each file. Exit 0 all as stated, 1 not,
77 when the jsonschema module (Debian: python3-jsonschema) is missing.
"""
import csv
import json
import pathlib
import sys

try:
    import jsonschema
except ImportError:
    print("check_schema: skipped, the python module jsonschema is missing")
    sys.exit(77)


def accepts(validator, path):
    try:
        return validator.is_valid(json.loads(path.read_text(encoding="utf-8")))
    except json.JSONDecodeError:
        return False


def main():
    schema = json.loads(pathlib.Path(sys.argv[1]).read_text(encoding="utf-8"))
    jsonschema.Draft202012Validator.check_schema(schema)
    validator = jsonschema.Draft202012Validator(schema)
    manifest = pathlib.Path(sys.argv[2])
    with manifest.open(encoding="utf-8", newline="") as stream:
        cases = [(manifest.parent / row["file"], row["schema"]) for row in csv.DictReader(stream)]
    cases += [(pathlib.Path(name), "accepts") for name in sys.argv[3:]]
    wrong = 0
    for path, expected in cases:
        found = "accepts" if accepts(validator, path) else "rejects"
        if found != expected:
            print(f"{path}: the schema {found} it, expected: {expected}")
            wrong += 1
    print(f"check_schema: {len(cases)} files, {wrong} not as stated")
    return 1 if wrong or not cases else 0


if __name__ == "__main__":
    sys.exit(main())
