"""Lay-up and fibre as others read them: layup.vtu by VTK, layup.json by json, fibre.obj and fibre.step line by line.

fibre.step is read by step_file.py; Open Cascade 7.6.3 (occt-draw, stepread and lprops), too large to be installed for
this, was given the file of the first test by hand: one edge for each piece, lengths within 2e-6 of path.csv's.
"""
import csv
import json
import math
import sys

import program
from step_file import StepError, StepFile
from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader

CHORD_MM = 0.01      # of fibre_lines.h
ROUNDING_MM = 2e-4   # four decimals, of stations and of the polyline
THICKNESS_MM = 0.25
WIDTH_MM = 6.0
QUANTITIES = [("layers", ""), ("thickness", "_mm"), ("fibre_angle_to_spindle", "_deg"), ("winding_angle", "_deg"),
              ("area", "_mm2"), ("covered_share", "")]


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def minus(a, b):
    return [x - y for x, y in zip(a, b)]


def distance(point, a, b):
    step = minus(b, a)
    share = min(1.0, max(0.0, dot(minus(point, a), step) / dot(step, step)))
    return math.dist(point, [x + share * s for x, s in zip(a, step)])


def length(points):
    return sum(math.dist(a, b) for a, b in zip(points, points[1:]))


def obj_lines(text):
    """Points of each object, which must be one line element."""
    points, lines, name = [], {}, None
    for line in text.splitlines():
        key, *rest = line.split()
        if key == "v":
            points.append([float(x) for x in rest])
        elif key == "o":
            (name,) = rest
        elif key == "l":
            assert name not in lines, name
            lines[name] = [points[int(i) - 1] for i in rest]
        else:
            assert key == "#", line
    return lines


def numbers_of(arrays):
    """Names of the arrays that have numbers, not directions."""
    return {name for name, values in arrays.items() if not isinstance(values[0], tuple)}


