"""The page of `inspect --page`, read by the standard library alone; and what is written when it cannot be."""
import json
import math
import struct
import sys

import program
from page_data import Page


class InspectPage(program.ProgramTest):
    def inspect(self, *arguments):
        result = self.run_program("inspect", *arguments, "--page", "part.html")
        if "cli.page" in result.stdout or "without its pages" in result.stderr:
            self.skipTest("the program was built without the page")
        self.assertEqual(result.returncode, 0, result.stderr)
        return Page((self.folder / "part.html").read_text()), result.stdout

    def area(self, page, name):
        points = page[f"{name}/points"]
        for face in page[f"{name}/faces"]:
            p, q, r = (points[v] for v in face)
            u = [b - a for a, b in zip(p, q)]
            v = [b - a for a, b in zip(p, r)]
            yield 0.5 * math.hypot(u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2],
                                   u[0] * v[1] - u[1] * v[0])

    def test_regions_are_those_that_are_printed(self):
        """A solid pipe: each region's triangles have the area that is told, to the digits of single precision."""
        pipe = self.make("cylinder", "--radius", "30", "--length", "120", "--edge", "6", "--solid")
        page, printed = self.inspect(pipe)
        self.assertEqual(page.header["text"], printed)
        self.assertIn("\npage          part.html\n", printed)
        told = json.loads(self.done("inspect", pipe, "--json").stdout)
        self.assertEqual(page.header["inspection"].pop("page"), "part.html")
        self.assertEqual(page.header["inspection"], told)
        sums = {}
        for region, area in zip(page["part/region"], self.area(page, "part")):
            sums[region] = sums.get(region, 0.0) + area
        self.assertEqual(len(sums), 4)
        for region in told["mandrel"]["regions"]:
            self.assertAlmostEqual(sums[region["id"]], region["area_mm2"],
                                   delta=1e-4 * region["area_mm2"])
        kinds = sorted(region["kind"] for region in told["mandrel"]["regions"])
        self.assertEqual(kinds, ["bore", "end-cap", "end-cap", "outer-wall"])

    def test_the_same_part_gives_the_same_bytes(self):
        elbow = self.make("elbow", "--edge", "8")
        self.inspect(elbow)
        first = (self.folder / "part.html").read_bytes()
        self.inspect(elbow, "--threads", "1")
        self.assertEqual((self.folder / "part.html").read_bytes(), first)
        self.assertLess(len(first), 1e6)

    def test_a_job_has_its_say(self):
        """A sharp crotch for one tow is none for a tenth of it."""
        tee = self.make("tee", "--edge", "8", "--blend-radius", "3")
        wide, _ = self.inspect(tee, "--set", "tow.width=6")
        self.assertTrue(any(wide["part/sharp"]))
        self.assertTrue(wide.header["inspection"]["mandrel"]["places"])
        narrow, _ = self.inspect(tee, "--set", "tow.width=0.6")
        self.assertFalse(any(narrow["part/sharp"]))

    def test_axes_are_told_in_words_and_as_json(self):
        """A tee swings about its run by the corner of the branch's rim, hypot(236, 40) mm."""
        tee = self.make("tee", "--edge", "10")
        page, printed = self.inspect(tee)
        axes = page.header["inspection"]["mandrel"]["axis"]["candidates"]
        self.assertEqual((axes[0]["rule"], axes[0]["rims"]), ("coaxial-rims", 2))
        self.assertAlmostEqual(axes[0]["swing_mm"], math.hypot(236, 40), delta=0.2)
        self.assertEqual((axes[0]["angle_deg"], axes[0]["off_mm"]), (0, 0))
        lines = printed.split("\naxes ")[1].split("\nsurface ")[0].splitlines()[1:]
        self.assertEqual(len(lines), len(axes))
        for line, axis in zip(lines, axes):
            self.assertIn(axis["rule"], line)
            self.assertTrue(line.endswith(axis["why"]), line)
        self.assertTrue(lines[0].startswith("  * "))

    def test_a_part_that_the_main_job_refuses_has_a_page(self):
        """Half of a pipe: its rim goes along both cuts."""
        pipe = self.make("cylinder", "--radius", "30", "--length", "120", "--edge", "8")
        data = pipe.read_bytes()
        triangles = [data[at:at + 50] for at in range(84, len(data), 50)]
        half = [t for t in triangles if struct.unpack_from("<f", t, 12)[0] > 0.0]
        pipe.write_bytes(bytes(80) + struct.pack("<I", len(half)) + b"".join(half))
        page, printed = self.inspect(pipe)
        self.assertIn("is no circle", page.header["refused"])
        self.assertIn(page.header["refused"] + "; the main job refuses it", printed)

    def test_refused_in_one_line_and_nothing_written(self):
        self.make("cylinder", "--edge", "15")
        self.write("none.stl", "solid\nendsolid\n")
        for arguments in (["cylinder.stl", "--page", "cylinder.stl"],
                          ["cylinder.stl", "--page", "nowhere/part.html"],
                          ["none.stl", "--page", "part.html"],
                          ["cylinder.stl", "--set", "mandrel.keep_regions=[7]", "--page",
                           "part.html"]):
            before = {f.name: f.read_bytes() for f in self.folder.iterdir()}
            result = self.run_program("inspect", *arguments)
            self.assertEqual(result.returncode, 2, arguments)
            self.assertEqual(result.stdout, "")
            self.assertEqual(len(result.stderr.splitlines()), 1, result.stderr)
            self.assertEqual({f.name: f.read_bytes() for f in self.folder.iterdir()}, before)


if __name__ == "__main__":
    program.main(sys.modules[__name__])
