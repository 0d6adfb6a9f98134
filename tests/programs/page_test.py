"""The data of report.html against the files beside it, read by the standard library alone."""
import csv
import json
import sys

import program
from page_data import Page, SHOWN


class ReportPage(program.ProgramTest):
    def wind(self, *options):
        part = self.make("cylinder", "--radius", "30", "--length", "120", "--edge", "6")
        result = self.run_program(part, "--machine", "six_axis.json", "-o", "out", *options)
        self.assertEqual(result.returncode, 0, result.stdout + result.stderr)
        page = self.folder / "out" / "report.html"
        if not page.exists():
            self.skipTest("the program was built without the page")
        return Page(page.read_text())

    def rows(self, name):
        with (self.folder / "out" / name).open(newline="") as stream:
            return list(csv.DictReader(stream))

    def agree(self, page, prefix, path, motion):
        """Every array of a fibre against its tables."""
        rows = self.rows(path)
        for name, columns, digits in (("position_mm", ("x_mm", "y_mm", "z_mm"), 1e-4),
                                      ("normal", ("nx", "ny", "nz"), 1e-6),
                                      ("tangent", ("tx", "ty", "tz"), 1e-6)):
            entries = page[prefix + name]
            self.assertEqual(len(entries), len(rows))
            for entry, row in zip(entries, rows):
                for value, column in zip(entry, columns):
                    self.assertAlmostEqual(value, float(row[column]), delta=SHOWN[name] / 2 + digits)
        for name, digits in (("s_mm", 1e-2), ("slip", 1e-5), ("bridge_mm", 1e-4),
                             ("free_length_mm", 1e-3)):
            for value, row in zip(page[prefix + name], rows):
                self.assertAlmostEqual(value, float(row[name]), delta=SHOWN[name] / 2 + digits)
        for value, row in zip(page[prefix + "piece"], rows):
            self.assertEqual(value, int(row["course"]))
        blocks = self.rows(motion)
        letters = [axis["letter"] for chain in ("mandrel_chain", "eye_chain")
                   for axis in page.header["machine"][chain]]
        axes = page[prefix + "axes"]
        self.assertEqual(len(axes), len(blocks))
        stations = page[prefix + "station"]
        times = page[prefix + "time_s"]  # of the controller, which takes longer where blocks meet
        self.assertEqual(times, sorted(times))
        self.assertGreaterEqual(times[-1], 0.99 * float(blocks[-1]["time_s"]))
        for k, row in enumerate(blocks):
            for value, letter in zip(axes[k], letters):
                self.assertAlmostEqual(value, float(row[letter]), delta=1e-9)
            if row["course"]:
                self.assertEqual(rows[stations[k]]["course"], row["course"])
                self.assertEqual(rows[stations[k]]["point"], row["point"])
        self.agree_with_limits(page, prefix)
        for eye, row in zip(page[prefix + "eye_mm"], blocks):
            for value, column in zip(eye, ("ex_mm", "ey_mm", "ez_mm")):
                self.assertAlmostEqual(value, float(row[column]), delta=SHOWN["eye_mm"] / 2 + 1e-4)

    def agree_with_limits(self, page, prefix):
        """The acceleration that blocks need, by the times that the program asks for, is that of the check."""
        axes, asked = page[prefix + "axes"], page[prefix + "asked_s"]
        chains = page.header["machine"]["mandrel_chain"] + page.header["machine"]["eye_chain"]
        worst = 0.0
        for a, axis in enumerate(chains):
            if axis["acceleration"] is None:
                continue
            speed = [0.0] + [(axes[b][a] - axes[b - 1][a]) / asked[b] for b in range(1, len(axes))] + [0.0]
            ramps = [abs(after - before) for before, after in zip(speed, speed[1:])]
            worst = max([worst] + [(ramps[b - 1] + ramps[b]) / 2 / asked[b] / axis["acceleration"]
                                   for b in range(1, len(axes))])
        checks = page.header["report"]["checks"]
        ratio = max(check["acceleration_ratio"] for name, check in checks.items() if name.startswith("limits"))
        self.assertLessEqual(worst, 1.01 * ratio)
        self.assertGreater(worst, 0.5 * ratio)

    def test_one_layer(self):
        page = self.wind()
        report = json.loads((self.folder / "out" / "report.json").read_text())
        del report["timing_s"]  # differs from run to run
        self.assertEqual(page.header["report"], report)
        self.assertEqual(len(page.header["layers"]), 1)
        fibre, = page.header["layers"][0]["fibres"]
        self.assertEqual(fibre["prefix"], "layer1/fibre1/")
        self.agree(page, "layer1/fibre1/", "path.csv", "motion.csv")
        times = page["layer1/fibre1/time_s"]
        self.assertEqual(times, sorted(times))
        self.assertAlmostEqual(times[-1], report["program"]["duration_s"], delta=1e-3)
        courses = [piece for piece in fibre["pieces"] if piece["kind"] == "course"]
        self.assertEqual(len(courses), report["plan"]["courses"])
        self.assertEqual(sum(piece["count"] for piece in fibre["pieces"]),
                         len(self.rows("path.csv")))
        # Winding angles of a cylinder's courses are the pattern's.
        angles = page["layer1/fibre1/angle_deg"]
        piece = courses[len(courses) // 2]
        middle = angles[piece["first"] + piece["count"] // 2]
        self.assertAlmostEqual(middle, report["plan"]["pattern"]["angle_deg"], delta=0.2)
        # The listing is the program's, and every block's line is a line of motion in it.
        text = bytes(page["layer1/fibre1/text"]).decode()
        self.assertEqual(text, (self.folder / "out" / fibre["program"]).read_text())
        lines = text.splitlines()
        for line in page["layer1/fibre1/line"][1:]:
            self.assertRegex(lines[line - 1], r"[A-Z]-?[0-9.]")
        # Mean layers by area, from the page's triangles.
        points = page["mandrel/points"]
        area = layers = 0.0
        for face, value in zip(page["mandrel/faces"], page["total/layers"]):
            p, q, r = (points[v] for v in face)
            u = [b - a for a, b in zip(p, q)]
            v = [b - a for a, b in zip(p, r)]
            normal = (u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2],
                      u[0] * v[1] - u[1] * v[0])
            size = 0.5 * sum(x * x for x in normal) ** 0.5
            area += size
            layers += size * value
        self.assertAlmostEqual(layers / area, report["plan"]["coverage"]["mean_layers"],
                               delta=0.02)

    def test_checks_have_places_on_the_mandrel(self):
        page = self.wind()
        report = page.header["report"]
        blocks = len(self.rows("motion.csv"))
        for name in ("laydown", "slip", "bridging", "free_length", "limits", "payout"):
            place = report["checks"][name]["place"]
            self.assertEqual((place["layer"], place["fibre"]), (1, 1))
            self.assertLess(place["block"], blocks)
            x, y, z = place["position_mm"]
            self.assertAlmostEqual((x * x + y * y) ** 0.5, 30.0, delta=0.2)
            self.assertLess(abs(z), 60.0 + 100.0 + 1.0)

    def test_layers_and_fibres(self):
        job = self.write("job.json", json.dumps(
            {"layers": [{"kind": "helical", "angle": 45}, {"kind": "hoop"}]}))
        page = self.wind("--job", job)
        self.assertEqual([layer["kind"] for layer in page.header["layers"]], ["helical", "hoop"])
        self.agree(page, "layer1/fibre1/", "path.csv", "motion.csv")
        self.agree(page, "layer2/fibre1/", "path-layer-2.csv", "motion-layer-2.csv")
        bare = page["mandrel/points"]
        grown = page[page.header["layers"][1]["points"]]
        thickness = page.header["report"]["layers"][0]["thickness_mm"]["mean"]
        for p, q in zip(bare, grown):
            self.assertAlmostEqual(sum((b - a) ** 2 for a, b in zip(p, q)) ** 0.5, thickness,
                                   delta=1e-3)
        for total, first, second in zip(page["total/layers"], page["layer1/layers"],
                                        page["layer2/layers"]):
            self.assertAlmostEqual(total, first + second, delta=1e-4)


if __name__ == "__main__":
    program.main(sys.modules[__name__])
