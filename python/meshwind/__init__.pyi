"""Shapes: n stations, m triangles, b blocks, a axes of the machine."""
import os
from typing import Any, Callable, Dict, List, Optional, Sequence, Union

import numpy

__version__: str
_Job = Union[Dict[str, Any], str, "os.PathLike[str]", None]
_File = Union[str, "os.PathLike[str]"]
_Array = numpy.ndarray
_Progress = Optional[Callable[[str, float], Any]]

class Error(Exception):
    code: str
    place: str
    words: str

class InputError(Error, ValueError): ...
class IoError(Error, OSError): ...
class NumericalError(Error, ArithmeticError): ...

class Rim:
    """Where the wall ends: a circle on a leg."""
    @property
    def id(self) -> int: ...
    @property
    def centre_mm(self) -> _Array: ...  # 3
    @property
    def axis(self) -> _Array: ...  # 3, unit, away from the mandrel
    @property
    def radius_mm(self) -> float: ...

class Mandrel:
    """The surface that is wound."""
    @property
    def points_mm(self) -> _Array: ...  # p x 3
    @property
    def triangles(self) -> _Array: ...  # m x 3, indices into points_mm
    @property
    def regions(self) -> _Array: ...  # m, as `meshwind inspect` lists them
    @property
    def rims(self) -> List[Rim]: ...
    @property
    def remarks(self) -> List[str]: ...
    @property
    def unit_mm(self) -> float: ...  # of the file
    @property
    def mandrel_from_file(self) -> _Array: ...  # 4 x 4, file units to mm

class Path:
    """A fibre path. Arrays have an entry per station."""
    def __len__(self) -> int: ...
    @property
    def position_mm(self) -> _Array: ...  # n x 3
    @property
    def normal(self) -> _Array: ...  # n x 3, outward
    @property
    def tangent(self) -> _Array: ...  # n x 3
    @property
    def s_mm(self) -> _Array: ...  # n, arc length
    @property
    def kn_per_mm(self) -> _Array: ...  # n, normal curvature, > 0 where tension presses the fibre on
    @property
    def kg_per_mm(self) -> _Array: ...  # n, geodesic curvature, > 0 to the left seen from outside
    @property
    def slip(self) -> _Array: ...  # n, |kg / kn|
    @property
    def bridge_mm(self) -> _Array: ...  # n, gap under the taut fibre
    @property
    def words(self) -> str: ...  # how it ended, in one line

class Piece:
    """A course, or a transition that leads from one to the next. Arrays have an entry per station."""
    def __len__(self) -> int: ...
    @property
    def kind(self) -> str: ...  # "course" or "transition"
    @property
    def course(self) -> int: ...  # its number in the fibre, as path.csv and the plies have it
    @property
    def start_rim(self) -> int: ...
    @property
    def end_rim(self) -> int: ...
    @property
    def position_mm(self) -> _Array: ...  # n x 3
    @property
    def normal(self) -> _Array: ...  # n x 3
    @property
    def tangent(self) -> _Array: ...  # n x 3
    @property
    def s_mm(self) -> _Array: ...  # n
    @property
    def kn_per_mm(self) -> _Array: ...  # n
    @property
    def kg_per_mm(self) -> _Array: ...  # n
    @property
    def slip(self) -> _Array: ...  # n
    @property
    def bridge_mm(self) -> _Array: ...  # n

class Fibre:
    """A fibre of a layer and the program that lays it."""
    @property
    def pieces(self) -> List[Piece]: ...  # in winding order
    @property
    def program(self) -> Optional[str]: ...  # its text; None where a check failed and `force` was not given
    @property
    def file(self) -> str: ...  # name of the program, e.g. "program.ngc"
    @property
    def axes(self) -> List[str]: ...  # letters
    @property
    def positions(self) -> _Array: ...  # b x a, mm or degrees at the end of each block; the first is the start; a copy
    @property
    def positions_nano(self) -> _Array: ...  # b x a, integers of 1e-9 mm or degrees
    @property
    def time_s(self) -> _Array: ...  # b, at the end of each block; a copy
    @property
    def landing_mm(self) -> _Array: ...  # n x 3, of all pieces
    @property
    def eye_mm(self) -> _Array: ...  # n x 3
    @property
    def free_length_mm(self) -> _Array: ...  # n

class Layer:
    @property
    def kind(self) -> str: ...  # as the job has it
    @property
    def planner(self) -> str: ...
    @property
    def mandrel(self) -> Mandrel: ...  # what the layers before have left
    @property
    def layers(self) -> _Array: ...  # m, mean number of bands over each triangle
    @property
    def fibres(self) -> List[Fibre]: ...

class Layup:
    """All layers on the triangles of the bare mandrel."""
    @property
    def layers(self) -> _Array: ...  # m
    @property
    def thickness_mm(self) -> _Array: ...  # m
    @property
    def winding_angle_deg(self) -> _Array: ...  # m, mean angle to axis_1, 0 .. 90
    @property
    def area_mm2(self) -> _Array: ...  # m
    @property
    def covered_share(self) -> _Array: ...  # m
    @property
    def axis_1(self) -> _Array: ...  # m x 3, material axis 1, unit
    def plies(self) -> Dict[str, _Array]:
        """triangle, layer, fibre, course, share and angle_deg of every ply, from the bottom up in each triangle: copies."""

class Run:
    """What winding a mandrel came to."""
    @property
    def ok(self) -> bool: ...  # every check passed
    @property
    def usable(self) -> bool: ...  # the programs may be run
    @property
    def remarks(self) -> List[str]: ...
    @property
    def checks(self) -> Dict[str, Dict[str, Any]]: ...
    @property
    def report(self) -> Dict[str, Any]: ...  # docs/files.md
    @property
    def layers(self) -> List[Layer]: ...  # in winding order
    @property
    def layup(self) -> Optional[Layup]: ...  # None without a plan
    def report_text(self) -> str: ...
    def write(self, folder: _File) -> None:
        """The folder as the command line writes it."""

class Verification:
    ok: bool
    checks: Dict[str, Dict[str, Any]]
    report: Dict[str, Any]
    def __init__(self, report: Dict[str, Any]) -> None: ...

def set_threads(threads: int) -> None: ...
def load_mandrel(file: _File, job: _Job = ..., *, units: Optional[str] = ...) -> Mandrel: ...
def wind(mandrel: _File, machine: _File = ..., job: _Job = ..., *, units: Optional[str] = ..., seed: int = ...,
         effort: float = ..., force: bool = ..., progress: _Progress = ...) -> Run: ...
def verify(program: _File, mandrel: _File, machine: _File = ..., job: _Job = ..., *, plan: Optional[_File] = ...,
           units: Optional[str] = ..., seed: int = ...) -> Verification: ...
def trace(mandrel: Mandrel, start: Sequence[float], *, direction: Optional[Sequence[float]] = ...,
          angle_deg: Optional[float] = ..., to: Optional[Sequence[float]] = ..., slip_ratio: float = ...,
          length_mm: float = ..., method: str = ...) -> Path: ...
def study_mesh_size(mandrels: Sequence[_File] = ..., *, edges_mm: Sequence[float] = ..., paths: Optional[int] = ...,
                    units: Optional[str] = ..., seed: int = ..., progress: _Progress = ...) -> Dict[str, Any]: ...
