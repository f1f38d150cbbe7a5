"""A ball on a beach: a glass ball of the size of a hand and a hollow fishing float on rippled sand,
in the sun, on ten kilometres of sand and sea. What is looked at is a millionth of what the sun
shines on: photons have to find it.

    python3 sample_scenes/beach.py

writes beach.obj and beach.mtl beside this script (Python alone, no Blender). Camera, sun, sky and
the glass are in beach.ppm.json, which is written by hand.
"""

import math
import os

HALF = 5000.0  # of the beach, metres
FIELD, CELLS = 1.5, 96  # half side of the rippled sand, and its cells a side
SHORE = -2.6  # z of the waterline: the camera looks along -z

MATERIALS = {
    "Sand": ["Kd 0.46 0.37 0.26", "Ks 0 0 0", "illum 1"],
    "Sea": ["Kd 0.006 0.03 0.04", "Ks 0.5 0.5 0.5", "Ns 500", "illum 2"],
    "Glass": ["Kd 0 0 0", "Ks 0.5 0.5 0.5", "Ni 1.52", "Tf 1 1 1", "illum 7"],
    "Float": ["Kd 0 0 0", "Ks 0.5 0.5 0.5", "Ni 1.52", "Tf 1 1 1", "illum 7"],
    "Driftwood": ["Kd 0.24 0.20 0.16", "Ks 0 0 0", "illum 1"],
}


class Obj:
    """Lines of an OBJ; indices count from 1."""

    def __init__(self):
        self.lines = ["# beach, made by beach.py", "mtllib beach.mtl"]
        self.count = 0

    def mesh(self, name, material, points, normals, faces):
        """normals: one a point, or None for flat faces."""
        self.lines += [f"o {name}", f"usemtl {material}"]
        self.lines += [f"v {x:.6g} {y:.6g} {z:.6g}" for x, y, z in points]
        self.lines += [f"vn {x:.4f} {y:.4f} {z:.4f}" for x, y, z in normals or []]
        for face in faces:
            numbers = [self.count + i + 1 for i in face]
            self.lines.append("f " + " ".join(f"{n}//{n}" if normals else str(n) for n in numbers))
        if not normals:  # keep the two counts together
            self.lines += ["vn 0 1 0"] * len(points)
        self.count += len(points)


def unit(x, y, z):
    length = math.sqrt(x * x + y * y + z * z)
    return x / length, y / length, z / length


# ---- sand and sea --------------------------------------------------------------------------------


def sand(x, z):
    """Height of the sand: ripples that wander, a hollow under each ball, flat at the field's rim."""
    fade = max(0.0, 1.0 - max(abs(x), abs(z)) / FIELD) * 2.2
    fade = min(1.0, fade) ** 2 * (3.0 - 2.0 * min(1.0, fade))
    phase = 70.0 * z + 9.0 * x + 2.4 * math.sin(4.1 * x) + 1.7 * math.sin(6.3 * x + 5.0 * z)
    ripples = 0.0035 * math.sin(phase) * (0.7 + 0.3 * math.sin(3.0 * x - 2.0 * z))
    dunes = 0.012 * math.sin(2.3 * x + 0.6) * math.cos(1.9 * z)
    return fade * (ripples + dunes)


def add_field(obj):
    step = 2.0 * FIELD / CELLS
    side = CELLS + 1
    points, normals = [], []
    for row in range(side):
        for column in range(side):
            x, z = column * step - FIELD, row * step - FIELD
            points.append((x, sand(x, z), z))
            e = 0.002
            slope_x = (sand(x + e, z) - sand(x - e, z)) / (2 * e)
            slope_z = (sand(x, z + e) - sand(x, z - e)) / (2 * e)
            normals.append(unit(-slope_x, 1.0, -slope_z))
    faces = []
    for row in range(CELLS):
        for column in range(CELLS):
            a = row * side + column
            faces.append((a, a + side, a + side + 1, a + 1))
    obj.mesh("Ripples", "Sand", points, normals, faces)


def add_beach(obj):
    """Around the field, in four flat pieces that share its rim."""
    f, h = FIELD, HALF
    for name, (x0, x1, z0, z1) in {
        "Sand before": (-h, h, f, h), "Sand beyond": (-h, h, -h, -f),
        "Sand left": (-h, -f, -f, f), "Sand right": (f, h, -f, f),
    }.items():
        obj.mesh(name, "Sand", [(x0, 0, z1), (x1, 0, z1), (x1, 0, z0), (x0, 0, z0)], None,
                 [(0, 1, 2, 3)])


