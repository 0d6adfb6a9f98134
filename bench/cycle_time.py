#!/usr/bin/env python3
"""bench/cycle_time.py PROGRAM [MANDREL [MACHINE]]: cycle time of {"redundancy": "optimal"} against
what the same plan takes with fixed free lengths and the central angle, under the same limits and
tolerances. The lower bound is the fibre's length over its speed. MESHWIND_HOME as for the program.
"""

import csv
import json
import pathlib
import subprocess
import sys
import tempfile
import time

SPEED_M_MIN = 30.0  # of the fibre, in the jobs below
LENGTHS_MM = [*range(30, 200, 10), *range(200, 401, 25)]
PREFERRED_MM = [60, 100, 150, 200]
ROUNDS = 12  # of choosing lengths course by course


class Bench:
    def __init__(self, program, mandrel, machine, folder):
        self.program = program
        self.mandrel = mandrel
        self.machine = machine
        self.folder = folder

    def run(self, name, job, *arguments):
        """The report of a run; checks may fail."""
        out = self.folder / name
        file = self.folder / (name + ".json")
        file.write_text(json.dumps({"speed": {"fibre": SPEED_M_MIN}, **job}))
        result = subprocess.run(
            [self.program, *arguments, "--machine", self.machine, "--job", str(file), "-o",
             str(out), "--quiet"], capture_output=True, text=True, check=False)
        if result.returncode > 1:
            sys.exit(result.stderr)
        return json.loads((out / "report.json").read_text())

    def plan(self):
        return self.run("optimal", {"redundancy": "optimal"}, "wind", self.mandrel)

    def post(self, name, eye):
        """The plan's own path with other eyes."""
        return self.run(name, {"redundancy": "central-angle", "eye": eye}, "post",
                        str(self.folder / "optimal" / "path.csv"), "--frame", "mandrel",
                        "--mandrel", self.mandrel)

    def pieces(self):
        """Course or transition by its number."""
        with open(self.folder / "optimal" / "path.csv", newline="", encoding="ascii") as stream:
            return {int(row["course"]): row["kind"] for row in csv.DictReader(stream)}


def failed(report):
    return [name for name, check in report["checks"].items() if not check["ok"]]


def refused(report):
    return {entry["course"] for entry in report["program"]["refused"]}


def seconds(report):
    return report["program"]["duration_s"]


def equal(length, lengths=()):
    return {"rule": "equal-free-length", "free_length": length,
            **({"lengths": list(lengths)} if lengths else {})}


def fixed_lengths(bench, pieces):
    """Posts of every length: the shortest that passes, and what each refuses."""
    found = None
    blocks = {}
    for length in LENGTHS_MM:
        report = bench.post("fixed", equal(length))
        blocks[length] = refused(report)
        courses = sum(pieces[n] == "course" for n in blocks[length])
        words = f"fixed {length:3} mm: {courses} courses and {len(blocks[length]) - courses} turns refused"
        if not failed(report):
            print(f"{words}; clear, {seconds(report):.1f} s", flush=True)
            found = found or (f"fixed {length} mm", report)
            break
        print(f"{words}; fails {', '.join(failed(report))}", flush=True)
    return found, blocks


def lengths_per_course(bench, pieces, blocks):
    """The shortest length of each course that clears by itself, longer ones where neighbours of
    other lengths spoil it."""
    tried = {n: [length for length in blocks if n not in blocks[length]] for n in pieces}
    hopeless = sorted(n for n in pieces if not tried[n])
    if hopeless:
        print(f"per course: no length of the list clears {hopeless}")
        return None
    at = {n: 0 for n in pieces}
    for _ in range(ROUNDS):
        lengths = [{"course": n, "free_length": tried[n][at[n]]} for n in pieces]
        report = bench.post("courses", equal(max(LENGTHS_MM), lengths))
        if not failed(report):
            return "fixed per course", report
        spoilt = refused(report)
        print(f"per course: {len(spoilt)} refused, fails {', '.join(failed(report))}", flush=True)
        longer = {m for n in spoilt for m in (n - 1, n, n + 1)
                  if m in pieces and at[m] + 1 < len(tried[m])}
        if not longer:
            return None
        for n in longer:
            at[n] += 1
    return None


def adaptive(bench):
    best = None
    for length in PREFERRED_MM:
        report = bench.post("adaptive", {"rule": "adaptive", "free_length": length})
        bad = failed(report)
        print(f"adaptive, preferred {length} mm: {seconds(report):.1f} s"
              + (f", fails {', '.join(bad)}" if bad else ""), flush=True)
        if not bad and (best is None or seconds(report) < seconds(best[1])):
            best = (f"adaptive, preferred {length} mm", report)
    return best


def main(arguments):
    if not 1 <= len(arguments) <= 3:
        sys.exit(__doc__)
    defaults = ["", "tee.stl", "six_axis.json"]
    program, mandrel, machine = arguments + defaults[len(arguments):]
    begin = time.time()
    with tempfile.TemporaryDirectory() as folder:
        bench = Bench(program, mandrel, machine, pathlib.Path(folder))
        plan = bench.plan()
        if failed(plan):
            sys.exit(f"the plan fails {failed(plan)}")
        pieces = bench.pieces()
        bound = plan["plan"]["fibre_length_mm"] * 60.0 / (1000.0 * SPEED_M_MIN)
        found, blocks = fixed_lengths(bench, pieces)
        references = [found or lengths_per_course(bench, pieces, blocks), adaptive(bench)]
        rows = [reference for reference in references if reference]
        rows.append(("optimal", plan))
        baseline = seconds(rows[0][1])
        print(f"\n{'':28} {'s':>8} {'to bound':>9} {'excess':>8}")
        print(f"{'bound':28} {bound:8.1f} {1.0:9.3f}")
        for name, report in rows:
            excess = (seconds(report) - bound) / (baseline - bound)
            print(f"{name:28} {seconds(report):8.1f} {seconds(report) / bound:9.3f} {excess:8.3f}")
        print(f"({time.time() - begin:.0f} s)")


if __name__ == "__main__":
    main(sys.argv[1:])
