"""Commands that take what they need from a program's head: repeat, verify, resume, show."""
import json
import os

import page_data
import program

JOB = {"tow": {"width": 8, "friction": 0.25}, "mandrel": {"units": "in"},
               "layers": [{"kind": "helical", "angle": 50}, {"kind": "hoop"}], "tolerance": {"clearance": 3}}


class Repeat(program.ProgramTest):
    def wind(self, *arguments):
        """A pipe of R 30 x 120 mm in inches, wound by a job of two layers."""
        self.done("make", "cylinder", "--radius", 30 / 25.4, "--length", 120 / 25.4, "--edge", 5 / 25.4, "-o",
                  self.folder / "pipe.stl")
        self.write("my_job.json", json.dumps(JOB))
        self.done("pipe.stl", "--machine", "six_axis.json", "--job", "my_job.json", "-o", "out", "--seed", "7", "--effort",
                  "0.5", *arguments)
        return self.folder / "out"

    def refused(self, code, *arguments):
        result = self.run_program(*arguments, "--json", "--quiet")
        self.assertEqual(result.returncode, 2, result.stderr)
        self.assertEqual(json.loads(result.stdout)["error"]["code"], code)
        self.assertEqual(len(result.stderr.strip().split("\n")), 1)

    def test_a_program_is_repeated_from_its_text(self):
        out = self.wind()
        (self.folder / "my_job.json").unlink()
        for name in ("program.ngc", "program-layer-2.ngc"):
            with self.subTest(name):
                said = self.done("repeat", out / name, "-o", "again").stdout
                self.assertIn(f"again/{name} has the same blocks", said)
                for made in ("program.ngc", "program-layer-2.ngc"):
                    self.assertEqual((self.folder / "again" / made).read_bytes(), (out / made).read_bytes())
        again = self.folder / "again"
        self.assertIn("no program has the same blocks",
                      self.done("repeat", out / "program.ngc", "--set", "tow.width=9", "-o", "other").stdout)
        self.refused("output.holds_input", "repeat", again / "program.ngc", "-o", "again")

    def test_the_head_names_what_a_program_is_verified_with(self):
        out = self.wind()
        for name in ("program.ngc", "program-layer-2.ngc"):
            with self.subTest(name):
                report = json.loads(self.done("verify", out / name, "--json").stdout)
                self.assertTrue(report["ok"])
                self.assertFalse(report["other_job"])
        rest = json.loads(self.done("resume", out / "program.ngc", "--block", "100", "--json").stdout)
        self.assertTrue(rest["ok"])
        report = json.loads(self.done("verify", rest["file"], "--json").stdout)
        self.assertFalse(report["other_job"])
        # What is given counts more than the head.
        self.write("other.json", json.dumps({**JOB, "tow": {"width": 20}}))
        report = json.loads(self.run_program("verify", out / "program.ngc", "--job", "other.json", "--json").stdout)
        self.assertTrue(report["other_job"])

    def test_what_a_run_chose_by_itself_is_told(self):
        """A tee on which friction does not turn the fibre is wound on pins, of which the job says nothing."""
        self.make("tee", "--edge", "12", "--run-length", "240", "--branch-length", "140")
        self.write("job.json", json.dumps({"tow": {"width": 10, "friction": 0.1}, "mandrel": {"extension": 30}}))
        self.done("tee.stl", "--machine", "six_axis.json", "--job", "job.json", "-o", "out", "--effort", "0.1")
        (self.folder / "job.json").unlink()
        text = (self.folder / "out/program.ngc").read_text()
        self.assertIn('"turn":"pins"', text)
        report = json.loads(self.done("verify", "out/program.ngc", "--json").stdout)
        self.assertTrue(report["ok"])
        self.assertFalse(report["other_job"])
        self.done("repeat", "out/program.ngc", "-o", "again")
        self.assertEqual((self.folder / "again/program.ngc").read_text(), text)

    def test_what_the_head_does_not_say_has_to_be_given(self):
        out = self.wind()
        text = (out / "program.ngc").read_text()
        without = self.write("without.ngc", "\n".join(line for line in text.split("\n") if not line.startswith("(mandrel")))
        self.refused("origin.not_named", "verify", without)
        self.refused("origin.not_named", "verify", self.write("foreign.ngc", "G1 X1\n"))
        self.refused("repeat.no_run", "repeat", self.write("foreign.ngc", "G1 X1\n"))
        self.refused("repeat.no_run", "repeat", json.loads(
            self.done("resume", out / "program.ngc", "--block", "100", "--json").stdout)["file"])
        os.rename(self.folder / "pipe.stl", self.folder / "part.stl")
        self.refused("origin.no_file", "verify", out / "program.ngc")
        self.done("verify", out / "program.ngc", "--mandrel", "part.stl")
        self.done("make", "cylinder", "--radius", 31 / 25.4, "--length", 120 / 25.4, "--edge", 5 / 25.4, "-o", self.folder / "pipe.stl")
        self.refused("origin.other_mandrel", "verify", out / "program.ngc")
        spoilt = self.write("spoilt.ngc", text.replace('(job: {"', '(job: {', 1))
        self.refused("json.syntax", "verify", spoilt, "--mandrel", "part.stl")

    def test_show_writes_the_page_of_a_run_a_program_and_a_mesh(self):
        out = self.wind()
        if not (out / "report.html").exists():
            self.refused("cli.page", "show", "pipe.stl")  # built without pages
            return
        self.assertEqual(self.done("show", "out").stdout, "page: out/report.html\n")
        (out / "report.html").unlink()
        for what, page, mandrel in (("out", "out.html", "pipe.stl"), ("out/program-layer-2.ngc", "laid.html", "mandrel-layer-2.obj"),
                                    ("pipe.stl", "pipe.html", "pipe.stl")):
            with self.subTest(what):
                arguments = () if page != "laid.html" else ("-o", "laid.html")
                told = json.loads(self.done("show", what, *arguments, "--json").stdout)
                self.assertEqual(told, {"page": page})
                shown = page_data.Page((self.folder / page).read_text()).header
                self.assertEqual(shown.get("report", shown.get("inspection"))["mandrel"]["file"], mandrel)
        os.mkdir(self.folder / "empty")
        self.refused("show.nothing", "show", "empty")
        self.refused("cli.page_name", "show", "pipe.stl", "-o", "pipe.htm")


if __name__ == "__main__":
    program.main(__name__)
