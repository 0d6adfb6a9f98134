"""meshwind carry: the L-frame through the ring head, its files, failed checks and bad input."""
import csv
import json
import math
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

import program

CARRY = ("carry", "l_frame_axis.csv", "--machine", "robot_kr16.json")
FRAME = re.compile(r"LIN \{X (\S+),Y (\S+),Z (\S+),A (\S+),B (\S+),C ([^}]+)\}( C_DIS)?$")


def rotation(a, b, c):
    """Rz(a) Ry(b) Rx(c), degrees."""
    ca, sa, cb, sb, cc, sc = (f(math.radians(x)) for x in (a, b, c) for f in (math.cos, math.sin))
    return [[ca * cb, ca * sb * sc - sa * cc, ca * sb * cc + sa * sc],
            [sa * cb, sa * sb * sc + ca * cc, sa * sb * cc - ca * sc],
            [-sb, cb * sc, cb * cc]]


def times(matrix, vector):
    return [sum(m * v for m, v in zip(row, vector)) for row in matrix]


class Carry(program.ProgramTest):
    @classmethod
    def setUpClass(cls):
        """The frame as the defaults have it but the name, carried once for all tests that look at it."""
        holder = tempfile.TemporaryDirectory(prefix="meshwind-test-")
        cls.addClassCleanup(holder.cleanup)
        cls.carried = Path(holder.name)
        result = subprocess.run([program.PROGRAM, *CARRY, "--name", "l_frame", "-o", "out", "--json"], cwd=cls.carried,
                                stdin=subprocess.DEVNULL, capture_output=True, text=True, check=True)
        cls.report = json.loads(result.stdout)

    def rows(self, name):
        with open(name, newline="") as file:
            return list(csv.DictReader(file))

    def test_program_is_the_one_of_the_project(self):
        out = self.carried / "out"
        self.assertEqual((out / "l_frame.src").read_text(),
                         (program.SOURCE / "data/programs/l_frame.src").read_text())
        names = sorted(f.name for f in out.iterdir())
        self.assertEqual(names, ["fibre.csv", "l_frame.src", "l_frame_back.src", "motion.csv",
                                 "report.json", "rings.csv"])
        forth, back = ([FRAME.match(line).groups()[:6] for line in
                        (out / f"{name}.src").read_text().splitlines()
                        if line.startswith("LIN")] for name in ("l_frame", "l_frame_back"))
        self.assertEqual(back, forth[::-1])

    def test_frames_of_the_program_have_the_axis_in_the_head(self):
        """From the text alone: each frame's origin and turn put a point of the axis at H."""
        report = self.report
        self.assertEqual(json.loads((self.carried / "out/report.json").read_text()), report)
        self.assertTrue(report["ok"])
        stations = [[float(row[k]) for k in ("x_mm", "y_mm", "z_mm", "tx", "ty", "tz")]
                    for row in self.rows(program.SOURCE / "data/l_frame_axis.csv")]
        lines = (self.carried / "out/l_frame.src").read_text().splitlines()
        frames = [FRAME.match(line) for line in lines if line.startswith("LIN")]
        self.assertEqual(len(frames), report["program"]["moves"])
        self.assertEqual([bool(f[7]) for f in frames],
                         [False] + [True] * (len(frames) - 2) + [False])
        met = set()
        for frame in frames:
            x, y, z, a, b, c = (float(frame[i]) for i in range(1, 7))
            turn = rotation(a, b, c)
            for i, station in enumerate(stations):
                place = [p + q for p, q in zip(times(turn, station[:3]), (x, y, z))]
                along = times(turn, station[3:])
                if math.dist(place, (-1000, 1070, 990)) < 1e-3 and along[1] > 1 - 1e-9:
                    met.add(i)
        self.assertEqual(met & {0, 105}, {0, 105})
        self.assertTrue(set(range(55, 70)) <= met, "all stations of the bend are points")

    def test_motion_follows_the_time_of_the_program_and_winding_numbers(self):
        report = json.loads(self.done(*CARRY, "--speed", "12", "--tow-width", "7.4", "-o", "out", "--json").stdout)
        rows = self.rows(self.folder / "out/motion.csv")
        time = [float(row["time_s"]) for row in rows]
        self.assertEqual(time, sorted(time))
        self.assertAlmostEqual(time[-1], report["program"]["duration_s"], places=5)
        self.assertGreaterEqual(time[-1], 1050 / 12 - 0.01)
        for axis, ends in report["robot"]["axes_deg"].items():
            values = [float(row[axis]) for row in rows]
            self.assertAlmostEqual(min(values), ends["min"], places=4)
            self.assertAlmostEqual(max(values), ends["max"], places=4)
            self.assertLess(max(abs(p - q) for p, q in zip(values, values[1:])), 3)
        # Euler angles go on over the cut at 180 degrees.
        for name in ("a_deg", "b_deg", "c_deg"):
            values = [float(row[name]) for row in rows]
            self.assertLess(max(abs(p - q) for p, q in zip(values, values[1:])), 5)
        # The ring that keeps 45 degrees makes up for the frame's own turn in the bend.
        straight = 12 * 60 / (2 * math.pi * 20)
        self.assertAlmostEqual(float(rows[1]["ring1_rev_min"]), straight, delta=1e-3)
        self.assertAlmostEqual(float(rows[1]["ring2_rev_min"]), -straight, delta=1e-3)
        bend = 0.5 / 140 * 12 * 60
        self.assertAlmostEqual(max(float(row["ring1_rev_min"]) for row in rows), straight + bend,
                               delta=0.02)
        winding = report["winding"]
        self.assertAlmostEqual(winding["mm_per_turn"], 40 * math.pi, places=6)
        self.assertAlmostEqual(winding["longitudinal_lean_deg"],
                               math.degrees(math.atan(math.pi * 20 / 140)), delta=1e-3)
        low, high = (math.degrees(math.atan(1 + d * math.pi * 20 / 140)) for d in (-1, 0))
        self.assertAlmostEqual(winding["rings"][0]["laid_deg_at_even_speed"]["min"], low, delta=0.05)
        self.assertAlmostEqual(winding["rings"][0]["laid_deg_at_even_speed"]["max"], high,
                               delta=0.05)
        self.assertAlmostEqual(winding["coverage"], 12 * 7.4 * math.sqrt(2) / (40 * math.pi),
                               places=6)
        self.assertAlmostEqual(report["checks"]["ring"]["reach_mm"], 28.9068, places=3)

    def test_fibre_lies_on_the_frame_in_helices(self):
        pattern, laid = self.report["pattern"], self.report["laid"]
        self.assertEqual(pattern["ways"], "to-and-fro")
        self.assertEqual(pattern["passes"], 1)
        self.assertEqual(laid["covered"], 1)
        self.assertLess(laid["regular_cv"], 0.02)
        radius = 280 / math.pi
        self.assertAlmostEqual(pattern["inside_deg"],
                               math.degrees(math.atan(1 / (1 - 20 / radius))), delta=0.02)
        self.assertAlmostEqual(pattern["lag_mm"], math.sqrt(1200), places=6)
        # Thicker inside than outside, as even advance has it or more.
        self.assertGreater(laid["inside_over_outside"], pattern["inside_over_outside"])
        length = 0
        fibres = {}
        for row in self.rows(self.carried / "out/fibre.csv"):
            key = (int(row["ring"]), int(row["spool"]))
            fibres.setdefault(key, []).append(row)
        self.assertEqual(len(fibres), 24)
        for (ring, _), rows in fibres.items():
            points = [[float(row[k]) for k in ("x_mm", "y_mm", "z_mm")] for row in rows]
            length += sum(math.dist(p, q) for p, q in zip(points, points[1:]))
            sense = 1 if ring == 1 else -1
            for row, (x, y, z) in zip(rows, points):
                s = float(row["s_mm"])
                if s < 550:
                    self.assertAlmostEqual(math.hypot(x, y), 20, delta=1e-3)
                    self.assertAlmostEqual(z, s, delta=1e-2)
                elif s > 690:
                    self.assertAlmostEqual(math.hypot(y, z - 550 - radius), 20, delta=1e-3)
                else:
                    out = math.hypot(x - radius, z - 550)
                    self.assertAlmostEqual(math.hypot(out - radius, y), 20, delta=1e-3)
            arm = [row for row in rows if 10 < float(row["s_mm"]) < 440]
            for p, q in zip(arm, arm[1:]):
                turn = math.radians(float(q["round_deg"]) - float(p["round_deg"]))
                step = float(q["s_mm"]) - float(p["s_mm"])
                self.assertAlmostEqual(math.degrees(math.atan2(20 * turn, step)) % 180 - 90,
                                       sense * 45 % 180 - 90, delta=0.4)
        self.assertAlmostEqual(length / laid["fibre_mm"], 1, delta=2e-3)
        self.assertAlmostEqual(length / pattern["fibre_mm"], 1, delta=0.01)

    def test_mesh_gives_the_axis(self):
        """One command from the mesh of the paper's frame to a proven program."""
        mesh = self.make("frame", "--pipe-radius", "20", "--bend-radius", str(280 / math.pi),
                         "--leg1", "550", "--leg2", "360", "--edge", "5")
        carry = ("carry", mesh, "--machine", "robot_kr16.json")
        report = json.loads(self.done(*carry, "-o", "out", "--json").stdout)
        self.assertEqual(report["laid"]["covered"], 1)
        self.assertLess(report["laid"]["regular_cv"], 0.02)
        self.assertAlmostEqual(report["axis"]["length_mm"], 1050, delta=0.01)
        self.assertAlmostEqual(report["winding"]["tube_radius_mm"], 20, delta=0.001)
        self.assertLess(math.dist(report["axis"]["frame_in_file"]["origin_mm"], (0, 0, 0)), 0.01)
        # The flange stands where the table of the same frame has it.
        for axis, ends in self.report["robot"]["axes_deg"].items():
            self.assertAlmostEqual(report["robot"]["axes_deg"][axis]["min"], ends["min"], delta=0.05)
            self.assertAlmostEqual(report["robot"]["axes_deg"][axis]["max"], ends["max"], delta=0.05)
        other = json.loads(self.run_program(*carry, "--from-end", "-o", "out", "--json").stdout)
        origin = other["axis"]["frame_in_file"]["origin_mm"]
        radius = 280 / math.pi
        self.assertLess(math.dist(origin, (radius + 360, 0, 550 + radius)), 0.01)
        result = self.run_program("carry", self.make("tee"), "--quiet", "--json")
        self.assertEqual(result.returncode, 2)
        self.assertEqual(json.loads(result.stdout)["error"]["code"], "carry.no_tube")
        self.assertIn("3 rims", result.stderr)

    def test_rings_follow_frame_and_passage(self):
        rows = self.rows(self.carried / "out/rings.csv")
        for ring, way in (("1", 1), ("2", -1)):
            own = [row for row in rows if row["ring"] == ring]
            places = [float(row["s_mm"]) for row in own]
            self.assertEqual(places, sorted(places)[::way])
            # 1050 mm at 45 deg on 20 mm, and half a turn of the frame one way or the other.
            turn = math.radians(float(own[-1]["ring_deg"]))
            self.assertAlmostEqual(turn, 1050 / 20 + way * math.pi, delta=0.02)

    def test_what_the_fibre_does_not_keep(self):
        self.failed("--friction", "0.2", check="slip", word="friction of 0.38", forced=True)
        self.failed("--at-once", check="laydown", word="nearer to the head's centre")
        self.failed("--tow-width", "4", "--passes", "1", check="coverage", word="4.00 mm wide")
        self.failed("--angle", "20", check="bridging", word="steeper than 28.28 deg")

    def test_passes_and_mass(self):
        report = json.loads(self.done(*CARRY, "--tow-width", "4", "--tow-tex", "800", "--friction",
                                      "0.5", "-o", "out", "--json").stdout)
        pattern = report["pattern"]
        self.assertEqual(pattern["passes"], 3)
        self.assertAlmostEqual(pattern["offset_deg"], 10, places=6)
        self.assertAlmostEqual(pattern["mass_kg"], pattern["fibre_mm"] * 800e-9, places=6)
        self.assertAlmostEqual(pattern["fibre_mm"], 72 * pattern["fibre_per_tow_mm"], places=3)
        self.assertTrue(report["checks"]["slip"]["ok"])
        still = json.loads(self.done(*CARRY, "--angle", "0", "-o", "out", "--json").stdout)
        self.assertIsNone(still["pattern"])
        self.assertFalse((self.folder / "out/fibre.csv").exists())
        self.assertFalse((self.folder / "out/program_back.src").exists())

    def test_finer_tolerance_has_more_points(self):
        moves = []
        for tolerance in ("1", "0.2", "0.02"):
            report = json.loads(self.done(*CARRY, "--angle", "0", "--tolerance", tolerance, "-o", "out",
                                          "--json").stdout)
            check = report["checks"]["interpolation"]
            self.assertLessEqual(check["distance_mm"], float(tolerance))
            moves.append(report["program"]["moves"])
        self.assertLess(moves[0], moves[1])
        self.assertLess(moves[1], moves[2])

    def failed(self, *arguments, check, word, forced=False):
        shutil.copytree(self.carried / "out", self.folder / "out", dirs_exist_ok=True)
        result = self.run_program(*CARRY, *arguments, "-o", "out", "--quiet")
        self.assertEqual(result.returncode, 1, result.stderr)
        self.assertIn(f"check failed: {check}: ", result.stderr)
        self.assertIn(word, result.stderr)
        self.assertFalse(list((self.folder / "out").glob("*.src")), "the old one is taken away")
        report = json.loads((self.folder / "out/report.json").read_text())
        self.assertFalse(report["checks"][check]["ok"])
        self.assertIsNone(report["program"]["file"])
        if forced:
            result = self.run_program(*CARRY, *arguments, "-o", "out", "--quiet", "--force")
            self.assertEqual(result.returncode, 1)
            self.assertIn(f"; FAILED check {check}: ", (self.folder / "out/program.src").read_text())

    def test_failed_checks(self):
        self.failed("--ring-radius", "28", check="ring", word="28.91", forced=True)
        self.failed("--tool", "0,0,1200,0,0,0", check="reach", word=" mm ")

    def test_limit_of_an_axis(self):
        machine = json.loads((program.SOURCE / "machines/robot_kr16.json").read_text())
        machine["mandrel_chain"][3].update(min=-80, max=80)
        self.write("narrow.json", json.dumps(machine))
        result = self.run_program("carry", "l_frame_axis.csv", "--machine", "narrow.json", "--angle",
                                  "0", "--quiet", "--json")
        self.assertEqual(result.returncode, 1)
        check = json.loads(result.stdout)["checks"]["limits"]
        self.assertFalse(check["ok"])
        self.assertGreater(check["travel_violations"], 0)
        # The axis, where it goes to, where along the axis, and by how much that is too far.
        self.assertRegex(result.stderr, r"limits: A\d .*\d deg .*\d mm .*\d deg")

    def test_body_in_the_way(self):
        machine = json.loads((program.SOURCE / "machines/robot_kr16.json").read_text())
        machine["bodies"][1]["to"][2] = 900
        self.write("tall_stand.json", json.dumps(machine))
        result = self.run_program("carry", "l_frame_axis.csv", "--machine", "tall_stand.json",
                                  "--angle", "0", "--quiet", "--json")
        self.assertEqual(result.returncode, 1)
        self.assertFalse(json.loads(result.stdout)["checks"]["clearance"]["ok"])
        self.assertRegex(result.stderr, r"clearance: .*\d mm .*body 2 ")

    def refused(self, *arguments, code, word=""):
        """Exit code 2, the error's code, and one line that names a place or an option."""
        result = self.run_program(*arguments, "--quiet", "--json")
        self.assertEqual(result.returncode, 2, result.stderr)
        self.assertEqual(len(result.stderr.splitlines()), 1, result.stderr)
        self.assertEqual(json.loads(result.stdout)["error"]["code"], code, result.stderr)
        self.assertIn(word, result.stderr)
        self.assertFalse((self.folder / "meshwind-out").exists())

    def test_bad_input(self):
        self.refused("carry", "none.csv", code="io.cannot_read", word="none.csv")
        self.refused("carry", self.write("a.csv", "x,y\n1,2\n"), code="axis.column", word="a.csv:1")
        self.refused("carry", self.write("b.csv", "x_mm,y_mm,z_mm\n0,0,0\n0,0,x\n"),
                     code="axis.number", word="b.csv:3")
        self.refused(*CARRY, "--speed", "0", code="carry.not_positive", word="--speed")
        self.refused(*CARRY, "--speed", "1e300", code="carry.speed", word="--speed")
        self.refused(*CARRY, "--tows", "0", code="carry.not_positive", word="--tows")
        self.refused(*CARRY, "--tolerance", "nan", code="carry.not_positive", word="--tolerance")
        self.refused(*CARRY, "--angle", "90", code="carry.angle", word="--angle")
        self.refused(*CARRY, "--spool-radius", "20", code="carry.spool", word="--spool-radius")
        self.refused(*CARRY, "--friction", "0", code="carry.not_positive", word="--friction")
        self.refused(*CARRY, "--tube-radius", "90", "--ring-radius", "99", code="carry.tight")
        self.refused(*CARRY, "--angle", "0.1", code="carry.short")
        self.refused(*CARRY, "--tool", "1,2,3", code="carry.tool", word="--tool")
        self.refused(*CARRY, "--tool", "1,2,3,4,5,6,7", code="carry.tool", word="--tool")
        self.refused(*CARRY, "--name", "7 frames", code="krl.name", word="name")
        self.refused("carry", "l_frame_axis.csv", "--machine", "six_axis.json",
                     code="carry.machine", word="robot_kr16")


if __name__ == "__main__":
    program.main(sys.modules[__name__])
