"""The main job on a small tee: the files of the contract and the program."""
import collections
import csv
import json
import os
import random
import re
import subprocess
import sys
from decimal import Decimal

import program
from page_data import Page

# With the first motion that is found: the one of least time takes as long as all else.
JOB = """{"mandrel": {"extension": 60}, "tow": {"width": 20, "friction": 0.25},
          "tolerance": {"clearance": 2}, "redundancy": "central-angle"}"""
PATH_HEADER = ("course,kind,point,s_mm,x_mm,y_mm,z_mm,nx,ny,nz,tx,ty,tz,kn_per_mm,kg_per_mm,slip,"
               "bridge_mm,free_length_mm")
MOTION_HEADER = "block,time_s,C,Z,Y,X,A,B,ex_mm,ey_mm,ez_mm,rx,ry,rz,course,point"
PLAN_KEYS = {"planner", "courses", "fibre_length_mm", "coverage", "uncovered"}
# Checks that `verify` cannot make of the text alone; the others it makes, too.
OF_THE_PLAN = {"continuity", "coverage", "eye", "rounding"}
TIMES = {"import", "plan", "post", "verify", "write", "total"}


def axis_words(line):
    """Letter and number of each axis word of a G1 line; comments taken off."""
    line = re.sub(r"\(.*?\)|;.*", "", line)
    return [(letter, Decimal(number))
            for letter, number in re.findall(r"([A-Z])\s*([-+]?[\d.]+)", line)]


def pieces_of(out):
    with open(out / "path.csv", newline="") as file:
        return {(row["kind"], row["course"]) for row in csv.DictReader(file)}


