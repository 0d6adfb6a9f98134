"""Finite elements: decks of three programs read back by readers of this test, and ply stresses of a closed tube by
CalculiX against classical laminate theory."""
import json
import math
import re
import unittest

import numpy

import program

# What laminate theory and finite elements may differ by, of the largest stress of a ply: the wall is as thick as 1/50
# of its radius, which the theory leaves out (measured: 0.6 %).
LAMINATE_SHARE = 0.03
RADIUS_MM = 50.0
PLY_MM = 0.25
# What laminate theory has on the cylinder of chen_2023_gas_cylinders, and what that paper prints (Table 3, "Max. Index
# Value"): radius 40, a steel liner of 1 mm, two plies of 0.5 mm, 12 MPa.
PAPER = {"radius_mm": 40.0, "ply_mm": 0.5, "pressure_mpa": 12.0, "index": {10: 0.8548, 15: 0.8264, 20: 0.7934}}
LAMINATE_OF_PAPER_SHARE = 0.015  # what laminate theory is off the print
# What laminate theory leaves out: the plies lie 1 to 2 mm outside of the pressed radius of 40, so strain 2.5 to 5 % less;
# some of what is across the fibre is paid by the radial stress.
THICK_WALL_SHARE = 0.06
MATERIAL = {
    "name": "test ply",
    "ply": {"modulus_1_MPa": 132000, "modulus_2_MPa": 10300, "poisson_12": 0.25, "poisson_23": 0.38, "shear_12_MPa": 6500,
            "shear_23_MPa": 3730, "density_g_per_cm3": 1.57,
            "strength": {"tension_1_MPa": 2100, "compression_1_MPa": 1050, "tension_2_MPa": 24, "compression_2_MPa": 132,
                         "shear_12_MPa": 75}},
    "matrix": {"modulus_MPa": 3500, "poisson": 0.35},
}


def tube(angles_deg, edge_mm, length_mm, bare=(), radius_mm=RADIUS_MM, ply_mm=PLY_MM):
    """layup.json of a tube about Z, with plies of the given angles to it."""
    around = round(2 * math.pi * radius_mm / edge_mm)
    along = round(length_mm / edge_mm)
    points = [[radius_mm * math.cos(2 * math.pi * (i + 0.5 * (k % 2)) / around),
               radius_mm * math.sin(2 * math.pi * (i + 0.5 * (k % 2)) / around), length_mm * (k / along - 0.5)]
              for k in range(along + 1) for i in range(around)]
    triangles = []
    for k in range(along):
        for i in range(around):
            low, high = k * around, (k + 1) * around
            j = (i + 1) % around
            pair = ([(low + i, low + j, high + i), (low + j, high + j, high + i)] if k % 2 == 0 else
                    [(low + i, low + j, high + j), (low + i, high + j, high + i)])
            for corners in pair:
                a, b, c = (numpy.array(points[p]) for p in corners)
                normal = numpy.cross(b - a, c - a)
                area = 0.5 * numpy.linalg.norm(normal)
                axis_1 = numpy.array([0.0, 0.0, 1.0]) - normal * normal[2] / (normal @ normal)
                axis_1 /= numpy.linalg.norm(axis_1)
                axis_2 = numpy.cross(normal, axis_1)
                axis_2 /= numpy.linalg.norm(axis_2)
                plies = [] if len(triangles) in bare else [[1, 1, 0, angle, ply_mm] for angle in angles_deg]
                triangles.append({"points": list(corners), "region": 0, "area_mm2": area, "layers": len(plies),
                                  "thickness_mm": ply_mm * len(plies), "axis_1": axis_1.tolist(),
                                  "axis_2": axis_2.tolist(), "plies": plies})
    return {"schema": "meshwind-layup-1", "meshwind": "0", "frame": "mandrel",
            "tow": {"width_mm": 5, "thickness_mm": ply_mm}, "layers": [{"layer": 1, "planner": "pattern"}],
            "ply_columns": ["layer", "fibre", "course", "angle_deg", "thickness_mm"], "points_mm": points,
            "triangles": triangles}


