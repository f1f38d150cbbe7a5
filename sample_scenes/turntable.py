"""A turntable of brushed metal that makes one turn in 24 frames, with a goblet and marbles of glass;
beside it a velvet cushion, a ball with a thin film, and a vase of metallic paint under a clear coat.

    blender --background --factory-startup --threads 1 --python sample_scenes/turntable.py

writes turntable.glb beside this script. What Blender 3.4's exporter has no words for is written
into the file afterwards: sheen, film, anisotropy, the area lights and the size of the spot lamp
(docs/gltf.md, docs/light-units.md), so a reference by Cycles lacks it.
"""

import math
import os
import sys

sys.dont_write_bytecode = True  # leave no __pycache__ in the tree
sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import bpy
import scene_kit as kit

FRAMES = 24
TABLE_RADIUS, TABLE_TOP = 0.16, 0.03
TABLE_PLACE = (0.03, 0.04, 0.0)

# What glTF's extensions say about the materials, by name.
EXTENSIONS = {
    "Brushed": {
        "KHR_materials_anisotropy": {
            "anisotropyStrength": 0.85,
            "anisotropyRotation": 1.570796,  # across the grooves, which run round
        },
    },
    "Velvet": {
        "KHR_materials_sheen": {
            "sheenColorFactor": [0.75, 0.30, 0.34],
            "sheenRoughnessFactor": 0.4,
        },
    },
    "Anodised": {
        "KHR_materials_iridescence": {
            "iridescenceFactor": 1.0,
            "iridescenceIor": 1.7,
            "iridescenceThicknessMaximum": 400.0,
        },
    },
    "Paint": {
        "KHR_materials_clearcoat": {"clearcoatFactor": 1.0, "clearcoatRoughnessFactor": 0.02},
    },
}

def add_backdrop():
    """A floor that bends up into a wall."""
    cloth = kit.lambert("Backdrop", (0.55, 0.52, 0.48))
    profile = [(-1.2, 0.0), (0.35, 0.0)]
    profile += [(0.35 + 0.35 * math.sin(t), 0.35 - 0.35 * math.cos(t))
                for t in (math.radians(3.0 * i) for i in range(1, 31))]
    profile.append((0.7, 1.4))
    vertices = [(x, y, z) for y, z in profile for x in (-1.6, 1.6)]
    faces = [(2 * i, 2 * i + 1, 2 * i + 3, 2 * i + 2) for i in range(len(profile) - 1)]
    kit.add_mesh("Backdrop", vertices, faces, cloth)


def add_turned_top(material, segments=96, rings=6):
    """A disk whose u runs round and whose v runs outwards, for the direction of its grooves."""
    vertices, uvs, faces = [], [], []
    for ring in range(rings + 1):
        radius = 0.004 + (TABLE_RADIUS - 0.006) * ring / rings
        for k in range(segments + 1):
            turn = 2.0 * math.pi * k / segments
            vertices.append((radius * math.cos(turn), radius * math.sin(turn), TABLE_TOP))
            uvs.append((k / segments, ring / rings))
    row = segments + 1
    for ring in range(rings):
        for k in range(segments):
            corner = ring * row + k
            faces.append((corner, corner + row, corner + row + 1, corner + 1))
    return kit.add_mesh("Top", vertices, faces, material, uvs=uvs)


def add_goblet(material):
    """Outside from the foot's middle up, over the rim, down inside; it stands on its edge."""
    foot = kit.arc((0.036, 0.0025), 0.002, -100.0, 60.0, 8)
    stem = [(0.020, 0.0065), (0.008, 0.013), (0.0048, 0.026), (0.0042, 0.045), (0.0050, 0.062),
            (0.010, 0.072)]
    bowl = kit.arc((0.0, 0.112), 0.041, -68.0, 12.0, 14)
    rim = (0.0375, 0.140)
    inside = kit.arc((0.0, 0.113), 0.0385, 10.0, -90.0, 20)
    profile = [(0.0, 0.0035), (0.018, 0.0025), *foot, *stem, *bowl]
    profile += [(0.0391, 0.1385), (0.0386, 0.1403), rim, (0.0366, 0.1395), *inside[:-1]]
    profile.append((0.0, inside[-1][1]))
    return kit.add_lathe("Goblet", profile, material, (0.0, 0.0, TABLE_TOP + 0.0005), segments=96)


def add_marbles():
    colors = (("Amber", (1.0, 0.62, 0.22)), ("Green", (0.35, 0.85, 0.5)), ("Blue", (0.35, 0.6, 1.0)))
    marbles = []
    for i, (name, color) in enumerate(colors):
        turn = 2.0 * math.pi * (i / 3 + 0.07)
        place = (0.115 * math.cos(turn), 0.115 * math.sin(turn), TABLE_TOP + 0.0205)
        marbles.append(kit.add_sphere(name, place, 0.02, kit.glass(name, 1.5, color), 56, 28))
    return marbles


def add_turntable():
    """All that turns hangs on one empty node."""
    axis = kit.link("Turntable", None, TABLE_PLACE)
    brushed = kit.metal("Brushed", (0.88, 0.80, 0.68), 0.32)
    dark = kit.metal("Edge", (0.45, 0.42, 0.40), 0.25)
    edge = kit.arc((TABLE_RADIUS - 0.003, TABLE_TOP - 0.003), 0.003, 0.0, 90.0, 6)
    side = [(0.0, 0.004), (0.10, 0.004), (TABLE_RADIUS, 0.004), *edge]
    body = kit.add_lathe("Body", [*side, (0.0, TABLE_TOP - 0.0004)], dark, segments=96)
    goblet = add_goblet(kit.glass("Crystal", 1.55))
    for thing in (body, add_turned_top(brushed), goblet, *add_marbles()):
        thing.parent = axis
    kit.turn_about_z(axis, FRAMES)


