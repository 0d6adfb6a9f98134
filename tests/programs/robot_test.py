"""Programs for robots: written, wound again from their text, repeated, resumed; a run in the air is refused."""
import csv
import json
import re
import sys

import program

# Of each language: ending, and a block of it as a pattern of its six angles, the spindle and the time. In TP positions stand
# behind the times, and the third angle is counted from the ground.
NUMBER = r"(-?[\d.]+)"
LANGUAGES = {
    "rapid": (".mod", r"MoveAbsJ \[\[" + ",".join([NUMBER] * 6) + r"\],\[" + NUMBER + r",.*\\T:=" + NUMBER + ","),
    "krl": (".src", r"SPTP \{" + ",".join(f"A{i} {NUMBER}" for i in range(1, 7)) + rf",E1 {NUMBER}\}}\nTIME_BLOCK PART={NUMBER}\n"),
    "tp": (".ls", r"P\[\d+\]\{\s+GP1:\s+UF : 0, UT : 1," + "".join(rf"\s+[JE]\d=\s*{NUMBER} deg,?" for _ in range(7))),
}


def blocks_of(dialect, text):
    found = [[float(number) for number in block] for block in re.findall(LANGUAGES[dialect][1], text)]
    if dialect == "tp":
        times_s = [int(msec) / 1000 for msec in re.findall(r"J P\[\d+\] (\d+)msec", text)]
        found = [[a, b, c - b, u, v, w, x, time_s] for (a, b, c, u, v, w, x), time_s in zip(found[1:], times_s)]
    return found


JOB = '{"tow": {"width": 12}, "redundancy": "central-angle", "layers": [{"kind": "helical", "angle": 50}]}'


class Robot(program.ProgramTest):
    def wind(self, dialect):
        machine = json.loads((program.SOURCE / "machines/robot_winder.json").read_text())
        machine["controller"]["dialect"] = dialect
        self.write("robot.json", json.dumps(machine))
        self.write("job.json", JOB)
        self.done("make", "cylinder", "--radius", "30", "--length", "120", "--edge", "6", "-o", "pipe.stl")
        self.done("pipe.stl", "--machine", "robot.json", "--job", "job.json", "-o", "out", "--quiet")
        return "out/program" + LANGUAGES[dialect][0]

    def test_a_program_is_read_as_it_is_written(self):
        for dialect in LANGUAGES:
            with self.subTest(dialect):
                name = self.wind(dialect)
                text = (self.folder / name).read_text()
                # By an own reading of the text: the blocks of motion.csv.
                with open(self.folder / "out/motion.csv", newline="", encoding="utf-8") as stream:
                    rows = list(csv.DictReader(stream))[1:]
                found = blocks_of(dialect, text)
                self.assertEqual(len(found), len(rows))
                at_s = 0.0
                for block, row in zip(found, rows):
                    at_s += block[7]
                    self.assertAlmostEqual(at_s, float(row["time_s"]), delta=1e-4)
                    for letter, value in zip("ABCUVWX", block):
                        self.assertAlmostEqual(value, float(row[letter]), delta=1e-9)
                checks = json.loads(self.done("verify", name, "--plan", "out", "--json").stdout)["checks"]
                self.assertTrue(all(check["ok"] for check in checks.values()), checks)

                self.done("repeat", name, "-o", "again", "--quiet")
                self.assertEqual((self.folder / "again" / name.split("/")[1]).read_text(), text)
                self.done("resume", name, "--block", len(rows) // 2)
                refused = self.run_program("dry-run", name)
                self.assertEqual(refused.returncode, 2)
                self.assertIn("no linear axis", refused.stderr)

    def test_another_run_leaves_tables_of_the_user_alone(self):
        """`carry` has tables of its own beside a program in KRL; the main job has none."""
        name = self.wind("krl")
        self.write("out/rings.csv", "mine")
        self.wind("krl")
        self.assertEqual((self.folder / "out/rings.csv").read_text(), "mine")
        self.assertTrue((self.folder / name).exists())

    def test_a_machine_without_an_arm_is_refused(self):
        for dialect in LANGUAGES:
            machine = json.loads((program.SOURCE / "machines/six_axis.json").read_text())
            machine["controller"] = {"dialect": dialect}
            self.write("winder.json", json.dumps(machine))
            refused = self.run_program("validate", "winder.json")
            self.assertEqual(refused.returncode, 2)
            self.assertEqual(refused.stderr.count("\n"), 1, refused.stderr)
            self.assertIn("the six of an arm", refused.stderr)


if __name__ == "__main__":
    program.main(sys.modules[__name__])