class MainJob(program.ProgramTest):
    def wind(self, out):
        mandrel = self.folder / "tee.stl"
        if not mandrel.exists():
            self.make("tee", "--edge", "10", "--run-length", "200", "--branch-length", "120")
            self.write("job.json", JOB)
        result = self.done(mandrel, "--job", "job.json", "-o", out, "--json", "--effort", "0.1")
        for line in result.stderr.splitlines():
            self.assertTrue(line.endswith(" ...") or line.startswith("meshwind: "), line)
        return result

    def check_report(self, report):
        self.assertTrue(report["meshwind"])
        for key in ("file", "triangles", "file_to_mandrel", "axis", "rims", "area_mm2", "regions",
                    "repairs"):
            self.assertIn(key, report["mandrel"])
        plan = report["plan"]
        self.assertLessEqual(PLAN_KEYS, set(plan))
        self.assertLessEqual({"fraction", "mean_layers", "max_layers", "p1_layers", "cv"},
                             set(plan["coverage"]))
        self.assertGreater(plan["coverage"]["fraction"], 0.5)
        for bare in plan["uncovered"]:
            self.assertLessEqual({"region", "area_mm2", "reason"}, set(bare))
        self.assertLessEqual(OF_THE_PLAN | {"laydown", "slip", "limits"}, set(report["checks"]))
        for name, check in report["checks"].items():
            self.assertTrue(check["ok"], name)
        laydown = report["checks"]["laydown"]
        self.assertLessEqual(laydown["max_deviation_mm"], 0.2)
        self.assertLessEqual(laydown["max_angle_deg"], 0.3)
        self.assertLessEqual(3 * report["program"]["blocks"], report["program"]["path_points"])
        self.assertIsNone(report["verification"]["first_wrong"])
        part = report["program"]
        self.assertLessEqual({"file", "dialect", "blocks", "duration_s", "axes"}, set(part))
        self.assertEqual(part["repeats"], {"subprograms": 0, "calls": 0,
                                           "drift": dict.fromkeys("CZYXAB", 0.0)})
        for axis in "CZYXAB":
            self.assertLessEqual({"min", "max", "max_rounding_error"}, set(part["axes"][axis]))
        self.assertLessEqual(TIMES, set(report["timing_s"]))

    def check_limits(self, out):
        """Each number of a check that its kind names is there, and keeps the limit beside it."""
        if not (out / "report.html").exists():
            return  # built without the page
        held = set()
        for name, check, measure in Page((out / "report.html").read_text()).measures():
            self.assertIn(measure["key"], check, name)
            limit = measure.get("limit")
            if limit == "limit_twist_per_m" and limit not in check:
                continue  # the job asks for none
            if limit is not None:
                value = check[measure["key"]]
                limit = check[limit] if isinstance(limit, str) else limit
                least, most = (limit, value) if measure.get("least") else (value, limit)
                self.assertLessEqual(least, most + 1e-3 * abs(most), (name, measure))
                held.add(name)
        self.assertLessEqual({"laydown", "slip", "bridging", "free_length", "payout"}, held)

    def check_layup(self, out, report):
        """A cover counts its layers at closer stations than the plies are taken from."""
        triangles = json.loads((out / "layup.json").read_text())["triangles"]
        self.assertEqual(len(triangles), report["mandrel"]["triangles"])
        area = sum(t["area_mm2"] for t in triangles)
        self.assertAlmostEqual(area / report["mandrel"]["area_mm2"], 1.0, 6)
        plies = sum(t["area_mm2"] * ply[4] for t in triangles for ply in t["plies"])
        layers = plies / area / 0.25
        self.assertAlmostEqual(layers / report["plan"]["coverage"]["mean_layers"], 1.0, delta=0.03)
        names = re.findall("^o (.*)$", (out / "fibre.obj").read_text(), re.MULTILINE)
        self.assertEqual(len(names), report["plan"]["courses"] + report["plan"]["transitions"])
        self.assertEqual(set(names), {f"{kind}_{course}" for kind, course in pieces_of(out)})

    def check_use_of_fibre(self, out, report):
        """The figures of the report, of the path as it was written."""
        spans = collections.defaultdict(list)
        with open(out / "path.csv", newline="") as file:
            for row in csv.DictReader(file):
                spans[row["kind"], row["course"]].append(float(row["s_mm"]))
        lengths = {name: max(span) - min(span) for name, span in spans.items()}
        turns = sum(length for (kind, _), length in lengths.items() if kind == "transition")
        plan = report["plan"]
        self.assertAlmostEqual(plan["turn_share"], turns / sum(lengths.values()), 3)
        layer = report["mandrel"]["area_mm2"] / 20.0  # the tow's width
        self.assertAlmostEqual(plan["fibre_factor"], sum(lengths.values()) / layer, 2)
        self.assertGreater(plan["bound"]["least_factor"], 1.0)
        self.assertGreater(plan["bound"]["gap"], 0.0)

    def check_program(self, out):
        """From the first position on, the increments add up to motion.csv exactly."""
        with open(out / "motion.csv", newline="") as file:
            rows = list(csv.DictReader(file))
        letters = "CZYXAB"
        position = {axis: Decimal(rows[0][axis]) for axis in letters}
        row = 0
        incremental = False
        for line in (out / "program.ngc").read_text().splitlines():
            bare = re.sub(r"\(.*?\)|;.*", "", line)
            incremental = (incremental or "G91" in bare.split()) and "G90" not in bare.split()
            if not incremental:
                continue
            words = [w for w in axis_words(line) if w[0] in letters]
            if not words:
                continue
            row += 1
            for letter, number in words:
                position[letter] += number
            for axis in letters:
                self.assertEqual(position[axis], Decimal(rows[row][axis]), f"block {row} {axis}")
        self.assertEqual(row, len(rows) - 1)
        # LinuxCNC's own interpreter, where it is at hand (exit code 77: it is not).
        tools = program.SOURCE / "tests/tools"
        subprocess.run([tools / "run_rs274.sh", "--setup"], check=False)
        verdict = subprocess.run([tools / "check_program.py", out / "program.ngc",
                                  out / "motion.csv", program.SOURCE / "machines/six_axis.json"],
                                 capture_output=True, text=True, check=False)
        self.assertIn(verdict.returncode, (0, 77), verdict.stdout)

    def verify(self, text, machine="six_axis.json"):
        """Exit code and verify.json of a program text, against the plan in folder "one"."""
        result = self.run_program("verify", self.write("broken.ngc", text), "--mandrel", "tee.stl",
                                  "--machine", machine, "--job", "job.json", "--plan", "one",
                                  "--json")
        self.assertIn(result.returncode, (0, 1), result.stderr)
        return result.returncode, json.loads(result.stdout)

    def check_verify(self, out):
        """The program alone gives what the main job found, and the laid fibre as a table."""
        result = self.done("verify", out / "program.ngc", "--mandrel", "tee.stl", "--machine",
                           "six_axis.json", "--job", "job.json", "--plan", out, "-o", "verified")
        self.assertRegex(result.stdout, r"lays \d+\.\d m of fibre on tee\.stl in \d+ blocks")
        verified = json.loads((self.folder / "verified/verify.json").read_text())
        report = json.loads((out / "report.json").read_text())
        both = set(report["checks"]) - OF_THE_PLAN
        self.assertEqual(set(verified["checks"]), both | {"program", "code"})
        for name in both:
            for key, value in report["checks"][name].items():
                # The plan comes from path.csv now, with four decimals: of two places as bad the other
                # one may be told.
                again = verified["checks"][name][key]
                if key == "place":
                    self.assertEqual(again.keys(), value.keys(), name)
                else:
                    self.assertAlmostEqual(again, value, delta=2e-3, msg=name)
        with open(self.folder / "verified/laid.csv", newline="") as file:
            laid = list(csv.DictReader(file))
        self.assertEqual(int(laid[-1]["block"]), report["program"]["blocks"])
        # One count and one time, wherever they stand.
        head = (out / "program.ngc").read_text()
        for count in (re.search(r"\(blocks: (\d+)\)", head)[1],
                      re.search(r"in (\d+) blocks", result.stdout)[1],
                      report["verification"]["blocks"], report["checks"]["rounding"]["blocks"],
                      verified["verification"]["blocks"], verified["checks"]["program"]["blocks"]):
            self.assertEqual(int(count), report["program"]["blocks"])
        for part in (report["verification"], verified["verification"]):
            self.assertEqual(part["duration_s"], report["program"]["duration_s"])
        self.assertAlmostEqual(float(re.search(r"\(time: ([\d.]+) s\)", head)[1]),
                               report["program"]["duration_s"], delta=0.0501)
        self.assertAlmostEqual(float(laid[-1]["s_mm"]),
                               verified["verification"]["fibre_length_mm"], 3)

    def check_broken_programs(self, out):
        """Whatever is changed in a program is found, at the block where it was changed."""
        lines = (out / "program.ngc").read_text().splitlines()
        start = next(i for i, line in enumerate(lines) if "G91" in line)
        moves = [i for i in range(start, len(lines)) if axis_words(lines[i]) and "G1" in lines[i]]
        self.assertEqual(len(moves),
                         json.loads((out / "report.json").read_text())["program"]["blocks"])
        chance = random.Random(4)

        def check(name, broken, block):
            with self.subTest(f"{name}, block {block}"):
                code, report = self.verify("\n".join(broken) + "\n")
                self.assertEqual(code, 1)
                self.assertEqual(report["verification"]["first_wrong"]["block"], block)

        # mutations_test.cpp has many more of them, in memory.
        for _ in range(int(os.environ.get("MESHWIND_DRAWS", 1))):
            move = chance.randrange(len(moves))
            words = axis_words(lines[moves[move]])
            letter, number = chance.choice([w for w in words if w[0] in "CZYXAB"])
            changed = list(lines)
            changed[moves[move]] = re.sub(rf"\b{letter}[-+.\d]+", f"{letter}{number + 1}",
                                          lines[moves[move]])
            check(f"1 mm more of {letter}", changed, move + 1)

            first, second = sorted(chance.sample(range(len(moves)), 2))
            changed = list(lines)
            changed[moves[first]], changed[moves[second]] = (changed[moves[second]],
                                                             changed[moves[first]])
            check("two swapped", changed, first + 1)

            move = chance.randrange(len(moves) - 1)
            check("one deleted", lines[:moves[move]] + lines[moves[move] + 1:], move + 1)

        mirrored = [re.sub(r"\bC-?([.\d]+)", lambda m: ("C" if "C-" in m[0] else "C-") + m[1], line)
                    if i in moves else line for i, line in enumerate(lines)]
        check("C mirrored", mirrored,
              next(n for n, i in enumerate(moves, 1) if "C" in dict(axis_words(lines[i]))))

        for chain, axis in ("mandrel_chain", 0), ("eye_chain", 2), ("eye_chain", 3):
            machine = json.loads((program.SOURCE / "machines/six_axis.json").read_text())
            turned = machine[chain][axis]
            turned["direction"] = [-x for x in turned["direction"]]
            with self.subTest(f"another machine: {turned['letter']} mirrored"):
                code, report = self.verify("\n".join(lines) + "\n",
                                           self.write("other.json", json.dumps(machine)))
                self.assertEqual(code, 1)
                self.assertEqual(report["verification"]["first_wrong"]["block"], 0)

    def test_files_and_program(self):
        out = self.folder / "one"
        report = json.loads(self.wind(out).stdout)
        self.assertEqual(report, json.loads((out / "report.json").read_text()))
        self.check_report(report)
        self.check_limits(out)
        self.assertEqual((out / "path.csv").read_text().split("\n", 1)[0], PATH_HEADER)
        self.assertEqual((out / "motion.csv").read_text().split("\n", 1)[0], MOTION_HEADER)
        self.assertIn("VTKFile", (out / "layup.vtu").read_text()[:200])
        self.check_layup(out, report)
        self.check_use_of_fibre(out, report)
        self.check_program(out)
        self.check_verify(out)
        self.check_broken_programs(out)
        names = sorted(f.name for f in out.iterdir())
        self.assertFalse([n for n in names if n.startswith(".") or "tmp" in n], names)

    def test_several_fibres(self):
        """Each has a program of its own that holds; with fewer fibres no old file stays."""
        self.make("tee", "--edge", "10", "--run-length", "240", "--branch-length", "140")
        machine = json.loads((program.SOURCE / "machines/six_axis.json").read_text())
        machine["fibre"]["min_free_length"] = 200
        self.write("machine.json", json.dumps(machine))
        files = {"program.ngc", "path.csv", "motion.csv", "fibre.obj", "fibre.step"}
        more = {"program-2.ngc", "path-2.csv", "motion-2.csv", "fibre-2.obj", "fibre-2.step"}
        self.write("job.json", json.dumps(json.loads(JOB) | {
            "fibres": 2, "tolerance": {"clearance": 2, "bare": 0.05}}))
        result = self.done(self.folder / "tee.stl", "--machine", "machine.json", "--job",
                           "job.json", "-o", "out", "--json", "--effort", "0.1")
        report = json.loads(result.stdout)
        self.assertEqual(report["plan"]["fibres"], 2)
        self.assertGreaterEqual(len(report["plan"]["reach_of_fibres"]), 2)
        self.assertIn("slip-2", report["checks"])
        self.assertLessEqual(files | more, {f.name for f in (self.folder / "out").iterdir()})
        laid = 0.0
        for suffix in "", "-2":
            self.assertEqual(report["program" + suffix]["file"], f"program{suffix}.ngc")
            verified = json.loads(self.done(
                "verify", f"out/program{suffix}.ngc", "--mandrel", "tee.stl", "--machine",
                "machine.json", "--job", "job.json", "--plan", "out", "--json").stdout)
            self.assertTrue(verified["ok"])
            self.assertTrue(verified["checks"]["program"]["ok"])
            laid += verified["verification"]["fibre_length_mm"]
        self.assertAlmostEqual(laid / report["plan"]["fibre_length_mm"], 1.0, 3)

        pipe = self.make("cylinder", "--radius", "40", "--length", "80", "--edge", "10")
        self.write("job.json", '{"mandrel": {"extension": 0}, "layers": [{"kind": "hoop"}]}')
        self.done(pipe, "--job", "job.json", "-o", "out")
        written = {f.name for f in (self.folder / "out").iterdir()}
        self.assertLessEqual(files, written)
        self.assertFalse(written & more)


if __name__ == "__main__":
    program.main(sys.modules[__name__])
