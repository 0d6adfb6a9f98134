#!/usr/bin/env python3
"""The same job at other sizes: part, tow, tolerances and machine scaled alike give the same winding. And a tube of 5 mm on
a machine as it is.

scale_test.py PROGRAM PROJECT
"""
import json
import subprocess
import sys
import tempfile
from pathlib import Path

PROGRAM, PROJECT = sys.argv[1], Path(sys.argv[2])

# The cone's upper rim is a hollow with its extension.
PARTS = {"cylinder": {"radius": 50.0, "length": 100.0}, "cone": {"radius1": 60.0, "radius2": 40.0, "length": 80.0}}
# The first is what the others are held against. A tenth is between the ends: for one of the parts.
SCALES = {"cylinder": (1.0, 0.05, 10.0), "cone": (1.0, 0.1)}

# Shares of the wall: samples of its own for each size.
SAME_SHARE = 0.005


def scaled(values, by):
    return [by * value for value in values]


def machine_at(by):
    """Lengths, and the fibre's speed; axes are as fast and as fine as they are."""
    machine = json.loads((PROJECT / "machines/six_axis.json").read_text())
    for axis in machine["mandrel_chain"] + machine["eye_chain"]:
        axis["point"] = scaled(axis["point"], by)
        if axis["type"] == "linear":
            axis.update(min=by * axis["min"], max=by * axis["max"])
    for body in machine["eye"]["envelope"]:
        body.update({"from": scaled(body["from"], by), "to": scaled(body["to"], by), "radius": by * body["radius"]})
    for length in ("min_free_length", "max_free_length", "take_up", "max_speed"):
        machine["fibre"][length] *= by
    machine["controller"]["header"] = [f"G64 P{2.0 * by:g} Q{0.01 * by:g}"]
    return machine


def job_at(by):
    return {"layers": [{"kind": "helical", "angle": 45}],
            "tow": {"width": 10.0 * by, "thickness": 0.25 * by, "friction": 0.4, "bridging_tolerance": 0.5 * by},
            "mandrel": {"extension": 150.0 * by, "units": "mm"}, "tolerance": {"laydown": 0.2 * by, "clearance": 5.0 * by},
            "eye": {"free_length": 200.0 * by}, "speed": {"fibre": 30.0 * by}, "redundancy": "central-angle"}


def wind(folder, kind, sizes, edge, job, machine):
    part, job_file = folder / "part.stl", folder / "job.json"
    options = [word for name, value in sizes.items() for word in (f"--{name}", str(value))]
    made = subprocess.run([PROGRAM, "make", kind, *options, "--edge", str(edge), "-o", str(part)], capture_output=True, text=True)
    assert made.returncode == 0, made.stderr
    job_file.write_text(json.dumps(job))
    done = subprocess.run([PROGRAM, str(part), "--machine", str(machine), "--job", str(job_file), "-o", str(folder / "out")],
                          capture_output=True, text=True)
    assert done.returncode == 0, (kind, sizes, done.stderr)
    return json.loads((folder / "out/report.json").read_text())["plan"]


def wound_at(by, kind, folder):
    machine = folder / "machine.json"
    machine.write_text(json.dumps(machine_at(by)))
    plan = wind(folder, kind, {name: by * value for name, value in PARTS[kind].items()}, 8.0 * by, job_at(by), machine)
    return plan["pattern"], plan["coverage"]


def main():
    for kind in PARTS:
        first = None
        for by in SCALES[kind]:
            with tempfile.TemporaryDirectory() as folder:
                pattern, coverage = wound_at(by, kind, Path(folder))
            first = first or (pattern, coverage)
            for number in ("circuits", "starts"):
                assert pattern[number] == first[0][number], (kind, by, number, pattern[number], first[0][number])
            for share in ("fraction", "mean_layers"):
                off = coverage[share] / first[1][share] - 1.0
                assert abs(off) < SAME_SHARE, (kind, by, share, coverage[share], first[1][share])
    with tempfile.TemporaryDirectory() as folder:
        plan = wind(Path(folder), "cylinder", {"radius": 2.5, "length": 15.0}, 0.3, {"tow": {"width": 0.5}},
                    "six_axis.json")
    assert plan["coverage"]["fraction"] > 0.99, plan["coverage"]
    print("ok")


if __name__ == "__main__":
    main()
