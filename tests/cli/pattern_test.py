"""Layers by pattern: bodies of revolution wound regularly, and what is refused."""
import json
import sys

import program

MACHINE = "six_axis.json"


class Pattern(program.ProgramTest):
    def wind(self, mandrel, layer, code=0, **job):
        job["layers"] = [layer]
        text = self.write("job.json", json.dumps(job))
        result = self.run_program(mandrel, "--machine", MACHINE, "--job", text, "-o", "out")
        self.assertEqual(result.returncode, code, result.stdout + result.stderr)
        return json.loads((self.folder / "out" / "report.json").read_text())

    # Hoops of 5.88 mm on this cylinder; on one of 80 mm those of 5.69 overlap by 5 %, and layers
    # scatter by 0.023.
    def vessel(self):
        return self.make("vessel", "--radius", "50", "--cylinder-length", "100", "--dome-height",
                         "35", "--opening-radius", "12", "--edge", "5")

    def test_every_kind_on_a_vessel(self):
        vessel = self.vessel()
        for kind in ("helical", "polar", "hoop"):
            with self.subTest(kind):
                report = self.wind(vessel, {"kind": kind, "angle": 50.0} if kind == "helical"
                                   else {"kind": kind})
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
                self.assertEqual(plan["courses"], 2 * plan["pattern"]["circuits"])

    def test_a_pipe_gets_a_pattern_by_itself(self):
        pipe = self.make("cylinder", "--radius", "40", "--length", "200", "--edge", "6")
        report = self.wind(pipe, {"kind": "auto"})
        self.assertEqual(report["plan"]["planner"], "pattern")
        self.assertGreater(report["plan"]["coverage"]["fraction"], 0.999)
        self.assertGreater(report["plan"]["pattern"]["dwell_deg"], 0.0)

    def test_says_why_not(self):
        pipe = self.make("cylinder", "--radius", "40", "--length", "200", "--edge", "6")
        report = self.wind(pipe, {"kind": "helical", "angle": 20.0}, code=1)
        self.assertIn("mm of extension where there are 100.0", report["plan"]["failure"])
        report = self.wind(pipe, {"kind": "polar"}, code=1)
        self.assertIn("use \"helical\"", report["plan"]["failure"])
        elbow = self.make("elbow", "--edge", "10")
        report = self.wind(elbow, {"kind": "helical"}, code=1)
        self.assertIn("patterns are wound on bodies of revolution", report["plan"]["failure"])


if __name__ == "__main__":
    program.main(sys.modules[__name__])
