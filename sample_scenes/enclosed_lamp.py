"""A desk lamp whose bulb is enclosed in a globe of ribbed glass: all light of the scene has passed
glass, so that only photons find it. The ribs draw rays on wall and desk.

    blender --background --factory-startup --threads 1 --python sample_scenes/enclosed_lamp.py

writes enclosed_lamp.glb beside this script. With `-- --reference OUT.exr SAMPLES` at the end it
also renders a reference by Cycles, which takes very many samples here.
"""

import math
import os
import sys

sys.dont_write_bytecode = True  # leave no __pycache__ in the tree
sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import scene_kit as kit

LAMP = (-0.16, 0.10)  # its axis on the desk, metres
GLOBE_HEIGHT, GLOBE_RADIUS = 0.30, 0.085
RIBS, RIB_DEPTH = 14, 0.0028


def add_globe(location, material):
    """A hollow ball of glass: ribs outside, a plain ball inside with its faces towards the bulb."""
    segments, rings = 12 * RIBS, 20
    vertices, rows = [], []
    for ring in range(rings + 1):
        up = math.pi * (ring / rings - 0.5)
        pole = ring in (0, rings)
        first = len(vertices)
        count = 1 if pole else segments
        rows.append([first + k % count for k in range(segments + 1)])
        for k in range(count):
            turn = 2.0 * math.pi * k / segments
            depth = RIB_DEPTH * math.cos(up) ** 2
            radius = GLOBE_RADIUS + depth * math.cos(RIBS * turn)
            out = 0.0 if pole else radius * math.cos(up)
            vertices.append((out * math.cos(turn), out * math.sin(turn), radius * math.sin(up)))
    faces = []
    for lower, upper in zip(rows, rows[1:]):
        for k in range(segments):
            corners = (lower[k], lower[k + 1], upper[k + 1], upper[k])
            faces.append(tuple(dict.fromkeys(corners)))
    kit.add_mesh("Globe", vertices, faces, material, location)
    radius = GLOBE_RADIUS - 2.2 * RIB_DEPTH
    inwards = [(radius * math.cos(a), radius * math.sin(a))
               for a in (math.pi * (0.5 - i / 24) for i in range(25))]
    kit.add_lathe("Globe, inside", inwards, material, location, segments=48)


def add_lamp():
    x, y = LAMP
    brass = kit.metal("Brass", (0.78, 0.53, 0.24), 0.25)
    center = (x, y, GLOBE_HEIGHT)
    add_globe(center, kit.glass("Globe", 1.5))
    # the bulb: it shines outwards from a small ball, as if its coil filled it
    kit.add_sphere("Bulb", center, 0.014, kit.emitter("Bulb", (1.0, 0.74, 0.44), 1300.0), 32, 16)
    neck = GLOBE_HEIGHT - GLOBE_RADIUS - 0.0035
    stem = [(0.0, 0.0005), *kit.arc((0.062, 0.008), 0.0075, -90.0, 80.0, 8),
            *kit.arc((0.030, 0.040), 0.024, -80.0, -175.0, 8), (0.0055, 0.10), (0.0055, 0.16),
            (0.0055, neck - 0.03), (0.008, neck - 0.02), (0.019, neck - 0.004), (0.019, neck),
            (0.0, neck)]
    kit.add_lathe("Stem", stem, brass, (x, y, 0.0), segments=48)


def add_room():
    """A corner: two walls, a desk, and what closes it behind the viewer."""
    plaster = kit.lambert("Wall", (0.62, 0.55, 0.46))
    green = kit.lambert("Green wall", (0.22, 0.34, 0.27))
    desk = kit.principled("Desk", (0.30, 0.15, 0.075), Roughness=0.5)
    left, right, front, back, top = -0.55, 1.0, -1.3, 0.36, 1.1
    across, deep, up = (right - left, 0, 0), (0, back - front, 0), (0, 0, top)
    kit.add_quad("Desk", (left, front, 0), across, deep, desk)
    kit.add_quad("Ceiling", (left, front, top), deep, across, plaster)
    kit.add_quad("Back wall", (left, back, 0), across, up, plaster)
    kit.add_quad("Front wall", (left, front, 0), up, across, plaster)
    kit.add_quad("Left wall", (left, front, 0), deep, up, green)
    kit.add_quad("Right wall", (right, front, 0), up, deep, plaster)


def add_books():
    covers = ((0.42, 0.05, 0.04), (0.05, 0.12, 0.22), (0.50, 0.34, 0.08))
    paper = kit.lambert("Paper", (0.74, 0.70, 0.60))
    height = 0.0005
    turns, thicknesses = (-12.0, 7.0, -4.0), (0.034, 0.026, 0.03)
    for i, (cover, turn, thick) in enumerate(zip(covers, turns, thicknesses)):
        half_x, half_y = 0.115 - 0.012 * i, 0.08 - 0.006 * i
        cloth = kit.principled(f"Cover {i + 1}", cover, Roughness=0.6)
        x, y, board = 0.165, 0.14, 0.003
        for low in (height, height + thick - board):
            kit.add_cuboid("Cover", (x - half_x, y - half_y, low),
                           (x + half_x, y + half_y, low + board), cloth, turn)
        kit.add_cuboid("Pages", (x - half_x + 0.004, y - half_y + 0.004, height + board + 0.0002),
                       (x + half_x - 0.004, y + half_y - 0.004, height + thick - board - 0.0002),
                       paper, turn)
        height += thick + 0.0004
    return height


def main():
    kit.new_scene(800, 600)
    add_room()
    add_lamp()
    top = add_books()
    apple = kit.principled("Apple", (0.45, 0.045, 0.02), Roughness=0.25)
    profile = [(0.0, 0.012), *kit.arc((0.0165, 0.030), 0.0205, -100.0, 90.0, 14), (0.010, 0.048),
               (0.0, 0.042)]
    kit.add_lathe("Apple", profile, apple, (0.15, 0.13, top - 0.0092), segments=48)
    mug = kit.ceramic("Mug", (0.60, 0.62, 0.60), 0.05)
    outside = [(0.0, 0.001), (0.033, 0.0005), (0.039, 0.005)]
    outside += [*kit.line((0.039, 0.005), (0.041, 0.094), 5), (0.041, 0.094), (0.0395, 0.096)]
    inside = [(0.038, 0.094), *kit.line((0.038, 0.094), (0.036, 0.012), 5), (0.034, 0.007)]
    kit.add_lathe("Mug", [*outside, *inside, (0.0, 0.006)], mug, (0.03, -0.045, 0.0), segments=48)
    kit.add_camera((0.36, -0.92, 0.44), (0.02, 0.08, 0.185), 39.0)
    kit.finish(__file__)


main()
