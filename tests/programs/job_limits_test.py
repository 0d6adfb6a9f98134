"""Whatever a job may say by its schema ends as 0, 1 or 2 and in words: never in a failed assertion.

Draws jobs with keys at the ends of their ranges, out of the schema itself. MESHWIND_DRAWS and
MESHWIND_SEED say how many and which."""
import json
import os
import random
import sys

import program

PARTS = {"cylinder": ("--radius", 20, "--length", 60, "--edge", 8),
         "cone": ("--edge", 8, "--radius1", 20, "--radius2", 14, "--length", 50),
         "vessel": ("--edge", 8, "--radius", 24, "--cylinder-length", 40, "--dome-height", 18,
                    "--opening-radius", 8)}
MACHINES = ("six_axis.json", "four_axis.json", "hobby_grbl.json")
KINDS = ("auto", "helical", "hoop", "polar", "cover")
# Never drawn tiny: ten thousand circuits are right, and take their time.
SLOW = {("tow", "width"): 5.0, ("layers", "target_layers"): 0.001}


def ends_of(key, rule):
    """Both ends of a range, values just inside, the default."""
    low = rule.get("minimum", rule.get("exclusiveMinimum", 0.0))
    high = rule["maximum"]
    return [low, low + 1e-9 * (high - low), high, rule.get("default", low)]


class JobLimits(program.ProgramTest):
    @classmethod
    def setUpClass(cls):
        schema = json.loads((program.SOURCE / "data/schema/job.schema.json").read_text())
        cls.rules = schema["properties"]

    def drawn(self, random_, group, keys, chance=0.5):
        rules = self.rules[group]
        rules = rules["items"]["properties"] if group == "layers" else rules["properties"]
        values = {}
        for key in keys:
            if random_.random() < chance:
                value = random_.choice(ends_of(key, rules[key]))
                values[key] = max(value, SLOW.get((group, key), value))
        return values

    def ends_well(self, part, machine, job):
        file = self.write("job.json", json.dumps(job))
        result = self.run_program(part, "--machine", machine, "--job", file, "--quiet",
                                  "--effort", 0.1, "-o", self.folder / "out")
        what = f"{part.name} {machine} {json.dumps(job)}\n{result.stderr}"
        self.assertIn(result.returncode, (0, 1, 2), what)
        if result.returncode:
            self.assertNotEqual(result.stderr, "", what)
            self.assertTrue(all(line.startswith("meshwind: ")
                                for line in result.stderr.splitlines()), what)
        for word in ("nan", "inf ", "inf,", "inf;"):
            self.assertNotIn(word, result.stderr, what)
        return result

    def test_without_friction_a_turn_is_refused_in_words(self):
        """The length of the turn is infinite and was printed."""
        part = self.make("cylinder", "--radius", 25, "--length", 60, "--edge", 10)
        for angle in (45, 80):
            for turn in ("friction", "pins"):
                job = {"mandrel": {"turn": turn}, "tow": {"friction": 0, "width": 12},
                       "layers": [{"kind": "helical", "angle": angle}]}
                result = self.ends_well(part, "four_axis.json", job)
                if turn == "friction":
                    self.assertEqual(result.returncode, 1)
                    self.assertIn("no extension is long enough", result.stderr)

    def test_jobs_at_the_ends_of_their_ranges_end_in_words(self):
        parts = [self.make(kind, *options) for kind, options in PARTS.items()]
        seed = int(os.environ.get("MESHWIND_SEED", 1))
        random_ = random.Random(seed)
        for _ in range(int(os.environ.get("MESHWIND_DRAWS", 12))):
            layer = {"kind": random_.choice(KINDS), "angle": random_.choice((0, 1e-9, 30, 89.999, 90))}
            layer.update(self.drawn(random_, "layers", ["target_layers"], 0.2))
            job = {"mandrel": self.drawn(random_, "mandrel", ["extension"], 0.3),
                   "tow": self.drawn(random_, "tow",
                                     ["width", "thickness", "friction", "bridging_tolerance",
                                      "density"]),
                   "layers": [layer],
                   "eye": self.drawn(random_, "eye", ["free_length"], 0.2),
                   "tolerance": self.drawn(random_, "tolerance",
                                           ["laydown", "laydown_angle", "clearance"], 0.2),
                   "speed": self.drawn(random_, "speed", ["fibre"])}
            job["mandrel"]["turn"] = random_.choice(("friction", "friction", "pins", "pole"))
            machine = random_.choice(MACHINES)
            if machine == "hobby_grbl.json":
                job["eye"] = {"rule": "cylinder", "radius": 60}
            with self.subTest(seed=seed):
                self.ends_well(random_.choice(parts), machine, job)


if __name__ == "__main__":
    program.main(sys.modules[__name__])
