"""CAD files from their bytes to a program, against the faces that Open CASCADE itself evaluates (cad_files.cpp).

argv: PROGRAM CAD_FILES SOURCE_FOLDER [unittest options]
"""
import csv
import functools
import json
import math
import os
import random
import re
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent.parent / "programs"))
import program  # noqa: E402

CAD_FILES = ""


@functools.cache
def cad_folder():
    """Where the files of cad() stay until the last test has ended."""
    holder = tempfile.TemporaryDirectory(prefix="meshwind-test-")
    unittest.addModuleCleanup(holder.cleanup)
    return Path(holder.name)


@functools.cache
def cad(kind, unit="mm", ending=".step"):
    """A part's file, made once; no test changes it."""
    file = cad_folder() / f"{kind}_{unit}{ending}"
    subprocess.run([CAD_FILES, "make", kind, unit, file], check=True, capture_output=True)
    return file


@functools.cache
def told_of(file):
    """What inspect prints of such a file without options."""
    result = subprocess.run([program.PROGRAM, "inspect", file, "--json"], timeout=program.TIMEOUT_S,
                            stdin=subprocess.DEVNULL, capture_output=True, text=True)
    if result.returncode:
        raise AssertionError(f"{file.name}: {result.stderr}")
    return result.stdout


class CadTest(program.ProgramTest):
    def inspected(self, file, *options):
        return json.loads(self.done("inspect", file, "--json", *options).stdout)["mandrel"]

    def inspected_once(self, *part):
        return json.loads(told_of(cad(*part)))["mandrel"]

    def off_faces_mm(self, file, start, direction, length_mm, step_mm):
        """How far a traced geodesic ends from that on the exact faces, and its length."""
        table = self.folder / "path.csv"
        self.done("trace", file, "--start", ",".join(map(str, start)), "--direction", ",".join(map(str, direction)),
                  "--length", length_mm, "--frame", "file", "-o", table)
        rows = list(csv.DictReader(table.read_text().splitlines()))
        first, last = rows[0], rows[-1]
        at = [first[key] for key in ("x_mm", "y_mm", "z_mm", "tx", "ty", "tz")]
        exact = subprocess.run([CAD_FILES, "geodesic", file, last["s_mm"], str(step_mm)], input=" ".join(at),
                               capture_output=True, text=True, check=True).stdout.split()
        return math.dist([float(last[key]) for key in ("x_mm", "y_mm", "z_mm")], list(map(float, exact[:3]))), \
            float(last["s_mm"])

    def test_units_and_formats_give_the_same_part(self):
        vessel = (20.0, 20.0), ["cylinder"] * 3 + ["plane"] * 2 + ["sphere"] * 2
        tee = (40.0, 50.0, 50.0), ["cylinder"] * 2 + ["plane"] * 3 + ["spline"] * 2
        for kind, unit, unit_mm, (rims, faces) in (("tee", "mm", 1.0, tee), ("vessel", "mm", 1.0, vessel),
                                                   ("vessel", "inch", 25.4, vessel), ("vessel", "m", 1000.0, vessel)):
            with self.subTest((kind, unit)):
                part = self.inspected_once(kind, unit)
                self.assertEqual((part["unit_mm"], part["unit_rule"]), (unit_mm, "file"))
                radii = sorted(rim["radius"] for rim in part["rims"])
                for radius, wanted in zip(radii, rims, strict=True):
                    self.assertAlmostEqual(radius, wanted, delta=1e-6)  # digits of the file
                kinds = sorted(face["kind"] for face in part["cad_faces"])
                self.assertEqual(kinds, faces)
        for ending in (".igs", ".brep"):
            with self.subTest(ending):
                part = self.inspected_once("elbow", "mm", ending)
                self.assertEqual(len(part["rims"]), 2)
                self.assertEqual([part["kind"] for part in part["tube"]["parts"]], ["straight", "bend", "straight"])
                self.assertEqual("14 edges of the CAD part's faces were apart and are sewn" in part["remarks"],
                                 ending == ".igs")

    def test_corners_are_the_exact_faces(self):
        part = self.inspected_once("wye")
        fit = part["smooth_fit"]
        self.assertEqual(fit["exact"], sum(count for kind, count in fit.items() if kind != "exact"))
        self.assertGreater(part["winding_mesh"]["least_quality"], 0.3)  # no sliver
        self.assertFalse(part["winding_mesh"]["own"])
        run, branch = (next(face for face in part["cad_faces"] if abs(face.get("radius_mm", 0) - radius) < 1e-6)
                       for radius in (50, 40))
        self.assertAlmostEqual(abs(run["axis"]["direction"][2]), 1.0, delta=1e-9)
        self.assertAlmostEqual(abs(branch["axis"]["direction"][2]), 0.5, delta=1e-9)
        self.assertEqual((run["region"], branch["region"]), (0, 0))

    def test_geodesics_on_the_exact_faces(self):
        # On a torus and a cylinder 1e-4 mm per metre; the table has 1e-6 mm at both ends.
        for kind, start, direction, asked_mm in (("torus", (160, 160, 40), (0.3, -1, -0.5), 600),
                                                 ("pipe", (50, 0, -140), (0, 1, 0.5), 500)):
            off_mm, length_mm = self.off_faces_mm(cad(kind), start, direction, asked_mm, 0.2)
            self.assertGreater(length_mm, 150.0)
            self.assertLess(off_mm, 1e-4 * length_mm / 1000.0 + 2e-6, kind)
        # Random ones on the torus, on its outer and its inner side: 3e-5 mm per metre with these.
        dice = random.Random(1)
        off_mm2 = length_mm2 = 0.0
        for _ in range(5):
            angle = dice.uniform(0, 2 * math.pi)
            start = [math.sqrt(0.5) * (200 + 50 * math.cos(angle))] * 2 + [50 * math.sin(angle)]
            off_mm, length_mm = self.off_faces_mm(cad("torus"), start, [dice.uniform(-1, 1) for _ in range(3)], 300, 0.2)
            off_mm2, length_mm2 = off_mm2 + off_mm ** 2, length_mm2 + length_mm ** 2
        self.assertLess(math.sqrt(off_mm2 / length_mm2), 1e-4 / 1000.0)
        # Over the blend of a tee, two borders where the curvature jumps: 0.02 mm over 300 mm.
        off_mm, length_mm = self.off_faces_mm(cad("tee"), (36, -35, -90), (0.25, 0.2, 1), 300, 0.1)
        self.assertGreater(length_mm, 150.0)
        self.assertLess(off_mm, 0.02)

    def test_stated_accuracy_is_that_on_the_faces(self):
        """Within a factor of 5 of the rms of a few other paths; 1.6 and 1.4 with these."""
        dice = random.Random(3)
        for kind, middle, radius_mm in (("torus", (200, 0, 0), 50), ("elbow", (0, 0, -40), 40)):
            file = cad(kind)
            stated = self.inspected_once(kind)["accuracy"]
            off_mm2 = length_mm2 = 0.0
            for _ in range(3):
                angle = dice.uniform(0, 2 * math.pi)
                around = (0, math.sin(angle)) if kind == "torus" else (math.sin(angle), 0)
                start = [middle[0] + radius_mm * math.cos(angle), middle[1] + radius_mm * around[0], middle[2] + radius_mm * around[1]]
                direction = [dice.uniform(-1, 1) for _ in range(3)]
                if kind == "torus":  # into the quarter that the file has
                    start = [math.sqrt(0.5) * start[0], math.sqrt(0.5) * start[0], start[2]]
                off_mm, path_mm = self.off_faces_mm(file, start, direction, stated["length_mm"], 0.1)
                off_mm2, length_mm2 = off_mm2 + off_mm ** 2, length_mm2 + path_mm ** 2
            ratio = stated["patches_mm_per_m"] / (1000.0 * math.sqrt(off_mm2 / length_mm2))
            self.assertTrue(1 / 5 < ratio < 5, f"{kind}: {ratio}")

    def test_a_study_compares_with_the_exact_faces(self):
        study = json.loads(self.done("study", "mesh-size", "--mandrel", cad("torus"), "--edges", "16", "--paths", "4",
                                     "--length", "100", "--json", "-o", "study").stdout)
        self.assertIn("exact faces", json.dumps(study["references"]))
        ends = [line["points"][0]["worst"] for line in study["lines"]
                if (line["method"], line["quantity"]) == ("patches", "path-end")]
        self.assertTrue(ends)
        self.assertLess(max(ends), 1e-3)

    def test_a_tee_and_a_vessel_are_wound(self):
        job = self.write("job.json", '{"tow": {"width": 30}, "redundancy": "central-angle"}')
        for kind in ("tee", "vessel"):
            with self.subTest(kind):
                self.done(cad(kind, "inch"), "--machine", "six_axis.json", "--job", job, "-o", kind, "--effort", "0.1")
                report = json.loads((self.folder / kind / "report.json").read_text())
                self.assertTrue(all(check["ok"] for check in report["checks"].values()))
        self.done("verify", "vessel/program.ngc", "--mandrel", cad("vessel", "inch"), "--machine", "six_axis.json",
                  "--job", job)

    def test_the_same_bytes_again(self):
        outputs = {self.done("inspect", cad("tee"), "--json", "--threads", threads).stdout for threads in (1, 2)}
        self.assertEqual(outputs, {told_of(cad("tee"))})

    def test_several_solids(self):
        file = cad("two")
        self.refused(file, "mesh.several_solids", "1 (60 x 60 x 200 mm)", "2 (40 x 40 x 100 mm)")
        job = self.write("job.json", '{"mandrel": {"solid": "2"}}')
        self.assertAlmostEqual(self.inspected(file, "--job", job)["rims"][0]["radius"], 20.0, delta=1e-6)
        job = self.write("job.json", '{"mandrel": {"solid": "3"}}')
        self.refused(file, "mesh.no_such_solid", '"3"', options=("--job", job))

    def test_edges_are_no_longer_than_asked(self):
        count = []
        for edge in (7, 5):
            job = self.write("job.json", json.dumps({"mandrel": {"edge": edge}}))
            count.append(self.inspected(cad("vessel"), "--job", job)["triangles"])
        self.assertAlmostEqual(count[1] / count[0], (7 / 5) ** 2, delta=0.2)

    def painted(self, file, radius, red_green_blue):
        """The same STEP file with a colour on its cylindrical face of that radius."""
        text = file.read_text()
        surface = re.search(rf"(#\d+) = CYLINDRICAL_SURFACE\('',#\d+,{radius}\.\)", text)[1]
        face = re.search(rf"(#\d+) = ADVANCED_FACE\('',\([^)]*\),{surface},", text)[1]
        context = re.search(r"(#\d+) = \( GEOMETRIC_REPRESENTATION_CONTEXT\(3\)", text)[1]
        first = max(map(int, re.findall(r"^#(\d+) =", text, re.M))) + 1
        a, b, c, d, e, f, g, h, i = (f"#{first + k}" for k in range(9))
        more = [f"{a} = COLOUR_RGB('',{','.join(map(str, red_green_blue))});", f"{b} = FILL_AREA_STYLE_COLOUR('',{a});",
                f"{c} = FILL_AREA_STYLE('',({b}));", f"{d} = SURFACE_STYLE_FILL_AREA({c});",
                f"{e} = SURFACE_SIDE_STYLE('',({d}));", f"{f} = SURFACE_STYLE_USAGE(.BOTH.,{e});",
                f"{g} = PRESENTATION_STYLE_ASSIGNMENT(({f}));", f"{h} = STYLED_ITEM('colour',({g}),{face});",
                f"{i} = MECHANICAL_DESIGN_GEOMETRIC_PRESENTATION_REPRESENTATION('',({h}),{context});"]
        end = text.rindex("ENDSEC;")
        return self.write("painted.step", text[:end] + "\n".join(more) + "\n" + text[end:])

    def kept_of_faces(self, file, words, of, faces):
        """The area that a job with these words keeps, against that of the faces meant."""
        with self.subTest(words):
            job = self.write("job.json", json.dumps({"mandrel": {"keep_faces": words}}))
            regions = self.inspected(file, "--job", job)["regions"]
            kept = sum(region["area_mm2"] for region in regions if region["kept"])
            self.assertAlmostEqual(kept / sum(face["area_mm2"] for face in faces if of(face)), 1.0, delta=1e-6)

    def test_faces_by_kind_and_colour(self):
        self.kept_of_faces(cad("tee"), ["cylinder", "spline"], lambda face: face["kind"] != "plane",
                           self.inspected_once("tee")["cad_faces"])
        file = self.painted(cad("vessel"), 80, (1.0, 0.0, 0.2))
        faces = self.inspected(file)["cad_faces"]
        self.assertEqual([face["radius_mm"] for face in faces if face.get("colour") == "#ff0033"], [80.0])
        self.assertEqual(sum("colour" in face for face in faces), 1)
        self.kept_of_faces(file, ["#FF0033"], lambda face: face.get("colour"), faces)
        self.kept_of_faces(file, ["cylinder"], lambda face: face["kind"] == "cylinder", faces)
        for word, words in (("#00ff00", "has no face #00ff00"), ("cilinder", "names no face"), (9, "has no face 9")):
            job = self.write("job.json", json.dumps({"mandrel": {"keep_faces": [word]}}))
            result = self.run_program("inspect", file, "--job", job)
            self.assertEqual(result.returncode, 2)
            self.assertIn(words, result.stderr)

    def test_broken_files(self):
        whole = cad("tee").read_bytes()
        for name, content in (("empty.step", b""), ("cut.step", whole[:len(whole) // 2]), ("words.stp", b"solid x\n" * 9),
                              ("words.igs", b"a stormy night\n" * 9), ("words.brep", b"a stormy night\n" * 9)):
            with self.subTest(name):
                self.refused(self.write(name, content), "mesh.not_cad", name)
        self.refused(self.folder / "none.step", "mesh.missing_file")
        self.refused(cad("vessel"), "mesh.bad_unit", options=("--units", "m"))
        os.environ["MESHWIND_CAD"] = "/none"
        self.addCleanup(os.environ.pop, "MESHWIND_CAD")
        self.refused(self.write("tee.step", whole), "mesh.no_cad", "libocct-data-exchange-dev")

    def test_damaged_files_are_read_or_refused(self):
        """Files with some bytes changed, moved or gone, $MESHWIND_COUNT of them: a part or one line, never a crash."""
        whole = cad("vessel").read_bytes()
        dice = random.Random(1)
        refused = 0
        for number in range(int(os.environ.get("MESHWIND_COUNT", "8"))):
            damaged = bytearray(whole)
            for _ in range(dice.choice((1, 3, 30))):
                at, length = dice.randrange(len(damaged)), dice.randrange(1, 40)
                change = dice.randrange(4)
                if change == 0:
                    damaged[at] = dice.randrange(256)
                elif change == 1:
                    del damaged[at:at + length]
                elif change == 2:
                    damaged[at:at] = damaged[dice.randrange(len(damaged)):][:length]
                else:
                    digit = re.search(rb"[0-9]", bytes(damaged[at:at + 200]))
                    if digit:
                        damaged[at + digit.start()] = dice.choice(b"0123456789")
            file = self.write("damaged.step", bytes(damaged))
            with self.subTest(number):
                result = self.run_program("inspect", file)
                self.assertIn(result.returncode, (0, 2), result.stderr)
                if result.returncode == 2:
                    refused += 1
                    self.assertEqual(len(result.stderr.splitlines()), 1, result.stderr)
        self.assertGreater(refused, 0)

    def test_a_reader_that_dies_is_told_of(self):
        reader = self.write("reader.sh", "#!/bin/sh\nkill -SEGV $$\n")
        reader.chmod(0o755)
        os.environ["MESHWIND_CAD"] = str(reader)
        self.addCleanup(os.environ.pop, "MESHWIND_CAD")
        self.refused(cad("pipe"), "mesh.cad_failed", "signal 11")
        reader.write_text("#!/bin/sh\necho meshwind CAD mesh 1\n")
        self.refused(cad("pipe"), "mesh.cad_failed")

    def refused(self, file, code, *words, options=()):
        result = self.run_program("inspect", file, "--json", *options)
        self.assertEqual(result.returncode, 2, result.stderr)
        error = json.loads(result.stdout or result.stderr)["error"]
        self.assertEqual(error["code"], code)
        for word in words:
            self.assertIn(word, result.stdout + result.stderr)


if __name__ == "__main__":
    CAD_FILES = sys.argv.pop(2)
    program.main(__name__)
