"""Shapes and materials written as a .glb, by Python alone."""

import array
import json
import math
import struct
import zlib


class Mesh:
    """Triangles: positions and normals as flat lists, indices."""

    def __init__(self, positions, indices, normals=None, coordinates=None):
        self.positions, self.indices = positions, indices
        self.normals, self.coordinates = normals, coordinates


# ---- shapes, metres, +Y up ------------------------------------------------------------------------


def quad(corner, u, v):
    """A parallelogram that faces the side of cross(u, v)."""
    points = [
        corner,
        [c + a for c, a in zip(corner, u)],
        [c + a + b for c, a, b in zip(corner, u, v)],
        [c + b for c, b in zip(corner, v)],
    ]
    return Mesh(sum(map(list, points), []), [0, 1, 2, 0, 2, 3], None, [0, 0, 1, 0, 1, 1, 0, 1])


def box(low, high):
    """A closed box that faces outwards."""
    (x0, y0, z0), (x1, y1, z1) = low, high
    dx, dy, dz = (x1 - x0, 0, 0), (0, y1 - y0, 0), (0, 0, z1 - z0)
    faces = [
        quad((x0, y0, z0), dx, dz),
        quad((x0, y1, z0), dz, dx),
        quad((x0, y0, z0), dy, dx),
        quad((x0, y0, z1), dx, dy),
        quad((x0, y0, z0), dz, dy),
        quad((x1, y0, z0), dy, dz),
    ]
    return joined(faces)


def joined(meshes):
    positions, indices = [], []
    for mesh in meshes:
        first = len(positions) // 3
        positions += mesh.positions
        indices += [first + i for i in mesh.indices]
    return Mesh(positions, indices)


def sphere(center, radius, segments, is_smooth=True):
    """A closed sphere of segments by segments / 2 quads; smooth: with the sphere's own normals."""
    rings = max(3, segments // 2)
    positions, normals, indices = [], [], []
    for ring in range(rings + 1):
        polar = math.pi * ring / rings
        for step in range(segments):
            turn = 2 * math.pi * step / segments
            n = (math.sin(polar) * math.cos(turn), math.cos(polar), math.sin(polar) * math.sin(turn))
            normals += n
            positions += [c + radius * x for c, x in zip(center, n)]
    for ring in range(rings):
        for step in range(segments):
            a, b = ring * segments + step, ring * segments + (step + 1) % segments
            c, d = a + segments, b + segments
            if ring > 0:
                indices += [a, b, c]
            if ring < rings - 1:
                indices += [b, d, c]
    return Mesh(positions, indices, normals if is_smooth else None)


def tube(center, radius, height, segments, thickness):
    """An upright ring: its outer and inner walls and the rims between them."""
    profile = [(radius, 0.0), (radius, height), (radius - thickness, height), (radius - thickness, 0)]
    positions, indices = [], []
    for r, y in profile:
        for step in range(segments):
            turn = 2 * math.pi * step / segments
            positions += [center[0] + r * math.cos(turn), center[1] + y, center[2] + r * math.sin(turn)]
    for edge in range(4):
        for step in range(segments):
            a, b = edge * segments + step, edge * segments + (step + 1) % segments
            c, d = (edge + 1) % 4 * segments + step, (edge + 1) % 4 * segments + (step + 1) % segments
            indices += [a, c, b, b, c, d]
    return Mesh(positions, indices)


# ---- materials ------------------------------------------------------------------------------------


def lambert(color):
    return principled(color, roughness=1.0, specular=0.0)


def principled(color, roughness, metallic=0.0, specular=None):
    material = {
        "pbrMetallicRoughness": {
            "baseColorFactor": list(color) + [1.0],
            "metallicFactor": metallic,
            "roughnessFactor": roughness,
        },
        "extensions": {},
    }
    if specular is not None:
        material["extensions"]["KHR_materials_specular"] = {"specularFactor": specular}
    return material


def glass(ior=1.5, thickness=1.0, roughness=0.0, color=(1, 1, 1)):
    """Solid, or a thin sheet where thickness is 0."""
    material = principled(color, roughness)
    material["extensions"] = {
        "KHR_materials_transmission": {"transmissionFactor": 1.0},
        "KHR_materials_ior": {"ior": ior},
        "KHR_materials_volume": {"thicknessFactor": thickness},
    }
    return material


def emitter(radiance, texture=None):
    """Black otherwise. texture: rows of 8-bit grey pixels."""
    material = lambert((0, 0, 0))
    material["emissiveFactor"] = [1, 1, 1]
    material["extensions"]["KHR_materials_emissive_strength"] = {"emissiveStrength": radiance}
    material["texture_rows"] = texture
    return material


def png(rows):
    """Grey rows as an RGB picture."""

    def chunk(name, data):
        body = name + data
        return struct.pack(">I", len(data)) + body + struct.pack(">I", zlib.crc32(body))

    data = b"".join(b"\0" + b"".join(bytes((v, v, v)) for v in row) for row in rows)
    header = struct.pack(">IIBBBBB", len(rows[0]), len(rows), 8, 2, 0, 0, 0)
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(data))
            + chunk(b"IEND", b""))


