#!/usr/bin/env python3
"""Winds one part from the meshes of several meshers and compares what comes of them.

    meshers.py PROGRAM [--only tee] [--folder DIR] [--set KEY=VALUE]

The parts are made by `meshwind make` and meshed again here: with edges of 2 and 8 mm, cut by planes (slivers, as marching
cubes and clipping leave them), with vertices moved along the wall and diagonals drawn by lot, in single precision; the tee of
data/meshes/cad also as a CAD program exports it, one row of facets along each pipe.

Prints a table, one line for each mesh. Exit code 0 if every mesh is wound with all checks ok, has the same rims (radius, height
and distance from the spindle within 0.1 mm) and covers as much as the program's own mesh of 4 mm, within 1 %; else 1.
"""
import argparse
import json
import math
import pathlib
import random
import struct
import subprocess
import sys
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
COVERAGE_SHARE = 0.01
RIM_MM = 0.1
PARTS = {
    "tee": ["tee", "--run-radius", 50, "--branch-radius", 40, "--blend-radius", 12, "--run-length", 400, "--branch-length", 200],
    "equal_tee": ["tee", "--run-radius", 50, "--branch-radius", 50, "--blend-radius", 15],
    "thin_branch": ["tee", "--run-radius", 50, "--branch-radius", 25, "--blend-radius", 10],
    "elbow": ["elbow"],
    "vessel": ["vessel"],
}
CAD = {"tee": "tee.stl"}
PLANES_MM = 5.0  # apart
JITTER = 0.25  # of the mean edge, along the wall
FLIPS = 0.3  # share of the edges
SHARP_COSINE = 0.8  # vertices where the wall turns by more than 37 degrees stay
COLUMNS = ["part", "mesh", "triangles", "exit_code", "covered", "checks_failed", "wall_s", "words"]


def minus(a, b):
    return [x - y for x, y in zip(a, b)]


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def read_obj(path):
    points, faces = [], []
    for line in path.read_text(encoding="utf-8").splitlines():
        word, *rest = line.split() or [""]
        if word == "v":
            points.append([float(x) for x in rest[:3]])
        elif word == "f":
            faces.append([int(x.split("/")[0]) - 1 for x in rest])
    return points, faces


def write_obj(path, points, faces):
    lines = [f"v {x!r} {y!r} {z!r}" for x, y, z in points] + [f"f {a + 1} {b + 1} {c + 1}" for a, b, c in faces]
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")


def write_stl(path, points, faces):
    data = bytearray(80) + struct.pack("<I", len(faces))
    for face in faces:
        data += struct.pack("<12fH", 0.0, 0.0, 0.0, *(x for v in face for x in points[v]), 0)
    path.write_bytes(data)


def cut_by_planes(points, faces, axis):
    """Divides triangles where planes across an axis pass through them."""
    lowest = min(p[axis] for p in points) + 0.37 * PLANES_MM
    for plane in range(int((max(p[axis] for p in points) - lowest) / PLANES_MM) + 1):
        height = lowest + plane * PLANES_MM
        middle = {}

        def crossing(a, b):
            key = (min(a, b), max(a, b))
            if key not in middle:
                p, q = points[key[0]], points[key[1]]
                share = (height - p[axis]) / (q[axis] - p[axis])
                middle[key] = len(points)
                points.append([x + share * (y - x) for x, y in zip(p, q)])
            return middle[key]

        divided = []
        for face in faces:
            side = [points[v][axis] > height for v in face]
            if all(side) or not any(side):
                divided.append(face)
                continue
            alone = side.index(sum(side) == 1)
            a, b, c = (face[(alone + k) % 3] for k in range(3))
            ab, ca = crossing(a, b), crossing(c, a)
            divided += [[a, ab, ca], [ab, b, c], [ab, c, ca]]
        faces = divided
    return points, faces


def twice_area(points, face):
    p, q, r = (points[v] for v in face)
    return cross(minus(q, p), minus(r, p))


