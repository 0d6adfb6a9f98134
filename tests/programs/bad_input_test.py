"""Every bad input is refused with one line, the promised exit code, and nothing left behind."""
import copy
import json
import math
import os
import struct
import sys
import unittest

import program

STL_TRIANGLE = "facet normal 0 0 1\nouter loop\n{}endloop\nendfacet\n"


def stl_text(triangles):
    facets = ("".join(f"vertex {x} {y} {z}\n" for x, y, z in t) for t in triangles)
    return "solid t\n" + "".join(map(STL_TRIANGLE.format, facets)) + "endsolid t\n"


def moebius_off(steps=40, width=4):
    """A closed band with half a twist, as one connected mesh."""
    points, faces = [], []
    for i in range(steps):
        turn = 2 * math.pi * i / steps
        for j in range(width + 1):
            w = 10.0 * (j / width - 0.5)
            radius = 40.0 + w * math.cos(turn / 2)
            points.append((radius * math.cos(turn), radius * math.sin(turn),
                           w * math.sin(turn / 2)))
    for i in range(steps):
        for j in range(width):
            a, b = i * (width + 1) + j, i * (width + 1) + j + 1
            if i + 1 < steps:
                c, d = a + width + 1, b + width + 1
            else:
                c, d = width - j, width - j - 1
            faces += [(a, c, b), (b, c, d)]
    return ("OFF\n%d %d 0\n" % (len(points), len(faces)) +
            "".join("%.9f %.9f %.9f\n" % p for p in points) +
            "".join("3 %d %d %d\n" % f for f in faces))


def doubled_coil_off(segments=20, rings=60):
    """A tube R 20 bent twice around the same circle R 60: half of its wall sees the other half."""
    points, faces = [], []
    for j in range(rings + 1):
        bend = 4.2 * math.pi * j / rings
        for i in range(segments):
            turn = 2 * math.pi * i / segments
            radius = 60.0 + 20.0 * math.cos(turn)
            points.append((radius * math.cos(bend), 20.0 * math.sin(turn), radius * math.sin(bend)))
    for j in range(rings):
        for i in range(segments):
            a, b = j * segments + i, j * segments + (i + 1) % segments
            faces += [(a, b, a + segments), (b, b + segments, a + segments)]
    return ("OFF\n%d %d 0\n" % (len(points), len(faces)) +
            "".join("%.6f %.6f %.6f\n" % p for p in points) +
            "".join("3 %d %d %d\n" % f for f in faces))