def add_sea(obj):
    """A film on the sand whose waterline wanders; beyond 60 m to the sides it is straight."""
    line = [(-HALF, SHORE)]
    for i in range(121):
        x = i - 60.0
        line.append((x, SHORE + 0.35 * math.sin(0.63 * x) + 0.2 * math.sin(1.7 * x + 1.0)))
    line.append((HALF, SHORE))
    points = [(x, 0.01, z) for x, z in line] + [(x, 0.01, -HALF) for x, _ in line]
    n = len(line)
    faces = [(i, i + 1, n + i + 1, n + i) for i in range(n - 1)]
    obj.mesh("Sea", "Sea", points, None, faces)


# ---- things --------------------------------------------------------------------------------------


def sphere(center, radius, segments, side=1.0):
    """Points, normals and faces of a ball that faces outwards, or inwards where side is -1."""
    rings = segments // 2
    points, normals, faces = [], [], []
    for ring in range(rings + 1):
        polar = math.pi * ring / rings
        for step in range(segments):
            turn = 2 * math.pi * step / segments
            n = (math.sin(polar) * math.cos(turn), math.cos(polar), math.sin(polar) * math.sin(turn))
            points.append(tuple(c + radius * x for c, x in zip(center, n)))
            normals.append(tuple(side * x for x in n))
    for ring in range(rings):
        for step in range(segments):
            a, b = ring * segments + step, ring * segments + (step + 1) % segments
            face = [a, b, b + segments, a + segments]
            if ring == 0:
                face = [a, b + segments, a + segments]
            elif ring == rings - 1:
                face = [a, b, a + segments]
            faces.append(tuple(face if side > 0 else reversed(face)))
    return points, normals, faces


def add_float(obj, center, radius, wall):
    points, normals, faces = sphere(center, radius, 64)
    inner = sphere(center, radius - wall, 64, -1.0)
    faces += [tuple(len(points) + i for i in face) for face in inner[2]]
    obj.mesh("Float", "Float", points + inner[0], normals + inner[1], faces)


def add_driftwood(obj):
    """A bent, tapering branch."""
    rings, segments = 24, 14
    points, normals, faces = [], [], []
    for ring in range(rings + 1):
        t = ring / rings
        x, z = 0.20 + 0.42 * t, -0.34 + 0.10 * math.sin(2.6 * t) - 0.10 * t
        radius = 0.017 * (1.0 - 0.55 * t) * (1.0 + 0.10 * math.sin(23.0 * t))
        y = sand(x, z) + 0.6 * radius + 0.03 * math.sin(3.1 * t) ** 2
        for step in range(segments):
            turn = 2 * math.pi * step / segments
            n = (0.0, math.cos(turn), math.sin(turn))
            points.append((x, y + radius * n[1], z + radius * n[2]))
            normals.append(n)
    for ring in range(rings):
        for step in range(segments):
            a, b = ring * segments + step, ring * segments + (step + 1) % segments
            faces.append((a, b, b + segments, a + segments))
    for first in (0, rings * segments):
        faces.append(tuple(range(first, first + segments)))
    obj.mesh("Driftwood", "Driftwood", points, normals, faces)


def main():
    obj = Obj()
    add_field(obj)
    add_beach(obj)
    add_sea(obj)
    ball, float_ = (-0.03, 0.04), (0.17, -0.16)
    obj.mesh("Ball", "Glass", *sphere((ball[0], sand(*ball) + 0.039, ball[1]), 0.04, 64))
    add_float(obj, (float_[0], sand(*float_) + 0.062, float_[1]), 0.065, 0.004)
    add_driftwood(obj)
    path = os.path.splitext(os.path.abspath(__file__))[0]
    with open(path + ".obj", "w", encoding="ascii") as file:
        file.write("\n".join(obj.lines) + "\n")
    with open(path + ".mtl", "w", encoding="ascii") as file:
        file.write("# beach, made by beach.py\n")
        for name, lines in MATERIALS.items():
            file.write("\n".join([f"newmtl {name}", *lines]) + "\n")


main()
