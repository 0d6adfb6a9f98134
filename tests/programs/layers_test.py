"""Several layers, wound one on another: what grows, how the fibre goes on, what is written."""
import csv
import json
import math
import sys

import program

MACHINE = "six_axis.json"


class Layers(program.ProgramTest):
    def wind(self, mandrel, layers, code=0, **job):
        job = {"redundancy": "central-angle", **job, "layers": layers}
        text = self.write("job.json", json.dumps(job))
        result = self.run_program(mandrel, "--machine", MACHINE, "--job", text, "-o", "out",
                                  "--effort", 0.1)
        self.assertEqual(result.returncode, code, result.stdout + result.stderr)
        return json.loads((self.folder / "out" / "report.json").read_text())

    def last_row(self, name, row=-1):
        with (self.folder / "out" / name).open(newline="") as stream:
            return list(csv.DictReader(stream))[row]

    def vessel(self):
        return self.make("vessel", "--radius", "30", "--cylinder-length", "50", "--dome-height",
                         "20", "--opening-radius", "8", "--edge", "4")

    # Polar, crossed, hoops: one fibre, each layer on a mandrel of its own.
    def test_a_laminate_is_one_fibre(self):
        layers = [{"kind": "polar"}, {"kind": "helical", "angle": 45}, {"kind": "hoop"},
                  {"kind": "helical", "angle": 35}]
        report = self.wind(self.vessel(), layers)
        self.assertTrue(report["ok"])
        self.assertEqual(report["plan"]["fibres"], 1)
        self.assertEqual([layer["goes_on"] for layer in report["layers"]],
                         [False, True, True, True])
        self.assertEqual([layer["kind"] for layer in report["layers"]],
                         [layer["kind"] for layer in layers])
        for key in ("fibre_m", "mass_g", "time_s"):
            self.assertAlmostEqual(report["laminate"][key],
                                   sum(layer[key] for layer in report["layers"]), places=3)
        self.assertEqual(report["program"]["blocks"],
                         sum(layer["program"]["blocks"] for layer in report["layers"]))
        for layer in report["layers"]:
            tow = 6.0 * 0.25 * 1.55 / 1000.0  # g per mm
            self.assertAlmostEqual(layer["mass_g"], tow * 1000.0 * layer["fibre_m"], places=3)
        # The spindle goes on from where it stands, and so does the eye.
        for before, after in (("motion.csv", "motion-layer-2.csv"),
                              ("motion-layer-2.csv", "motion-layer-3.csv"),
                              ("motion-layer-3.csv", "motion-layer-4.csv")):
            a = self.last_row(before)
            b = self.last_row(after, 0)
            self.assertLess(abs(float(a["C"]) - float(b["C"])), 180.0)
        # The fibre lies where it is led on from, one thickness further in.
        for number, layer in enumerate(report["layers"][1:], start=2):
            before = self.last_row("path.csv" if number == 2 else f"path-layer-{number - 1}.csv")
            after = self.last_row(f"path-layer-{number}.csv", 0)
            step = math.dist(*[[float(row[k]) for k in ("x_mm", "y_mm", "z_mm")]
                               for row in (before, after)])
            self.assertLess(step, report["layers"][number - 2]["thickness_mm"]["max"] + 0.1)
            text = (self.folder / "out" / layer["program"]["file"]).read_text()
            self.assertIn("the fibre goes on", text)

    # The mandrel that a layer was wound on is a file like any other; fewer layers remove the files of more.
    def test_a_layer_can_be_verified_by_itself(self):
        layers = [{"kind": "helical", "angle": 45}, {"kind": "hoop"}]
        pipe = self.make("cylinder", "--radius", "40", "--length", "80", "--edge", "6")
        report = self.wind(pipe, layers, tow={"width": 10})
        thickness = report["layers"][0]["thickness_mm"]
        self.assertAlmostEqual(thickness["mean"], thickness["max"], places=6)
        circuits = report["layers"][0]["plan"]["pattern"]["circuits"]
        share = 2 * circuits * 10.0 / (2.0 * math.pi * 40.0 * math.cos(math.pi / 4.0))
        self.assertAlmostEqual(thickness["mean"], 0.25 * share, places=6)
        grown = str(self.folder / "out" / "mandrel-layer-2.obj")
        inspected = json.loads(self.run_program("inspect", grown, "--json").stdout)
        self.assertAlmostEqual(inspected["mandrel"]["rims"][0]["radius"],
                               40.0 + thickness["mean"], places=6)
        job = self.write("axis.json", json.dumps(
            {"tow": {"width": 10}, "mandrel": {"axis": {"origin": [0, 0, 0], "direction": [0, 0, 1]}, "units": "mm"}}))
        result = self.run_program("verify", str(self.folder / "out" / "program-layer-2.ngc"),
                                  "--mandrel", grown, "--machine", MACHINE, "--job", job,
                                  "--plan", str(self.folder / "out"))
        self.assertEqual(result.returncode, 0, result.stdout + result.stderr)
        self.wind(pipe, [{"kind": "hoop"}], tow={"width": 10})
        # report.html is written by programs that were built with npm at hand.
        written = {file.name for file in (self.folder / "out").iterdir()} - {"report.html"}
        self.assertEqual(written, {"fibre.obj", "fibre.step", "layup.json", "layup.vtu",
                                   "motion.csv", "path.csv", "program.ngc", "report.json"})

    # Layers are thicker inside a bend than outside, but follow the line of the bare tube.
    def test_an_elbow_is_wound_twice(self):
        elbow = self.make("elbow", "--pipe-radius", "40", "--bend-radius", "110", "--leg1", "80",
                          "--leg2", "80", "--edge", "7")
        report = self.wind(elbow, [{"kind": "helical", "angle": angle} for angle in (78, 74)], tow={"width": 14})
        first, second = report["layers"]
        self.assertFalse(second["goes_on"])
        self.assertGreater(first["thickness_mm"]["max"], 1.5 * first["thickness_mm"]["mean"])
        for layer, suffix in ((first, ""), (second, "-layer-2")):
            plan = layer["plan"]
            self.assertEqual(plan["planner"], "elbow")
            self.assertGreater(plan["coverage"]["fraction"], 0.995)
            self.assertLess(plan["coverage"]["regular_cv"], 0.025)
            self.assertLess(report["checks"]["closure" + suffix]["closure_deg"], 0.001)
            # Rims are round only to what the layer before left uneven.
            self.assertLess(report["checks"]["continuity" + suffix]["worst_joint_mm"], 0.1)
        for name, check in report["checks"].items():
            self.assertTrue(check["ok"], name)
        self.assertTrue((self.folder / "out" / "program-layer-2.ngc").exists())

    # Rims stay circles under courses that cross, and what is wound on them holds all checks.
    def test_a_cover_is_covered(self):
        pipe = self.make("cylinder", "--radius", "25", "--length", "60", "--edge", "4")
        report = self.wind(pipe, [{"kind": "cover"}, {"kind": "cover"}], tow={"width": 12})
        self.assertTrue(report["ok"])
        first, second = (layer["plan"]["coverage"]["fraction"] for layer in report["layers"])
        self.assertGreater(second, first - 0.02)
        thickness = report["layers"][0]["thickness_mm"]
        self.assertGreater(thickness["max"], thickness["mean"] + 0.05)
        grown = str(self.folder / "out" / "mandrel-layer-2.obj")
        inspected = json.loads(self.run_program("inspect", grown, "--json").stdout)
        for rim in inspected["mandrel"]["rims"]:
            self.assertLess(rim["circularity_mm"], 1e-4)

    # Where a layer cannot be planned there is no program of any, and the words name the layer.
    def test_a_layer_that_cannot_be(self):
        pipe = self.make("cylinder", "--radius", "40", "--length", "80", "--edge", "8")
        report = self.wind(pipe, [{"kind": "hoop"}, {"kind": "polar"}], code=1, tow={"width": 20})
        self.assertFalse(report["checks"]["plan-layer-2"]["ok"])
        self.assertFalse((self.folder / "out" / "program.ngc").exists())


if __name__ == "__main__":
    program.main(sys.modules[__name__])