class Layup(program.ProgramTest):
    def wind(self, layers):
        mandrel = self.make("cylinder", "--radius", "40", "--length", "150", "--edge", "6")
        job = self.write("job.json", json.dumps(
            {"layers": layers, "tow": {"width": WIDTH_MM, "thickness": THICKNESS_MM},
             "redundancy": "central-angle"}))
        self.done(mandrel, "--machine", "six_axis.json", "--job", job, "-o", "out")
        return json.loads(self.read("report.json"))

    def read(self, name):
        return (self.folder / "out" / name).read_text()

    def grid(self):
        reader = vtkXMLUnstructuredGridReader()
        reader.SetFileName(str(self.folder / "out" / "layup.vtu"))
        reader.Update()
        self.assertEqual(reader.GetErrorCode(), 0)
        return reader.GetOutput()

    def arrays(self, grid):
        data = grid.GetCellData()
        names = [data.GetArrayName(i) for i in range(data.GetNumberOfArrays())]
        arrays = {}
        for name in names:
            array = data.GetArray(name)
            read = array.GetTuple1 if array.GetNumberOfComponents() == 1 else array.GetTuple3
            arrays[name] = [read(f) for f in range(grid.GetNumberOfCells())]
        self.assertEqual(len(arrays), len(names))
        return arrays

    def check_areas(self, grid, arrays, report):
        self.assertEqual(grid.GetNumberOfCells(), report["mandrel"]["triangles"])
        for f in range(0, grid.GetNumberOfCells(), 7):
            self.assertAlmostEqual(grid.GetCell(f).ComputeArea(), arrays["area_mm2"][f], places=5)
        self.assertAlmostEqual(sum(arrays["area_mm2"]) / report["mandrel"]["area_mm2"], 1.0, 9)
        self.assertEqual({int(r) for r in arrays["region"]},
                         {r["id"] for r in report["mandrel"]["regions"] if r["kept"]})

    def check_ranges(self, arrays):
        for name, values in arrays.items():
            if "deg" in name:
                self.assertTrue(all(0.0 <= v <= 90.0 for v in values), name)
            if "covered" in name:
                self.assertTrue(all(0.0 <= v <= 1.0 for v in values), name)

    def samples_give(self, arrays, of, coverage):
        """The samples weigh the triangles as report.json does."""
        samples = arrays["samples" + of]
        mean = dot(samples, arrays["layers" + of]) / sum(samples)
        self.assertAlmostEqual(mean, coverage["mean_layers"], delta=1e-6)
        covered = dot(samples, arrays["covered_share" + of]) / sum(samples)
        self.assertAlmostEqual(covered, coverage["fraction"], delta=1e-6)

    def check_triangles(self, layup, arrays, layers):
        """Frames and sums of layup.json. Returns all plies with their triangles."""
        points = layup["points_mm"]
        self.assertEqual(layup["ply_columns"], ["layer", "fibre", "course", "angle_deg", "thickness_mm"])
        self.assertEqual([entry["layer"] for entry in layup["layers"]], list(range(1, layers + 1)))
        self.assertEqual(len(layup["triangles"]), len(arrays["layers"]))
        all_plies = []
        for f, triangle in enumerate(layup["triangles"]):
            a, b, c = (points[i] for i in triangle["points"])
            normal = cross(minus(b, a), minus(c, a))
            twice = math.sqrt(dot(normal, normal))
            normal = [x / twice for x in normal]
            self.assertGreater(dot(normal, a), 0.0)  # outward
            one, two = triangle["axis_1"], triangle["axis_2"]
            for value, expected in ((dot(one, one), 1), (dot(two, two), 1), (dot(one, two), 0), (dot(one, normal), 0),
                                    (dot(cross(one, two), normal), 1)):
                self.assertAlmostEqual(value, expected, delta=1e-5)
            self.assertGreater(one[2], 0.99)
            self.assertAlmostEqual(triangle["area_mm2"], 0.5 * twice, delta=1e-4)
            plies = triangle["plies"]
            self.assertEqual(plies, sorted(plies, key=lambda p: p[:3]))  # in winding order
            self.assertTrue(all(0 < p[4] <= THICKNESS_MM and -90 < p[3] <= 90 for p in plies))
            thickness = sum(p[4] for p in plies)
            self.assertAlmostEqual(thickness, triangle["thickness_mm"], delta=1e-5)
            self.assertAlmostEqual(triangle["thickness_mm"], THICKNESS_MM * triangle["layers"], delta=1e-5)
            self.assertAlmostEqual(triangle["layers"], arrays["layers"][f], delta=1e-5)
            self.assertAlmostEqual(triangle["thickness_mm"], arrays["thickness_mm"][f], delta=1e-5)
            angle = sum(p[4] * abs(p[3]) for p in plies) / thickness
            self.assertAlmostEqual(angle, arrays["winding_angle_deg"][f], delta=1e-2)
            self.check_directions(triangle, arrays, f)
            all_plies += [(triangle, ply) for ply in plies]
        return all_plies

    def check_directions(self, triangle, arrays, f):
        """The vectors of layup.vtu are those of layup.json."""
        one, two = triangle["axis_1"], triangle["axis_2"]
        wanted = {"axis_1": one}
        for k in range(1, 13):
            if f"fibre_direction_of_ply_{k}" in arrays:
                wanted[f"fibre_direction_of_ply_{k}"] = [0.0, 0.0, 0.0]
        for k, ply in enumerate(triangle["plies"][:12], 1):
            angle = math.radians(ply[3])
            wanted[f"fibre_direction_of_ply_{k}"] = [math.cos(angle) * a + math.sin(angle) * b for a, b in zip(one, two)]
        for name, vector in wanted.items():
            # A line has two senses: at 90 degrees rounding takes either.
            sense = -1.0 if name != "axis_1" and dot(arrays[name][f], vector) < 0.0 else 1.0
            for found, expected in zip(arrays[name][f], vector):
                self.assertAlmostEqual(sense * found, expected, delta=2e-4)

    def pieces(self, suffix):
        pieces = {}
        with (self.folder / "out" / f"path{suffix}.csv").open(newline="") as stream:
            for row in csv.DictReader(stream):
                pieces.setdefault(f"{row['kind']}_{row['course']}", []).append(
                    [float(row[k]) for k in ("x_mm", "y_mm", "z_mm")])
        return pieces

    def check_fibre(self, suffix):
        pieces = self.pieces(suffix)
        step = StepFile(self.read(f"fibre{suffix}.step")).polylines()
        self.assertEqual(list(step), list(pieces))
        self.assertEqual(obj_lines(self.read(f"fibre{suffix}.obj")), step)
        for name, stations in pieces.items():
            line = step[name]
            self.assertEqual((line[0], line[-1]), (stations[0], stations[-1]))
            self.assertTrue(all(point in stations for point in line))
            first = 0  # of the polyline's points: stations come in order
            for station in stations:
                while first + 2 < len(line) and station == line[first + 1]:
                    first += 1
                self.assertLessEqual(distance(station, line[first], line[first + 1]), CHORD_MM + ROUNDING_MM)
            # Along a chord each step loses no more than stepping from one side of the band to the other.
            lost = sum(h - math.sqrt(max(0.0, h * h - 4 * (CHORD_MM + ROUNDING_MM) ** 2))
                       for h in (math.dist(a, b) for a, b in zip(stations, stations[1:])))
            self.assertLessEqual(length(line), length(stations) + 1e-9)
            self.assertGreaterEqual(length(line), length(stations) - lost)
        return pieces

    def test_one_layer(self):
        report = self.wind([{"kind": "helical", "angle": 50}])
        grid = self.grid()
        arrays = self.arrays(grid)
        self.assertEqual(numbers_of(arrays), {q + unit for q, unit in QUANTITIES} | {"samples", "region"})
        self.check_areas(grid, arrays, report)
        self.check_ranges(arrays)
        self.samples_give(arrays, "", report["plan"]["coverage"])
        layup = json.loads(self.read("layup.json"))
        self.assertEqual(layup["tow"], {"width_mm": WIDTH_MM, "thickness_mm": THICKNESS_MM})
        plies = self.check_triangles(layup, arrays, 1)
        pieces = self.check_fibre("")

        # Both hands of the pattern's angle, and as much of one as of the other.
        angle = report["plan"]["pattern"]["angle_deg"]
        for triangle, ply in plies:
            # Within a tow width of a rim there are bands whose middle is beyond it, where the fibre begins to turn.
            at_rim = any(abs(layup["points_mm"][i][2]) > 75.0 - WIDTH_MM for i in triangle["points"])
            self.assertAlmostEqual(abs(ply[3]), angle, delta=1.0 if at_rim else 0.1)
        volume = {hand: sum(t["area_mm2"] * p[4] for t, p in plies if (p[3] > 0) == hand) for hand in (True, False)}
        self.assertAlmostEqual(volume[True] / volume[False], 1.0, delta=0.02)
        # What lies there is the laid fibre but for the turns, which lie on the extensions.
        laid = sum(length(points) for name, points in pieces.items() if name.startswith("course"))
        self.assertAlmostEqual(sum(volume.values()) / (laid * WIDTH_MM * THICKNESS_MM), 1.0, delta=0.03)

        # Which hand a course has follows from path.csv: on a left-hand screw the way up goes clockwise.
        for triangle, (layer, fibre, course, angle_deg, _) in plies[::11]:
            self.assertEqual((layer, fibre), (1, 1))
            a, b = pieces[f"course_{course}"][:2]
            out = [a[0], a[1], 0.0]
            up = math.copysign(1.0, b[2] - a[2])
            around = dot(cross([0, 0, 1], out), minus(b, a)) * up
            # Axis 2 is outward x up, which is clockwise about the spindle.
            self.assertEqual(angle_deg > 0, around < 0, (course, triangle["points"]))

        # A ply lies where its course passes: no corner of the triangle is further off than band and triangle are.
        for triangle, ply in plies[::37]:
            corner = layup["points_mm"][triangle["points"][0]]
            nearest = min(math.dist(corner, station) for station in pieces[f"course_{ply[2]}"])
            self.assertLess(nearest, WIDTH_MM / 2 + 8.0 + 4.0 / 2)

    def test_layers_of_their_own(self):
        report = self.wind([{"kind": "helical", "angle": 45}, {"kind": "hoop"}])
        grid = self.grid()
        arrays = self.arrays(grid)
        names = {q + of + unit for q, unit in QUANTITIES for of in ("", "_of_layer_1", "_of_layer_2")}
        self.assertEqual(numbers_of(arrays), names | {"samples_of_layer_1", "samples_of_layer_2", "region"})
        self.check_areas(grid, arrays, report)
        self.check_ranges(arrays)
        for number in (1, 2):
            self.samples_give(arrays, f"_of_layer_{number}", report["layers"][number - 1]["plan"]["coverage"])
        area, layers = arrays["area_mm2"], arrays["layers"]
        coverage = report["plan"]["coverage"]
        self.assertAlmostEqual(dot(area, layers) / sum(area), coverage["mean_layers"], delta=1e-6)
        self.assertAlmostEqual(dot(area, arrays["covered_share"]) / sum(area), coverage["fraction"], delta=1e-6)
        self.assertAlmostEqual(max(layers), coverage["max_layers"], delta=1e-6)
        for f, total in enumerate(layers):
            self.assertAlmostEqual(arrays["layers_of_layer_1"][f] + arrays["layers_of_layer_2"][f], total, delta=1e-9)
        # The second layer lies on a wall that has grown by the first.
        grown = sum(arrays["area_of_layer_2_mm2"]) / sum(arrays["area_of_layer_1_mm2"])
        mean = report["layers"][0]["thickness_mm"]["mean"]
        self.assertAlmostEqual(grown, 1.0 + mean / 40.0, delta=1e-4)

        plies = self.check_triangles(json.loads(self.read("layup.json")), arrays, 2)
        for _, (layer, _, _, angle_deg, _) in plies:
            hoop = math.degrees(math.atan(2 * math.pi * 40.0 / WIDTH_MM))
            self.assertAlmostEqual(abs(angle_deg), 45.0 if layer == 1 else hoop, delta=1.0 if layer == 1 else 1.5)
        for suffix in ("", "-layer-2"):
            self.check_fibre(suffix)

    def test_a_wall_against_what_was_asked_for(self):
        report = self.wind([{"kind": "wall", "layers": 2, "parts": [{"rim": 0, "within": 30, "layers": 4}]}])
        arrays = self.arrays(self.grid())
        asked, laid = arrays["wall_layers_asked"], arrays["wall_layers_laid"]
        rim = report["mandrel"]["rims"][0]["centre"]
        points = json.loads(self.read("layup.json"))
        for f, triangle in enumerate(points["triangles"]):
            # Of a cylinder: the way to the rim's circle is along the axis, but for the facets' depth.
            off = abs(sum(points["points_mm"][i][2] for i in triangle["points"]) / 3.0 - rim[2])
            if abs(off - 30.0) > 0.1:
                self.assertEqual(asked[f], 4 if off < 30.0 else 2)
        stages = range(1, len(report["layers"]) + 1)
        for f, layers in enumerate(laid):
            self.assertAlmostEqual(sum(arrays[f"layers_of_layer_{n}"][f] for n in stages), layers, delta=1e-9)
        area = arrays["area_mm2"]
        mean = sum(a * layers / n for a, layers, n in zip(area, laid, asked)) / sum(area)
        # The figure is of samples; triangles across the edge of the thick part are asked for as their middle is.
        self.assertAlmostEqual(mean, report["walls"][0]["mean_over_asked"], delta=0.03)

    def test_the_reader_of_step_files_is_strict(self):
        self.wind([{"kind": "hoop"}])
        text = self.read("fibre.step")
        StepFile(text)
        for old, new in (("=POLYLINE('course_0',(", "=POLYLINE('course_0',("  "#1,"), ("CARTESIAN_POINT", "CARTESIAN_DOT"),
                         (";\nENDSEC;\nEND-ISO", "\nENDSEC;\nEND-ISO"), ("#12=", "#11="), (".0000,", ".0000,,")):
            self.assertIn(old, text)
            with self.assertRaises(StepError, msg=new):
                StepFile(text.replace(old, new, 1))


if __name__ == "__main__":
    program.main(sys.modules[__name__])