def normals_of(points, faces):
    normals = [[0.0, 0.0, 0.0] for _ in points]
    for face in faces:
        area = twice_area(points, face)
        for v in face:
            normals[v] = [x + y for x, y in zip(normals[v], area)]
    return normals


def wings_of(faces):
    """Per edge, in the order of its face: face and corner opposite."""
    return {(face[k], face[(k + 1) % 3]): (number, face[(k + 2) % 3]) for number, face in enumerate(faces) for k in range(3)}


def solved(rows):
    """The unknowns of a small linear system; a row is its coefficients and its right side."""
    size = len(rows)
    for k in range(size):
        best = max(range(k, size), key=lambda i: abs(rows[i][k]))
        rows[k], rows[best] = rows[best], rows[k]
        for i in range(k + 1, size):
            share = rows[i][k] / rows[k][k]
            rows[i] = [x - share * y for x, y in zip(rows[i], rows[k])]
    unknown = [0.0] * size
    for k in reversed(range(size)):
        unknown[k] = (rows[k][size] - dot(rows[k][k + 1:size], unknown[k + 1:])) / rows[k][k]
    return unknown


def height_over(point, normal, others):
    """The tangents at a point, and the wall's height over them as a function of two lengths: a parabola through others."""
    n = [x / math.sqrt(dot(normal, normal)) for x in normal]
    u = cross(n, [1.0, 0.0, 0.0] if abs(n[0]) < 0.7 else [0.0, 1.0, 0.0])
    u = [x / math.sqrt(dot(u, u)) for x in u]
    v = cross(n, u)
    rows = [[0.0] * 6 for _ in range(5)]
    for other in others:
        d = minus(other, point)
        x, y = dot(d, u), dot(d, v)
        terms = [x, y, x * x, x * y, y * y, dot(d, n)]
        for i in range(5):
            rows[i] = [a + terms[i] * b for a, b in zip(rows[i], terms)]
    a, b, c, d, e = solved(rows)
    return u, v, n, lambda x, y: a * x + b * y + c * x * x + d * x * y + e * y * y


def shaken(points, faces, seed):
    """Vertices off lines moved along the wall, and a share of the diagonals flipped, by lot."""
    lot = random.Random(seed)
    normals = normals_of(points, faces)
    wings = wings_of(faces)
    fixed = {v for edge in wings if edge[::-1] not in wings for v in edge}
    for (a, b), (number, _) in wings.items():
        if (b, a) in wings:
            n, m = (twice_area(points, faces[f]) for f in (number, wings[(b, a)][0]))
            if dot(n, m) < SHARP_COSINE * math.sqrt(dot(n, n) * dot(m, m)):
                fixed |= {a, b}
    edge_mm = sum(math.dist(points[a], points[b]) for a, b in wings) / len(wings)
    near = [set() for _ in points]
    for a, b in wings:
        near[a].add(b)
        near[b].add(a)
    moved = []
    for k, p in enumerate(points):
        x, y = lot.uniform(-JITTER, JITTER) * edge_mm, lot.uniform(-JITTER, JITTER) * edge_mm
        if k in fixed or near[k] & fixed:
            moved.append(p)
            continue
        two_rings = sorted({w for v in near[k] for w in near[v]} - {k})
        u, v, n, height = height_over(p, normals[k], [points[w] for w in two_rings])
        moved.append([p[i] + x * u[i] + y * v[i] + height(x, y) * n[i] for i in range(3)])
    points = moved
    for a, b in sorted(wings):
        if (b, a) not in wings or a > b or lot.random() > FLIPS or {a, b} & fixed:
            continue
        (left, c), (right, d) = wings[(a, b)], wings[(b, a)]
        if (c, d) in wings or (d, c) in wings:
            continue
        new = [[c, a, d], [d, b, c]]
        before = twice_area(points, faces[left])
        if any(dot(before, twice_area(points, face)) <= 0.0 for face in new):
            continue
        faces[left], faces[right] = new
        del wings[(a, b)], wings[(b, a)]
        for number in (left, right):
            for k in range(3):
                face = faces[number]
                wings[(face[k], face[(k + 1) % 3])] = (number, face[(k + 2) % 3])
    return points, faces


