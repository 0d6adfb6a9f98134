#!/usr/bin/env python3
"""Asks the program about parts that a generator makes at random, and compares its answers with the truth.

    parts.py GENERATOR PROGRAM [--count 200] [--seed 1] [--wind N] [--step] [--folder DIR] [--jobs N]

GENERATOR is the program of cad_part.cpp; part SEED, SEED + 1 ... are made. `inspect` understands a part if it finds the
unit, a rim on each end (radius within 1 %, centre within 2 % of the radius from the leg's axis, direction within a
degree, where the end is) and the spindle axis, where the truth names one. A part with a cause must be refused in one line
with exit code 2, by `inspect` or by the main job; a closed body may be wound over its poles instead. With --wind the main job runs on the first N parts, and chooses a blend.

Prints a table, one line for each part, and sums. Exit code 0 if 98 % of the parts without a cause are understood and 80 %
of those that were to be wound are, else 1; 2 if a part cannot be made.
"""
import argparse
import collections
import concurrent.futures
import json
import math
import pathlib
import subprocess
import sys
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
LEAST_UNDERSTOOD = 0.98
LEAST_WOUND = 0.80
RADIUS_SHARE = 0.01
OFF_AXIS_SHARE = 0.02
ANGLE_DEG = 1.0
CIRCLE_SHARE = 0.05  # of the radius, how far a rim may be off its circle
CUT_MM, CUT_SHARE = 6.0, 0.3  # what may be cut off an end: so much or so large a share of the radius
MAKE_S = 60.0
INSPECT_S = 120.0
COLUMNS = ["seed", "kind", "details", "export", "cause", "triangles", "outcome", "why", "mesh", "inspect_s", "wind",
           "wind_s", "wind_words"]


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def minus(a, b):
    return [x - y for x, y in zip(a, b)]


def unit(a):
    return [x / math.sqrt(dot(a, a)) for x in a]


