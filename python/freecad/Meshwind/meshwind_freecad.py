"""A part of a FreeCAD document wound by meshwind, and what came of it as objects of the document.

Nothing here needs a window: macros and freecadcmd call it as the workbench does.

    import meshwind_freecad as winding
    file = winding.write_part(document.Tee, "out")
    end = winding.wind(file, "out/run", machine="six_axis.json", settings={"tow.width": 8})
    winding.show_run(document, "out/run")
"""
import json
import os
import shutil
import subprocess
from dataclasses import dataclass
from pathlib import Path

import FreeCAD
import Mesh
import Part

THICKNESS_CLASSES = 8
# From thin to thick: dark to light, told apart with colour blindness too (viridis).
CLASS_COLOURS = [(0.27, 0.00, 0.33), (0.27, 0.20, 0.50), (0.21, 0.36, 0.55), (0.15, 0.50, 0.56),
                 (0.12, 0.63, 0.53), (0.29, 0.76, 0.43), (0.63, 0.85, 0.22), (0.99, 0.91, 0.14)]
FIBRE_COLOUR = (0.10, 0.10, 0.12)


class WindingError(Exception):
    """What meshwind says is wrong, in a line."""


@dataclass
class End:
    """How a run ended."""
    folder: Path
    passed: bool  # else a check failed: the plan can be looked at, there is no program
    text: str     # meshwind's summary


def find_program():
    """The program: $MESHWIND, the one of the workbench's settings, or the one in PATH."""
    settings = FreeCAD.ParamGet("User parameter:BaseApp/Preferences/Mod/Meshwind")
    for program in (os.environ.get("MESHWIND"), settings.GetString("Program"), shutil.which("meshwind")):
        if program:
            return program
    raise WindingError("meshwind is not in PATH; install it, or name it in the settings of the workbench")


def write_part(part, folder):
    """The part as a file that meshwind reads, in the document's frame and mm: exact faces of a shape (.brep), or the
    triangles of a mesh (.stl). Returns the file."""
    folder = Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    if part.isDerivedFrom("Mesh::Feature"):
        file = folder / f"{part.Name}.stl"
        part.Mesh.write(str(file))
        return file
    shape = getattr(part, "Shape", None)
    if shape is None or shape.isNull() or not shape.Faces:
        raise WindingError(f"{part.Label} has no faces: choose a solid, a shell or a mesh")
    file = folder / f"{part.Name}.brep"
    shape.exportBrep(str(file))
    return file


def arguments(file, out, machine="six_axis.json", job="", settings=None, effort=1.0):
    """The command line of a run."""
    words = [str(file), "--machine", str(machine), "--units", "mm", "--effort", str(effort), "-o", str(out)]
    if job:
        words += ["--job", str(job)]
    for key, value in (settings or {}).items():
        words += ["--set", f"{key}={value}"]
    return words


def environment():
    """That of other programs: FreeCAD's own libraries are not theirs."""
    return {name: value for name, value in os.environ.items() if name not in ("LD_LIBRARY_PATH", "PYTHONHOME")}


def wind(file, out, **options):
    """Runs meshwind to its end; options as arguments() has them. Raises WindingError for input that cannot be wound."""
    result = subprocess.run([find_program(), *arguments(file, out, **options)], env=environment(),
                            stdin=subprocess.DEVNULL, capture_output=True, text=True, check=False)
    return end_of_run(result.returncode, result.stdout, result.stderr, out)


def end_of_run(code, output, errors, out):
    """What an exit code of meshwind means."""
    if code not in (0, 1):
        lines = errors.strip().splitlines()
        raise WindingError(lines[-1] if lines else f"meshwind ended with code {code}")
    return End(Path(out), code == 0, output)


def fibre_lines(file):
    """(name, points) of each course and transition of a fibre*.obj, in winding order."""
    points, lines, name = [], [], ""
    for line in Path(file).read_text().splitlines():
        words = line.split()
        if not words:
            continue
        if words[0] == "v":
            points.append(FreeCAD.Vector(*map(float, words[1:4])))
        elif words[0] == "o":
            name = words[1]
        elif words[0] == "l":
            lines.append((name, [points[int(word) - 1] for word in words[1:]]))
    return lines


