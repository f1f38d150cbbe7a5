#!/usr/bin/env python3
"""Writes a .glb of many triangles: a bumpy sheet, cut into meshes. Only Python itself is needed.

    big_glb.py OUT.glb [--triangles 10000000] [--meshes 1] [--normals] [--normal-map]
"""
import argparse
import array
import json
import math
import struct


def parse():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("out")
    parser.add_argument("--triangles", type=int, default=10_000_000)
    parser.add_argument("--meshes", type=int, default=1)
    parser.add_argument("--normals", action="store_true", help="normals and texture coordinates")
    parser.add_argument("--normal-map", action="store_true",
                        help="a material whose tangents must be computed, with --normals")
    return parser.parse_args()


def positions(side, rows, first_row, scale):
    """rows + 1 rows of side + 1 vertices."""
    values = array.array("f")
    wave = [math.sin(0.05 * x) for x in range(side + 1)]
    for row in range(first_row, first_row + rows + 1):
        z = scale * row
        bump = 2.0 * math.cos(0.05 * row)
        for x in range(side + 1):
            values.extend((scale * x, scale * bump * wave[x], z))
    return values


def normals(side, rows, first_row):
    values = array.array("f")
    wave = [math.sin(0.05 * x) for x in range(side + 1)]
    slope = [0.05 * math.cos(0.05 * x) for x in range(side + 1)]
    for row in range(first_row, first_row + rows + 1):
        cosine, sine = 2.0 * math.cos(0.05 * row), -0.1 * math.sin(0.05 * row)
        for x in range(side + 1):
            nx, nz = -cosine * slope[x], -sine * wave[x]
            length = math.sqrt(nx * nx + 1.0 + nz * nz)
            values.extend((nx / length, 1.0 / length, nz / length))
    return values


def coordinates(side, rows, first_row):
    values = array.array("f")
    for row in range(first_row, first_row + rows + 1):
        for x in range(side + 1):
            values.extend((x / side, row / side))
    return values


def indices(side, rows):
    first = array.array("I")
    for x in range(side):
        a, b = x, x + side + 1
        first.extend((a, b, a + 1, a + 1, b, b + 1))
    values = array.array("I")
    for row in range(rows):
        base = row * (side + 1)
        values.extend(array.array("I", [i + base for i in first]))
    return values


class Writer:
    """Accessors over one buffer, whose parts go to the file as they come."""

    def __init__(self, file):
        self.file, self.length = file, 0
        self.views, self.accessors = [], []

    def add(self, values, kind, component, size):
        data = values.tobytes()
        self.views.append({"buffer": 0, "byteOffset": self.length, "byteLength": len(data)})
        accessor = {"bufferView": len(self.views) - 1, "componentType": component,
                    "count": len(values) // size, "type": kind}
        if kind == "VEC3":
            accessor["min"] = [min(values[i::3]) for i in range(3)]
            accessor["max"] = [max(values[i::3]) for i in range(3)]
        self.accessors.append(accessor)
        self.file.write(data)
        self.length += len(data)
        return len(self.accessors) - 1


def add_mesh(writer, options, side, rows, first_row):
    attributes = {"POSITION": writer.add(positions(side, rows, first_row, 1.0 / side), "VEC3", 5126, 3)}
    if options.normals:
        attributes["NORMAL"] = writer.add(normals(side, rows, first_row), "VEC3", 5126, 3)
        attributes["TEXCOORD_0"] = writer.add(coordinates(side, rows, first_row), "VEC2", 5126, 2)
    elements = writer.add(indices(side, rows), "SCALAR", 5125, 1)
    primitive = {"attributes": attributes, "indices": elements}
    if options.normal_map:
        primitive["material"] = 0
    return {"primitives": [primitive]}


# One pixel, (0, 0, 1) as a normal.
PNG = ("iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAIAAACQd1PeAAAADElEQVR4nGNo"
       "aPgPAAODAgAApfuJAAAAAElFTkSuQmCC")
MAPPED = {"materials": [{"normalTexture": {"index": 0}}], "textures": [{"source": 0}],
          "images": [{"uri": "data:image/png;base64," + PNG}]}


def main():
    options = parse()
    side = max(1, round(math.sqrt(options.triangles / 2)))
    cuts = [side * i // options.meshes for i in range(options.meshes + 1)]
    with open(options.out, "w+b") as file:
        room = 4096 + 1200 * options.meshes  # for the JSON, which is known at the end
        file.seek(12 + 8 + room + 8)
        writer = Writer(file)
        meshes = [add_mesh(writer, options, side, b - a, a) for a, b in zip(cuts, cuts[1:]) if b > a]
        text = json.dumps({**(MAPPED if options.normal_map else {}),
            "asset": {"version": "2.0", "generator": "big_glb.py"}, "scene": 0,
            "scenes": [{"nodes": list(range(len(meshes)))}],
            "nodes": [{"mesh": i} for i in range(len(meshes))], "meshes": meshes,
            "accessors": writer.accessors, "bufferViews": writer.views,
            "buffers": [{"byteLength": writer.length}]}, separators=(",", ":")).encode()
        assert len(text) <= room
        padding = -writer.length % 4
        file.write(b"\0" * padding)
        total = file.tell()
        file.seek(0)
        file.write(struct.pack("<4sII", b"glTF", 2, total))
        file.write(struct.pack("<II", room, 0x4E4F534A) + text.ljust(room))
        file.write(struct.pack("<II", writer.length + padding, 0x004E4942))


if __name__ == "__main__":
    main()
