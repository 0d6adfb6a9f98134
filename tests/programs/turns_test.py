"""Turns on pins and about poles: what they wind, and what is refused."""
import json
import re
import sys

import program

MACHINE = "six_axis.json"
LAYER = {"kind": "helical", "angle": 20.0}


class Turns(program.ProgramTest):
    def wind(self, mandrel, layer, code, tow=6.0, **mandrel_job):
        job = {"mandrel": {"extension": 40.0, **mandrel_job}, "layers": [layer], "tow": {"width": tow},
               "redundancy": "central-angle"}
        text = self.write("job.json", json.dumps(job))
        result = self.run_program(mandrel, "--machine", MACHINE, "--job", text, "-o", "out")
        self.assertEqual(result.returncode, code, result.stdout + result.stderr)
        return result

    def refused(self, mandrel, layer, code, **mandrel_job):
        result = self.wind(mandrel, layer, 2, **mandrel_job)
        report = json.loads(self.run_program(mandrel, "--machine", MACHINE, "--job", "job.json",
                                             "-o", "out", "--json").stdout)
        self.assertEqual(report["error"]["code"], code)
        self.assertIn(report["error"]["message"], result.stderr)
        return report["error"]["place"]

    def report(self):
        return json.loads((self.folder / "out" / "report.json").read_text())

    def no_plan(self, figure=""):
        """The check "plan" fails, for a reason that tells the figure; nothing is written to run."""
        report = self.report()
        self.assertFalse(report["checks"]["plan"]["ok"])
        self.assertTrue(report["plan"]["failure"])
        self.assertIn(figure, report["plan"]["failure"])
        self.assertFalse((self.folder / "out" / "program.ngc").exists())

    def pipe(self):
        return self.make("cylinder", "--radius", "40", "--length", "60", "--edge", "8")

    def vessel(self):
        return self.make("vessel", "--radius", "30", "--cylinder-length", "50", "--dome-height", "20",
                         "--opening-radius", "8", "--edge", "4")


class Pins(Turns):
    def test_a_pipe_is_wound_at_20_degrees(self):
        pipe = self.pipe()
        self.wind(pipe, LAYER, 1)
        needed = re.search(r"takes ([0-9.]+) mm of extension where there are 40.0",
                           self.report()["plan"]["failure"])
        # (R / slip)(1 / sin(20 deg) - 1) with 0.2 as the slip: 385 mm, and more with less.
        self.assertGreater(float(needed[1]), 385.0)
        said = self.wind(pipe, LAYER, 0, turn="pins").stdout
        rings = re.search(r"\npins: (.*)\n", said)[1].split("; ")
        for rim, ring in enumerate(sorted(rings)):
            self.assertRegex(ring, rf"^at rim {rim} \d+ of 2\.0 x \d+\.\d mm, \d+\.\d mm beyond it$")
        self.assertEqual(len(rings), 2)
        report = self.report()
        plan = report["plan"]
        for name, check in report["checks"].items():
            self.assertTrue(check["ok"], name)
        self.assertLess(report["checks"]["closure"]["closure_deg"], 0.01)
        self.assertGreater(plan["coverage"]["fraction"], 0.999)
        self.assertEqual(len(plan["pins"]), 2)
        for ring in plan["pins"]:
            self.assertEqual(ring["count"], plan["pattern"]["circuits"])
            self.assertLess(ring["offset_mm"], 20.0)
        for turns in plan["turns"]:
            self.assertLess(turns["extension_mm"], 40.0)
        self.verified(pipe)

    def verified(self, mandrel):
        """The program alone says where the pins stand."""
        program = self.folder / "out/program.ngc"
        self.done("verify", program, "--mandrel", mandrel, "--machine", MACHINE)
        self.done("verify", program, "--mandrel", mandrel, "--machine", MACHINE, "--plan", self.folder / "out")
        text = re.sub(r"\((pins at rim|job:).*\)\n", "", program.read_text())
        again = self.run_program("verify", self.write("bare.ngc", text), "--mandrel", mandrel, "--machine", MACHINE,
                                 "--json")
        self.assertEqual(again.returncode, 1, again.stdout + again.stderr)
        self.assertFalse(json.loads(again.stdout)["checks"]["slip"]["ok"])

    def test_courses_cover_a_pipe(self):
        pipe = self.make("cylinder", "--radius", "30", "--length", "120", "--edge", "6")
        self.wind(pipe, {"kind": "cover"}, 0, turn="pins", tow=12.0)
        report = self.report()
        for name, check in report["checks"].items():
            self.assertTrue(check["ok"], name)
        self.assertEqual(len(report["plan"]["pins"]), 2)
        self.assertLess(report["plan"]["turn_share"], 0.3)
        self.verified(pipe)

    def test_what_cannot_be_is_said(self):
        pipe = self.pipe()
        vessel = self.vessel()
        for mandrel, layer, pins, figure in (
                (vessel, {"kind": "helical", "angle": 50.0}, {}, ""),
                (pipe, LAYER, {"count": 41}, "41"),
                (pipe, LAYER, {"skip": 1}, "1"),
                (pipe, LAYER, {"diameter": 6.0}, "6.00"),
                (pipe, LAYER, {"offset": 35.0}, "40.0")):
            with self.subTest(pins):
                self.wind(mandrel, layer, 1, turn="pins", pins=pins)
                self.no_plan(figure)

    def test_what_is_not_offered_is_refused(self):
        pipe = self.pipe()
        place = self.refused(pipe, {"kind": "hoop"}, "job.not_offered", turn="pins")
        self.assertTrue(place.endswith("job.json: /mandrel/turn"), place)
        place = self.refused(pipe, LAYER, "job.pins_unused", turn="friction", pins={"skip": 3})
        self.assertTrue(place.endswith("job.json: /mandrel/pins"), place)


class Poles(Turns):
    def test_only_domes_turn_the_fibre(self):
        self.wind(self.vessel(), {"kind": "polar"}, 0, turn="pole", extension=0.0)
        for rim in self.report()["plan"]["turns"]:
            self.assertEqual(rim["turns"], 0)
        pipe = self.pipe()
        self.wind(pipe, LAYER, 1, turn="pole")
        self.no_plan()
        self.wind(pipe, {"kind": "cover"}, 1, turn="pole")
        self.no_plan()


if __name__ == "__main__":
    program.main(sys.modules[__name__])
