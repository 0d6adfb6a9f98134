"""Filament winding on triangulated mandrels.

    import meshwind
    run = meshwind.wind("tee.stl", "six_axis.json", {"tow": {"width": 8}})
    print(run.ok, run.report["plan"]["coverage"]["fraction"])
    for fibre in run.layers[0].fibres:
        print(fibre.file, len(fibre.positions), "blocks")
    run.write("out")

Lengths are mm, angles degrees and times seconds, as the names say; points and directions are in the mandrel frame, whose Z
axis is the spindle. Arrays look into memory of the run or the mandrel: nothing is copied, none can be written to, and the
memory stays as long as an array does. The functions let other Python threads run. Ctrl-C ends them.
"""
import json as _json
import os as _os
import pathlib as _pathlib

_shared = _pathlib.Path(__file__).parent / "share"
if _shared.is_dir():  # of a wheel, which brings machines and example meshes
    _os.environ.setdefault("MESHWIND_HOME", str(_shared))

from . import _meshwind  # noqa: E402
from ._meshwind import (Fibre, Layer, Layup, Mandrel, Path, Piece, Rim, Run, __version__)  # noqa: E402
from .errors import Error, InputError, IoError, NumericalError  # noqa: E402

__all__ = ["Error", "Fibre", "InputError", "IoError", "Layer", "Layup", "Mandrel", "NumericalError", "Path", "Piece", "Rim",
           "Run", "Verification", "load_mandrel", "set_threads", "study_mesh_size", "trace", "verify", "wind"]

def _job(job):
    """A job of a dictionary, of a file, or the defaults."""
    if job is None:
        job = {}
    if isinstance(job, dict):
        return _meshwind.JobSource("", _json.dumps(job))
    return _meshwind.JobSource(_os.fspath(job), "")


def set_threads(threads):
    """Number of threads from here on; 0: one per core. Results do not depend on it."""
    _meshwind.set_threads(threads)


def load_mandrel(file, job=None, *, units=None):
    """Reads a mandrel as a job winds it.

    file   .stl, .obj, .ply, .off ..., or the name of one that comes with meshwind
    job    dictionary, job file, or None: the defaults
    units  of the file: "um", "mm", "cm", "m", "in"; None: as the job and the file have it
    """
    return _meshwind.load_mandrel(_os.fspath(file), _job(job), units)


def wind(mandrel, machine="six_axis.json", job=None, *, units=None, seed=1, effort=1.0, force=False, progress=None):
    """Plans every layer of the job, makes its programs and winds them again: what `meshwind MANDREL` does.

    mandrel   file; machine: file, or the name of one that comes with meshwind
    job       dictionary as a job file has it, job file, or None: the defaults
    effort    how long plans are improved, as a multiple
    force     the programs are for use although a check failed
    progress  called with (step, share) as a step goes on; its errors end the run

    Raises InputError for what cannot be wound at all. What a plan cannot do is a check that failed: run.ok, run.checks.
    """
    return _meshwind.wind(_os.fspath(mandrel), _os.fspath(machine), _job(job), units, seed, effort, force, progress)


class Verification:
    """What a program was found to lay, wound again from its text alone.

    ok      every check passed
    checks  by name, dictionaries with "ok" and the check's numbers
    report  as verify.json has it (docs/files.md)
    """

    def __init__(self, report):
        self.report = report
        self.ok = report["ok"]
        self.checks = report["checks"]

    def __repr__(self):
        return f"<meshwind.Verification, {'ok' if self.ok else 'not ok'}>"


def verify(program, mandrel, machine="six_axis.json", job=None, *, plan=None, units=None, seed=1):
    """Winds a program's text again and judges it. plan: folder of the run that made it, to compare with."""
    return Verification(_json.loads(_meshwind.verify(_os.fspath(program), _os.fspath(mandrel), _os.fspath(machine), _job(job),
                                                     "" if plan is None else _os.fspath(plan), units, seed)))


def trace(mandrel, start, *, direction=None, angle_deg=None, to=None, slip_ratio=0.0, length_mm=10000.0, method="patches"):
    """A fibre path over a mandrel of load_mandrel().

    start       point near the surface, file frame and file units; so is `to`
    direction   file frame, any length; or angle_deg: from the local axial direction, counter-clockwise seen from outside;
                or to: where the path ends
    slip_ratio  kg / kn of the path; 0 is a geodesic
    method      "patches", 4th order, or "walk", over the facets
    """
    if sum(given is not None for given in (direction, angle_deg, to)) != 1:
        raise ValueError("give one of direction, angle_deg and to")
    if method not in ("patches", "walk"):
        raise ValueError(f"method is 'patches' or 'walk', not {method!r}")
    return _meshwind.trace(mandrel, start, direction, angle_deg, to, slip_ratio, length_mm, method == "walk")


def study_mesh_size(mandrels=("cylinder", "torus", "ellipsoid", "tee"), *, edges_mm=(), paths=None, units=None, seed=1,
                    progress=None):
    """Path errors against the mesh size, as study.json has them (docs/study.md). mandrels: names as by default, or files."""
    return _json.loads(_meshwind.study_mesh_size([_os.fspath(mandrel) for mandrel in mandrels], units,
                                                 list(edges_mm), paths, seed, progress))


def _report(run):
    """report.json of the run, as a dictionary (docs/files.md)."""
    if not hasattr(run, "_made_report"):
        run._made_report = _json.loads(run.report_text())
    return run._made_report


def _checks(run):
    """By name, dictionaries with "ok" and the check's numbers."""
    return _report(run)["checks"]


def _run_repr(run):
    return f"<meshwind.Run, {len(run.layers)} layer{'s' if len(run.layers) != 1 else ''}, {'ok' if run.ok else 'not ok'}>"


Run.report = property(_report)
Run.checks = property(_checks)
Run.__repr__ = _run_repr
