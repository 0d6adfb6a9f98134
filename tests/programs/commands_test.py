"""What the commands do when all is well."""
import csv
import json
import math
import sys
import xml.etree.ElementTree

import program

KINDS = ("cylinder", "cone", "vessel", "isotensoid", "elbow", "tee", "wye", "cross", "combination",
         "frame", "torus", "ellipsoid")
PATH_HEADER = ("point,s_mm,x_mm,y_mm,z_mm,nx,ny,nz,tx,ty,tz,kn_per_mm,kg_per_mm,slip,bridge_mm"
               .split(","))


class Commands(program.ProgramTest):
    def test_version_and_help(self):
        self.assertRegex(self.done("--version").stdout, r"^meshwind \d+\.\d+\.\d+\n$")
        for arguments in (["--help"], ["wind", "--help"], ["inspect", "--help"],
                          ["make", "--help"], ["make", "tee", "--help"], ["trace", "--help"],
                          ["study", "--help"], ["study", "mesh-size", "--help"], ["verify", "--help"],
                          ["post", "--help"], ["design", "--help"], ["design", "vessel", "--help"], ["carry", "--help"], ["validate", "--help"]):
            result = self.done(*arguments)
            self.assertIn("--help", result.stdout)
            self.assertEqual(result.stderr, "")

    def test_makes_every_kind_in_every_format(self):
        for kind in KINDS:
            for ending in ("stl", "obj", "ply", "off"):
                with self.subTest(f"{kind}.{ending}"):
                    file = self.folder / f"{kind}.{ending}"
                    self.assertIn(file.name, self.done("make", kind, "--edge", "8", "-o",
                                                       file).stdout)
                    self.assertGreater(file.stat().st_size, 1000)

    VESSEL = ("design", "vessel", "--radius", "40", "--opening", "15", "--length", "80")

    def test_design_of_the_published_vessel(self):
        """data/reference/seed000.json: c = 1.5 cm, k_e as printed and as reciprocity has it."""
        with open(program.SOURCE / "data/reference/seed000.json") as file:
            ref = json.load(file)["vessel"]
        report = json.loads(self.done(*self.VESSEL, "--ke", ref["k_e"]["as_printed"], "--band", "5",
                                      "--angles", "20,25,30,35,40", "--json").stdout)
        dome = next(d for d in ref["domes"] if d["id"] == "c1.5")
        self.assertAlmostEqual(report["dome"]["height_mm"], 10 * dome["height"], 7)
        self.assertAlmostEqual(report["dome"]["meridian_mm"], 10 * dome["meridian"], 7)
        self.assertEqual([row["geodesic"] for row in report["angles"]], [False] + 4 * [True])
        self.assertGreater(report["angles"][0]["slip_to_turn"], 0)
        wanted = [g for g in ref["geodesics"] if g["dome"] == "c1.5"]
        for row, geodesic in zip(report["angles"][1:], wanted):
            self.assertAlmostEqual(row["angle_deg"], geodesic["angle_deg"], 8)
            self.assertAlmostEqual(math.radians(row["dome_turn_deg"]),
                                   geodesic["dome_turn_rad"], 8)
            self.assertAlmostEqual(row["dome_pass_mm"], 10 * geodesic["pass_length"], 7)
            self.assertAlmostEqual(row["circuit_length_mm"], 10 * geodesic["circuit_length"], 6)
            self.assertAlmostEqual(row["circuits"] * row["circuit_length_mm"],
                                   row["fibre_length_mm"], 3)
            thickest = max(p["thickness_mm"] for p in row["thickness"])
            self.assertLessEqual(thickest, row["thickest_mm"])
        ply = json.loads(self.done(*self.VESSEL, "--e1", ref["E1"], "--e2", ref["E2"], "--nu12",
                                   ref["nu12"], "--json").stdout)
        self.assertAlmostEqual(ply["vessel"]["ke"], ref["k_e"]["value"], 8)

    def test_design_prints_a_row_for_each_angle(self):
        lines = self.done(*self.VESSEL, "--angles", "20,30,54.7", "--pressure", "60", "--strength",
                          "1200").stdout.splitlines()
        self.assertIn("hoops", lines[2])
        self.assertEqual([line.split()[0] for line in lines[4:7]], ["20.00", "30.00", "54.70"])
        self.assertIn("slip ratio", lines[7])
        self.assertEqual(len(lines), 8)

    def test_a_design_is_wound_from_what_it_writes(self):
        result = self.done(*self.VESSEL, "--wall", "0.5", "--angles", "20,30,40", "-o", "vessel")
        designed = json.loads((self.folder / "vessel/job.json").read_text())
        self.assertEqual([layer["kind"] for layer in designed["layers"]], ["helical"])
        self.assertGreaterEqual(designed["layers"][0]["target_layers"] * 0.25, 0.5)
        command = result.stdout.splitlines()[-1].split("meshwind ")[1].split()
        self.done(*command, "--machine", "six_axis", "-o", "out")
        plan = json.loads((self.folder / "out/report.json").read_text())["plan"]
        self.assertAlmostEqual(plan["pattern"]["angle_deg"], designed["layers"][0]["angle"], delta=3)
        self.assertGreater(plan["coverage"]["mean_layers"], designed["layers"][0]["target_layers"])
        refused = self.run_program(*self.VESSEL, "--angles", "10", "-o", "none")
        self.assertEqual(refused.returncode, 2)
        self.assertFalse((self.folder / "none").exists())

    def test_inspect_has_the_keys_of_the_contract(self):
        mandrel = self.make("tee", "--edge", "12")
        report = json.loads(self.done("inspect", mandrel, "--json").stdout)
        part = report["mandrel"]
        self.assertTrue(report["meshwind"])
        self.assertEqual(part["file"], "tee.stl")
        for key in ("triangles", "area_mm2", "regions", "repairs"):
            self.assertIn(key, part)
        self.assertEqual([len(row) for row in part["file_to_mandrel"]], [4, 4, 4, 4])
        self.assertLessEqual({"rule", "residual_mm"}, set(part["axis"]))
        self.assertEqual(len(part["rims"]), 3)
        for rim in part["rims"]:
            self.assertLessEqual({"id", "centre", "axis", "radius"}, set(rim))
            self.assertAlmostEqual(math.hypot(*rim["axis"]), 1.0, 9)
        self.assertEqual(sorted(round(r["radius"], 3) for r in part["rims"]), [40.0, 50.0, 50.0])
        self.assertIn("tee.stl", self.done("inspect", mandrel).stdout)

    def test_inspect_names_the_parts_of_a_body_of_revolution(self):
        mandrel = self.make("vessel", "--edge", "5", "--cylinder-length", "120")
        part = json.loads(self.done("inspect", mandrel, "--json").stdout)["mandrel"]["revolution"]
        self.assertEqual(set(part), {"residual_mm", "length_mm", "ends", "parts"})
        self.assertEqual([p["kind"] for p in part["parts"]], ["dome", "cylinder", "dome"])
        self.assertEqual([end["kind"] for end in part["ends"]], ["rim", "rim"])
        middle = part["parts"][1]
        # The file has single precision: 4e-6 mm at 75 mm.
        self.assertAlmostEqual(middle["mean_radius_mm"], 75.0, 4)
        self.assertAlmostEqual(middle["to_mm"] - middle["from_mm"], 120.0, 3)
        self.assertEqual(part["parts"][2]["to_mm"], part["length_mm"])
        self.assertLess(part["residual_mm"], 1e-4)
        self.assertRegex(self.done("inspect", mandrel).stdout,
                         r"(?m)^revolution +body of revolution: dome 84\.11 mm R 15\.00 to 75\.00, "
                         r"cylinder 120\.00 mm R 75\.00, dome .*, residual 0\.000\d mm$")
        cone = self.make("cone", "--edge", "8")
        part = json.loads(self.done("inspect", cone, "--json").stdout)["mandrel"]["revolution"]
        self.assertAlmostEqual(part["parts"][0]["slope_deg"],
                               -math.degrees(math.atan2(30, 200)), 4)
        tee = self.make("tee", "--edge", "12")
        part = json.loads(self.done("inspect", tee, "--json").stdout)["mandrel"]["revolution"]
        self.assertEqual(set(part), {"why_not"})
        self.assertIn("3 rims", part["why_not"])

    def test_inspect_names_the_parts_of_a_tube(self):
        elbow = self.make("elbow", "--edge", "8")
        part = json.loads(self.done("inspect", elbow, "--json").stdout)["mandrel"]["tube"]
        self.assertEqual(set(part), {"residual_mm", "length_mm", "rims", "lean_deg", "radius",
                                     "parts"})
        self.assertEqual([p["kind"] for p in part["parts"]], ["straight", "bend", "straight"])
        # The file has single precision: 8e-6 mm at 180 mm.
        self.assertAlmostEqual(part["parts"][1]["bend_radius_mm"], 100.0, 3)
        self.assertAlmostEqual(part["parts"][1]["angle_deg"], 90.0, 3)
        self.assertAlmostEqual(part["radius"][0]["radius_mm"], 40.0, 4)
        self.assertLess(part["residual_mm"], 1e-4)
        self.assertRegex(self.done("inspect", elbow).stdout,
                         r"(?m)^tube +radius 40\.00: straight 80\.00 mm, bend 90\.00 deg R 100\.00, "
                         r"straight 80\.00 mm, residual 0\.0000 mm$")
        tee = self.make("tee", "--edge", "12")
        part = json.loads(self.done("inspect", tee, "--json").stdout)["mandrel"]["tube"]
        self.assertEqual(set(part), {"why_not"})

    def test_inspect_estimates_accuracy(self):
        """Half the edges: a quarter of the drift by walk, a sixteenth by patches; half of that fall
        is asked for. Not a word of it changes with the number of threads."""
        reports = []
        for edge in ("10", "5"):
            mandrel = self.make("torus", "--edge", edge)
            text = self.done("inspect", mandrel, "--json", "--threads", "1").stdout
            self.assertEqual(self.done("inspect", mandrel, "--json", "--threads", "2").stdout, text)
            part = json.loads(text)["mandrel"]
            self.assertEqual(set(part["smooth_fit"]),
                             {"quartic", "cubic", "quadratic", "reduced", "averaged"})
            self.assertEqual(part["smooth_fit"]["quartic"], sum(part["smooth_fit"].values()))
            reports.append(part["accuracy"])
        coarse, fine = reports
        self.assertEqual(coarse["paths"], 32)
        self.assertGreater(coarse["walk_mm_per_m"], 2 * fine["walk_mm_per_m"])
        self.assertGreater(coarse["patches_mm_per_m"], 8 * fine["patches_mm_per_m"])
        self.assertGreater(fine["walk_mm_per_m"], fine["patches_mm_per_m"])
        text = self.done("inspect", self.folder / "torus.stl").stdout
        self.assertRegex(text, r"(?m)^accuracy +paths drift by about 0\.\d+ mm per metre \(walk\)")

    def test_inspect_refines_in_the_frame_and_units_of_the_file(self):
        """A pipe of 0.05 m radius along x, in metres: the refined one has its points there too."""
        self.make("cylinder", "--radius", "50", "--length", "200", "--edge", "12")
        self.done("inspect", "cylinder.stl", "--refine", "9", "-o", "same.obj")
        lines = (self.folder / "same.obj").read_text().splitlines()
        points = [tuple(map(float, line.split()[1:4])) for line in lines if line.startswith("v ")]
        self.write("metres.obj", "\n".join(
            "v %.9g %.9g %.9g" % (p[2] / 1000, p[0] / 1000, p[1] / 1000)
            for p in points) + "\n" + "\n".join(x for x in lines if x.startswith("f ")) + "\n")
        refined = json.loads(self.done("inspect", "metres.obj", "--units", "m", "--refine", "3",
                                       "-o", "fine.obj", "--json").stdout)["refined"]
        lines = (self.folder / "fine.obj").read_text().splitlines()
        faces = [line for line in lines if line.startswith("f ")]
        points = [tuple(map(float, line.split()[1:4])) for line in lines if line.startswith("v ")]
        self.assertEqual(refined, {"file": "fine.obj", "longest_edge_mm": 3.0,
                                   "triangles": len(faces)})
        self.assertEqual({round(p[0], 6) for p in points} & {-0.1, 0.1}, {-0.1, 0.1})
        for x, y, z in points:
            # Flat edges of 12 mm would be up to 12^2 / (8 * 50) = 0.36 mm inside.
            self.assertAlmostEqual(math.hypot(y, z), 0.05, delta=2e-5)
            self.assertLessEqual(abs(x), 0.1 + 1e-8)

    def trace(self, mandrel, *arguments):
        out = self.folder / "path.csv"
        self.done("trace", mandrel, *arguments, "-o", out)
        with open(out, newline="") as file:
            rows = list(csv.reader(file))
        self.assertEqual(rows[0], PATH_HEADER)
        return [dict(zip(rows[0], map(float, row))) for row in rows[1:]]

    STUDY = ("study", "mesh-size", "--edges", "8,16", "--paths", "6", "--length", "120")

    def test_study_writes_table_report_and_plot(self):
        out = self.folder / "study"
        result = self.done(*self.STUDY, "--mandrel", "cylinder", "torus", "--radius", "40,60",
                           "-o", out, "--timing")
        self.assertIn("holds:", result.stdout)
        self.assertEqual(sorted(f.name for f in out.iterdir()),
                         ["study.csv", "study.html", "study.json", "study.svg", "timing.csv"])
        with open(out / "study.csv", newline="") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual({r["mandrel"] for r in rows}, {"cylinder-40", "cylinder-60", "torus"})
        self.assertEqual({r["tangent_rule"] for r in rows},
                         {"", "chord", "central", "parabola", "traced"})
        self.assertTrue(all(float(r["worst"]) >= float(r["rms"]) >= 0 for r in rows))
        report = json.loads((out / "study.json").read_text())
        self.assertEqual(report["options"]["paths"], 6)
        self.assertEqual(sum(len(line["points"]) for line in report["lines"]), len(rows))
        self.assertEqual(len(report["advice"]), 5)
        svg = xml.etree.ElementTree.parse(out / "study.svg").getroot()
        self.assertTrue(svg.tag.endswith("svg"))
        self.done(*self.STUDY, "--mandrel", "torus", "-o", out)
        self.assertFalse((out / "timing.csv").exists(), "of another run")

    def test_study_is_the_same_for_any_number_of_threads(self):
        part = self.make("tee", "--edge", "12")
        for threads in ("1", "2"):
            self.done(*self.STUDY, "--mandrel", "cylinder", "ellipsoid", part, "-o",
                      self.folder / threads, "--threads", threads)
        for name in ("study.csv", "study.json", "study.svg"):
            self.assertEqual((self.folder / "1" / name).read_bytes(),
                             (self.folder / "2" / name).read_bytes(), name)

    def test_study_prints_its_report(self):
        result = self.done(*self.STUDY, "--mandrel", "torus", "--json", "--regular", "-o",
                           self.folder / "out")
        self.assertEqual(result.stdout, (self.folder / "out" / "study.json").read_text())
        self.assertFalse(json.loads(result.stdout)["options"]["irregular"])

    def test_helix_on_a_cylinder_ends_where_it_must(self):
        """A geodesic at 45 degrees from (50, 0, -100): z = s cos 45, turn = s sin 45 / R. The
        vertices lie on the cylinder; at an edge of 4 mm facets are up to 0.04 mm inside."""
        mandrel = self.make("cylinder", "--radius", "50", "--length", "300", "--edge", "4")
        path = self.trace(mandrel, "--start", "50,0,-100", "--direction", "0,1,1", "--length",
                          "250", "--frame", "file")
        end = path[-1]
        run = 250 * math.sqrt(0.5)
        self.assertAlmostEqual(end["s_mm"], 250.0, 5)
        self.assertAlmostEqual(end["x_mm"], 50 * math.cos(run / 50), delta=0.1)
        self.assertAlmostEqual(end["y_mm"], 50 * math.sin(run / 50), delta=0.1)
        self.assertAlmostEqual(end["z_mm"], run - 100, delta=0.1)
        self.assertAlmostEqual(end["tz"], math.sqrt(0.5), delta=1e-3)
        self.assertAlmostEqual(end["kn_per_mm"], 0.5 / 50, delta=1e-4)
        self.assertEqual([p["point"] for p in path], list(range(len(path))))

    def test_steered_path_reaches_hoop_after_the_closed_form_run(self):
        """z = (R / lambda)(1 / sin alpha - 1) from alpha to hoop, then it turns back: the largest
        z over the start."""
        mandrel = self.make("cylinder", "--radius", "50", "--length", "300", "--edge", "4")
        run = 50 / 0.3 * (math.sqrt(2) - 1)
        for slip in ("0.3", "-0.3"):
            path = self.trace(mandrel, "--start", "50,0,-100", "--direction",
                              "0,1,1" if slip == "-0.3" else "0,-1,1", "--lambda", slip,
                              "--length", "220", "--frame", "file")
            self.assertAlmostEqual(max(p["z_mm"] for p in path), run - 100, delta=0.3)
            self.assertAlmostEqual(max(abs(p["slip"]) for p in path), 0.3, delta=0.02)

    def test_path_between_two_points(self):
        """The helix of one radian over 80 mm: hypot(50, 80) mm long. Points on facets are up to
        0.1 mm inside at an edge of 8 mm, and lengths around short by h^2 / (24 R^2) = 0.1 %."""
        mandrel = self.make("cylinder", "--radius", "50", "--length", "120", "--edge", "8")
        end = (50 * math.cos(1.0), 50 * math.sin(1.0), 40.0)
        for slip in ("0", "0.2", "-0.2"):
            path = self.trace(mandrel, "--start", "50,0,-40", "--to", "%.6f,%.6f,%.6f" % end,
                              "--lambda", slip, "--frame", "file")
            for axis, x in zip("xyz", end):
                self.assertAlmostEqual(path[-1][axis + "_mm"], x, delta=0.2)
            if slip == "0":
                geodesic_mm = path[-1]["s_mm"]
                self.assertAlmostEqual(geodesic_mm, math.hypot(50, 80), delta=0.2)
            else:
                # Longer by kg^2 L^3 / 24 with kg = 0.2 kn, kn = (50 / L)^2 / 50: 0.044 mm.
                self.assertAlmostEqual(path[-1]["s_mm"] - geodesic_mm, 0.044, delta=0.01)
                # kg turns to the left of travel for a positive ratio.
                middle = path[len(path) // 2]
                self.assertGreater(float(slip) * middle["kg_per_mm"], 0.0)
        line = self.done("trace", mandrel, "--start", "50,0,-40", "--to", "50,0,40", "-o",
                         self.folder / "path.csv").stdout
        self.assertIn("ended at: target", line)

    def test_frames_differ_by_file_to_mandrel(self):
        mandrel = self.make("elbow", "--edge", "8")
        start = ["--start", "40,0,40", "--direction", "0,1,1", "--length", "60"]
        in_file = self.trace(mandrel, *start, "--frame", "file")
        in_mandrel = self.trace(mandrel, *start, "--frame", "mandrel")
        report = json.loads(self.done("inspect", mandrel, "--json").stdout)
        matrix = report["mandrel"]["file_to_mandrel"]
        self.assertEqual(len(in_file), len(in_mandrel))
        for a, b in zip(in_file, in_mandrel):
            p = (a["x_mm"], a["y_mm"], a["z_mm"], 1.0)
            for row, axis in zip(matrix, "xyz"):
                self.assertAlmostEqual(sum(m * v for m, v in zip(row, p)), b[axis + "_mm"], 5)

    def test_validate(self):
        for name in ("machines/six_axis.json", "data/conformance/job/valid/all_keys.json"):
            self.assertIn("valid", self.done("validate", program.SOURCE / name).stdout)
        self.done("validate", "six_axis.json")  # found in the project's folders
        self.assertEqual(self.done("validate", "six_axis.json", "--quiet").stdout, "")
        for kind, arguments in (("job", ()), ("job", ("job",)), ("machine", ("machine",))):
            schema = (program.SOURCE / f"data/schema/{kind}.schema.json").read_text()
            self.assertEqual(self.done("validate", "--schema", *arguments).stdout, schema)
        self.assertEqual(self.run_program("validate", "--schema", "job.json").returncode, 2)

    def test_resume_writes_the_rest_that_verify_takes(self):
        self.make("cylinder", "--radius", "30", "--length", "120")
        self.done("cylinder.stl", "--machine", "six_axis.json", "-o", "out")
        with_mandrel = ("--mandrel", "cylinder.stl", "--machine", "six_axis.json")
        whole = json.loads(self.done("verify", "out/program.ngc", *with_mandrel, "--json").stdout)
        report = json.loads(self.done("resume", "out/program.ngc", *with_mandrel, "--block", "150", "--json").stdout)
        self.assertTrue(report["ok"])
        self.assertEqual(report["block"], 150)
        rest = self.folder / "out/resume_program.ngc"
        self.assertEqual(report["file"], "out/resume_program.ngc")
        left = json.loads(self.done("verify", rest, *with_mandrel, "--json").stdout)
        self.assertAlmostEqual(report["laid_mm"] + left["verification"]["fibre_length_mm"],
                               whole["verification"]["fibre_length_mm"], 2)
        self.done("resume", "out/program.ngc", *with_mandrel, "--line", report["line"], "-o", "again.ngc")
        self.assertEqual((self.folder / "again.ngc").read_text(), rest.read_text())
        for bad, code in ((("--block", "999999"), "resume.block"), ((), "resume.block"),
                          (("--line", "1"), "resume.line"),
                          (("--block", "150", "--line", "150"), "cli.usage")):
            result = self.run_program("resume", "out/program.ngc", *with_mandrel, *bad, "-o", "none.ngc", "--json")
            self.assertEqual(result.returncode, 2)
            self.assertEqual(json.loads(result.stdout)["error"]["code"], code)
        self.assertFalse((self.folder / "none.ngc").exists())
        result = self.run_program("resume", "out/program.ngc", *with_mandrel, "--block", "150", "-o", "out/../out/program.ngc")
        self.assertEqual(result.returncode, 2)
        self.assertIn("give another name", result.stderr)

    def test_verify_of_a_program_from_elsewhere(self):
        """The laid length is that of the helix, pi / 2 * 50 mm / sin 45 deg."""
        self.make("cylinder", "--radius", "50", "--length", "200")
        helix = (program.SOURCE / "data/programs/pipe_helix.ngc").read_text()
        file = self.write("helix.ngc", helix)
        command = ["verify", file, "--mandrel", "cylinder.stl", "--machine", "six_axis.json"]
        report = json.loads(self.done(*command, "--json", "-o", "out").stdout)
        self.assertEqual(report, json.loads((self.folder / "out/verify.json").read_text()))
        self.assertTrue(report["ok"])
        self.assertAlmostEqual(report["verification"]["fibre_length_mm"],
                               math.pi / 2 * 50 * math.sqrt(2), 2)
        self.assertIsNone(report["verification"]["first_wrong"])
        width, wall = 6, 2 * math.pi * 50 * 200
        share = report["verification"]["fibre_length_mm"] * width / wall
        self.assertAlmostEqual(report["coverage"]["fraction"], share, delta=0.03 * share)
        self.assertEqual(report["coverage"]["max_layers"], 1)
        with open(self.folder / "out/laid.csv", newline="") as table:
            rows = list(csv.DictReader(table))
        for row in rows:
            x, y, z, s = (float(row[name]) for name in ("x_mm", "y_mm", "z_mm", "s_mm"))
            self.assertAlmostEqual(math.hypot(x, y), 50, 3)
            self.assertAlmostEqual(z, -60 + s / math.sqrt(2), 2)
            self.assertAlmostEqual(50 * math.atan2(y, x), s / math.sqrt(2), 2)

        # The same a quarter of a turn further and 40 mm on, tied on there by option.
        shifted = helix.replace("(tie on", "(no tie").replace("C-70.529", "C-160.529")
        file.write_text(shifted.replace("Z81.421", "Z121.421"))
        again = json.loads(self.done(*command, "--tie-on", "0,50,-20", "--json").stdout)
        self.assertAlmostEqual(again["verification"]["fibre_length_mm"],
                               report["verification"]["fibre_length_mm"], 3)

        # Off the end of the extension.
        file.write_text(helix.replace("C-90 Z78.540", "C-900 Z785.40"))
        result = self.run_program(*command, "--json")
        self.assertEqual(result.returncode, 1)
        self.assertFalse(json.loads(result.stdout)["checks"]["laydown"]["ok"])
        self.assertIn("line 8", result.stderr)


if __name__ == "__main__":
    program.main(sys.modules[__name__])
