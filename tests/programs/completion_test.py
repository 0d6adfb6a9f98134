"""Completion of bash: what it offers at the end of a line; and that the generated files are those of this program."""
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

import program

SCRIPT = r"""
set -u
. "$1"; shift
COMP_WORDS=("$@"); COMP_CWORD=$(($# - 1)); COMP_LINE="$*"; COMP_POINT=${#COMP_LINE}
_meshwind
((${#COMPREPLY[@]} == 0)) || printf '%s\n' "${COMPREPLY[@]}"
"""


class Completion(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        for name in ("my part.stl", "other.obj", "job.json", "points.csv", "notes.txt", "made.ngc"):
            (self.folder / name).touch()
        (self.folder / "out").mkdir()

    def offered(self, *words):
        result = subprocess.run(
            ["bash", "--norc", "-c", SCRIPT, "complete", program.SOURCE / "cli/meshwind.bash", "meshwind", *words],
            cwd=self.folder, capture_output=True, text=True, check=True,
            env={"PATH": "/usr/bin:/bin", "MESHWIND_HOME": str(program.SOURCE)})
        self.assertEqual(result.stderr, "")
        return sorted(result.stdout.splitlines())

    def test_commands(self):
        self.assertEqual(self.offered("ver"), ["verify"])
        self.assertIn("study", self.offered(""))
        self.assertEqual(self.offered("study", ""), ["cases", "merge", "mesh-size"])
        self.assertEqual(self.offered("--quiet", "make", "iso"), ["isotensoid"])

    def test_kinds_of_mandrels(self):
        self.assertEqual(sorted(self.offered("make", "")),
                         sorted("cylinder cone vessel isotensoid elbow tee wye cross combination frame torus ellipsoid".split()))

    def test_options(self):
        self.assertEqual(self.offered("--mac"), ["--machine"])
        self.assertEqual(self.offered("verify", "--pl"), ["--plan"])
        self.assertEqual(sorted(self.offered("make", "tee", "--b")), ["--blend-radius", "--branch-length", "--branch-radius"])
        self.assertEqual(self.offered("make", "tee", "--ed"), ["--edge"])
        self.assertEqual(self.offered("inspect", "part.stl", "--js"), ["--json"])

    def test_values(self):
        self.assertEqual(self.offered("post", "points.csv", "--frame", ""), ["file", "mandrel"])
        self.assertEqual(self.offered("tee.stl", "--units", "m"), ["m", "mm"])
        self.assertEqual(self.offered("trace", "--method", "=", "w"), ["walk"])
        self.assertEqual(self.offered("tee.stl", "--seed", ""), [])

    def test_files_by_kind(self):
        mandrels = self.offered("inspect", "")
        self.assertTrue({"my part.stl", "other.obj", "out", "tee.stl", "tee_tetra_large_t.stl"} <= set(mandrels))
        self.assertFalse({"job.json", "notes.txt"} & set(mandrels))
        self.assertEqual(self.offered("tee.stl", "--job", ""), ["job.json", "out"])
        self.assertEqual(self.offered("tee.stl", "-o", ""), ["out"])
        self.assertEqual(self.offered("verify", "m"), ["made.ngc"])
        self.assertEqual(self.offered("post", "p"), ["points.csv"])
        self.assertEqual(self.offered("show", "m"), ["made.ngc", "my part.stl"])

    def test_machines_by_name(self):
        self.assertEqual(self.offered("tee.stl", "--machine", "si"), ["six_axis.json"])
        self.assertEqual(self.offered("tee.stl", "--machine", "=", "rob"), ["robot_kr16.json", "robot_track.json", "robot_winder.json"])
        self.assertEqual(self.offered("tee.stl", "--profile", "gl"), ["glass_2400tex.json"])
        self.assertEqual(self.offered("validate", "hob"), ["hobby_grbl.json"])


class Reference(unittest.TestCase):
    def test_is_that_of_this_program(self):
        result = subprocess.run([sys.executable, program.SOURCE / "docs/make_reference.py", "--check", "--program",
                                 program.PROGRAM], capture_output=True, text=True, check=False)
        self.assertEqual((result.returncode, result.stdout + result.stderr), (0, ""))

    @unittest.skipUnless(shutil.which("groff"), "groff is missing")
    def test_manual_page_has_no_warnings(self):
        result = subprocess.run(["groff", "-man", "-ww", "-Tutf8", "-z", program.SOURCE / "docs/meshwind.1"],
                                capture_output=True, text=True, check=True)
        self.assertEqual(result.stderr, "")


if __name__ == "__main__":
    program.main(sys.modules[__name__])