def laminate_stress(angles_deg, pressure_mpa, radius_mm=RADIUS_MM, ply_mm=PLY_MM, liner=None):
    """Along, across and shear of each ply of a closed tube by classical laminate theory."""
    ply = MATERIAL["ply"]
    nu_21 = ply["poisson_12"] * ply["modulus_2_MPa"] / ply["modulus_1_MPa"]
    free = 1 - ply["poisson_12"] * nu_21
    q = numpy.array([[ply["modulus_1_MPa"] / free, nu_21 * ply["modulus_1_MPa"] / free, 0],
                     [nu_21 * ply["modulus_1_MPa"] / free, ply["modulus_2_MPa"] / free, 0], [0, 0, ply["shear_12_MPa"]]])

    def strain_turn(angle_deg):
        c, s = math.cos(math.radians(angle_deg)), math.sin(math.radians(angle_deg))
        return numpy.array([[c * c, s * s, c * s], [s * s, c * c, -c * s], [-2 * c * s, 2 * c * s, c * c - s * s]])

    turns = [strain_turn(angle) for angle in angles_deg]
    stiffness = sum(ply_mm * turn.T @ q @ turn for turn in turns)
    if liner:
        nu = liner["poisson"]
        stiffness = stiffness + liner["thickness_mm"] * liner["modulus_MPa"] / (1 - nu * nu) * numpy.array(
            [[1, nu, 0], [nu, 1, 0], [0, 0, 0.5 * (1 - nu)]])
    strain = numpy.linalg.solve(stiffness, [0.5 * pressure_mpa * radius_mm, pressure_mpa * radius_mm, 0])
    return [q @ turn @ strain for turn in turns]


def reserve(stress):
    """How many times the stress the criterion of Tsai and Wu allows, from its roots."""
    x, xc, y, yc, s = (MATERIAL["ply"]["strength"][key] for key in (
        "tension_1_MPa", "compression_1_MPa", "tension_2_MPa", "compression_2_MPa", "shear_12_MPa"))
    one, two, shear = stress
    square = one ** 2 / (x * xc) + two ** 2 / (y * yc) + (shear / s) ** 2 - one * two / math.sqrt(x * xc * y * yc)
    linear = one * (1 / x - 1 / xc) + two * (1 / y - 1 / yc)
    return max(numpy.roots([square, linear, -1.0]))


def keyword_blocks(text):
    """(keyword with its parameters, lines) of a deck of Abaqus or CalculiX."""
    blocks = []
    for line in text.splitlines():
        if line.startswith("**"):
            continue
        if line.startswith("*"):
            words = [word.strip() for word in line[1:].split(",")]
            blocks.append((words[0], dict(word.split("=") for word in words[1:] if "=" in word), []))
        else:
            blocks[-1][2].append([cell.strip() for cell in line.split(",")])
    return blocks


def large_fields(text):
    """Cards of a Nastran deck in large field format: (name, fields)."""
    cards = []
    for line in text[text.index("BEGIN BULK"):].splitlines()[1:]:
        if line.startswith("*"):
            fields = cards[-1][1]
            fields += [None] * (-len(fields) % 4)
        elif line[:8].rstrip().endswith("*"):
            fields = []
            cards.append((line[:8].rstrip(" *"), fields))
        else:
            continue
        fields += [line[k:k + 16].strip() or None for k in range(8, len(line), 16)]
    return cards