# ---- the file -------------------------------------------------------------------------------------


class File:
    """Collects meshes, each with its material, and writes them."""

    def __init__(self):
        self.binary = b""
        self.json = {
            "asset": {"version": "2.0", "generator": "worlds"},
            "scene": 0,
            "scenes": [{"nodes": []}],
            **{key: [] for key in ("nodes", "meshes", "materials", "accessors", "bufferViews")},
        }

    def view(self, data):
        self.binary += b"\0" * (-len(self.binary) % 4)
        self.json["bufferViews"].append(
            {"buffer": 0, "byteOffset": len(self.binary), "byteLength": len(data)})
        self.binary += data
        return len(self.json["bufferViews"]) - 1

    def accessor(self, values, code, kind, size, **extra):
        view = self.view(array.array(code, values).tobytes())
        self.json["accessors"].append({
            "bufferView": view, "componentType": 5126 if code == "f" else 5125,
            "count": len(values) // size, "type": kind, **extra})
        return len(self.json["accessors"]) - 1

    def attributes(self, mesh):
        p = list(array.array("f", mesh.positions))
        low = [min(p[k::3]) for k in range(3)]
        high = [max(p[k::3]) for k in range(3)]
        found = {"POSITION": self.accessor(p, "f", "VEC3", 3, min=low, max=high)}
        if mesh.normals:
            found["NORMAL"] = self.accessor(mesh.normals, "f", "VEC3", 3)
        if mesh.coordinates:
            found["TEXCOORD_0"] = self.accessor(mesh.coordinates, "f", "VEC2", 2)
        return found

    def material(self, material):
        material = dict(material)
        rows = material.pop("texture_rows", None)
        if rows:
            images = self.json.setdefault("images", [])
            images.append({"bufferView": self.view(png(rows)), "mimeType": "image/png"})
            self.json.setdefault("textures", []).append({"source": len(images) - 1})
            material["emissiveTexture"] = {"index": len(self.json["textures"]) - 1}
        self.json["materials"].append(material)
        return len(self.json["materials"]) - 1

    def add(self, name, mesh, material):
        primitive = {"attributes": self.attributes(mesh),
                     "indices": self.accessor(mesh.indices, "I", "SCALAR", 1),
                     "material": self.material(material)}
        self.json["meshes"].append({"primitives": [primitive]})
        self.json["nodes"].append({"mesh": len(self.json["meshes"]) - 1, "name": name})
        self.json["scenes"][0]["nodes"].append(len(self.json["nodes"]) - 1)

    def write(self, path):
        self.json["buffers"] = [{"byteLength": len(self.binary)}]
        used = sorted({name for m in self.json["materials"] for name in m["extensions"]})
        self.json["extensionsUsed"] = used
        text = json.dumps(self.json).encode()
        text += b" " * (-len(text) % 4)
        binary = self.binary + b"\0" * (-len(self.binary) % 4)
        with open(path, "wb") as file:
            file.write(struct.pack("<4sII", b"glTF", 2, 28 + len(text) + len(binary)))
            file.write(struct.pack("<I4s", len(text), b"JSON") + text)
            file.write(struct.pack("<I4s", len(binary), b"BIN\0") + binary)
