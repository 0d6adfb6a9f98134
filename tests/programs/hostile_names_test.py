"""Names with markup, quotes, brackets and line breaks stay names in every file that has them."""
import base64
import gzip
import json
import os
import re
import sys
import unittest
import xml.etree.ElementTree

import program

HOOPS = '{"tow": {"width": 12}, "mandrel": {"extension": 0}, "layers": [{"kind": "hoop"}]}'
NAMES = ("</script><img src=x onerror=alert(1)>", "a) M3 (b", "a\nM30\nG0 X9", "*/ --> ]]> \\",
         "\"'`;%{mandrel}", "tie on at X1 Y2 Z3 on the mandrel", "Wickelgerät 巻 \u202e", "\x1b[2J\x07",
         "course 5", "x" * 300)
FILES = tuple(name.replace("/", "|")[:120] for name in NAMES)


class HostileNames(program.ProgramTest):
    def setUp(self):
        super().setUp()
        self.mandrel = self.make("cylinder", "--radius", "40", "--length", "60", "--edge", "15")
        self.job = self.write("hoops.json", HOOPS)
        self.out = self.folder / "out"

    def machine(self, name, dialect="linuxcnc"):
        machine = json.loads((program.SOURCE / "machines/six_axis.json").read_text())
        machine["name"] = name
        machine["controller"] = {"dialect": dialect}
        return self.write("machine.json", json.dumps(machine))

    def wind(self, mandrel, machine):
        return self.run_program(mandrel, "--machine", machine, "--job", self.job, "-o", self.out)

    def code_of(self, text):
        """What the controller runs: the program without comments and blank lines."""
        lines = (re.sub(r"\([^()]*\)|;.*", "", line).strip() for line in text.splitlines())
        return [line for line in lines if line]

    def page(self):
        """The page in two: all that is not data, and the data's head."""
        page = (self.out / "report.html").read_text()
        found = re.search(r'<script id="meshwind-data"[^>]*>([A-Za-z0-9+/=]*)</script>', page)
        content = gzip.decompress(base64.b64decode(found.group(1)))
        length = int.from_bytes(content[:4], "little")
        return page.replace(found.group(0), ""), json.loads(content[4:4 + length].decode())

    def test_programs_and_reports_of_hostile_machines_and_files(self):
        plain = {}
        for dialect, extension in (("linuxcnc", "ngc"), ("siemens", "mpf"), ("fanuc", "nc")):
            result = self.wind(self.mandrel, self.machine("plain", dialect))
            self.assertEqual(result.returncode, 0, result.stderr)
            plain[dialect] = self.code_of((self.out / f"program.{extension}").read_text())
        plain_page, _ = self.page()
        dialects = list(plain)
        for i, (name, file) in enumerate(zip(NAMES, FILES)):
            dialect = dialects[i % 3]
            with self.subTest(name=name, dialect=dialect):
                mandrel = self.folder / (file + ".stl")
                mandrel.write_bytes(self.mandrel.read_bytes())
                result = self.wind(mandrel, self.machine(name, dialect))
                self.assertEqual(result.returncode, 0, result.stderr)
                report = json.loads((self.out / "report.json").read_text())
                self.assertEqual(report["mandrel"]["file"], mandrel.name)
                text = (self.out / report["program"]["file"]).read_bytes()
                self.assertTrue(all(b in b"\n" or 0x20 <= b < 0x7f for b in text))
                self.assertEqual(self.code_of(text.decode()), plain[dialect])
                page, data = self.page()
                self.assertTrue(page == plain_page, "names stand in the data alone")
                self.assertEqual(data["report"]["mandrel"]["file"], mandrel.name)
                xml.etree.ElementTree.parse(self.out / "layup.vtu")
                json.loads((self.out / "layup.json").read_text())
                again = self.run_program("verify", self.out / report["program"]["file"],
                                         "--mandrel", mandrel, "--machine", "machine.json", "--job",
                                         self.job, "--plan", self.out, "--json")
                self.assertEqual(again.returncode, 0, again.stderr)
                self.assertEqual(json.loads(again.stdout)["machine"], name)

    def test_messages_stay_one_line(self):
        for name in FILES:
            with self.subTest(name):
                result = self.run_program("inspect", name + ".stl")
                self.assertEqual(result.returncode, 2)
                self.assertEqual(len(result.stderr.splitlines()), 1, result.stderr)
                self.assertFalse([c for c in result.stderr if c < " " and c != "\n"])

    def test_summaries_have_no_control_characters(self):
        for i, name in enumerate(("\x1b[2J\x07", "a\rb\x7f")):
            with self.subTest(name):
                mandrel = self.folder / (name + ".stl")
                mandrel.write_bytes(self.mandrel.read_bytes())
                for result in (self.run_program("inspect", mandrel),
                               self.wind(mandrel, self.machine(name))):
                    self.assertEqual(result.returncode, 0, result.stderr)
                    self.assertIn(("\\x1b[2J\\x07", "a\\x0db\\x7f")[i], result.stdout)
                    self.assertFalse([c for c in result.stdout if c < " " and c not in "\n\t"])

    def test_a_name_that_is_no_text(self):
        mandrel = os.fsencode(self.folder) + b"/bad\xff.stl"
        with open(mandrel, "wb") as file:
            file.write(self.mandrel.read_bytes())
        result = self.run_program(os.fsdecode(mandrel), "--job", self.job, "-o", self.out, "--json",
                                  "--quiet")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(json.loads(result.stdout)["mandrel"]["file"], "bad\ufffd.stl")
        self.assertEqual(json.loads((self.out / "report.json").read_text())["mandrel"]["file"],
                         "bad\ufffd.stl")
        self.assertEqual(self.page()[1]["report"]["mandrel"]["file"], "bad\ufffd.stl")

    def test_lines_of_the_controller(self):
        machine = json.loads((program.SOURCE / "machines/six_axis.json").read_text())
        for key in ("header", "footer"):
            for line in ("{mandrel}", "{machine}", "%", " % ", "%%", "G64\nM3", "(\x1b)", "(ä)",
                         "{mandrel", "{nothing}", "G64 P{mandrel}"):
                with self.subTest(key=key, line=line):
                    machine["controller"] = {"dialect": "linuxcnc", key: [line]}
                    file = self.write("own.json", json.dumps(machine))
                    for command in (["validate", file],
                                    [self.mandrel, "--machine", file, "-o", self.out]):
                        result = self.run_program(*command, "--quiet")
                        self.assertEqual(result.returncode, 2, result.stdout)
                        self.assertEqual(len(result.stderr.splitlines()), 1, result.stderr)
                        self.assertIn("own.json: /controller", result.stderr)
            machine["controller"] = {"dialect": "linuxcnc", key: ["({mandrel} on {machine})"]}
            self.done("validate", self.write("own.json", json.dumps(machine)))


if __name__ == "__main__":
    program.main("__main__")