class Strength(program.ProgramTest):
    def setUp(self):
        super().setUp()
        self.write("ply.json", json.dumps(MATERIAL))

    def write_tube(self, *arguments, **more):
        layup = tube(*arguments, **more)
        self.write("layup.json", json.dumps(layup))
        return layup

    def deck(self, form, *more):
        self.done("export", "fe", "layup.json", "--material", "ply.json", "--merge", "0", "--format", form, "-o", "deck", *more)
        return (self.folder / "deck").read_text()

    def assert_balanced(self, points, forces, triangles, pressure):
        """What pulls at the nodes and what presses on the triangles."""
        force, moment = numpy.zeros(3), numpy.zeros(3)
        for node, pull in forces:
            force += pull
            moment += numpy.cross(points[node], pull)
        for a, b, c in (tuple(points[p] for p in corners) for corners in triangles):
            push = 0.5 * pressure * numpy.cross(b - a, c - a)
            force += push
            moment += numpy.cross((a + b + c) / 3, push)
        whole = pressure * math.pi * RADIUS_MM ** 2
        self.assertLess(numpy.linalg.norm(force), 1e-6 * whole)
        self.assertLess(numpy.linalg.norm(moment), 1e-6 * whole * RADIUS_MM)

    def directions(self, triangle):
        axis_1, axis_2 = (numpy.array(triangle[key]) for key in ("axis_1", "axis_2"))
        return [math.cos(math.radians(ply[3])) * axis_1 + math.sin(math.radians(ply[3])) * axis_2
                for ply in triangle["plies"]]

    def test_calculix_deck(self):
        layup = self.write_tube((30, -30, 90), 15.0, 60.0, bare={4})
        blocks = keyword_blocks(self.deck("calculix", "--pressure", "2"))
        self.assertNotIn("DISTRIBUTION", [block[0] for block in blocks])
        axes = {block[1]["NAME"]: [float(cell) for cell in block[2][0]] for block in blocks if block[0] == "ORIENTATION"}
        sections = [block for block in blocks if block[0] == "SHELL SECTION"]
        self.assertEqual(len(sections), len(layup["triangles"]))
        rows = {len(block[2]) for block in sections}
        self.assertEqual(len(rows), 1)  # CalculiX wants as many plies on every element
        for number, (section, triangle) in enumerate(zip(sections, layup["triangles"]), 1):
            plies = [row for row in section[2] if row[2] == "UD"]
            self.assertEqual([row[3] for row in plies], [f"O{number}_{k + 1}" for k in range(len(triangle["plies"]))])
            self.assertTrue(numpy.allclose([float(row[0]) for row in plies], [ply[4] for ply in triangle["plies"]]))
            for row, along in zip(plies, self.directions(triangle)):
                self.assertLess(numpy.linalg.norm(numpy.array(axes[row[3]][:3]) - along), 1e-9)
        bare = [row for row in sections[4][2] if float(row[0]) > 0.01]
        self.assertEqual([row[2] for row in bare], ["MATRIX"])

    def test_abaqus_deck(self):
        layup = self.write_tube((30, -30, 90), 15.0, 60.0, bare={4})
        blocks = keyword_blocks(self.deck("abaqus", "--pressure", "2"))
        named = {block[0]: block[2] for block in blocks}
        points = numpy.array([[float(cell) for cell in row[1:]] for row in named["NODE"]])
        self.assertLess(abs(points - numpy.array(layup["points_mm"])).max(), 1e-9)
        triangles = [[int(cell) - 1 for cell in row[1:]] for row in named["ELEMENT"]]
        self.assertEqual(triangles, [triangle["points"] for triangle in layup["triangles"]])
        axes = [numpy.array([float(cell) for cell in row[1:4]]) for row in named["DISTRIBUTION"][1:]]
        across = [numpy.array([float(cell) for cell in row[4:7]]) for row in named["DISTRIBUTION"][1:]]
        sections = [block[2] for block in blocks if block[0] == "SHELL SECTION"]
        for section, triangle, one, two in zip(sections, layup["triangles"], axes, across, strict=True):
            plies = [row for row in section if row[2] == "UD"]
            for row, ply, along in zip(plies, triangle["plies"], self.directions(triangle), strict=True):
                self.assertAlmostEqual(float(row[0]), ply[4], places=9)
                angle = math.radians(float(row[3]))
                self.assertLess(numpy.linalg.norm(math.cos(angle) * one + math.sin(angle) * two - along), 1e-9)
        forces = [(int(row[0]) - 1, float(row[2]) * numpy.eye(3)[int(row[1]) - 1]) for row in named["CLOAD"]]
        self.assert_balanced(points, forces, triangles, float(named["DLOAD"][0][2]))

    def test_nastran_deck(self):
        layup = self.write_tube((30, -30, 90), 15.0, 60.0, bare={4})
        cards = large_fields(self.deck("nastran", "--pressure", "2"))
        points = numpy.array([[float(cell) for cell in fields[2:5]] for name, fields in cards if name == "GRID"])
        self.assertLess(abs(points - numpy.array(layup["points_mm"])).max(), 1e-9)
        shells = [fields for name, fields in cards if name == "CTRIA3"]
        sections = {fields[0]: fields[8:] for name, fields in cards if name == "PCOMP"}
        triangles = []
        for shell, triangle in zip(shells, layup["triangles"], strict=True):
            corners = [int(cell) - 1 for cell in shell[2:5]]
            triangles.append(corners)
            a, b, c = points[corners]
            side = (b - a) / numpy.linalg.norm(b - a)
            square = numpy.cross(numpy.cross(b - a, c - a), side)
            square /= numpy.linalg.norm(square)
            rows = [sections[shell[1]][k:k + 4] for k in range(0, len(sections[shell[1]]), 4)]
            plies = [row for row in rows if row[0] == "1"]
            for row, ply, along in zip(plies, triangle["plies"], self.directions(triangle), strict=True):
                self.assertAlmostEqual(float(row[1]), ply[4], places=9)
                angle = math.radians(float(shell[5]) + float(row[2]))
                self.assertLess(numpy.linalg.norm(math.cos(angle) * side + math.sin(angle) * square - along), 1e-9)
        forces = [(int(fields[1]) - 1, float(fields[3]) * numpy.array([float(cell) for cell in fields[4:7]]))
                  for name, fields in cards if name == "FORCE"]
        pressures = {float(fields[1]) for name, fields in cards if name == "PLOAD2"}
        self.assertEqual(pressures, {2.0})
        self.assert_balanced(points, forces, triangles, 2.0)

    def test_loads_between_rims(self):
        self.write_tube((45, -45), 15.0, 90.0)
        blocks = keyword_blocks(self.deck("abaqus", "--axial", "1000", "--moment", "3000,-2000,5000"))
        named = {block[0]: block[2] for block in blocks}
        self.assertNotIn("DLOAD", named)
        points = numpy.array([[float(cell) for cell in row[1:]] for row in named["NODE"]])
        for end, sign in ((45.0, 1.0), (-45.0, -1.0)):
            force, moment = numpy.zeros(3), numpy.zeros(3)
            for row in named["CLOAD"]:
                point = points[int(row[0]) - 1]
                if abs(point[2] - end) < 1e-6:
                    pull = float(row[2]) * numpy.eye(3)[int(row[1]) - 1]
                    force += pull
                    moment += numpy.cross(point, pull)
            self.assertLess(numpy.linalg.norm(force - sign * numpy.array([0, 0, 1000])), 1e-6)
            self.assertLess(numpy.linalg.norm(moment - sign * numpy.array([3000, -2000, 5000])), 1e-5)

    def test_closed_tube_by_laminate_theory(self):
        for angle in (54.74, 30.0):
            with self.subTest(angle=angle):
                angles = (angle, -angle, -angle, angle)
                layup = self.write_tube(angles, RADIUS_MM / 8, 3 * RADIUS_MM)
                result = json.loads(self.done("strength", "layup.json", "--material", "ply.json", "--merge", "0",
                                              "-o", "out", "--json").stdout)
                expected = laminate_stress(angles, 1.0)
                largest = numpy.abs(expected).max()
                for mean, wanted in zip(self.stresses_amid(layup, len(angles), RADIUS_MM), expected):
                    self.assertLess(numpy.abs(mean - wanted).max(), LAMINATE_SHARE * largest, (mean, wanted))
                self.assertEqual(result["plies"]["most"], 4)
                self.assertGreater(result["first_failure"]["reserve"], 0)

    def stresses_amid(self, layup, plies, radius_mm):
        """Mean stresses of each ply in the middle of a tube, away from its rims."""
        sums = numpy.zeros((plies, 3))
        count = numpy.zeros(plies)
        middle = {number for number, triangle in enumerate(layup["triangles"], 1)
                  if all(abs(layup["points_mm"][p][2]) < 0.5 * radius_mm for p in triangle["points"])}
        for line in (self.folder / "out/strength.dat").read_text().splitlines():
            cells = line.split()
            ply = re.match(r"O(\d+)_(\d+)", cells[8]) if len(cells) > 8 else None
            if ply and int(cells[0]) in middle:
                sums[int(ply[2]) - 1] += [float(cells[k]) for k in (2, 3, 5)]
                count[int(ply[2]) - 1] += 1
        return sums / count[:, None]

    def test_cylinder_of_a_paper(self):
        lined = {**MATERIAL, "liner": {"modulus_MPa": 200000, "poisson": 0.3, "thickness_mm": 1.0}}
        self.write("lined.json", json.dumps(lined))
        for angle, index in PAPER["index"].items():
            with self.subTest(angle=angle):
                layup = self.write_tube((angle, -angle), 7.0, 120.0, radius_mm=PAPER["radius_mm"],
                                        ply_mm=PAPER["ply_mm"])
                self.done("strength", "layup.json", "--material", "lined.json", "--merge", "0", "-o", "out",
                          "--pressure", PAPER["pressure_mpa"])
                thin = laminate_stress((angle, -angle), PAPER["pressure_mpa"], PAPER["radius_mm"], PAPER["ply_mm"],
                                       lined["liner"])
                for stress, laminate in zip(self.stresses_amid(layup, 2, PAPER["radius_mm"]), thin, strict=True):
                    self.assertAlmostEqual(1.0 / reserve(laminate) / index, 1.0, delta=LAMINATE_OF_PAPER_SHARE)
                    self.assertAlmostEqual(reserve(laminate) / reserve(stress), 1.0, delta=THICK_WALL_SHARE)

    def test_what_cannot_be(self):
        layup = self.write_tube((30,), 30.0, 60.0)
        weak = json.loads(json.dumps(MATERIAL))
        del weak["ply"]["strength"]
        unstable = json.loads(json.dumps(MATERIAL))
        unstable["ply"]["poisson_23"] = 0.98
        unstable["ply"]["modulus_2_MPa"] = 132000
        far = json.loads(json.dumps(layup))
        far["triangles"][3]["points"][1] = 100000
        self.write("weak.json", json.dumps(weak))
        self.write("unstable.json", json.dumps(unstable))
        self.write("far.json", json.dumps(far))
        for words, arguments in (
                ("has no strengths", ("strength", "layup.json", "--material", "weak.json")),
                ("no elastic body", ("export", "fe", "layup.json", "--material", "unstable.json")),
                ("/triangles/3/points/1", ("export", "fe", "far.json", "--material", "ply.json")),
                ("rims 1 to 2", ("export", "fe", "layup.json", "--material", "ply.json", "--axial", "1", "--rims", "1,3")),
                ("from 1", ("export", "fe", "layup.json", "--material", "ply.json", "--axial", "1", "--rims", "2")),
                ("none.json", ("export", "fe", "layup.json", "--material", "none.json"))):
            with self.subTest(words=words):
                result = self.run_program(*arguments)
                self.assertEqual(result.returncode, 2, result.stderr)
                self.assertEqual(len(result.stderr.splitlines()), 1, result.stderr)
                self.assertIn(words, result.stderr)
                self.assertFalse((self.folder / "wall.inp").exists())


if __name__ == "__main__":
    program.main(__name__)
