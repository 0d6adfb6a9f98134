"""Runs the meshwind program for tests: a folder of one's own, a time limit, plain assertions."""
import os
import resource
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

TIMEOUT_S = 900  # a run that hangs; the slowest takes a minute on an idle core
ENDS_WITHIN_S = 10  # CPU seconds; it takes one or two, and a tee that goes on takes thirty or more
PROGRAM = ""
SOURCE = Path()


class ProgramTest(unittest.TestCase):
    def setUp(self):
        holder = tempfile.TemporaryDirectory(prefix="meshwind-test-")
        self.addCleanup(holder.cleanup)
        self.folder = Path(holder.name)

    def run_program(self, *arguments):
        return subprocess.run([PROGRAM, *map(str, arguments)], cwd=self.folder, timeout=TIMEOUT_S,
                              stdin=subprocess.DEVNULL, capture_output=True, text=True)

    def ended_by(self, process, number):
        """What a process wrote that a signal ended; it ends long before it would be done, in CPU seconds,
        which do not depend on what else the machine does."""
        fields = Path(f"/proc/{process.pid}/stat").read_text().rsplit(")", 1)[1].split()
        before_s = sum(map(int, fields[11:13])) / os.sysconf("SC_CLK_TCK")
        others = resource.getrusage(resource.RUSAGE_CHILDREN)
        process.send_signal(number)
        out, err = process.communicate(timeout=60)  # also of one that only waits
        all_of_it = resource.getrusage(resource.RUSAGE_CHILDREN)
        self.assertLess(all_of_it.ru_utime + all_of_it.ru_stime - others.ru_utime -
                        others.ru_stime - before_s, ENDS_WITHIN_S)
        return out, err

    def done(self, *arguments):
        result = self.run_program(*arguments)
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