def to_document(report):
    """Where the mandrel's frame stands in the document."""
    rows = report["mandrel"]["file_to_mandrel"]
    return FreeCAD.Placement(FreeCAD.Matrix(*(value for row in rows for value in row)).inverse())


def show_run(document, folder, name="Winding"):
    """What a run made, as a group of the document: its report, the fibre as a wire for each course, the wall by
    thickness. Returns the group."""
    folder = Path(folder)
    report = json.loads((folder / "report.json").read_text())
    group = document.addObject("App::DocumentObjectGroup", name)
    group.addObject(report_object(document, report, folder))
    placement = to_document(report)
    for file in sorted(folder.glob("fibre*.obj"), key=natural_order):
        fibre = document.addObject("App::DocumentObjectGroup", "Fibre")
        fibre.Label = file.stem
        for label, points in fibre_lines(file):
            if len(points) > 1:
                wire = document.addObject("Part::Feature", "Course" if label.startswith("course") else "Transition")
                wire.Label = label
                wire.Shape = Part.makePolygon(points)
                wire.Placement = placement
                colour(wire, FIBRE_COLOUR, line=True)
                fibre.addObject(wire)
        group.addObject(fibre)
    if (folder / "layup.json").exists():
        group.addObject(wall_group(document, json.loads((folder / "layup.json").read_text()), placement))
    document.recompute()
    return group


def natural_order(file):
    """fibre-2 before fibre-10."""
    return [int(word) if word.isdigit() else word for word in file.stem.split("-")]


def report_object(document, report, folder):
    """The figures of a run as properties."""
    item = document.addObject("App::FeaturePython", "Report")
    failed = [check for check, told in report["checks"].items() if not told["ok"]]
    plan = report.get("plan") or {}
    program = report.get("program") or {}
    programs = sorted(str(file) for file in folder.glob("program*"))
    for kind, label, value in (
            ("App::PropertyBool", "Passed", report["ok"]),
            ("App::PropertyStringList", "FailedChecks", failed),
            ("App::PropertyString", "Machine", str(report["machine"])),
            ("App::PropertyLength", "FibreLength", plan.get("fibre_length_mm")),
            ("App::PropertyInteger", "Courses", plan.get("courses")),
            ("App::PropertyFloat", "CoveredPercent", percent(plan, "fraction")),
            ("App::PropertyFloat", "MeanLayers", (plan.get("coverage") or {}).get("mean_layers")),
            ("App::PropertyFloat", "DurationSeconds", program.get("duration_s")),
            ("App::PropertyStringList", "Programs", programs),
            ("App::PropertyPath", "Folder", str(folder))):
        if value is not None:
            item.addProperty(kind, label, "Winding")
            setattr(item, label, value)
    return item


def percent(plan, key):
    share = (plan.get("coverage") or {}).get(key)
    return None if share is None else 100.0 * share


def wall_group(document, layup, placement):
    """The wall as meshes, one for each class of thickness from thin to thick."""
    group = document.addObject("App::DocumentObjectGroup", "Wall")
    triangles = layup["triangles"]
    points = layup["points_mm"]
    thickest = max(triangle["thickness_mm"] for triangle in triangles)
    classes = [[] for _ in range(THICKNESS_CLASSES)]
    for triangle in triangles:
        share = triangle["thickness_mm"] / thickest if thickest > 0.0 else 0.0
        classes[min(int(share * THICKNESS_CLASSES), THICKNESS_CLASSES - 1)] += [points[k] for k in triangle["points"]]
    for number, corners in enumerate(classes):
        if corners:
            mesh = document.addObject("Mesh::Feature", "Thickness")
            low, high = (thickest * k / THICKNESS_CLASSES for k in (number, number + 1))
            mesh.Label = f"{low:.2f} to {high:.2f} mm"
            mesh.Mesh = Mesh.Mesh([corners[k:k + 3] for k in range(0, len(corners), 3)])
            mesh.Placement = placement
            colour(mesh, CLASS_COLOURS[number])
            group.addObject(mesh)
    return group


def colour(item, rgb, line=False):
    """Where there is a window."""
    view = getattr(item, "ViewObject", None)
    if FreeCAD.GuiUp and view is not None:
        setattr(view, "LineColor" if line else "ShapeColor", rgb)
