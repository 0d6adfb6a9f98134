"""The Python module: arrays over the run's own memory, the command line's bytes, errors, and an end by Ctrl-C.

module_test.py PROGRAM SOURCE_FOLDER [unittest options]; PYTHONPATH has the module's folder.
"""
import ast
import csv
import functools
import gc
import json
import os
import pathlib
import re
import resource
import shutil
import signal
import subprocess
import sys
import tempfile
import threading
import time
import unittest

import meshwind
import numpy

PROGRAM = sys.argv[1]
SOURCE = pathlib.Path(sys.argv[2])
PIPE = {"tow": {"width": 12}, "layers": [{"kind": "helical", "angle": 45}, {"kind": "hoop"}], "redundancy": "central-angle"}
TEE = {"mandrel": {"extension": 120}, "tow": {"width": 30, "friction": 0.25}, "tolerance": {"clearance": 2},
       "redundancy": "central-angle"}


LOADS = """
import meshwind, resource, sys
def load(times):
    for _ in range(times):
        assert len(meshwind.load_mandrel(sys.argv[1]).points_mm) > 10
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
before_kb = load(50)
print(load(200) - before_kb)
"""


@functools.cache
def shared_folder():
    """Where the pipe of pipe() stays until the last test has ended."""
    holder = tempfile.TemporaryDirectory(prefix="meshwind-test-")
    unittest.addModuleCleanup(holder.cleanup)
    return pathlib.Path(holder.name)


@functools.cache
def pipe():
    file = shared_folder() / "pipe.stl"
    subprocess.run([PROGRAM, "make", "cylinder", "--radius", "40", "--length", "160", "--edge", "10", "-o", file], check=True,
                   capture_output=True)
    return file


@functools.cache
def wound_pipe():
    """A run that several tests read."""
    return meshwind.wind(pipe(), job=PIPE)


class Module(unittest.TestCase):
    def setUp(self):
        holder = tempfile.TemporaryDirectory(prefix="meshwind-test-")
        self.addCleanup(holder.cleanup)
        self.folder = pathlib.Path(holder.name)

    def make(self, kind, *sizes):
        file = self.folder / f"{kind}.stl"
        self.command("make", kind, *sizes, "-o", file)
        return file

    def command(self, *arguments):
        return subprocess.run([PROGRAM, *map(str, arguments)], check=True, capture_output=True, text=True)


