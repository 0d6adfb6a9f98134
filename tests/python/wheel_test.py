"""The wheel: made without a network, and by itself enough to wind.

wheel_test.py PROGRAM SOURCE_FOLDER: PROGRAM is not used.
"""
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest
import zipfile

SOURCE = pathlib.Path(sys.argv[2])
WINDS = """
import meshwind, pathlib
assert pathlib.Path(meshwind.__file__).parts[-3] == "site", meshwind.__file__
mandrel = meshwind.load_mandrel("tee.stl")
run = meshwind.wind("pipe.obj", job={"layers": [{"kind": "hoop"}]})
assert run.ok and len(mandrel.rims) == 3
run.write("out")
"""


def pipe():
    """A pipe of 24 facets around, as an .obj."""
    import math
    lines, around, along = [], 24, 12
    for i in range(along + 1):
        for k in range(around):
            turn = 2.0 * math.pi * k / around
            lines.append(f"v {40 * math.cos(turn):.9f} {40 * math.sin(turn):.9f} {160 * i / along:.9f}")
    for i in range(along):
        for k in range(around):
            a, b = i * around + k + 1, i * around + (k + 1) % around + 1
            lines += [f"f {a} {b} {b + around}", f"f {a} {b + around} {a + around}"]
    return "\n".join(lines) + "\n"


class Wheel(unittest.TestCase):
    def test_it_winds_by_itself(self):
        with tempfile.TemporaryDirectory(prefix="meshwind-test-") as name:
            folder = pathlib.Path(name)
            made = subprocess.run([SOURCE / "python/wheel.sh", folder / "wheel"], capture_output=True, text=True)
            self.assertEqual(made.returncode, 0, made.stderr)
            wheel = pathlib.Path(made.stdout.splitlines()[-1])
            self.assertTrue(wheel.name.startswith("meshwind-"), wheel)
            with zipfile.ZipFile(wheel) as archive:
                archive.extractall(folder / "site")
            (folder / "pipe.obj").write_text(pipe())
            without = {key: value for key, value in os.environ.items() if key not in ("MESHWIND_HOME", "PYTHONPATH")}
            done = subprocess.run([sys.executable, "-c", WINDS], cwd=folder, capture_output=True, text=True,
                                  env=without | {"PYTHONPATH": str(folder / "site")})
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertTrue((folder / "out/program.ngc").exists())


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]])
