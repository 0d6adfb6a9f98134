"""Layers by pattern: bodies of revolution and elbows wound regularly, and what is refused."""
import csv
import json
import math
import re
import sys

import program

MACHINE = "six_axis.json"


class Pattern(program.ProgramTest):
    def wind(self, mandrel, layer, code=0, **job):
        """With the first motion that is found, unless the job asks for the one of least time."""
        job = {"redundancy": "central-angle", **job, "layers": [layer]}
        text = self.write("job.json", json.dumps(job))
        result = self.run_program(mandrel, "--machine", MACHINE, "--job", text, "-o", "out")
        self.assertEqual(result.returncode, code, result.stdout + result.stderr)
        return json.loads((self.folder / "out" / "report.json").read_text())

    def test_every_kind_on_a_vessel(self):
        vessel = self.make("vessel", "--radius", "50", "--cylinder-length", "60", "--dome-height",
                           "35", "--opening-radius", "15", "--edge", "6")
        for kind in ("helical", "polar", "hoop"):
            with self.subTest(kind):
                report = self.wind(vessel, {"kind": kind, "angle": 50.0} if kind == "helical"
                                   else {"kind": kind}, redundancy="optimal", tow={"width": 10})
                plan = report["plan"]
                self.assertEqual(plan["planner"], "pattern")
                self.assertEqual(plan["fibres"], 1)
                coverage = plan["coverage"]
                # All that the turns enclose, and evenly.
                self.assertGreater(coverage["fraction"], 0.998 * coverage["reachable"])
                self.assertLess(coverage["regular_cv"], 0.02)
                for name, check in report["checks"].items():
                    self.assertTrue(check["ok"], name)
                if kind == "hoop":
                    self.assertNotIn("pattern", plan)
                    continue
                self.assertLess(plan["pattern"]["closure_deg"], 0.01)
                self.assertLess(report["checks"]["closure"]["closure_deg"], 0.001)
                self.assertEqual(plan["courses"], 2 * plan["pattern"]["circuits"])

    def test_a_pipe_gets_a_pattern_by_itself(self):
        report = self.wind(self.pipe(), {"kind": "auto"})
        self.assertEqual(report["plan"]["planner"], "pattern")
        self.assertGreater(report["plan"]["coverage"]["fraction"], 0.999)
        self.assertGreater(report["plan"]["pattern"]["dwell_deg"], 0.0)

    def pipe(self):
        return self.make("cylinder", "--radius", "40", "--length", "100", "--edge", "8")

    def test_wishes_are_kept(self):
        report = self.wind(self.pipe(), {"kind": "helical", "angle": 50.0, "pattern": {
            "circuits": 30, "starts": 7, "lead": "lagging", "dwell_deg": 20.0}})
        pattern = report["plan"]["pattern"]
        self.assertEqual([pattern[key] for key in ("circuits", "starts", "order")],
                         [30, 7, "lagging"])
        self.assertGreaterEqual(pattern["dwell_deg"], 40.0)
        self.assertEqual(pattern["interlacing"]["diamonds_around"], 7)
        # Both ways of 30 circuits; the paths themselves say how often they cross.
        crossings = self.crossings()
        self.assertEqual(pattern["interlacing"]["crossings"], crossings)
        self.assertEqual(crossings % 30, 0)

    def crossings(self):
        """Of the courses of path.csv, each pair of ways: multiples of a turn between their ends."""
        passes = {}
        with (self.folder / "out" / "path.csv").open(newline="") as stream:
            for row in csv.DictReader(stream):
                if row["kind"] == "course":
                    passes.setdefault(int(row["course"]), []).append(
                        math.atan2(float(row["y_mm"]), float(row["x_mm"])))
        ways = [[], []]
        for number, azimuths in enumerate(passes[key] for key in sorted(passes)):
            turn = sum(math.remainder(b - a, 2.0 * math.pi)
                       for a, b in zip(azimuths, azimuths[1:]))
            ways[number % 2].append((azimuths[0], azimuths[0] + turn))
        return sum(math.floor((down[1] - up[0]) / (2.0 * math.pi))
                   - math.floor((down[0] - up[1]) / (2.0 * math.pi))
                   for up in ways[0] for down in ways[1])

    def no_plan(self, report, figure=""):
        """The check "plan" fails, for a reason that tells the figure."""
        self.assertFalse(report["checks"]["plan"]["ok"])
        self.assertTrue(report["plan"]["failure"])
        self.assertIn(figure, report["plan"]["failure"])

    def test_says_which_patterns_are_near(self):
        report = self.wind(self.pipe(), {"kind": "helical", "angle": 50.0, "pattern": {
            "circuits": 30, "starts": 6}}, code=1)
        failure = report["plan"]["failure"]
        near = re.findall(r"(\d+) circuits, (\d+) starts", failure)
        self.assertEqual(near[0], ("30", "7"), failure)
        self.assertEqual(len(near), 5, failure)

    def test_wide_bands_leave_the_gaps_asked_for(self):
        report = self.wind(self.pipe(), {"kind": "helical", "angle": 50.0, "pattern": {
            "band_offset_mm": 9.0}})
        self.assertLess(report["plan"]["pattern"]["overlap"], -0.3)
        self.assertNotIn("limit", report["checks"]["coverage"])

    def test_lattices(self):
        pipe = self.pipe()
        report = self.wind(pipe, {"kind": "lattice", "circuits": 6, "angle": 50.0, "series": 2,
                                  "plies": 2})
        lattice = report["plan"]["pattern"]["lattice"]
        self.assertEqual([lattice[key] for key in ("ribs", "series", "plies", "circuits_in_all")],
                         [12, 2, 2, 24])
        self.assertEqual(report["plan"]["courses"], 48)
        share = 12 * 6.0 / (2.0 * math.pi * 40.0 * math.cos(math.radians(50.0)))
        coverage = report["checks"]["coverage"]
        self.assertAlmostEqual(coverage["fraction"], 1.0 - (1.0 - share) ** 2, delta=0.01)
        self.assertEqual(coverage["ribs"], 12)
        self.assertTrue(report["ok"])
        filled = self.wind(pipe, {"kind": "lattice", "circuits": 7, "angle": 50.0,
                                  "series": "fill"})
        self.assertGreater(filled["plan"]["coverage"]["fraction"], 0.999)
        self.assertIn("limit", filled["checks"]["coverage"])
        wide = self.wind(pipe, {"kind": "lattice", "circuits": 7, "angle": 50.0, "series": 9},
                         code=1)
        self.no_plan(wide)

    def expect_even(self, report):
        plan = report["plan"]
        self.assertEqual(plan["planner"], "pattern")
        self.assertEqual(plan["fibres"], 1)
        coverage = plan["coverage"]
        self.assertGreater(coverage["fraction"], 0.995 * coverage["reachable"])
        self.assertLess(coverage["regular_cv"], 0.02)
        self.assertLess(plan["pattern"]["closure_deg"], 0.01)
        for name, check in report["checks"].items():
            self.assertTrue(check["ok"], name)

    # A geodesic would turn on the cone: it is steered to the narrow rim.
    def test_a_cone(self):
        report = self.wind(self.make("cone"), {"kind": "auto"}, tow={"width": 10})
        self.expect_even(report)
        self.assertGreater(report["plan"]["coverage"]["fraction"], 0.999)
        self.assertGreater(abs(report["plan"]["pattern"]["slip_ratio"]), 0.0)

    # Over a sharp edge and over a hollow one, a rim at one end and a dome at the other.
    def test_combinations(self):
        other = ("--radius1", "50", "--length1", "100", "--cone-length", "50", "--radius2", "35",
                 "--length2", "60", "--dome-height", "25", "--opening-radius", "12")
        for shape in ((), other):
            with self.subTest(shape):
                report = self.wind(self.make("combination", *shape), {"kind": "auto"}, tow={"width": 10})
                self.expect_even(report)
                self.assertGreater(report["plan"]["coverage"]["fraction"], 0.98)
                self.assertEqual(report["plan"]["turns"][1]["turns"], 0)

    # The band touches both openings, by a constant slip from one to the other.
    def test_a_vessel_with_unequal_openings(self):
        vessel = self.make("vessel", "--opening-radius", "15", "--upper-opening-radius", "25", "--edge", "6")
        report = self.wind(vessel, {"kind": "polar"}, tow={"width": 10})
        self.expect_even(report)
        self.assertGreater(report["plan"]["coverage"]["fraction"], 0.99)
        slip = abs(report["plan"]["pattern"]["slip_ratio"])
        self.assertGreater(slip, 0.03)
        self.assertLess(slip, 0.9 * 0.96 * 0.2)

    def test_says_how_far_friction_leads(self):
        report = self.wind(self.make("cone"), {"kind": "helical", "angle": 55.0}, code=1,
                           tow={"friction": 0.1})
        self.no_plan(report, "0.136")
        vessel = self.make("vessel", "--opening-radius", "15", "--upper-opening-radius", "60", "--edge", "8")
        report = self.wind(vessel, {"kind": "polar"}, code=1)
        self.no_plan(report)

    def test_says_why_not(self):
        pipe = self.pipe()
        report = self.wind(pipe, {"kind": "helical", "angle": 20.0}, code=1)
        self.no_plan(report, "100.0")
        report = self.wind(pipe, {"kind": "polar"}, code=1)
        self.no_plan(report)
        tee = self.make("tee", "--edge", "12")
        report = self.wind(tee, {"kind": "helical"}, code=1)
        self.no_plan(report)
        elbow = self.make("elbow", "--leg1", "40", "--leg2", "40", "--edge", "10")
        report = self.wind(elbow, {"kind": "polar"}, code=1)
        self.no_plan(report)
        report = self.wind(elbow, {"kind": "helical", "angle": 55}, code=1)
        self.no_plan(report)
        report = self.wind(elbow, {"kind": "helical", "pattern": {"starts": 3}}, code=1)
        self.no_plan(report)

    def test_an_elbow_is_wound_by_both_hands_without_a_gap(self):
        elbow = self.make("elbow", "--pipe-radius", "40", "--bend-radius", "120", "--leg1", "80",
                          "--leg2", "80", "--edge", "7", "--irregular")
        report = self.wind(elbow, {"kind": "auto"}, tow={"width": 12})
        plan = report["plan"]
        self.assertEqual(plan["planner"], "elbow")
        self.assertEqual(plan["fibres"], 1)
        self.assertEqual(plan["courses"], 2 * plan["elbow"]["lines"])
        self.assertGreaterEqual(plan["elbow"]["lines"], plan["elbow"]["needed_by_bend"])
        coverage = plan["coverage"]
        self.assertEqual(coverage["reachable"], 1.0)
        self.assertGreater(coverage["fraction"], 0.995)
        self.assertLess(coverage["regular_cv"], 0.02)
        # Bands around phi are as far apart as the geometry has them.
        self.assertLess(coverage["thickest_layers"], plan["elbow"]["thickest_layers"] + 0.3)
        self.assertGreater(coverage["thinnest_layers"], plan["elbow"]["thinnest_layers"] - 0.3)
        for name, check in report["checks"].items():
            self.assertTrue(check["ok"], name)


if __name__ == "__main__":
    program.main(sys.modules[__name__])