class Winding(Module):
    def test_the_lines_of_the_readme(self):
        self.assertEqual(len(meshwind.load_mandrel("tee.stl").rims), 3)
        # A pipe stands in for the tee; test_the_bytes_of_the_command_line_for_a_tee winds one.
        shutil.copy(pipe(), self.folder / "tee.stl")
        for document in ("README.md", "docs/how-to/python.md"):
            for text in re.findall(r"```python\n(.*?)```", (SOURCE / document).read_text(), re.DOTALL):
                with self.subTest(document=document, text=text.split("\n")[0]):
                    here = os.getcwd()
                    os.chdir(self.folder)
                    try:
                        exec(compile(text, document, "exec"), {})
                    finally:
                        os.chdir(here)

    def same_files(self, mandrel, job, **options):
        file = self.folder / "job.json"
        file.write_text(json.dumps(job))
        run = meshwind.wind(mandrel, "six_axis.json", job, **options)
        run.write(self.folder / "module")
        words = [word for key, value in options.items() for word in (f"--{key}", str(value))]
        self.command(mandrel, "--machine", "six_axis.json", "--job", file, "-o", self.folder / "command", *words)
        names = sorted(path.name for path in (self.folder / "command").iterdir())
        self.assertEqual(sorted(path.name for path in (self.folder / "module").iterdir()), names)
        for name in names:
            one, other = ((self.folder / folder / name).read_bytes() for folder in ("module", "command"))
            if name == "report.json":  # all but what a clock says
                one, other = ({k: v for k, v in json.loads(text).items() if k != "timing_s"} for text in (one, other))
            self.assertTrue(one == other, name)  # a list of what differs would take minutes
        return run

    def test_the_bytes_of_the_command_line_for_layers(self):
        self.assertTrue(self.same_files(pipe(), PIPE).ok)

    def test_the_bytes_of_the_command_line_for_a_tee(self):
        tee = self.make("tee", "--edge", "8", "--run-length", "240", "--branch-length", "140")
        self.same_files(tee, TEE, effort=0.1, seed=2)

    def test_arrays_are_those_of_the_files(self):
        run = wound_pipe()
        run.write(self.folder / "out")
        for number, layer in enumerate(run.layers, start=1):
            suffix = "" if number == 1 else f"-layer-{number}"
            with open(self.folder / f"out/path{suffix}.csv", newline="") as file:
                rows = list(csv.DictReader(file))
            pieces = layer.fibres[0].pieces
            names = [(p.kind, p.course) for p in pieces for _ in range(len(p))]
            self.assertTrue(names == [(row["kind"], int(row["course"])) for row in rows])
            for name, keys in (("position_mm", ("x_mm", "y_mm", "z_mm")), ("tangent", ("tx", "ty", "tz"))):
                told = numpy.array([[float(row[key]) for key in keys] for row in rows])
                self.assertLess(abs(numpy.vstack([getattr(p, name) for p in pieces]) - told).max(), 1e-3)
            with open(self.folder / f"out/motion{suffix}.csv", newline="") as file:
                rows = list(csv.DictReader(file))
            fibre = layer.fibres[0]
            told = numpy.array([[float(row[axis]) for axis in fibre.axes] for row in rows])
            self.assertLess(abs(fibre.positions - told).max(), 1e-6)
            self.assertTrue((fibre.positions_nano == numpy.rint(told * 1e9)).all())
            self.assertLess(abs(fibre.time_s - [float(row["time_s"]) for row in rows]).max(), 1e-5)
            self.assertTrue(fibre.program == (self.folder / "out" / fibre.file).read_text())
            self.assertLess(abs(numpy.linalg.norm(fibre.eye_mm - fibre.landing_mm, axis=1) - fibre.free_length_mm).max(), 1e-6)
        layup = json.loads((self.folder / "out/layup.json").read_text())["triangles"]
        self.assertLess(abs(run.layup.thickness_mm - [t["thickness_mm"] for t in layup]).max(), 1e-5)
        plies = run.layup.plies()
        counts = numpy.bincount(plies["triangle"], minlength=len(layup))
        self.assertEqual(counts.tolist(), [len(t["plies"]) for t in layup])
        angles = numpy.array([ply[3] for t in layup for ply in t["plies"]])
        off = abs(plies["angle_deg"] - angles)
        self.assertLess(numpy.minimum(off, 180.0 - off).max(), 1e-3)  # hoops are +90 and -90
        # What lies there is the laid fibre but for the turns.
        laid = numpy.dot(run.layup.layers, run.layup.area_mm2) / 12.0
        courses = sum(p.s_mm[-1] - p.s_mm[0] for layer in run.layers for f in layer.fibres for p in f.pieces if p.kind == "course")
        self.assertAlmostEqual(laid / courses, 1.0, delta=0.05)

    def test_what_fails_has_no_program_but_by_force(self):
        slips = {"tow": {"width": 12, "friction": 0.001}, "layers": [{"kind": "hoop"}]}
        for force in (False, True):
            run = meshwind.wind(pipe(), job=slips, force=force)
            self.assertFalse(run.ok)
            self.assertFalse(run.checks["slip"]["ok"])
            self.assertEqual(run.usable, force)
            program = run.layers[0].fibres[0].program
            self.assertEqual("FAILED" in (program or ""), force, program and program[:500])
            self.assertIs(run.report, run.report)

    def test_verify(self):
        run = wound_pipe()
        run.write(self.folder / "out")
        verified = meshwind.verify(self.folder / "out/program.ngc", pipe(), job=PIPE, plan=self.folder / "out")
        self.assertTrue(verified.ok, verified.checks)
        laid_mm = verified.report["verification"]["fibre_length_mm"]
        self.assertAlmostEqual(laid_mm / (run.report["layers"][0]["fibre_m"] * 1000.0), 1.0, places=3)
        text = (self.folder / "out/program.ngc").read_text().splitlines(keepends=True)
        moves = [i for i, line in enumerate(text) if line.startswith("G1") or " G1 " in line]
        del text[moves[len(moves) // 2]]
        (self.folder / "broken.ngc").write_text("".join(text))
        broken = meshwind.verify(self.folder / "broken.ngc", pipe(), job=PIPE, plan=self.folder / "out")
        self.assertFalse(broken.ok)

    def test_progress_is_told_and_its_error_ends_the_run(self):
        steps = []
        meshwind.wind(pipe(), job=PIPE, progress=lambda step, share: steps.append((step, share)))
        self.assertTrue(steps)
        self.assertTrue(all(0.0 <= share <= 1.0 for _, share in steps))

        class Enough(Exception):
            pass

        def stop(step, share):
            raise Enough

        with self.assertRaises(Enough):
            meshwind.wind(pipe(), job=PIPE, progress=stop)


class Memory(Module):
    def test_arrays_look_into_the_mandrel_and_keep_it(self):
        mandrel = meshwind.load_mandrel(pipe())
        points, again = mandrel.points_mm, mandrel.points_mm
        self.assertEqual(points.ctypes.data, again.ctypes.data)
        self.assertFalse(points.flags.owndata)
        self.assertFalse(points.flags.writeable)
        with self.assertRaises(ValueError):
            points[0, 0] = 1.0
        before = points.copy()
        del mandrel, again
        gc.collect()
        self.assertTrue((points == before).all())
        self.assertAlmostEqual(numpy.hypot(points[:, 0], points[:, 1]).max(), 40.0, places=4)

    def test_arrays_of_a_run_outlive_it(self):
        run = meshwind.wind(pipe(), job=PIPE)
        piece = run.layers[0].fibres[0].pieces[0]
        position, thickness = piece.position_mm, run.layup.thickness_mm
        self.assertEqual(position.ctypes.data, run.layers[0].fibres[0].pieces[0].position_mm.ctypes.data)
        self.assertEqual(position.strides, piece.tangent.strides)
        self.assertEqual(piece.s_mm.strides[0], position.strides[0])
        before = position.copy(), thickness.copy()
        del run, piece
        gc.collect()
        self.assertTrue((position == before[0]).all())
        self.assertTrue((thickness == before[1]).all())

    def test_hundreds_of_loads_leave_nothing(self):
        file = self.make("cylinder", "--radius", "20", "--length", "40", "--edge", "10")
        # A process of its own: after a run its peak would hide them.
        done = subprocess.run([sys.executable, "-c", LOADS, file], capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, done.stderr)
        # A mandrel is some 30 kB: two hundred of them would be 6 MB.
        self.assertLess(int(done.stdout), 1600)

    def test_other_threads_go_on(self):
        ticks = []
        ended = threading.Event()

        def tick():
            while not ended.wait(0.01):
                ticks.append(time.monotonic())

        thread = threading.Thread(target=tick)
        thread.start()
        begun = time.monotonic()
        meshwind.wind(pipe(), job=PIPE)
        spent = time.monotonic() - begun
        ended.set()
        thread.join()
        self.assertGreater(len(ticks), spent / 0.01 / 10)


class Errors(Module):
    def test_each_has_its_code_and_its_class(self):
        bad = self.folder / "bad.stl"
        bad.write_text("solid\n facet\n")
        for kind, code, call in (
                (meshwind.InputError, "json.unknown_key", lambda: meshwind.wind(pipe(), job={"tow": {"wdth": 3}})),
                (meshwind.InputError, "job.no_region", lambda: meshwind.wind(
                    pipe(), job={"layers": [{"kind": "wall", "layers": 2, "parts": [{"region": 99, "layers": 3}]}]})),
                (meshwind.IoError, "io.cannot_read", lambda: meshwind.wind(pipe(), "no_machine.json")),
                (meshwind.IoError, "mesh.missing_file", lambda: meshwind.load_mandrel("nothing.stl")),
                (meshwind.InputError, "trace.direction", lambda: meshwind.trace(
                    meshwind.load_mandrel(pipe()), (40, 0, 0), direction=(0, 0, 0)))):
            with self.subTest(code):
                with self.assertRaises(kind) as raised:
                    call()
                self.assertEqual(raised.exception.code, code, raised.exception)
                self.assertIn(raised.exception.words, str(raised.exception))
                self.assertNotIn("\n", str(raised.exception))
        self.assertTrue(issubclass(meshwind.InputError, ValueError))
        self.assertTrue(issubclass(meshwind.IoError, OSError))
        with self.assertRaises(meshwind.Error):
            meshwind.load_mandrel(bad)
        with self.assertRaises(ValueError):
            meshwind.load_mandrel(pipe(), units="furlong")

    def test_ctrl_c_ends_a_run(self):
        begun = time.monotonic()
        threading.Timer(1.0, os.kill, (os.getpid(), signal.SIGINT)).start()
        with self.assertRaises(KeyboardInterrupt):
            meshwind.wind(SOURCE / "data/tee.stl")
        self.assertLess(time.monotonic() - begun, 20.0)
        self.assertEqual(signal.getsignal(signal.SIGINT), signal.default_int_handler)
        self.assertTrue(meshwind.wind(pipe(), job=PIPE).ok)  # nothing of it is left


class Paths(Module):
    def test_a_helix_on_a_cylinder(self):
        mandrel = meshwind.load_mandrel(self.make("cylinder", "--radius", "50", "--length", "300", "--edge", "6"))
        path = meshwind.trace(mandrel, (50, 0, -100), angle_deg=45, length_mm=200)
        self.assertAlmostEqual(path.s_mm[-1], 200.0, places=6)
        self.assertLess(abs(path.kn_per_mm - 0.5 / 50.0).max(), 1e-5)
        self.assertLess(abs(path.kg_per_mm).max(), 1e-6)
        z = path.position_mm[:, 2] - path.position_mm[0, 2]
        self.assertLess(abs(z - path.s_mm / numpy.sqrt(2.0)).max(), 1e-3)
        with self.assertRaises(ValueError):
            meshwind.trace(mandrel, (50, 0, 0))

    def test_a_study(self):
        study = meshwind.study_mesh_size(["cylinder"], edges_mm=[20, 10], paths=3)
        self.assertEqual({point["edge_mm"] for line in study["lines"] for point in line["points"]}, {20.0, 10.0})


class Stubs(unittest.TestCase):
    def test_they_declare_what_is_there(self):
        tree = ast.parse(pathlib.Path(meshwind.__file__).with_name("__init__.pyi").read_text())
        declared = {node.name: node for node in tree.body if isinstance(node, (ast.ClassDef, ast.FunctionDef))}
        self.assertEqual(set(declared), set(meshwind.__all__))
        for name, node in declared.items():
            if not isinstance(node, ast.ClassDef) or issubclass(getattr(meshwind, name), Exception):
                continue
            members = {entry.name for entry in node.body if isinstance(entry, ast.FunctionDef)}
            members |= {entry.target.id for entry in node.body if isinstance(entry, ast.AnnAssign)}
            there = {member for member in dir(getattr(meshwind, name)) if not member.startswith("_")}
            if name != "Verification":  # whose members are set by its __init__
                self.assertEqual({member for member in members if not member.startswith("_")}, there, name)
        for name, value in vars(meshwind).items():
            if name in meshwind.__all__ and callable(value) and not isinstance(value, type):
                self.assertTrue(value.__doc__, name)


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]])