def angle_deg(a, b):
    cross = [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
    return math.degrees(math.atan2(math.sqrt(dot(cross, cross)), dot(a, b)))


def turned(matrix, v):
    return [dot(row[:3], v) for row in matrix[:3]]


def placed(matrix, p):
    return [dot(row[:3], p) + row[3] for row in matrix[:3]]


def off_line(point, origin, direction):
    """Distance of a point from a line, and where its foot is along the line."""
    v = minus(point, origin)
    along = dot(v, direction)
    return math.sqrt(max(0.0, dot(v, v) - along * along)), along


class Leg:
    """The truth of a leg in the mandrel's frame, mm."""

    def __init__(self, leg, matrix, unit_mm):
        self.end = placed(matrix, leg["centre"])
        self.axis = unit(turned(matrix, leg["axis"]))
        self.radius = leg["radius"] * unit_mm

    def faults(self, rim):
        found = []
        angle = angle_deg(self.axis, rim["axis"])
        off, along = off_line(rim["centre"], self.end, self.axis)
        if angle > ANGLE_DEG:
            found.append(f"direction {angle:.1f} deg off")
        if abs(rim["radius"] - self.radius) > RADIUS_SHARE * self.radius:
            found.append(f"radius {rim['radius']:.2f} for {self.radius:.2f}")
        if off > OFF_AXIS_SHARE * self.radius:
            found.append(f"centre {off:.2f} mm off the axis of a leg of R {self.radius:.2f}")
        if along < -max(CUT_MM, CUT_SHARE * self.radius) or along > 0.5:
            found.append(f"{along:+.1f} mm from the end")
        if rim["circularity_mm"] > CIRCLE_SHARE * self.radius:
            found.append(f"off its circle by {rim['circularity_mm']:.2f} of {self.radius:.2f}")
        return found

    def distance(self, rim):
        off, along = off_line(rim["centre"], self.end, self.axis)
        return angle_deg(self.axis, rim["axis"]) / 10.0 + (off + 0.2 * abs(along)) / self.radius


def faults_of(truth, report):
    """What the report has wrong, in words; empty if nothing."""
    mandrel = report["mandrel"]
    if abs(mandrel["unit_mm"] / truth["unit_mm"] - 1.0) > 1e-6:
        return [f"unit {mandrel['unit_mm']} mm for {truth['unit_mm']}"]
    found = []
    matrix = mandrel["file_to_mandrel"]
    rims = list(mandrel["rims"])
    legs = [Leg(leg, matrix, truth["unit_mm"]) for leg in truth["legs"]]
    if len(rims) != len(legs):
        found.append(f"{len(rims)} rims for {len(legs)} ends")
    for number, leg in enumerate(legs):
        if not rims:
            break
        rim = min(rims, key=leg.distance)
        rims.remove(rim)
        found += [f"leg {number}: {fault}" for fault in leg.faults(rim)]
    if truth["axis"]:
        direction = unit(turned(matrix, truth["axis"]["direction"]))
        origin = placed(matrix, truth["axis"]["origin"])
        angle = angle_deg(direction, [0.0, 0.0, 1.0])
        angle = min(angle, 180.0 - angle)
        if angle > ANGLE_DEG:
            found.append(f"spindle {angle:.1f} deg off ({mandrel['axis']['rule']})")
        else:
            back = origin[2] / direction[2]  # to where the line passes the middle of the part
            off = math.hypot(origin[0] - back * direction[0], origin[1] - back * direction[1])
            if off > OFF_AXIS_SHARE * max(leg.radius for leg in legs):
                found.append(f"spindle {off:.2f} mm off ({mandrel['axis']['rule']})")
    return found


def mesh_of(report):
    """What mesh would be wound: even (the program's own), file (as good as that), or uneven, with the reason."""
    mandrel = report["mandrel"]
    for remark in mandrel["remarks"]:
        if "wound as they are" in remark:
            return "uneven: " + remark.partition("wound as they are: ")[2].replace("\t", " ")
    return "even" if mandrel["winding_mesh"]["own"] else "file"


def run(command, seconds):
    """(exit code or None if it took too long, standard output, standard error, seconds)"""
    begin = time.monotonic()
    try:
        result = subprocess.run([str(word) for word in command], stdin=subprocess.DEVNULL, capture_output=True, text=True,
                                timeout=seconds, check=False)
        return result.returncode, result.stdout, result.stderr, time.monotonic() - begin
    except subprocess.TimeoutExpired:
        return None, "", "", time.monotonic() - begin


def first_line(text):
    lines = [line for line in text.split("\n") if line.strip()]
    return lines[0].replace("\t", " ") if lines else ""


class NoPart(Exception):
    """The generator made none."""


class Asker:
    def __init__(self, options, folder):
        self.options = options
        self.folder = folder

    def wind(self, truth):
        """Runs the main job. (outcome, first line of what it says, seconds, whether that is a refusal in one line)"""
        name = f"part_{truth['seed']}"
        job = self.folder / f"{name}.job.json"
        width = round(0.1 * truth["smallest_diameter_mm"], 2)
        job.write_text(json.dumps({"tow": {"width": width, "friction": 0.3}, "mandrel": {"blend": "auto"}}), encoding="utf-8")
        code, _, errors, seconds = run(
            [self.options.program, self.folder / truth["file"], "--machine", self.options.machine, "--job", job,
             "--quiet", "-o", self.folder / f"{name}.out", *truth["options"]], self.options.timeout)
        refused = code == 2 and len(errors.strip().split("\n")) == 1 and errors.strip() != ""
        if code is None:
            return "too long", "", seconds, False
        outcome = {0: "wound", 1: "check failed", 2: "refused"}.get(code, f"exit code {code}")
        return outcome, first_line(errors), seconds, refused

    def ask(self, seed, wanted):
        """Makes a part, asks about it; the line of the table."""
        code, _, errors, seconds = run([self.options.generator, seed, self.folder], MAKE_S)
        if code != 0:
            raise NoPart(f"seed {seed}: no part after {seconds:.0f} s: {first_line(errors)}")
        truth = json.loads((self.folder / f"part_{seed}.json").read_text(encoding="utf-8"))
        made = truth["export"]
        flags = [name for name in ("relative", "seams", "inverted", "moved") if made[name]]
        flags += [truth["unit"]] if truth["unit"] != "mm" else []
        line = dict.fromkeys(COLUMNS, "")
        line.update(seed=seed, kind=truth["kind"], details=" ".join(truth["details"]), export=" ".join(flags),
                    cause=truth["cause"] or "", triangles=made["triangles"])
        if self.options.step:
            step = self.folder / f"part_{seed}.step"
            if not step.exists():
                line["outcome"] = "no exact part"
                return line
            truth["file"], truth["options"] = step.name, []
        code, output, errors, seconds = run(
            [self.options.program, "inspect", "--json", self.folder / truth["file"], *truth["options"]], INSPECT_S)
        line["inspect_s"] = f"{seconds:.2f}"
        refused = code == 2 and len(errors.strip().split("\n")) == 1
        report = json.loads(output) if code == 0 else None
        line["mesh"] = mesh_of(report) if report else ""
        if truth["cause"]:
            self.judge_cause(truth, line, code, errors, refused)
            return line
        if report:
            faults = faults_of(truth, report)
            line["outcome"] = "misunderstood" if faults else "understood"
            line["why"] = "; ".join(faults)
        else:
            line["outcome"] = "too long" if code is None else "refused" if refused else f"exit code {code}"
            line["why"] = first_line(errors)
        if wanted:
            self.note_winding(line, self.wind(truth))
        return line

    def judge_cause(self, truth, line, code, errors, refused):
        if code == 0:
            outcome = self.wind(truth)
            self.note_winding(line, outcome)
            over_poles = truth["cause"] == "closed" and outcome[0] == "wound"
            line["outcome"] = "refused by job" if outcome[3] else "wound over its poles" if over_poles else "not refused"
        else:
            line["outcome"] = "refused by inspect" if refused else "not refused"
            line["why"] = first_line(errors) or f"exit code {code}"

    @staticmethod
    def note_winding(line, outcome):
        line["wind"], line["wind_words"] = outcome[0], outcome[1]
        line["wind_s"] = f"{outcome[2]:.1f}"


def share(lines, good):
    right = sum(1 for line in lines if good(line))
    return f"{right} of {len(lines)}" + (f" ({100.0 * right / len(lines):.0f} %)" if lines else "")


def groups(lines, keys):
    found = collections.defaultdict(list)
    for line in lines:
        for key in keys(line) or ["-"]:
            found[key].append(line)
    return sorted(found.items())


def cause_met(line):
    return line["outcome"].startswith(("refused", "wound over"))


def understood(line):
    return line["outcome"] == "understood"


def summary(lines):
    """Prints the sums. Whether they are good enough."""
    lines = [line for line in lines if line["outcome"] != "no exact part"]
    plain = [line for line in lines if not line["cause"]]
    spoilt = [line for line in lines if line["cause"]]
    wound = [line for line in plain if line["wind"]]
    print(f"\nunderstood {share(plain, understood)}")
    for title, keys in [("kind", lambda line: [line["kind"]]), ("detail", lambda line: line["details"].split()),
                        ("export", lambda line: line["export"].split())]:
        for name, some in groups(plain, keys):
            print(f"  {title:<7}{name:<12}{share(some, understood)}")
    print(f"wound on even triangles {share(plain, lambda line: line['mesh'] in ('even', 'file'))}")
    print(f"refused of those with a cause {share(spoilt, cause_met)}")
    for name, some in groups(spoilt, lambda line: [line["cause"]]):
        print(f"  cause  {name:<14}{share(some, cause_met)}")
    if wound:
        print(f"wound {share(wound, lambda line: line['wind'] == 'wound')}")
        for name, some in groups(wound, lambda line: [line["kind"]]):
            print(f"  kind   {name:<12}{share(some, lambda line: line['wind'] == 'wound')}")
    enough = sum(map(understood, plain)) >= LEAST_UNDERSTOOD * len(plain)
    return enough and sum(line["wind"] == "wound" for line in wound) >= LEAST_WOUND * len(wound)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("generator", type=pathlib.Path)
    parser.add_argument("program", type=pathlib.Path)
    parser.add_argument("--count", type=int, default=200)
    parser.add_argument("--seed", type=int, default=1, help="of the first part")
    parser.add_argument("--wind", type=int, default=0, metavar="N", help="run the main job on the first N parts")
    parser.add_argument("--timeout", type=float, default=600.0, metavar="S", help="of a main job")
    parser.add_argument("--machine", type=pathlib.Path, default=ROOT / "machines/six_axis.json")
    parser.add_argument("--folder", type=pathlib.Path, help="where parts and outputs stay; without it they are deleted")
    parser.add_argument("--step", action="store_true", help="the exact parts, not their triangles")
    parser.add_argument("--jobs", type=int, default=1, help="parts at a time")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as temporary:
        folder = options.folder or pathlib.Path(temporary)
        folder.mkdir(parents=True, exist_ok=True)
        asker = Asker(options, folder)
        print("\t".join(COLUMNS))
        lines = []
        with concurrent.futures.ThreadPoolExecutor(max_workers=options.jobs) as pool:
            tasks = [pool.submit(asker.ask, options.seed + i, i < options.wind) for i in range(options.count)]
            for task in tasks:
                try:
                    lines.append(task.result())
                except BaseException:
                    pool.shutdown(cancel_futures=True)
                    raise
                print("\t".join(str(lines[-1][column]) for column in COLUMNS), flush=True)
    return 0 if summary(lines) else 1


if __name__ == "__main__":
    try:
        sys.exit(main())
    except NoPart as error:
        print(f"parts.py: {error}", file=sys.stderr)
        sys.exit(2)