class Winder:
    def __init__(self, options, folder):
        self.options = options
        self.folder = folder

    def made(self, part, edge_mm):
        file = self.folder / f"{part}_{edge_mm}.obj"
        subprocess.run([str(w) for w in [self.options.program, "make", *PARTS[part], "--edge", edge_mm, "-o", file]], check=True,
                       capture_output=True)
        return file

    def meshes(self, part):
        """(name, file), the program's own of 4 mm first."""
        usual, fine = self.made(part, 4), self.made(part, 2)
        yield "made, 4 mm", usual
        yield "made, 2 mm", fine
        yield "made, 8 mm", self.made(part, 8)
        file = self.folder / f"{part}_single.stl"
        write_stl(file, *read_obj(usual))
        yield "single precision", file
        file = self.folder / f"{part}_cut.obj"
        points, faces = read_obj(fine)
        for axis in range(3):
            points, faces = cut_by_planes(points, faces, axis)
        write_obj(file, points, faces)
        yield "slivers", file
        file = self.folder / f"{part}_shaken.obj"
        write_obj(file, *shaken(*read_obj(fine), seed=1))
        yield "shaken", file
        if part in CAD:
            yield "one row of facets", ROOT / "data/meshes/cad" / CAD[part]

    def wind(self, part, name, file):
        """The line of the table, and the rims: (radius, height, distance from the spindle)."""
        command = [self.options.program, file, "--machine", ROOT / "machines/six_axis.json", "--quiet", "--json",
                   "-o", self.folder / f"{part}.out"]
        for setting in self.options.set:
            command += ["--set", setting]
        begin = time.monotonic()
        result = subprocess.run([str(w) for w in command], capture_output=True, text=True, check=False)
        line = dict.fromkeys(COLUMNS, "")
        line.update(part=part, mesh=name, exit_code=result.returncode, wall_s=round(time.monotonic() - begin, 1),
                    words=result.stderr.partition("\n")[0][:160])
        rims = []
        if result.returncode in (0, 1):
            report = json.loads(result.stdout)
            line.update(triangles=report["mandrel"]["file_triangles"], covered=report["plan"]["coverage"]["fraction"],
                        checks_failed=sum(not check["ok"] for check in report["checks"].values()))
            rims = sorted(((rim["radius"], abs(rim["centre"][2]), math.hypot(*rim["centre"][:2]))
                           for rim in report["mandrel"]["rims"]), key=lambda rim: [round(x) for x in rim])
        return line, rims


def same_rims(some, others):
    return len(some) == len(others) and all(math.dist(a, b) <= RIM_MM for a, b in zip(some, others))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", type=pathlib.Path)
    parser.add_argument("--only", choices=PARTS, action="append", help="of the parts")
    parser.add_argument("--folder", type=pathlib.Path, help="where meshes and outputs stay; without it they are deleted")
    parser.add_argument("--set", action="append", default=[], metavar="KEY=VALUE", help="of the job")
    options = parser.parse_args()
    good = True
    with tempfile.TemporaryDirectory() as temporary:
        folder = options.folder or pathlib.Path(temporary)
        folder.mkdir(parents=True, exist_ok=True)
        winder = Winder(options, folder)
        print("\t".join(COLUMNS))
        for part in options.only or PARTS:
            own = None
            for name, file in winder.meshes(part):
                line, rims = winder.wind(part, name, file)
                own = own or (line, rims)
                as_good = line["exit_code"] == 0 and own[0]["exit_code"] == 0 and same_rims(own[1], rims) and (
                    abs(line["covered"] - own[0]["covered"]) <= COVERAGE_SHARE)
                good = good and as_good
                print("\t".join(str(line[column]) for column in COLUMNS) + ("" if as_good else "\tNOT AS GOOD"), flush=True)
    return 0 if good else 1


if __name__ == "__main__":
    sys.exit(main())
