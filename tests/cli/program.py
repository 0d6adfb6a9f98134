"""Runs the meshwind program for tests: a folder of one's own, a time limit, plain assertions."""
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

TIMEOUT_S = 60
PROGRAM = ""
SOURCE = Path()


# A helix at 45 degrees on a pipe of 50 mm radius, a quarter of a turn in one block; the eye is
# 200 mm ahead along the fibre, at (50, 141.421) from the spindle, 141.421 mm further along it.
HELIX = """(tie on at X50.000 Y0.000 Z-60.000 on the mandrel)
G21 G90 G94
G90 G0 A-75.964 B0 C-70.529
G90 G0 X150 Y0 Z81.421
G91 G93
G1 C-90 Z78.540 F20
M2
"""


class ProgramTest(unittest.TestCase):
    def setUp(self):
        holder = tempfile.TemporaryDirectory(prefix="meshwind-test-")
        self.addCleanup(holder.cleanup)
        self.folder = Path(holder.name)

    def run_program(self, *arguments, timeout_s=TIMEOUT_S):
        return subprocess.run([PROGRAM, *map(str, arguments)], cwd=self.folder, timeout=timeout_s,
                              stdin=subprocess.DEVNULL, capture_output=True, text=True)

    def done(self, *arguments, **options):
        result = self.run_program(*arguments, **options)
        self.assertEqual(result.returncode, 0, result.stderr)
        return result

    def make(self, kind, *arguments):
        file = self.folder / f"{kind}.stl"
        self.done("make", kind, *arguments, "-o", file)
        return file

    def write(self, name, content):
        file = self.folder / name
        if isinstance(content, bytes):
            file.write_bytes(content)
        else:
            file.write_text(content)
        return file


def main(module):
    """argv: PROGRAM SOURCE_FOLDER [unittest options]"""
    global PROGRAM, SOURCE
    PROGRAM, SOURCE = str(Path(sys.argv[1]).resolve()), Path(sys.argv[2]).resolve()
    unittest.main(module=module, argv=[sys.argv[0], *sys.argv[3:]])