def add_cushion(location, half, height, steps=28):
    """Two sheets that meet at a seam; the corners are drawn out."""
    velvet = kit.principled("Velvet", (0.11, 0.008, 0.018), Roughness=0.9, Specular=0.3)
    places = [math.sin(math.pi / 2 * (2 * i / steps - 1)) for i in range(steps + 1)]
    index, vertices, faces = {}, [], []
    for sign in (1, -1):
        for i, s in enumerate(places):
            for j, t in enumerate(places):
                is_seam = i in (0, steps) or j in (0, steps)
                key = (i, j) if is_seam else (i, j, sign)
                if key in index:
                    continue
                index[key] = len(vertices)
                up = 0.0 if is_seam else ((1 - s * s) * (1 - t * t)) ** 0.42
                dent = 1.0 - 0.16 * math.exp(-7.0 * (s * s + t * t)) * (sign > 0)
                x = half * s * (1 - 0.10 * (1 - t * t) * s * s)
                y = half * t * (1 - 0.10 * (1 - s * s) * t * t)
                vertices.append((x, y, sign * height * up * dent))

    def corner(i, j, sign):
        return index[(i, j) if i in (0, steps) or j in (0, steps) else (i, j, sign)]

    for sign in (1, -1):
        for i in range(steps):
            for j in range(steps):
                face = [corner(i, j, sign), corner(i + 1, j, sign), corner(i + 1, j + 1, sign),
                        corner(i, j + 1, sign)]
                faces.append(tuple(face if sign > 0 else reversed(face)))
    cushion = kit.add_mesh("Cushion", vertices, faces, velvet, location)
    cushion.rotation_euler.z = math.radians(24.0)
    anodised = kit.metal("Anodised", (0.72, 0.70, 0.68), 0.14)
    x, y, z = location
    kit.add_sphere("Ball", (x, y, z + 0.84 * height + 0.033), 0.035, anodised, 64, 32)


def add_vase(location):
    paint = kit.metal("Paint", (0.015, 0.13, 0.20), 0.42)
    outside = [(0.0, 0.002), (0.02, 0.001), (0.036, 0.0), (0.044, 0.006), (0.058, 0.04),
               (0.064, 0.075), (0.060, 0.11), (0.046, 0.145), (0.028, 0.175), (0.020, 0.20),
               (0.022, 0.222), (0.030, 0.24)]
    inside = [(0.027, 0.2405), (0.019, 0.222), (0.017, 0.20), (0.0, 0.18)]
    vase = kit.add_lathe("Vase", [*outside, (0.0288, 0.2415), *inside], paint, location, 72)
    smooth = vase.modifiers.new("Smooth", "SUBSURF")
    smooth.levels = smooth.render_levels = 1


def add_area(name, location, target, shape, size, watts, color):
    """An area light, with the extras that docs/light-units.md describes. The exporter leaves its
    node empty. Of Cycles' watts a Lambertian surface makes pi / 4."""
    data = bpy.data.lights.new(name, "AREA")
    data.shape, data.size, data.size_y = shape, size[0], size[1]
    data.energy, data.color = watts, color
    lamp = kit.link(name, data, location)
    kit.aim(lamp, target)
    kind = "rect" if shape == "RECTANGLE" else "ellipse"
    return {"ppm_area": {"shape": kind, "size": size, "power_w": round(watts * math.pi / 4, 4),
                         "color": color}}


def add_lights():
    """Returns the extras of the nodes, by name."""
    kit.add_spot("Spot", (0.42, 0.48, 0.62), (0.03, 0.02, 0.05), 60.0, 34.0, 0.5,
                 (1.0, 0.93, 0.82))
    return {
        "Softbox": add_area("Softbox", (-0.55, -0.45, 0.85), (0.0, 0.0, 0.05), "RECTANGLE",
                            [0.9, 0.6], 9.5, [1.0, 0.95, 0.88]),
        "Rim": add_area("Rim", (0.75, 0.30, 0.45), (0.0, 0.0, 0.08), "ELLIPSE", [0.3, 0.3], 5.0,
                        [0.75, 0.87, 1.0]),
        "Spot": {"ppm_radius": 0.004},
    }


def edit(gltf, extras):
    for material in gltf["materials"]:
        for name, values in EXTENSIONS.get(material["name"], {}).items():
            kit.add_extension(gltf, material, name, values)
    for node in gltf["nodes"]:
        if node["name"] in extras:
            node["extras"] = extras[node["name"]]
    gltf["asset"]["copyright"] = "2026 the ppm-render authors, Apache-2.0"


def main():
    kit.new_scene(720, 480)
    add_backdrop()
    add_turntable()
    add_cushion((-0.215, 0.04, 0.044), 0.095, 0.042)
    add_vase((0.265, 0.13, 0.0))
    extras = add_lights()
    kit.add_camera((0.02, -0.90, 0.46), (0.008, 0.03, 0.090), 37.0)
    kit.finish(__file__, lambda gltf: edit(gltf, extras))


main()
