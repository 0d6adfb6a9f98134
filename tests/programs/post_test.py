"""meshwind post: landing points made elsewhere, the eye rules on them, and what is refused."""
import csv
import json
import math
import random
import sys

import program

MACHINE = "six_axis.json"
JOB = {"tow": {"width": 24}, "mandrel": {"extension": 0}}  # and what a test gives besides


def helix(start_z, start_turn, angle_deg, count, radius=50.0, step=4.0):
    """Points of a helix about z, `step` mm apart."""
    angle = math.radians(angle_deg)
    points = []
    for i in range(count):
        turn = start_turn + i * step * math.sin(angle) / radius
        points.append((radius * math.cos(turn), radius * math.sin(turn),
                       start_z + i * step * math.cos(angle)))
    return points


def table(points, header="x,y,z", course=None):
    rows = [header if course is None else "course," + header]
    for i, p in enumerate(points):
        cells = ["%.4f" % x for x in p]
        rows.append(",".join(cells if course is None else [course[i]] + cells))
    return "\n".join(rows) + "\n"


class Post(program.ProgramTest):
    def cylinder(self):
        return self.make("cylinder", "--radius", "50", "--length", "280", "--edge", "12")

    def post(self, points, mandrel, *options, job={}, machine=MACHINE, code=0, out="out"):
        arguments = ["post", points, "--mandrel", mandrel, "--machine", machine, "-o", out]
        if job is not None:
            arguments += ["--job", self.write("job.json", json.dumps({**JOB, **job}))]
        result = self.run_program(*arguments, *options)
        self.assertEqual(result.returncode, code, result.stdout + result.stderr)
        return result

    def report(self, out="out"):
        return json.loads((self.folder / out / "report.json").read_text())

    def rows(self, file):
        with open(self.folder / file, newline="") as stream:
            return list(csv.DictReader(stream))

    def refused(self, text, mandrel, code, words, *options, job={}):
        """Exit code 2 and the error's code; places and figures in its line; nothing written."""
        result = self.post(self.write("bad.csv", text), mandrel, "--json", *options, job=job,
                           code=2, out="none")
        line = result.stderr.strip().splitlines()[-1]
        error = json.loads(result.stdout)["error"]
        self.assertEqual(error["code"], code, line)
        self.assertIn(error["message"], line)
        for word in words:
            self.assertIn(word, line)
        self.assertFalse((self.folder / "none").exists())

    def test_a_helix_becomes_a_program(self):
        mandrel = self.cylinder()
        result = self.post(self.write("points.csv", table(helix(-75, 0, 50, 60))), mandrel, job=None)
        self.assertIn("60 landing points of points.csv", result.stdout)
        # report.html is written by programs that were built with npm at hand.
        written = {file.name for file in (self.folder / "out").iterdir()} - {"report.html"}
        self.assertEqual(written, {"fibre.obj", "fibre.step", "layup.json", "layup.vtu",
                                   "motion.csv", "path.csv", "program.ngc", "report.json"})
        report = self.report()
        self.assertTrue(report["ok"])
        self.assertEqual(report["plan"]["planner"], "imported")
        self.assertEqual(report["plan"]["courses"], 1)
        self.assertAlmostEqual(report["plan"]["fibre_length_mm"], 59 * 4.0, delta=0.05)
        fit = report["import"]
        self.assertEqual((fit["points"], fit["joins"], fit["frame"]), (60, 0, "file"))
        # The mesh is a cylinder of 50 mm to its patches' accuracy.
        self.assertLess(fit["worst_mm"], 0.01)
        self.assertLess(report["checks"]["slip"]["worst"], 0.01)  # a helix is a geodesic
        for row in self.rows("out/path.csv"):
            self.assertAlmostEqual(float(row["tz"]), math.cos(math.radians(50)), delta=2e-3)
            self.assertAlmostEqual(float(row["kn_per_mm"]),
                                   math.sin(math.radians(50)) ** 2 / 50, delta=1e-4)
        # The points themselves are not replaced.
        before = (self.folder / "out/path.csv").read_bytes()
        result = self.post("out/path.csv", mandrel, "--frame", "mandrel", code=2)
        self.assertIn("out/path.csv", result.stderr)
        self.assertIn("-o", result.stderr)
        self.assertEqual((self.folder / "out/path.csv").read_bytes(), before)
        self.assertTrue((self.folder / "out/program.ngc").exists())
        self.post("out/path.csv", mandrel, "--frame", "mandrel", out="again")

    def test_same_bytes_again_for_any_number_of_threads_and_of_an_imported_layer(self):
        mandrel = self.cylinder()
        points = self.write("points.csv", table(helix(-130, 0, 50, 60)))
        for threads in ("1", "2"):
            self.post(points, mandrel, "--threads", threads, out=threads)
        for name in ("path.csv", "motion.csv", "program.ngc", "layup.vtu", "layup.json",
                     "fibre.obj", "fibre.step"):
            self.assertEqual((self.folder / "1" / name).read_bytes(),
                             (self.folder / "2" / name).read_bytes(), name)
        job = self.write("layer.json", json.dumps({**JOB, "layers": [{"kind": "imported", "file": "points.csv"}]}))
        self.done("wind", mandrel, "--machine", MACHINE, "--job", job, "-o", "wound")
        for name in ("path.csv", "motion.csv"):
            self.assertEqual((self.folder / "1" / name).read_bytes(),
                             (self.folder / "wound" / name).read_bytes())

    def test_a_planned_path_gives_the_plan_again(self):
        mandrel = self.make("cylinder", "--radius", "30", "--length", "150", "--edge", "6")
        job = {"tow": {"width": 12}, "mandrel": {"extension": 80}}
        file = self.write("job.json", json.dumps(job))
        self.done("wind", mandrel, "--machine", MACHINE, "--job", file, "-o", "planned")
        self.post("planned/path.csv", mandrel, "--frame", "mandrel", job=job)
        planned, again = self.report("planned"), self.report()
        for key in ("courses", "transitions"):
            self.assertEqual(again["plan"][key], planned["plan"][key])
        self.assertAlmostEqual(again["plan"]["fibre_length_mm"],
                               planned["plan"]["fibre_length_mm"], delta=0.5)
        self.assertAlmostEqual(again["plan"]["coverage"]["fraction"],
                               planned["plan"]["coverage"]["fraction"], delta=0.005)
        # The program made of the table lays the fibre of the plan, within the job's tolerance.
        result = self.run_program("verify", "out/program.ngc", "--mandrel", mandrel, "--machine",
                                  MACHINE, "--job", file, "--plan", "planned", "--json")
        checks = json.loads(result.stdout)["checks"]
        self.assertFalse(checks["program"]["ok"])  # its blocks are others
        self.assertTrue(checks["laydown"]["ok"], checks["laydown"])
        self.assertLess(checks["laydown"]["max_deviation_mm"], 0.2)

    def test_courses_are_joined_where_friction_holds(self):
        mandrel = self.cylinder()
        first = helix(-120, 0, 60, 20)
        way = 19 * 4.0 + 60.0  # 60 mm further on the same helix, and 2 mm beside it
        second = helix(-120 + way * 0.5 + 2.0, way * math.sin(math.pi / 3) / 50, 60, 20)
        text = table(first + second, course=["A"] * 20 + ["B"] * 20)
        self.post(self.write("points.csv", text), mandrel)
        report = self.report()
        self.assertEqual(report["import"]["joins"], 1)
        self.assertEqual((report["plan"]["courses"], report["plan"]["transitions"]), (2, 1))
        rows = self.rows("out/path.csv")
        join = [float(r["slip"]) for r in rows if r["course"] == "1"]
        self.assertGreater(max(join), 0.05)
        self.assertLess(max(join), 0.2)
        self.assertEqual({(r["course"], r["kind"]) for r in rows},
                         {("0", "course"), ("1", "transition"), ("2", "course")})
        for a, b in zip(rows, rows[1:]):
            gap = math.dist(*([float(r[k]) for k in ("x_mm", "y_mm", "z_mm")] for r in (a, b)))
            self.assertLess(gap, 9.5)  # the last two stations of 4 mm, and one of the wall's
            turned = sum(float(a[k]) * float(b[k]) for k in ("tx", "ty", "tz"))
            self.assertGreater(turned, math.cos(0.15))
        # Courses that meet need no join.
        points = helix(-120, 0, 60, 40)
        text = table(points[:20] + points[19:], course=["1"] * 20 + ["2"] * 21)
        self.post(self.write("points.csv", text), mandrel)
        self.assertEqual(self.report()["import"]["joins"], 0)

    def test_courses_that_cannot_be_joined_are_named(self):
        mandrel = self.cylinder()
        first = helix(-120, 0, 60, 20)
        apart = table(first + helix(0, 0, 60, 20), course=["A"] * 20 + ["B"] * 20)
        self.refused(apart, mandrel, "import.not_joined", ["bad.csv:22:", "course B", "course A"])
        way = 19 * 4.0 + 40.0
        beside = helix(-120 + way * 0.5 + 8.0, way * math.sin(math.pi / 3) / 50, 60, 20)
        self.refused(table(first + beside, course=["A"] * 20 + ["B"] * 20), mandrel,
                     "import.not_joined", ["bad.csv:22:", "course B", "44.", "course A", "0.192"])
        back = table(first + first[::-1], course=["A"] * 20 + ["B"] * 20)
        self.refused(back, mandrel, "import.not_joined",
                     ["bad.csv:22:", "course B", "0.00 mm", "course A", "180.0 deg"])

    def test_frames_and_units(self):
        """The same part in inches, its axis along x: points in its axes and units, in its axes in
        mm, and in the mandrel frame."""
        self.cylinder()
        self.done("inspect", "cylinder.stl", "--refine", "20", "-o", "same.obj")
        lines = (self.folder / "same.obj").read_text().splitlines()
        turned = ["v %.9f %.9f %.9f" % (float(v[3]) / 25.4, float(v[1]) / 25.4, float(v[2]) / 25.4)
                  for v in (line.split() for line in lines if line.startswith("v "))]
        part = self.write("inch.obj", "\n".join(
            turned + [line for line in lines if line.startswith("f ")]) + "\n")
        points = helix(-100, 0.3, 55, 60)
        mm = [(z, x, y) for x, y, z in points]
        lengths = []
        for header, given in (("x_mm,y_mm,z_mm", mm),
                              ("x,y,z", [tuple(c / 25.4 for c in p) for p in mm])):
            self.post(self.write("points.csv", table(given, header)), part, "--units", "in")
            self.assertLess(self.report()["import"]["worst_mm"], 0.02)
            lengths.append(self.report()["plan"]["fibre_length_mm"])
        self.post("out/path.csv", part, "--units", "in", "--frame", "mandrel", out="again")
        lengths.append(self.report("again")["plan"]["fibre_length_mm"])
        for length in lengths:
            self.assertAlmostEqual(length, 59 * 4.0, delta=0.05)
        self.refused((self.folder / "out/path.csv").read_text(), part,
                     "import.too_far", ["bad.csv:2:"], "--units", "in")

    def test_broken_tables_are_refused_in_one_line(self):
        mandrel = self.cylinder()
        good = table(helix(-100, 0, 50, 10))
        self.refused("", mandrel, "import.column", ["bad.csv"])
        self.refused(good.replace("x,y,z", "a,b,c"), mandrel, "import.column", ["bad.csv:1:", "'x'"])
        self.refused(good.replace("\n", "\n1;2;3\n", 1), mandrel, "import.number", ["bad.csv:2:", "1 cells"])
        self.refused(good.replace(",", ",,", 3), mandrel, "import.number", ["bad.csv:2:", "4 cells"])
        self.refused(good + "1,2,three\n", mandrel, "import.number",
                     ["bad.csv:12:", "'three'"])
        self.refused(good + "60,0,0\n", mandrel, "import.too_far", ["bad.csv:12:", "10.000 mm"])
        self.refused("x,y,z\n50,0,0\n", mandrel, "import.empty", ["bad.csv"])
        self.refused("\x00\x01\x02", mandrel, "import.column", ["bad.csv"])
        self.refused(good, "missing.stl", "mesh.missing_file", ["missing.stl"])
        self.refused(good, mandrel, "json.missing_key", ["/eye", "radius"],
                     job={"eye": {"rule": "cylinder"}})
        self.refused(good, mandrel, "cli.usage", ["--within"], "--within", "-1")
        # Points off by less than is allowed are moved, and the report says how far.
        text = table([tuple(1.04 * c for c in p[:2]) + p[2:] for p in helix(-100, 0, 50, 40)])
        self.refused(text, mandrel, "import.too_far", ["bad.csv:2:", "2.000 mm"])
        self.post(self.write("points.csv", text), mandrel, "--within", "3")
        self.assertAlmostEqual(self.report()["import"]["mean_mm"], 2.0, delta=0.01)

    def test_every_eye_rule(self):
        """But that of equal free length, which the next test has."""
        mandrel = self.cylinder()
        points = self.write("points.csv", table(helix(-130, 0, 50, 100)))

        def motion(eye):
            self.post(points, mandrel, job={"eye": eye, "redundancy": "central-angle"})
            return [{k: float(v) for k, v in row.items()} for row in self.rows("out/motion.csv")]

        for row in motion({"rule": "cylinder", "radius": 220}):
            self.assertAlmostEqual(row["X"], 220, delta=0.05)
            self.assertAlmostEqual(row["Y"], 0, delta=0.05)
        for row in motion({"rule": "vertical-plane", "plane_x": 210}):
            self.assertAlmostEqual(row["X"], 210, delta=0.05)
            self.assertAlmostEqual(row["Y"], -50, delta=0.05)
        for row in motion({"rule": "horizontal-plane", "plane_y": 210}):
            self.assertAlmostEqual(row["Y"], 210, delta=0.05)
            self.assertAlmostEqual(row["X"], 50, delta=0.05)
        # This fibre meets a plane below the spindle behind it, where the machine does not reach.
        result = self.post(points, mandrel, job={"eye": {"rule": "horizontal-plane",
                                                         "plane_y": -210}}, code=1)
        self.assertIn("check failed: limits", result.stderr)
        result = self.post(points, mandrel, job={"eye": {"rule": "cylinder", "radius": 40}}, code=1)
        self.assertIn("not within the cylinder of 40.00 mm", result.stderr)
        self.assertIn("\n  motion: by the central angle; none of least time", result.stdout)
        self.assertFalse((self.folder / "out" / "program.ngc").exists())

    def test_every_redundancy(self):
        """A helix of 347.6 degrees: the mandrel turns by that, or by 90 or 30 degrees less."""
        mandrel = self.cylinder()
        points = self.write("points.csv", table(helix(-130, 0, 50, 100)))
        eye = {"rule": "equal-free-length", "free_length": 180}
        turn = math.degrees(99 * 4.0 * math.sin(math.radians(50)) / 50)
        radius = math.hypot(50, 180 * math.sin(math.radians(50)))
        duration_s = {}
        for word, play in (("central-angle", 0), ("hold", 90), ("oscillate", 30),
                           ("optimal", None)):
            self.post(points, mandrel, job={"eye": eye, "redundancy": word})
            duration_s[word] = self.report()["program"]["duration_s"]
            rows = [{k: float(v) for k, v in row.items()} for row in self.rows("out/motion.csv")]
            for row in rows:
                self.assertAlmostEqual(math.hypot(row["ex_mm"], row["ey_mm"]), radius,
                                       delta=0.1 if word == "central-angle" else 0.3)
            if play is not None:
                turned = [abs(row["C"] - rows[0]["C"]) for row in rows]
                self.assertAlmostEqual(turned[-1], turn - play, delta=0.2)
                self.assertLess(sum(abs(b["C"] - a["C"]) for a, b in zip(rows, rows[1:])),
                                turn - play + 0.2)
                self.assertAlmostEqual(math.degrees(math.atan2(abs(rows[-1]["Y"]), rows[-1]["X"])),
                                       play, delta=0.1)
        self.assertLessEqual(duration_s["optimal"], duration_s["central-angle"])

    def test_points_on_an_extension_cover_no_wall(self):
        """Half of the helix lies beyond the rim: it is wound, and only the other half counts."""
        cylinder = self.cylinder()
        fraction = []
        for start, count in ((60.0, 29), (60.0, 57)):
            points = self.write("points.csv", table(helix(start, 0.0, 45.0, count)))
            self.post(points, cylinder, job={"mandrel": {"extension": 90}})
            fraction.append(self.report()["plan"]["coverage"]["fraction"])
        self.assertGreater(fraction[0], 0.0)
        self.assertAlmostEqual(fraction[0], fraction[1], delta=2e-3)

    def test_branch_is_wound_with_the_mandrel_standing_still(self):
        """fu_2009_post_processing, sec. 2.1: dC = 0 while the eye goes round the branch."""
        tee = program.SOURCE / "data" / "tee.stl"
        self.done("trace", tee, "--start", "120,0,40", "--direction=0.17,0.985,0", "--length",
                  "600", "--frame", "mandrel", "-o", "branch.csv")
        travel = {}
        for word in ("central-angle", "hold", "oscillate"):
            self.post("branch.csv", tee, "--frame", "mandrel",
                      job={"redundancy": word,
                           "eye": {"rule": "equal-free-length", "free_length": 100}})
            turns = [float(row["C"]) for row in self.rows("out/motion.csv")]
            travel[word] = sum(abs(b - a) for a, b in zip(turns, turns[1:]))
        self.assertEqual(travel["hold"], 0)
        self.assertGreater(travel["central-angle"], 180)  # to and fro, twice 35 degrees a turn
        self.assertGreater(travel["oscillate"], 0)
        self.assertLess(travel["oscillate"], 0.5 * travel["central-angle"])

    def test_redundancy_that_cannot_be_had(self):
        mandrel = self.cylinder()
        text = table(helix(-130, 0, 50, 100))
        plane = {"rule": "vertical-plane", "plane_x": 210}
        for word in ("hold", "oscillate", "optimal"):
            self.refused(text, mandrel, "job.turn_forced", ["job.json: /redundancy"],
                         job={"eye": plane, "redundancy": word})
        points = self.write("points.csv", text)
        for word, code in ((None, 0), ("optimal", 0), ("central-angle", 0), ("hold", 2),
                           ("oscillate", 2)):
            result = self.post(points, mandrel, job={"redundancy": word} if word else {}, machine="four_axis.json",
                               code=code, out=word or "left-out")
            if code == 0:
                self.assertEqual((self.folder / (word or "left-out") / "motion.csv").read_bytes(),
                                 (self.folder / "left-out" / "motion.csv").read_bytes())
            else:
                self.assertIn("job.json: /redundancy", result.stderr)
                self.assertIn("Four-axis vessel winder", result.stderr)

    def test_plans_by_a_strict_rule(self):
        mandrel = self.make("cylinder", "--radius", "30", "--length", "150", "--edge", "6")
        job = {"tow": {"width": 12}, "mandrel": {"extension": 80},
               "eye": {"rule": "cylinder", "radius": 180}}
        self.done("wind", mandrel, "--machine", MACHINE, "--job",
                  self.write("job.json", json.dumps(job)))
        eyes = [math.hypot(float(r["ex_mm"]), float(r["ey_mm"]))
                for r in self.rows("meshwind-out/motion.csv")]
        self.assertGreater(len(eyes), 10)
        for eye in eyes:
            self.assertAlmostEqual(eye, 180, delta=0.1)
        job["eye"] = {"rule": "equal-free-length", "lengths": [{"course": 0, "free_length": 250}]}
        result = self.run_program("wind", mandrel, "--machine", MACHINE, "--job",
                                  self.write("job.json", json.dumps(job)))
        self.assertEqual(result.returncode, 2)
        self.assertIn("/eye/lengths", result.stderr)
        self.assertIn("meshwind post", result.stderr)

    def test_tee_of_the_mesh_post_processing_paper(self):
        """fu_2009_post_processing, sec. 2.1 (3): the branch reaches 236 mm from the spindle. Fibre
        that runs round the run at its root comes near it with 200 mm of free fibre, and passes
        beyond its end with 250 mm. The path steers hoop and back beside the branch."""
        tee = program.SOURCE / "data" / "tee.stl"
        turn, angle = math.radians(-176), math.radians(70)
        start = "%.6f,%.6f,84" % (50 * math.cos(turn), 50 * math.sin(turn))
        along = "%.6f,%.6f,%.6f" % (-math.sin(turn) * math.sin(angle),
                                    math.cos(turn) * math.sin(angle), -math.cos(angle))
        self.done("trace", tee, "--start", start, "--direction=" + along, "--lambda", "0.15",
                  "--length", "240", "--frame", "file", "-o", "trace.csv")
        rows = self.rows("trace.csv")
        # What a list of points has, no more: tangents come from the points.
        text = table([tuple(float(r[k]) for k in ("x_mm", "y_mm", "z_mm")) for r in rows],
                     "x_mm,y_mm,z_mm")
        self.assertLess(min(float(r["z_mm"]) for r in rows), 65)
        points = self.write("root.csv", text)

        def wind(eye, code):
            result = self.post(points, tee, code=code,
                               job={"eye": eye, "redundancy": "central-angle"})
            self.assertEqual((self.folder / "out" / "program.ngc").exists(), code == 0)
            return result, self.report()["checks"]

        equal = {"rule": "equal-free-length", "free_length": 200}
        result, checks = wind(equal, 1)
        self.assertIn("check failed: collision: the head comes within 5.0 mm", result.stderr)
        self.assertEqual([name for name, check in checks.items() if not check["ok"]],
                         ["collision"])
        self.assertAlmostEqual(checks["free_length"]["max_mm"], 200, delta=1)
        _, checks = wind({**equal, "free_length": 250}, 0)
        # 14 mm between the eye and the branch's end, and some more as the fibre is tangential:
        # sqrt(250^2 + 50^2) - 236 = 18.95, less the ring's 3.5 mm.
        self.assertAlmostEqual(checks["collision"]["min_clearance_mm"], 14, delta=2)
        stretch = [{"from_mm": 60, "to_mm": 130, "free_length": 250}]
        _, checks = wind({**equal, "lengths": stretch}, 0)
        self.assertAlmostEqual(checks["free_length"]["min_mm"], 200, delta=1)
        self.assertAlmostEqual(checks["free_length"]["max_mm"], 250, delta=1)
        path = self.rows("out/path.csv")
        self.assertEqual({float(r["free_length_mm"]) for r in (path[0], path[-1])}, {200.0})
        self.assertEqual({float(r["free_length_mm"]) for r in path
                          if 60 <= float(r["s_mm"]) <= 130}, {250.0})
        _, checks = wind({"rule": "adaptive"}, 0)
        self.assertGreaterEqual(checks["collision"]["min_clearance_mm"], 5.0)


    def test_one_circuit_whose_points_scatter(self):
        """A pattern given as one circuit of some forty points, each off by some hundredths of a mm: it slips, and smoothed it
        does not."""
        self.done("make", "vessel", "--radius", "60", "--cylinder-length", "150", "--dome-height", "40", "--opening-radius",
                  "20", "-o", "vessel.stl")
        job = self.write("polar.json", '{"tow": {"width": 6, "friction": 0.2}, "layers": [{"kind": "polar"}]}')
        self.done("vessel.stl", "--machine", "six_axis.json", "--job", job, "-o", "planned")
        courses = {}
        with (self.folder / "planned/path.csv").open() as file:
            for row in csv.DictReader(file):
                courses.setdefault(row["course"], []).append(row)
        place = lambda row: [float(row[f"{c}_mm"]) for c in "xyz"]
        around = lambda row: math.degrees(math.atan2(float(row["y_mm"]), float(row["x_mm"])))
        there, back, after = list(courses.values())[:3]
        circuit = there + back[1:]
        points = [place(circuit[0])]
        direction = [float(circuit[0][f"t{c}"]) for c in "xyz"]
        scatter = random.Random(1)
        for row in circuit[1:-1]:
            now = [float(row[f"t{c}"]) for c in "xyz"]
            turned = math.acos(max(-1.0, min(1.0, sum(a * b for a, b in zip(now, direction)))))
            if math.dist(place(row), points[-1]) > 14.0 or turned > 0.3:
                points.append([c + scatter.gauss(0.0, 0.05) for c in place(row)])
                direction = now
        points.append(place(circuit[-1]))
        self.assertLess(len(points), 50)
        self.write("circuit.csv", "x_mm,y_mm,z_mm\n" + "".join("%.4f,%.4f,%.4f\n" % tuple(p) for p in points))
        post = ["post", "circuit.csv", "--mandrel", "vessel.stl", "--machine", "six_axis.json", "--job", job, "--frame", "mandrel",
                "--circuits", len(list(courses)) // 2, "--turn", around(after[0]) - around(there[0]), "--json"]
        rough = self.run_program(*post, "-o", "rough")
        self.assertEqual(rough.returncode, 1)
        self.assertFalse(json.loads(rough.stdout)["checks"]["slip"]["ok"])
        smooth = json.loads(self.done(*post, "--smooth", "0.2", "-o", "smooth").stdout)
        self.assertTrue(smooth["ok"])
        self.assertLessEqual(smooth["import"]["smoothed_mm"], 0.202)
        planned = json.loads((self.folder / "planned/report.json").read_text())
        self.assertAlmostEqual(smooth["plan"]["fibre_length_mm"] / planned["plan"]["fibre_length_mm"], 1.0, 2)
        self.assertLessEqual(smooth["checks"]["slip"]["worst"], 0.2)


if __name__ == "__main__":
    program.main(sys.modules[__name__])