class BadInput(program.ProgramTest):
    def refused(self, *arguments, code, word=""):
        """Exit code 2, the error's code, and one line that names `word`: a place, key or option."""
        result = self.run_program(*arguments, "--quiet", "--json")
        self.assertEqual(result.returncode, 2, result.stderr)
        lines = result.stderr.splitlines()
        self.assertEqual(len(lines), 1, result.stderr)
        self.assertTrue(lines[0].startswith("meshwind: "), lines[0])
        self.assertGreater(len(lines[0]), len("meshwind: ") + 10)
        self.assertIn(word.lower(), lines[0].lower())
        error = json.loads(result.stdout)["error"]
        self.assertEqual(error["code"], code, lines[0])
        return lines[0]

    def refused_mandrel(self, name, content, code, word=""):
        file = self.write(name, content)
        before = sorted(self.folder.iterdir())
        for command in (["inspect"], [], ["wind"]):
            more = [] if command == ["inspect"] else ["-o", self.folder / "out"]
            line = self.refused(*command, file, *more, code=code, word=word)
            self.assertIn(name, line, "the line names the file")
        self.refused("trace", file, "--start", "0,0,0", "--angle", "45", "-o",
                     self.folder / "path.csv", code=code)
        self.assertEqual(sorted(self.folder.iterdir()), before, "nothing is left behind")

    def test_empty_file(self):
        for name in ("empty.stl", "empty.obj", "empty.ply", "empty.off"):
            with self.subTest(name):
                self.refused_mandrel(name, "", "mesh.empty_file")

    def test_text_that_is_no_mesh(self):
        for name in ("words.stl", "words.obj", "words.ply", "words.off"):
            with self.subTest(name):
                # a line of words is one that OBJ has no meaning for
                self.refused_mandrel(name, "it was a dark and stormy night\n" * 20,
                                     "mesh.bad_line" if name == "words.obj" else "mesh.not_a_mesh")

    def test_unknown_format(self):
        self.refused_mandrel("part.3mf", "PK\n", "mesh.unknown_format")

    def test_truncated_binary_stl(self):
        whole = self.make("cylinder", "--edge", "10").read_bytes()
        for kept in (40, 83, 84, 100, 84 + 50 * 20 + 17, len(whole) - 1):
            with self.subTest(kept):
                self.refused_mandrel("cut.stl", whole[:kept],
                                     "mesh.not_a_mesh" if kept == 40 else "mesh.truncated")

    def test_binary_stl_that_promises_four_billion_triangles(self):
        self.refused_mandrel("huge.stl", bytes(80) + struct.pack("<I", 0xFFFFFFFF) + bytes(50),
                             "mesh.truncated")

    def test_vertices_that_are_no_numbers(self):
        good = [(0, 0, 0), (10, 0, 0), (0, 10, 0)]
        for bad in ("nan", "inf", "-inf", "1e300"):
            with self.subTest(bad):
                self.refused_mandrel("bad.stl", stl_text([good, [(0, 0, bad), *good[1:]]]),
                                     "mesh.size_out_of_range" if bad == "1e300" else
                                     "mesh.not_finite")
        triangle = struct.pack("<12fH", 0, 0, 1, 0, 0, math.nan, 1, 0, 0, 0, 1, 0, 0)
        self.refused_mandrel("bad.stl", bytes(80) + struct.pack("<I", 1) + triangle,
                             "mesh.not_finite")

    def test_nothing_left_after_repair(self):
        line = [(0, 0, 0), (10, 0, 0), (20, 0, 0)]
        point = [(5, 5, 5)] * 3
        self.refused_mandrel("flat.stl", stl_text([line, point]), "mesh.no_triangles_left")

    def test_moebius_band(self):
        self.refused_mandrel("moebius.off", moebius_off(), "mesh.not_orientable")

    def test_a_closed_ring_has_nowhere_to_turn(self):
        file = self.make("torus", "--edge", "15")
        self.refused(file, "-o", self.folder / "out", code="plan.no_turn", word=file.name)
        self.assertFalse((self.folder / "out" / "program.ngc").exists())

    def test_no_wall(self):
        self.refused_mandrel("coil.off", doubled_coil_off(), "mesh.no_wall", "keep_regions")
        self.refused("inspect", self.folder / "coil.off", "--refine", "5", "-o",
                     self.folder / "fine.off", code="mesh.no_wall", word="keep_regions")

    def test_indices_and_rows_that_are_not_there(self):
        for name, content, code, word in (
                ("a.off", "OFF\n3 1 0\n0 0 0\n9 0 0\n0 9 0\n3 0 1 99999999\n", "mesh.bad_index", "a.off:6"),
                ("b.off", "OFF\n4 4 0\n0 0 0\n1 0\n3 0 1 2\n", "mesh.bad_line", "b.off:4"),
                ("a.obj", "v 0 0 0\nv 9 0 0\nv 0 9 0\nf" + 200000 * " 1 2 3" + "\n", "mesh.large_polygon", "a.obj:4"),
                ("a.ply", "ply\nformat ascii 1.0\nelement vertex 1\npropety float x\nend_header\n0\n",
                 "mesh.not_a_mesh", "a.ply:4")):
            with self.subTest(name):
                self.refused_mandrel(name, content, code, word)

    def test_pipe_without_a_writer(self):
        pipe = self.folder / "pipe.stl"
        os.mkfifo(pipe)
        self.refused("inspect", pipe, code="mesh.unreadable", word="pipe.stl")

    def refused_machine(self, machine, code, word):
        file = self.write("machine.json", json.dumps(machine))
        self.refused("validate", file, code=code, word=word)
        self.refused("cylinder.stl", "--machine", file, "-o", self.folder / "out", code=code,
                     word=word)
        self.assertFalse((self.folder / "out").exists())

    def six_axis(self):
        return json.loads((program.SOURCE / "machines/six_axis.json").read_text())

    def test_machine_files(self):
        self.make("cylinder", "--edge", "15")
        good = self.six_axis()

        def changed(change):
            machine = copy.deepcopy(good)
            change(machine)
            return machine

        without = lambda letter: changed(lambda m: m.update(
            eye_chain=[a for a in m["eye_chain"] if a["letter"] != letter]))
        # the head's parts on a missing axis are named first, so they go with it
        bare = changed(lambda m: m["eye"].update(envelope=[]))
        for letter in "XYZA":
            with self.subTest("without " + letter):
                machine = without(letter)
                machine["eye"]["envelope"] = bare["eye"]["envelope"]
                file = self.write("machine.json", json.dumps(machine))
                # valid each; whether the main job can be run with it is told
                self.done("validate", file)
                if letter == "Y":  # the turn of the spindle stands in for it
                    job = self.write("job.json", '{"tow": {"width": 40}}')
                    self.done("cylinder.stl", "--machine", file, "--job", job, "-o",
                              self.folder / "wound")
                else:
                    self.refused("cylinder.stl", "--machine", file, "-o", self.folder / "out",
                                 code="machine.unsupported_chain" if letter == "A" else
                                 "machine.missing_axis", word="Six-axis winder")
        with self.subTest("no spindle"):
            self.refused_machine(changed(lambda m: m.update(mandrel_chain=[])),
                                 "machine.missing_axis", "mandrel")
        with self.subTest("unknown key"):
            self.refused_machine(changed(lambda m: m["eye"].update(rollers=[0, 0, 1])),
                                 "json.unknown_key", "rollers")
        with self.subTest("wrong type"):
            self.refused_machine(changed(lambda m: m["fibre"].update(take_up="much")),
                                 "json.wrong_type", "take_up")
        with self.subTest("unknown dialect"):
            self.refused_machine(changed(lambda m: m["controller"].update(dialect="klingon")),
                                 "dialect.unknown", "klingon")

    def test_machine_with_a_head_mesh_that_is_missing(self):
        self.make("cylinder", "--edge", "15")
        machine = self.six_axis()
        machine["eye"]["envelope"] = [{"type": "mesh", "link": "X", "file": "no_head.stl"}]
        file = self.write("machine.json", json.dumps(machine))
        self.refused("cylinder.stl", "--machine", file, "-o", self.folder / "out",
                     code="mesh.missing_file", word="no_head")

    def refused_job(self, text, code, word):
        file = self.write("job.json", text)
        self.refused("cylinder.stl", "--job", file, "-o", self.folder / "out", code=code, word=word)
        self.assertFalse((self.folder / "out").exists())

    def test_job_files(self):
        self.make("cylinder", "--edge", "15")
        for text, code, word in (('{"tow": {"widht": 6}}', "json.unknown_key", "width"),
                           ('{"tows": {}}', "json.unknown_key", "tow"),
                           ('{"tow": {"width": "6"}}', "json.wrong_type", "/tow/width"),
                           ('{"layers": {}}', "json.wrong_type", "/layers"),
                           ('[]', "json.wrong_type", "job.json"),
                           ('{"tow": {"width": 6}', "json.syntax", "job.json"),
                           ('', "json.syntax", "job.json"),
                           ('{"tow": {"width": 6,}}', "json.syntax", "job.json"),
                           ('{"eye": {"free_length": 5}}', "job.free_length", "/eye/free_length"),
                           ('{"eye": {"free_length": 900}}', "job.free_length", "/eye/free_length"),
                           ('{"mandrel": {"keep_regions": [77]}}', "mesh.no_such_region", "77"),
                           ('{"eye": {"rule": "equal-free-length", "lengths": [{"course": 0, '
                            '"free_length": 900}]}}', "job.not_offered", "/eye/lengths"),
                           ('{"eye": {"rule": "cylinder"}}', "json.missing_key", "radius"),
                           ('{"eye": {"radius": 200}}', "job.eye_unused", "/eye/radius"),
                           ('{"layers": [{"kind": "imported", "file": "x.csv"}]}', "io.cannot_read", "x.csv"),
                           ('{"layers": [{"kind": "hoops"}]}', "json.out_of_range", "/layers/0/kind"),
                           ('{"mandrel": {"turn": "pins"}, "layers": [{"kind": "hoop"}]}', "job.not_offered", "/mandrel/turn")):
            with self.subTest(text):
                self.refused_job(text, code, word)

    def test_output_below_a_file(self):
        mandrel = self.make("cylinder", "--edge", "15", "--length", "60")
        self.write("file", "precious")
        job = self.write("job.json", '{"tow": {"width": 40}}')
        for below in ("file", "file/out"):
            with self.subTest(below):
                self.refused(mandrel, "--job", job, "-o", self.folder / below,
                             code="output.unwritable", word="file")
        self.refused("trace", mandrel, "--start", "50,0,0", "--angle", "45", "-o",
                     self.folder / "file" / "path.csv", code="output.unwritable", word="file")
        self.refused("make", "cylinder", "-o", self.folder / "file" / "a.stl",
                     code="output.unwritable", word="file")
        self.assertEqual((self.folder / "file").read_text(), "precious")
        self.assertEqual(len(list(self.folder.iterdir())), 3)

    def test_usage(self):
        self.make("cylinder", "--edge", "15")
        for arguments, code, word in ((["cylinder.stl", "--bogus"], "cli.unknown_option", "--bogus"),
                                (["none.stl"], "mesh.missing_file", "none.stl"),
                                (["inspect", "none.stl"], "mesh.missing_file", "none.stl"),
                                (["inspect"], "cli.usage", "mandrel"),
                                (["inspect", self.folder], "mesh.unreadable", ""),
                                (["inspect", "cylinder.stl", "--refine", "5"], "cli.output", "-o"),
                                (["inspect", "cylinder.stl", "--refine", "0", "-o", "a.stl"],
                                 "refine.not_positive", ""),
                                (["inspect", "cylinder.stl", "--refine", "-1", "-o", "a.stl"],
                                 "refine.not_positive", ""),
                                (["inspect", "cylinder.stl", "--refine", "nan", "-o", "a.stl"],
                                 "refine.not_positive", ""),
                                (["inspect", "cylinder.stl", "--refine", "0.001", "-o", "a.stl"],
                                 "refine.too_many", ""),
                                (["inspect", "cylinder.stl", "--refine", "5", "-o", "a.xyz"], "export.unknown_format", "xyz"),
                                (["inspect", "cylinder.stl", "-o", "a.stl"], "cli.usage", "--refine"),
                                (["validate", "none.json"], "io.cannot_read", "none.json"),
                                (["validate", self.folder], "io.cannot_read", ""),
                                (["cylinder.stl", "--machine", "none.json"], "io.cannot_read", "none.json"),
                                (["cylinder.stl", "--job", "none.json"], "io.cannot_read", "none.json"),
                                (["cylinder.stl", "--threads", "-1"], "cli.usage", "threads"),
                                (["cylinder.stl", "--threads", "99999999999"], "cli.usage", "threads"),
                                (["cylinder.stl", "--seed", "many"], "cli.usage", "seed"),
                                (["cylinder.stl", "--seed", "-1"], "cli.usage", "seed"),
                                (["cylinder.stl", "--seed", "1.5"], "cli.usage", "seed"),
                                (["cylinder.stl", "--seed", "18446744073709551616"], "cli.usage", "seed"),
                                (["cylinder.stl", "--effort", "0"], "cli.usage", "effort"),
                                (["cylinder.stl", "--effort", "2000"], "cli.usage", "effort"),
                                (["cylinder.stl", "--units", "cubit"], "cli.usage", "cubit"),
                                (["cylinder.stl", "inspect", "cylinder.stl"], "cli.extra", "cylinder.stl"),
                                (["make", "cube", "-o", "a.stl"], "make.unknown_kind", ""),
                                (["make", "cylinder"], "cli.output", "-o"),
                                (["make", "cylinder", "-o", "a.xyz"], "export.unknown_format", "xyz"),
                                (["make", "cylinder", "--radius", "-5", "-o", "a.stl"], "make.not_positive", "radius"),
                                (["make", "cylinder", "--radius", "nan", "-o", "a.stl"], "make.not_positive", "radius"),
                                (["make", "cylinder", "--edge", "0", "-o", "a.stl"], "make.not_positive", "edge"),
                                (["make", "tee", "--branch-radius", "80", "-o", "a.stl"], "make.branch_too_wide", "branch")):
            with self.subTest(" ".join(map(str, arguments))):
                self.refused(*arguments, code=code, word=word)
        self.assertEqual([f.name for f in self.folder.iterdir()], ["cylinder.stl"])

    def test_design(self):
        vessel = ["design", "vessel", "--radius", "40", "--length", "80", "--opening"]
        for arguments, code, word in (([], "cli.usage", "--opening"),
                                (["40"], "vessel.opening", ""),
                                (["-1"], "vessel.not_positive", "opening"),
                                (["15", "--ke", "0"], "vessel.opening", ""),
                                (["15", "--ke", "1"], "make.stiffness_ratio", "ke"),
                                (["15", "--ke", "nan"], "make.negative", "ke"),
                                (["15", "--ke", "0.1", "--e1", "1"], "cli.usage", "--ke"),
                                (["15", "--e1", "132", "--e2", "10"], "cli.usage", "--nu12"),
                                (["15", "--e1", "10", "--e2", "132", "--nu12", "0.3"], "vessel.stiffness", "e1"),
                                (["15", "--design-radius", "39"], "make.design_radius", "design-radius"),
                                (["15", "--angles", "0"], "vessel.angle", "angles"),
                                (["15", "--angles", "30,90"], "vessel.angle", "angles"),
                                (["15", "--angles", "30,x"], "cli.usage", "angles"),
                                (["15", "--band", "0"], "vessel.not_positive", "band"),
                                (["15", "--wall", "1", "--pressure", "1"], "vessel.demand", "wall"),
                                (["15", "--wall", "1e300"], "vessel.out_of_range", "wall"),
                                (["15", "--wall", "1e6"], "vessel.demand", ""),
                                (["1e-300"], "vessel.out_of_range", "opening"),
                                (["15", "--length", "1e300"], "cli.usage", "length"),
                                (["15", "--radius", "1e308"], "cli.usage", "radius"),
                                (["15", "--band", "5e-324"], "vessel.out_of_range", "band"),
                                (["15", "--density", "1e300"], "vessel.out_of_range", "density"),
                                (["15", "--design-radius", "1e-300"], "vessel.out_of_range", "design-radius"),
                                (["15", "--e1", "132", "--e2", "10", "--nu12", "inf"], "vessel.stiffness", "nu12"),
                                (["15", "--pressure", "1"], "vessel.not_positive", "strength")):
            with self.subTest(" ".join(arguments)):
                self.refused(*(vessel + arguments if arguments else vessel[:-1]), code=code,
                             word=word)
        self.refused("design", code="cli.usage")

    def test_trace(self):
        mandrel = self.make("cylinder", "--edge", "15")
        start = ["trace", mandrel, "-o", self.folder / "path.csv", "--start"]
        for arguments, code, word in ((["50,0,0", "--direction", "1,0,0"], "trace.direction", "direction"),
                                (["50,0,0", "--direction", "0,0,0"], "trace.direction", "direction"),
                                (["50,0,0", "--direction", "0,1"], "cli.vector", "--direction"),
                                (["50,0,0", "--direction", "0,1,2,3"], "cli.vector", "--direction"),
                                (["50;0;0", "--angle", "45"], "cli.vector", "--start"),
                                (["nan,0,0", "--angle", "45"], "cli.vector", "--start"),
                                (["1e300,1e300,0", "--angle", "45"], "trace.start", "start"),
                                (["50,0,0", "--angle", "nan"], "trace.angle", "angle"),
                                (["50,0,0", "--angle", "inf"], "trace.angle", "angle"),
                                (["50,0,0", "--angle", "45", "--lambda", "nan"], "trace.lambda", "lambda"),
                                (["50,0,0", "--angle", "45", "--length", "-1"], "trace.length", "length"),
                                (["50,0,0", "--angle", "45", "--length", "nan"], "trace.length", "length"),
                                (["50,0,0", "--angle", "45", "--frame", "moon"], "cli.usage", "frame"),
                                (["50,0,0"], "cli.direction", "--direction"),
                                (["50,0,0"], "cli.direction", "--to"),
                                (["50,0,0", "--to", "0,50"], "cli.vector", "--to"),
                                (["50,0,0", "--to", "nan,0,0"], "cli.vector", "--to"),
                                (["50,0,0", "--to", "1e300,0,0"], "trace.to", "--to"),
                                (["50,0,0", "--to", "50,0,0"], "trace.not_connected", ""),
                                (["50,0,0", "--to", "0,50,0", "--angle", "45"], "cli.usage", "--to"),
                                (["50,0,0", "--to", "0,50,0", "--direction", "0,0,1"], "cli.usage", "--to"),
                                (["50,0,0", "--to", "0,50,0", "--length", "50"], "cli.usage", "--to"),
                                (["50,0,0", "--to", "0,50,0", "--lambda", "nan"], "trace.lambda", "lambda"),
                                (["50,0,0", "--angle", "45", "--direction", "0,0,1"], "cli.usage", "")):
            with self.subTest(" ".join(arguments)):
                self.refused(*start, *arguments, code=code, word=word)
                self.assertFalse((self.folder / "path.csv").exists())

    def test_no_path_between_two_points(self):
        """With a slip ratio of 0.5 a path on a sphere is a circle of radius R / sqrt(1.25)."""
        mandrel = self.make("ellipsoid", "--equator-radius", "50", "--pole-radius", "50",
                            "--edge", "10")
        self.refused("trace", mandrel, "--start", "50,0,0", "--to=-49,9,3", "--lambda", "0.5",
                     "-o", self.folder / "path.csv", code="trace.not_connected")
        self.assertFalse((self.folder / "path.csv").exists())

    def test_study(self):
        part = self.make("cylinder", "--edge", "15")
        out = self.folder / "out"
        for arguments, code, word in ((["--edges", "0"], "study.not_positive", "edges"),
                                (["--edges", "nan"], "study.not_positive", "edges"),
                                (["--edges", "fine"], "cli.usage", "edges"),
                                (["--mandrel", "torus", "--edges", "400"], "study.no_mesh", ""),
                                (["--mandrel", "nothing.stl"], "mesh.missing_file", "nothing.stl"),
                                (["--mandrel", part, "--edges", "2"], "study.no_mesh", ""),
                                (["--mandrel", "torus", "torus"], "study.twice", ""),
                                (["--mandrel", "cylinder", "--radius", "5,5"], "study.twice", ""),
                                (["--mandrel", "cylinder", "--radius", "-5"], "make.not_positive", "radius"),
                                (["--lambda", "3"], "study.slip_ratio", "lambda"),
                                (["--lambda", "nan"], "study.slip_ratio", "lambda"),
                                (["--paths", "0"], "study.not_positive", "paths"),
                                (["--paths", "1000000"], "study.too_long", "paths"),
                                (["--length", "-1"], "study.not_positive", "length"),
                                (["--length", "inf"], "study.not_positive", "length"),
                                (["--free-length", "0"], "study.not_positive", "free length")):
            with self.subTest(" ".join(map(str, arguments))):
                self.refused("study", "mesh-size", *arguments, "-o", out, code=code, word=word)
                self.assertFalse(out.exists())
        self.refused("study", code="cli.usage", word="mesh-size")
        self.refused("study", "mesh-shape", code="cli.unknown_command", word="mesh-size")

    def test_verify(self):
        self.make("cylinder", "--radius", "50", "--length", "200", "--edge", "15")
        out = self.folder / "out"
        job = self.write("job.json", '{"mandrel": {"extension": 0}}')
        world = ["--mandrel", "cylinder.stl", "--machine", "six_axis.json", "--job", job]
        helix = (program.SOURCE / "data/programs/pipe_helix.ngc").read_text()
        for text, code, word in (("", "nc.no_end", ""), ("\0\1\2", "nc.not_understood", "broken.ngc:1"), ("(meshwind 1)\nG91 G93\nG1 C5 F20\nM2\n", "nc.unknown_start", "axis"),
                           ("(meshwind 1)\n" + helix.replace("M2\n", ""), "nc.no_end", ":9"),
                           (helix.replace("F20", ""), "nc.feed", "broken.ngc:8"),
                           (helix.replace("C-90", "C#5"), "nc.not_understood", "broken.ngc:8"),
                           (helix.replace("C-90", "C-9e99"), "nc.not_understood", "broken.ngc:8"),
                           (helix.replace("C-90", "Cnan"), "nc.number", "broken.ngc:8"),
                           (helix.replace("(tie on", "(no tie"), "verify.tie_on", "--tie-on"),
                           (helix.replace("X50.000", "X90.000"), "verify.tie_on", ""),
                           (helix.replace("tie on at X50.000", "tie on at Xhere"), "nc.tie_on", "broken.ngc:3")):
            with self.subTest(text[:60]):
                file = self.write("broken.ngc", text.encode())
                self.refused("verify", file, *world, "-o", out, code=code, word=word)
                self.assertFalse(out.exists())
        file = self.write("helix.ngc", helix)
        plan = self.folder / "plan"
        plan.mkdir()
        for arguments, code, word in (([file, *world, "--tie-on", "1,2"], "cli.vector", "--tie-on"),
                                ([file, *world, "--plan", "nowhere"], "io.cannot_read", "path.csv"),
                                ([file, *world, "--plan", plan], "io.cannot_read", "path.csv"),
                                (["nothing.ngc", *world], "io.cannot_read", "nothing.ngc"),
                                ([self.folder, *world], "io.cannot_read", ""),
                                ([file, *world[:2]], "origin.not_named", "--machine"), ([file, *world[2:]], "origin.not_named", "--mandrel")):
            with self.subTest(" ".join(map(str, arguments))):
                self.refused("verify", *arguments, "-o", out, code=code, word=word)
                self.assertFalse(out.exists())
        path = ("course,point,x_mm,y_mm,z_mm,nx,ny,nz,tx,ty,tz,bridge_mm\n"
                "0,0,50,0,-60,1,0,0,0,0.70711,0.70711,0\n0,1,0,50,18.54,0,1,0,-0.70711,0,0.70711,0\n")
        motion = "time_s,C,Z,Y,X,A,B,ex_mm,ey_mm,ez_mm,rx,ry,rz\n0,0,0,0,0,0,0,0,0,0,1,0,0\n"
        for name, text, code, word in (("path.csv", "", "plan.column", ""), ("path.csv", path[:30], "plan.column", ""),
                                 ("path.csv", path.replace("18.54", "1e999"), "plan.number", "path.csv:3"),
                                 ("path.csv", path + "0,2,1\n", "plan.number", "path.csv:4"),
                                 ("path.csv", path.split("\n")[0] + "\n", "plan.empty", ""),
                                 ("motion.csv", motion.replace("time_s,", "t,"), "plan.column", "time_s"),
                                 ("motion.csv", motion + "1,x,0,0,0,0,0,0,0,0,1,0,0\n", "plan.number", "motion.csv:3")):
            with self.subTest(f"{name}: {word}"):
                (plan / "path.csv").write_text(path)
                (plan / "motion.csv").write_text(motion)
                (plan / name).write_text(text)
                self.refused("verify", file, *world, "--plan", plan, "-o", out, code=code,
                             word=word)
                self.assertFalse(out.exists())


if __name__ == "__main__":
    program.main(sys.modules[__name__])
