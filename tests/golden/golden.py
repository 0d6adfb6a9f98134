#!/usr/bin/env python3
"""Whether the jobs of the golden set still give the bytes that they gave.

    golden.py PROGRAM                 compares; exit code 1 where a digest or a figure differs
    golden.py PROGRAM --only NAME ... only these jobs
    golden.py PROGRAM --update        takes what the program makes now; the commit says why it differs
    golden.py PROGRAM --keep DIR      leaves the outputs there, to be looked at, and DIR/NAME/summary.txt

Digests (SHA-256) are of programs, motions, paths and lay-ups. The figures beside them say how far a change went:
blocks, time, fibre, courses, covered share. All mandrels are made by the program itself, but for data/tee.stl.
"""
import argparse
import hashlib
import json
import math
import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
EXPECTED = Path(__file__).with_name("digests.json")
DIGESTED = ("program", "motion", "path", "layup.json", "rings.csv", "fibre.csv")
VESSEL = ["vessel", "--radius", "75", "--cylinder-length", "150", "--opening-radius", "20", "--edge", "5"]
PIPE = ["cylinder", "--radius", "40", "--length", "200", "--edge", "5"]


def layers(*kinds, **job):
    """A job of these layers; what is no object is a kind."""
    return {**job, "layers": [kind if isinstance(kind, dict) else {"kind": kind} for kind in kinds]}


def helical(angle, **wishes):
    return {"kind": "helical", "angle": angle, **wishes}


# name: parameters of `meshwind make` (None: data/tee.stl), job, machine
JOBS = {
    "tee": (None, {}, "six_axis"),
    "tee-four-layers": (None, layers({"kind": "cover", "target_layers": 4}), "six_axis"),
    "tee-two-fibres": (None, {"fibres": 2, "mandrel": {"extension": 60}}, "six_axis"),
    "vessel-laminate": (VESSEL, layers("polar", helical(45), "hoop", "hoop", helical(30), "hoop"), "six_axis"),
    "elbow": (["elbow", "--bend-radius", "120", "--leg1", "150", "--leg2", "150"], layers("helical"), "six_axis"),
    "cone": (["cone", "--edge", "5"], {}, "six_axis"),
    "combination": (["combination", "--edge", "5"], {}, "six_axis"),
    "pins": (["cylinder", "--radius", "40", "--length", "120", "--edge", "4"],
             layers(helical(20), mandrel={"extension": 40, "turn": "pins"}), "six_axis"),
    "lattice": (PIPE, layers({"kind": "lattice", "circuits": 6, "angle": 50, "series": 2, "plies": 2}), "six_axis"),
    "pole-four-axes": (VESSEL, layers("polar", mandrel={"extension": 0, "turn": "pole"}), "four_axis"),
    "hobby-pipe": (PIPE, layers(helical(45), eye={"rule": "cylinder", "radius": 60}, speed={"fibre": 9}),
                   "hobby_grbl"),
    "frame": (["frame", "--edge", "4"], None, "robot_kr16"),
}


def run(program, *arguments):
    home = dict(os.environ, MESHWIND_HOME=str(ROOT))
    result = subprocess.run([program, *map(str, arguments)], env=home, stdin=subprocess.DEVNULL,
                            capture_output=True, text=True)
    if result.returncode not in (0, 1):
        sys.exit(f"golden: {' '.join(map(str, arguments))}: exit code {result.returncode}: {result.stderr}")
    return result.stdout


def wind(program, name, folder):
    """The output folder of a job."""
    made, job, machine = JOBS[name]
    folder.mkdir(parents=True, exist_ok=True)
    mandrel, out = ROOT / "data/tee.stl", folder / "out"
    if made:
        mandrel = folder / f"{name}.stl"
        run(program, "make", *made, "-o", mandrel)
    machine = ROOT / f"machines/{machine}.json"
    if job is None:
        summary = run(program, "carry", mandrel, "--machine", machine, "-o", out)
    else:
        text = folder / "job.json"
        text.write_text(json.dumps(job))
        summary = run(program, mandrel, "--machine", machine, "--job", text, "-o", out)
    (folder / "summary.txt").write_text(summary)
    return out


def outcome(out):
    """What is compared: figures of the report and digests of the files."""
    report = json.loads((out / "report.json").read_text())
    plan, written = report.get("plan", {}), report.get("program", {})
    figures = {"ok": report["ok"], "blocks": written.get("blocks", written.get("moves")),
               "time_s": written.get("duration_s"), "fibre_mm": plan.get("fibre_length_mm"), "courses": plan.get("courses"),
               "covered": plan.get("coverage", {}).get("fraction")}
    files = {file.name: hashlib.sha256(file.read_bytes()).hexdigest() for file in sorted(out.iterdir())
             if file.name.startswith(DIGESTED)}
    return {"figures": figures, "files": files}


def same(one, other):
    """Sums of sines differ in their last digits from one processor's library to another's."""
    if isinstance(one, float) and isinstance(other, float):
        return math.isclose(one, other, rel_tol=1e-9)
    return one == other


def differences(name, was, now):
    for key, value in now["figures"].items():
        if not same(was["figures"].get(key), value):
            yield f"{name}: {key} {was['figures'].get(key)} -> {value}"
    for file in sorted(was["files"].keys() | now["files"].keys()):
        if was["files"].get(file) != now["files"].get(file):
            change = "differs" if file in was["files"] and file in now["files"] else "is new or gone"
            yield f"{name}: {file} {change}"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", type=Path)
    parser.add_argument("--only", nargs="+", choices=JOBS, default=list(JOBS))
    parser.add_argument("--update", action="store_true")
    parser.add_argument("--keep", type=Path)
    options = parser.parse_args()
    expected = json.loads(EXPECTED.read_text()) if EXPECTED.exists() else {}
    found = []
    with tempfile.TemporaryDirectory(prefix="meshwind-golden-") as holder:
        for name in options.only:
            begun = time.monotonic()
            now = outcome(wind(options.program.resolve(), name, (options.keep or Path(holder)) / name))
            different = list(differences(name, expected.get(name, {"figures": {}, "files": {}}), now))
            found += different
            expected[name] = now
            print(f"{name}: {'differs' if different else 'same'}, {time.monotonic() - begun:.1f} s", flush=True)
    for line in found:
        print(line)
    if options.update:
        EXPECTED.write_text(json.dumps({name: expected[name] for name in JOBS if name in expected}, indent=1) + "\n")
        return 0
    same = len(options.only) - len({line.split(":")[0] for line in found})
    print(f"golden: {same} of {len(options.only)} jobs give the same bytes")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
