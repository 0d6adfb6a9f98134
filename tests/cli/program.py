"""Runs the meshwind program for tests: a folder of one's own, a time limit, plain assertions."""
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

TIMEOUT_S = 60
PROGRAM = ""
SOURCE = Path()


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
