"""The FreeCAD workbench without a window: freecadcmd runs this file. $MESHWIND is the program, $MESHWIND_SOURCE the project."""
import json
import math
import os
import sys
import tempfile
import unittest
from pathlib import Path

import FreeCAD
import Part

SOURCE = Path(os.environ["MESHWIND_SOURCE"])
sys.path.insert(0, str(SOURCE / "python/freecad/Meshwind"))
import meshwind_freecad as winding  # noqa: E402

RADIUS_MM, LENGTH_MM = 30.0, 150.0
# What fibre may be off the exact cylinder: 0.01 mm that fibre.obj leaves out, and its chords.
OFF_MM = 0.1


class Workbench(unittest.TestCase):
    def setUp(self):
        holder = tempfile.TemporaryDirectory(prefix="meshwind-freecad-")
        self.addCleanup(holder.cleanup)
        self.folder = Path(holder.name)
        self.document = FreeCAD.newDocument("Test")
        self.addCleanup(lambda: FreeCAD.closeDocument("Test"))

    def pipe(self):
        """A pipe that stands askew in the document."""
        pipe = self.document.addObject("Part::Feature", "Pipe")
        pipe.Shape = Part.makeCylinder(RADIUS_MM, LENGTH_MM).cut(Part.makeCylinder(RADIUS_MM - 3, LENGTH_MM))
        pipe.Placement = FreeCAD.Placement(FreeCAD.Vector(100, -50, 20),
                                           FreeCAD.Rotation(FreeCAD.Vector(1, 2, 0), 40))
        return pipe

    def test_part_to_fibre_in_the_document(self):
        pipe = self.pipe()
        file = winding.write_part(pipe, self.folder)
        self.assertEqual(file.suffix, ".brep")
        end = winding.wind(file, self.folder / "run",
                           settings={"tow.width": 12, "layers.0.kind": "helical", "layers.0.angle": 50})
        self.assertTrue(end.passed, end.text)
        group = winding.show_run(self.document, end.folder)
        report = json.loads((end.folder / "report.json").read_text())
        shown = {item.Name.rstrip("0123456789"): item for item in group.Group}
        self.assertTrue(shown["Report"].Passed)
        self.assertEqual(shown["Report"].FailedChecks, [])
        self.assertEqual(shown["Report"].Courses, report["plan"]["courses"])
        wires = [item for item in shown["Fibre"].Group if item.Label.startswith("course")]
        self.assertEqual(len(wires), report["plan"]["courses"])
        length = sum(item.Shape.Length for item in shown["Fibre"].Group)
        self.assertAlmostEqual(length / report["plan"]["fibre_length_mm"], 1.0, delta=2e-3)
        # In the document the fibre lies on the pipe where it stands.
        inverse = pipe.Placement.inverse()
        for wire in wires:
            for vertex in wire.Shape.Vertexes:
                own = inverse.multVec(vertex.Point)
                self.assertLess(abs(math.hypot(own.x, own.y) - RADIUS_MM), OFF_MM)
                self.assertTrue(-1.0 < own.z < LENGTH_MM + 1.0, own)
        area = sum(item.Mesh.Area for item in shown["Wall"].Group)
        self.assertAlmostEqual(area / (2 * math.pi * RADIUS_MM * LENGTH_MM), 1.0, delta=0.01)
        self.saved_and_opened_again(len(self.document.Objects))

    def saved_and_opened_again(self, objects):
        file = self.folder / "wound.FCStd"
        self.document.saveAs(str(file))
        again = FreeCAD.openDocument(str(file))
        self.assertEqual(len(again.Objects), objects)
        FreeCAD.closeDocument(again.Name)
        self.document = FreeCAD.newDocument("Test")

    def test_mesh_is_written_as_triangles(self):
        import Mesh

        mesh = self.document.addObject("Mesh::Feature", "Bottle")
        mesh.Mesh = Mesh.createCylinder(20.0, 80.0, True, 5.0, 40)
        file = winding.write_part(mesh, self.folder)
        self.assertEqual(file.suffix, ".stl")
        self.assertGreater(file.stat().st_size, 1000)

    def test_what_cannot_be_wound_is_told(self):
        line = self.document.addObject("Part::Feature", "Line")
        line.Shape = Part.makeLine((0, 0, 0), (1, 0, 0))
        with self.assertRaisesRegex(winding.WindingError, "no faces"):
            winding.write_part(line, self.folder)
        pipe = winding.write_part(self.pipe(), self.folder)
        with self.assertRaisesRegex(winding.WindingError, "tow.width"):
            winding.wind(pipe, self.folder / "run", settings={"tow.width": -1})
        self.assertFalse((self.folder / "run").exists())


result = unittest.TextTestRunner(stream=sys.stdout, verbosity=2).run(
    unittest.defaultTestLoader.loadTestsFromTestCase(Workbench))
sys.stdout.flush()
os._exit(0 if result.wasSuccessful() else 1)  # freecadcmd would wait for commands
