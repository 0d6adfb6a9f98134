"""Installed, the program finds its data beside itself, wherever the folder was moved to."""
import json
import os
import shutil
import subprocess
import sys
import unittest

import program


class Install(program.ProgramTest):
    def test_data_is_found_in_the_moved_prefix(self):
        prefix = self.folder / "prefix"
        subprocess.run(["cmake", "--install", BUILD, "--prefix", prefix], check=True,
                       capture_output=True)
        moved = self.folder / "else where" / "opt"
        moved.parent.mkdir()
        prefix.rename(moved)
        # One that neither the sources nor another installation have.
        machine = json.loads((moved / "share/meshwind/machines/six_axis.json").read_text())
        machine["name"] = "Only here"
        own = moved / "share/meshwind/machines/only_here.json"
        own.write_text(json.dumps(machine))
        environment = {k: v for k, v in os.environ.items() if k != "MESHWIND_HOME"}
        work = self.folder / "work"
        work.mkdir()

        def run(program_file, *arguments):
            return subprocess.run([program_file, *arguments], cwd=work, env=environment,
                                  stdin=subprocess.DEVNULL, capture_output=True, text=True,
                                  timeout=program.TIMEOUT_S)

        link = work / "meshwind"
        link.symlink_to(moved / "bin/meshwind")
        for program_file in (moved / "bin/meshwind", link):
            result = run(program_file, "validate", "only_here.json")
            self.assertEqual(result.returncode, 0, result.stderr)
            result = run(program_file, "inspect", "tee.stl")
            self.assertEqual(result.returncode, 0, result.stderr)
        shutil.rmtree(moved / "share/meshwind/data")
        own.unlink()
        self.assertEqual(run(link, "validate", "only_here.json").returncode, 2)


if __name__ == "__main__":
    BUILD = sys.argv.pop(3)
    program.main("__main__")
