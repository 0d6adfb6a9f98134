"""Programs as other makers write them, wound again."""
import csv
import json
import re
import sys

import program
from page_data import Page, SHOWN


class Foreign(program.ProgramTest):
    def setUp(self):
        super().setUp()
        self.done("make", "cylinder", "--radius", "40", "--length", "120", "-o", "pipe.stl")
        self.done("pipe.stl", "--machine", "hobby_grbl.json", "-o", "out")
        self.ours = self.verify("out/program.gcode", "hobby_grbl.json")
        self.tie_on = re.search(r"tie on at X(\S+) Y(\S+) Z(\S+) ",
                                (self.folder / "out/program.gcode").read_text()).groups()
        machine = json.loads((program.SOURCE / "machines/hobby_grbl.json").read_text())
        machine["controller"]["dialect"] = "marlin"
        self.write("marlin.json", json.dumps(machine))

    def verify(self, text, machine, *arguments, code=0):
        result = self.run_program("verify", text, "--mandrel", "pipe.stl", "--machine", machine, "--json", *arguments)
        self.assertEqual(result.returncode, code, result.stderr)
        return json.loads(result.stdout)

    def positions(self):
        """Of each block, from the text alone: X Y Z and F."""
        at = {"X": 0.0, "Y": 0.0, "Z": 0.0}
        sums = False
        for line in (self.folder / "out/program.gcode").read_text().splitlines():
            line = line.partition("(")[0]
            sums = "G91" in line or (sums and "G90" not in line)
            words = {letter: float(number) for letter, number in re.findall(r"([XYZF])(-?[\d.]+)", line)}
            for axis in at:
                at[axis] = words.get(axis, 0.0 if sums else at[axis]) + (at[axis] if sums else 0.0)
            if words and ("G0" in line or "G1 " in line):
                yield dict(at), words.get("F")

    def test_moves_without_feed_moves(self):
        """G0 alone, absolute words, G92 after each turn of the mandrel, six digits, long comments, no end."""
        text = [f"; Parameters {'x' * 150}", "G21", "G90", "G0 F9000"]
        turned = 0.0
        for at, feed in self.positions():
            text.append(f"G0 X{at['X']:.6f} Y{at['Y'] - turned:.6f} Z{at['Z']:.6f}" + (f" F{feed}" if feed else ""))
            if abs(at["Y"] - turned) > 360.0:
                turned = at["Y"]
                text.append("G92 Y0")
        # The moves to the start are the first ones of ours: rotary axes, then the linear one.
        text.insert(6, "M0")
        self.write("foreign.gcode", "\n".join(text) + "\n")
        found = self.verify("foreign.gcode", "marlin.json", "--tie-on", ",".join(self.tie_on), "-o", "seen")
        laid = found["verification"]
        self.assertAlmostEqual(laid["fibre_length_mm"], self.ours["verification"]["fibre_length_mm"], 1)
        head = (self.folder / "out/program.gcode").read_text()
        time_s, corners_s = (float(re.search(words + r": (\S+) s", head).group(1)) for words in ("time", "blocks meet"))
        self.assertAlmostEqual(laid["duration_s"], time_s - corners_s, delta=0.11)  # Marlin's are not known
        for figure, value in self.ours["coverage"].items():
            self.assertAlmostEqual(found["coverage"][figure], value, 3)
        remarks = " ".join(found["remarks"])
        for words in ("no G1 is in the program", "G92 says", "end with the file"):
            self.assertIn(words, remarks)
        self.assertEqual(self.ours["remarks"], [])
        if (self.folder / "out/report.html").exists():  # a program that was built with npm at hand
            self.check_page(Page((self.folder / "seen/verify.html").read_text()), found, text)

    def check_page(self, page, found, text):
        """The page of the laid fibre has the table's places, the program's lines and its checks."""
        self.assertEqual(page.header["report"]["checks"].keys(), found["checks"].keys())
        self.assertEqual(len(page.header["layers"][0]["fibres"][0]["pieces"]), 1)  # there are no course marks
        with (self.folder / "seen/laid.csv").open() as file:
            laid = list(csv.DictReader(file))
        at = "layer1/fibre1/"
        self.assertEqual(len(page[at + "position_mm"]), len(laid))
        for shown, row in zip(page[at + "position_mm"], laid):
            for value, c in zip(shown, "xyz"):
                self.assertAlmostEqual(value, float(row[c + "_mm"]), delta=SHOWN["position_mm"] / 2 + 1e-4)
        self.assertEqual(len(page[at + "time_s"]), found["verification"]["blocks"] + 1)
        lines = page[at + "line"]
        self.assertTrue(all(text[line - 1].startswith("G0 ") for line in lines[1:]))
        stations = page[at + "station"]
        self.assertEqual(stations, sorted(stations))
        self.assertEqual(stations[-1], len(laid) - 1)

    def test_tie_on_in_the_frame_of_the_file(self):
        """The mandrel's file with X along its axis: the place as its CAD program says it."""
        self.done("inspect", "pipe.stl", "--refine", "5", "-o", "pipe.obj")
        x, y, z = self.tie_on
        turned = "".join(
            "v {2} {0} {1}\n".format(*line.split()[1:4]) if line.startswith("v ") else line
            for line in (self.folder / "pipe.obj").read_text().splitlines(keepends=True) if not line.startswith("vn"))
        self.write("lying.obj", turned)
        ours = (self.folder / "out/program.gcode").read_text()
        self.write("foreign.gcode", re.sub(r"\((meshwind|tie on|code digest)[^)]*\)\n", "", ours))
        result = self.run_program("verify", "foreign.gcode", "--mandrel", "lying.obj", "--units", "mm", "--machine", "hobby_grbl.json",
                                  "--tie-on", f"{z},{x},{y}", "--frame", "file", "--json")
        tie = json.loads(result.stdout)["checks"]["tie_on"]
        self.assertTrue(tie["ok"], tie)


if __name__ == "__main__":
    program.main(sys.modules[__name__])
