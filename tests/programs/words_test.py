"""What the command line says: proposals for slips of the pen, errors as JSON, remarks in time."""
import json
import sys
import time

import program


class Words(program.ProgramTest):
    def refused(self, *arguments, code=None, words=()):
        """One line on stderr; with --json the code, the place and the same words on stdout."""
        plain = self.run_program(*arguments)
        self.assertEqual(plain.returncode, 2, plain.stderr)
        lines = [line for line in plain.stderr.splitlines() if not line.endswith(" ...")]
        self.assertEqual(len(lines), 1, plain.stderr)
        self.assertEqual(plain.stdout, "")
        for word in words:
            self.assertIn(word, lines[0])
        if code:
            result = self.run_program(*arguments, "--json")
            self.assertEqual(result.returncode, 2, result.stderr)
            report = json.loads(result.stdout)
            self.assertEqual(report["error"]["code"], code)
            self.assertEqual(report["exit_code"], 2)
            self.assertFalse(report["ok"])
            self.assertIn(report["error"]["message"], result.stderr)
            self.assertIn(report["error"]["place"], report["error"]["message"])
        return lines[0]

    def test_slips_of_the_pen_get_a_proposal(self):
        out = ("-o", self.folder / "t.stl")
        for arguments, code, words in (
                (("tee.stl", "--machin", "six_axis.json"), "cli.unknown_option", ["--machine"]),
                (("trace", "tee.stl", "--start", "0,0,0", "--angle", "45", "--set", "tow.width=4", *out),
                 "cli.unknown_option", ["--set", "'trace'", "meshwind trace --help"]),
                (("wnd", "tee.stl"), "cli.unknown_command", ["wnd", '"wind"']),
                (("inspct",), "cli.unknown_command", ['"inspect"']),
                (("tee.stl", "inspect"), "cli.extra", ["meshwind inspect tee.stl"]),
                (("make", "tea", *out), "make.unknown_kind", ["tea", '"tee"']),
                (("make", "tee", "--run-radus", "5", *out), "make.unknown_parameter",
                 ["meshwind make tee --help"]),
                (("inspect", "tee.stl", "--units", "inch"), "cli.usage", ['"in"', "inspect --help"]),
                (("tee.stl", "--machine", "sixaxis"), "io.cannot_read",
                 ["six_axis.json", "hobby_grbl.json"]),
                (("tee.stl", "--machine", "six_axes.json"), "io.cannot_read", ['"six_axis.json"']),
                (("none.stl",), "mesh.missing_file", ["none.stl"])):
            self.refused(*arguments, code=code, words=words)
        self.assertEqual(list(self.folder.iterdir()), [])

    def test_help_is_a_command_too(self):
        self.assertIn("Examples", self.done("help").stdout)
        self.assertIn("--run-radius", self.done("help", "make", "tee").stdout)

    def test_places_and_hints(self):
        machine = json.loads((program.SOURCE / "machines/six_axis.json").read_text())
        machine["controller"]["dialect"] = "sinumerik"
        file = self.write("m.json", json.dumps(machine))
        self.refused("tee.stl", "--machine", file, code="dialect.unknown",
                     words=["m.json: /controller/dialect", "siemens"])
        self.refused("validate", file, code="dialect.unknown", words=["/controller/dialect"])
        self.refused("tee.stl", "--machine", "robot_kr16.json", words=["meshwind carry"])
        self.refused("tee.stl", "--job", self.write("j.json", '{\n// fibre\n"tow": {}}'),
                     code="json.syntax", words=["j.json:2", "no comments"])
        self.refused(self.write("part.3mf", "PK"), code="mesh.unknown_format", words=[".step"])

    def test_a_material_stands_below_the_job(self):
        part = self.make("cylinder", "--radius", "30", "--length", "60", "--edge", "6")
        listed = json.loads(self.run_program("profiles", "--json").stdout)
        glass = next(entry["job"] for entry in listed if entry["file"] == "glass_2400tex.json")
        job = self.write("job.json", json.dumps({"tow": {"friction": 0.3, "price_per_kg": 12.5}}))
        result = self.run_program(part, "--profile", "glass_2400tex", "--job", job, "--machine", "six_axis", "-o", "out")
        self.assertEqual(result.returncode, 0, result.stdout + result.stderr)
        report = json.loads((self.folder / "out/report.json").read_text())
        self.assertEqual(report["run"]["job"]["tow"]["width"], glass["tow"]["width"])
        self.assertEqual(report["run"]["job"]["tow"]["friction"], 0.3)
        price = 12.5 * report["cost"]["mass_g"] / 1000
        self.assertAlmostEqual(report["cost"]["price"], price, 4)
        self.assertIn(f"price {price:.2f}", result.stdout)
        refused = self.run_program(part, "--profile", "glas_2400tex")
        self.assertEqual(refused.returncode, 2)
        self.assertIn("glass_2400tex.json", refused.stderr)

    def test_machines_whose_eye_keeps_its_distance_run_as_they_are(self):
        pipe = self.make("cylinder", "--radius", 40, "--length", 80, "--edge", 8)
        for name, distance in (("hobby_grbl.json", "60.000"), ("two_axis.json", "58.310")):
            self.assertIn(distance, self.done("validate", name).stdout)
            out = self.folder / f"out-{distance}"
            result = self.done(pipe, "--machine", name, "--set", "tow.width=12", "-o", out)
            self.assertIn(distance, result.stdout)
            report = json.loads((out / "report.json").read_text())
            self.assertEqual(report["eye"]["rule"], "cylinder")
            self.assertTrue(report["eye"]["by_machine"])
            payout = report["checks"]["payout"]
            self.assertLessEqual(payout["max_speed_mm_s"], payout["limit_mm_s"])
        job = self.write("j.json", '{"eye": {"rule": "cylinder", "radius": 61}}')
        self.refused(pipe, "--machine", "hobby_grbl.json", "--job", job,
                     code="machine.missing_axis", words=["60.000"])

    def test_without_a_cross_feed_no_radius_of_zero_is_advised(self):
        machine = json.loads((program.SOURCE / "machines/four_axis.json").read_text())
        machine["eye_chain"] = [axis for axis in machine["eye_chain"] if axis["letter"] != "X"]
        machine["eye"]["envelope"] = machine["eye"]["envelope"][:1]
        file = self.write("m.json", json.dumps(machine))
        line = self.refused("tee.stl", "--machine", file, code="machine.missing_axis")
        self.assertNotIn("0.000", line)

    def test_the_summary_has_unit_size_and_the_angle_that_was_asked_for(self):
        vessel = self.make("vessel", "--radius", 60, "--cylinder-length", 80, "--edge", 6)
        job = self.write("j.json", '{"layers": [{"kind": "helical", "angle": 30}]}')
        result = self.done(vessel, "--job", job, "--set", "tow.width=10", "-o", self.folder / "out")
        self.assertIn("120.0 x 120.0 x 176.8 mm (unit mm, assumed)", result.stdout)
        report = json.loads((self.folder / "out/report.json").read_text())
        self.assertEqual(report["plan"]["asked_angle_deg"], 30)
        if abs(report["plan"]["pattern"]["angle_deg"] - 30) > 0.05:
            self.assertIn("(30.00 asked for)", result.stdout)

    def test_what_cannot_be_wound_is_known_at_once(self):
        tube = self.make("cylinder", "--radius", 25, "--length", 3200, "--edge", 8)
        begin = time.monotonic()
        self.refused(tube, "--machine", "four_axis.json", "-o", self.folder / "out",
                     code="plan.travel", words=["axis Z", "1600", "1500.0"])
        self.assertLess(time.monotonic() - begin, 30)  # two runs on a busy machine; planning: minutes
        self.assertFalse((self.folder / "out").exists())


if __name__ == "__main__":
    program.main(sys.modules[__name__])
