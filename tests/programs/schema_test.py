"""report.json and layup.json hold to their schemas, whatever was wound and however it ended."""
import json

import jsonschema

import program

PIPE = ("cylinder", "--radius", 30, "--length", 60, "--edge", 10)
TEE = ("tee", "--edge", 10, "--run-length", 240, "--branch-length", 140)
SMALL_TEE = ("tee", "--edge", 10, "--run-radius", 40, "--branch-radius", 30, "--blend-radius", 12, "--run-length", 140,
             "--branch-length", 90)
TOW = ("--set", "tow.width=12")


def layers(*kinds, **more):
    words = [word for k, kind in enumerate(kinds) for word in ("--set", f"layers.{k}.kind={kind}")]
    return [*words, *(word for key, value in more.items() for word in ("--set", f"layers.0.{key}={value}"))]


class Schemas(program.ProgramTest):
    def setUp(self):
        super().setUp()
        self.validators = {}
        for name in ("report", "layup"):
            schema = json.loads(self.done("validate", "--schema", name).stdout)
            jsonschema.Draft202012Validator.check_schema(schema)
            self.validators[name] = jsonschema.Draft202012Validator(schema)

    def assert_held(self, name, value):
        errors = [f"{list(error.path)}: {error.message[:200]}" for error in self.validators[name].iter_errors(value)]
        self.assertEqual(errors, [])

    def wound(self, *arguments, code=0):
        """Report of a run."""
        result = self.run_program("wind", *arguments, "--json", "-o", "out")
        self.assertEqual(result.returncode, code, result.stderr)
        report = json.loads(result.stdout)
        self.assert_held("report", report)
        layup = self.folder / "out/layup.json"
        self.assertTrue(layup.exists())
        self.assert_held("layup", json.loads(layup.read_text()))
        return report

    def test_patterns_layers_walls_and_landing_points(self):
        pipe = self.make(*PIPE)
        self.assertIn("pattern", self.wound(pipe, *TOW, *layers("helical", angle=50))["plan"])
        result = self.done("post", "out/path.csv", "--frame", "mandrel", "--mandrel", pipe, "--machine",
                           "six_axis.json", *TOW, "--json", "-o", "post")
        self.assertIn("import", json.loads(result.stdout))
        self.assert_held("report", json.loads(result.stdout))
        self.assertEqual(len(self.wound(pipe, *TOW, *layers("helical", "hoop"))["layers"]), 2)
        self.assertEqual(len(self.wound(pipe, *TOW, *layers("wall", layers=6))["walls"]), 1)
        lattice = self.wound(pipe, *layers("lattice", circuits=6, angle=50))
        self.assertIn("lattice", lattice["plan"]["pattern"])
        pins = self.wound(pipe, *TOW, *layers("helical", angle=20), "--set", "mandrel.turn=pins", "--set",
                          "mandrel.extension=40", "--set", "redundancy=central-angle")
        self.assertIn("pins", pins["plan"])

    def test_covers_and_what_fails(self):
        job = [word for setting in ("mandrel.extension=60", "tow.width=24", "tow.friction=0.25",
                                    "tolerance.clearance=2", "redundancy=central-angle", "layers.0.angle=45")
               for word in ("--set", setting)]
        self.assertIn("wish_deg", self.run_cover(self.make(*SMALL_TEE), *job)["plan"]["angles"])
        failed = self.wound(self.make(*TEE), "--effort", "0.1", *TOW, "--set", "tow.friction=0.01", "--set",
                            "redundancy=central-angle", "--set", "mandrel.turn=friction", code=1)
        self.assertFalse(failed["ok"])
        # Without a plan there is nothing to write.
        result = self.run_program("wind", self.make(*PIPE), *layers("cover"), "--set", "mandrel.turn=pins", "--set",
                                  "mandrel.extension=5", "--json", "-o", "bare")
        self.assertEqual(result.returncode, 1, result.stderr)
        self.assert_held("report", json.loads(result.stdout))
        self.assertNotIn("program", json.loads(result.stdout))

    def run_cover(self, tee, *job):
        """Whether it passes is not what is looked at here."""
        result = self.run_program("wind", tee, "--effort", "0.1", *job, "--json", "-o", "out")
        report = json.loads(result.stdout)
        self.assert_held("report", report)
        self.assert_held("layup", json.loads((self.folder / "out/layup.json").read_text()))
        return report


if __name__ == "__main__":
    program.main(__name__)
