"""The main job on a small tee: the files of the contract, the program, and the same bytes again."""
import csv
import json
import re
import subprocess
import sys
from decimal import Decimal

import program

JOB = """{"mandrel": {"extension": 120}, "tow": {"width": 10, "friction": 0.25},
          "tolerance": {"clearance": 2}}"""
PATH_HEADER = ("course,kind,point,s_mm,x_mm,y_mm,z_mm,nx,ny,nz,tx,ty,tz,kn_per_mm,kg_per_mm,slip,"
               "bridge_mm,free_length_mm")
MOTION_HEADER = "block,time_s,C,Z,Y,X,A,B,ex_mm,ey_mm,ez_mm,course,point"
PLAN_KEYS = {"planner", "courses", "fibre_length_mm", "coverage", "uncovered"}
CHECK_KEYS = {"slip": {"limit", "worst"}, "bridging": {"limit_mm", "worst_mm"},
              "collision": {"fibre_hits", "head_hits", "min_clearance_mm"}, "limits": set(),
              "payout": set()}
TIMES = {"import", "plan", "post", "write", "total"}


def axis_words(line):
    """Letter and number of each axis word of a G1 line; comments taken off."""
    line = re.sub(r"\(.*?\)|;.*", "", line)
    return [(letter, Decimal(number))
            for letter, number in re.findall(r"([A-Z])\s*([-+]?[\d.]+)", line)]


class MainJob(program.ProgramTest):
    def wind(self, out):
        mandrel = self.folder / "tee.stl"
        if not mandrel.exists():
            self.make("tee", "--edge", "8", "--run-length", "240", "--branch-length", "140")
            self.write("job.json", JOB)
        result = self.run_program(mandrel, "--job", "job.json", "-o", out, "--json", "--force",
                                  timeout_s=600)
        self.assertIn(result.returncode, (0, 1), result.stderr)
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
        self.assertLessEqual({"fraction", "mean_layers", "max_layers", "cv"},
                             set(plan["coverage"]))
        self.assertGreater(plan["coverage"]["fraction"], 0.5)
        for bare in plan["uncovered"]:
            self.assertLessEqual({"region", "area_mm2", "reason"}, set(bare))
        for name, keys in CHECK_KEYS.items():
            self.assertLessEqual(keys | {"ok"}, set(report["checks"][name]), name)
        part = report["program"]
        self.assertLessEqual({"file", "dialect", "blocks", "duration_s", "axes"}, set(part))
        self.assertEqual(part["repeats"], {"subprograms": 0, "calls": 0,
                                           "drift": dict.fromkeys("CZYXAB", 0.0)})
        for axis in "CZYXAB":
            self.assertLessEqual({"min", "max", "max_rounding_error"}, set(part["axes"][axis]))
        self.assertLessEqual(TIMES, set(report["timing_s"]))

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

    def test_files_program_and_repeat(self):
        first = self.wind(self.folder / "one")
        out = self.folder / "one"
        report = json.loads(first.stdout)
        self.assertEqual(report, json.loads((out / "report.json").read_text()))
        self.check_report(report)
        self.assertEqual((out / "path.csv").read_text().split("\n", 1)[0], PATH_HEADER)
        self.assertEqual((out / "motion.csv").read_text().split("\n", 1)[0], MOTION_HEADER)
        self.assertIn("VTKFile", (out / "layup.vtu").read_text()[:200])
        self.check_program(out)
        names = sorted(f.name for f in out.iterdir())
        self.assertFalse([n for n in names if n.startswith(".") or "tmp" in n], names)

        second = self.wind(self.folder / "two")
        self.assertEqual(second.returncode, first.returncode)
        for name in names:
            with self.subTest(name):
                texts = [(self.folder / run / name).read_text() for run in ("one", "two")]
                if name == "report.json":
                    texts = [json.loads(text) for text in texts]
                    for text in texts:
                        text.pop("timing_s")
                self.assertTrue(texts[0] == texts[1], f"{name} differs between two runs")


if __name__ == "__main__":
    program.main(sys.modules[__name__])
