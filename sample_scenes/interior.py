"""A room by day, without caustics: light from the sky through a window, matte and satin surfaces of
simple shapes. The path tracer's case.

    blender --background --factory-startup --threads 1 --python sample_scenes/interior.py

writes interior.glb beside this script. With `-- --reference OUT.exr SAMPLES` at the end it also
renders a reference by Cycles.
"""

import math
import os
import sys

sys.dont_write_bytecode = True  # leave no __pycache__ in the tree
sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import scene_kit as kit

# Inner faces of the room, metres.
LEFT, RIGHT = -2.0, 2.0
FRONT, BACK = -2.8, 2.2
HEIGHT = 2.6
# The window, in the left wall.
SILL, LINTEL = 0.85, 2.25
WINDOW_FRONT, WINDOW_BACK = -0.6, 1.3
WALL = 0.22  # thickness


def add_room():
    white = kit.lambert("White", (0.74, 0.72, 0.68))
    wall = kit.lambert("Wall", (0.58, 0.62, 0.58))
    accent = kit.lambert("Accent wall", (0.20, 0.30, 0.36))
    oak = kit.principled("Oak floor", (0.36, 0.22, 0.12), Roughness=0.5)
    across, deep, up = (RIGHT - LEFT, 0, 0), (0, BACK - FRONT, 0), (0, 0, HEIGHT)
    kit.add_quad("Floor", (LEFT, FRONT, 0), across, deep, oak)
    kit.add_quad("Ceiling", (LEFT, FRONT, HEIGHT), deep, across, white)
    kit.add_quad("Back wall", (LEFT, BACK, 0), across, up, accent)
    kit.add_quad("Front wall", (LEFT, FRONT, 0), up, across, wall)
    kit.add_quad("Right wall", (RIGHT, FRONT, 0), up, deep, wall)
    out = LEFT - WALL
    kit.add_cuboid("Wall below", (out, FRONT, 0), (LEFT, BACK, SILL), wall)
    kit.add_cuboid("Wall above", (out, FRONT, LINTEL), (LEFT, BACK, HEIGHT), wall)
    kit.add_cuboid("Wall before", (out, FRONT, SILL), (LEFT, WINDOW_FRONT, LINTEL), wall)
    kit.add_cuboid("Wall behind", (out, WINDOW_BACK, SILL), (LEFT, BACK, LINTEL), wall)
    kit.add_cuboid("Skirting", (LEFT, BACK - 0.015, 0.0), (RIGHT, BACK, 0.09), white)
    kit.add_cuboid("Skirting", (RIGHT - 0.015, FRONT, 0.0), (RIGHT, BACK, 0.09), white)


def add_window():
    """A frame without glass, a sill, and the sky: a panel outside, tilted towards the room."""
    paint = kit.principled("Paint", (0.72, 0.72, 0.70), Roughness=0.45)
    x, bar = LEFT - WALL / 2, 0.025
    for y in (WINDOW_FRONT + bar, (WINDOW_FRONT + WINDOW_BACK) / 2, WINDOW_BACK - bar):
        kit.add_cuboid("Post", (x - bar, y - bar, SILL), (x + bar, y + bar, LINTEL), paint)
    for z in (SILL + bar, 1.75, LINTEL - bar):
        kit.add_cuboid("Bar", (x - bar * 0.9, WINDOW_FRONT, z - bar),
                       (x + bar * 0.9, WINDOW_BACK, z + bar), paint)
    kit.add_cuboid("Sill", (LEFT - 0.08, WINDOW_FRONT - 0.06, SILL - 0.02),
                   (LEFT + 0.16, WINDOW_BACK + 0.06, SILL + 0.012), paint)
    sky = kit.emitter("Sky", (0.80, 0.90, 1.0), 19.0)
    low, high = (-3.5, 0.0), (-2.6, 3.4)
    kit.add_quad("Sky", (low[0], -1.6, low[1]), (0, 6.0, 0),
                 (high[0] - low[0], 0, high[1] - low[1]), sky)


def add_sofa(x, y):
    """Against the back wall; x, y is the middle of its back edge on the floor."""
    cloth = kit.lambert("Sofa", (0.46, 0.36, 0.24))
    mustard = kit.lambert("Mustard", (0.58, 0.34, 0.05))
    rust = kit.lambert("Rust", (0.42, 0.12, 0.06))
    feet = kit.principled("Dark wood", (0.09, 0.05, 0.03), Roughness=0.5)
    kit.add_cuboid("Seat", (x - 0.95, y - 0.85, 0.12), (x + 0.95, y, 0.34), cloth)
    kit.add_cuboid("Back", (x - 0.95, y - 0.22, 0.34), (x + 0.95, y, 0.80), cloth)
    for side in (-1, 1):
        kit.add_cuboid("Arm", (x + side * 0.86 - 0.11, y - 0.87, 0.12),
                       (x + side * 0.86 + 0.11, y + 0.001, 0.58), cloth)
        kit.add_cuboid("Cushion", (x + side * 0.37 - 0.365, y - 0.83, 0.342),
                       (x + side * 0.37 + 0.365, y - 0.225, 0.46), cloth)
        for depth in (0.08, 0.76):
            kit.add_cuboid("Foot", (x + side * 0.85 - 0.03, y - depth - 0.03, 0.0),
                           (x + side * 0.85 + 0.03, y - depth + 0.03, 0.119), feet)
    for material, place, tip in ((mustard, x - 0.50, -14.0), (rust, x + 0.50, 18.0)):
        add_pillow("Pillow", (place, y - 0.33, 0.66), material, tip)


def add_pillow(name, location, material, turn_degrees):
    """A superquadric, leaning back."""
    columns, rows = 40, 20

    def power(value, exponent):
        return math.copysign(abs(value) ** exponent, value)

    vertices = [(0.0, 0.0, -0.075)]
    for j in range(1, rows):
        up = math.pi * (j / rows - 0.5)
        for i in range(columns):
            turn = 2.0 * math.pi * i / columns
            flat = power(math.cos(up), 0.9)
            vertices.append((0.22 * flat * power(math.cos(turn), 0.45),
                             0.22 * flat * power(math.sin(turn), 0.45), 0.075 * math.sin(up)))
    vertices.append((0.0, 0.0, 0.075))
    faces = []
    for i in range(columns):
        k = (i + 1) % columns
        faces.append((0, 1 + k, 1 + i))
        for j in range(rows - 2):
            a = 1 + j * columns
            faces.append((a + i, a + k, a + columns + k, a + columns + i))
        last = 1 + (rows - 2) * columns
        faces.append((last + i, last + k, len(vertices) - 1))
    pillow = kit.add_mesh(name, vertices, faces, material, location)
    pillow.rotation_euler = (math.radians(62.0), 0.0, math.radians(turn_degrees))


def add_table(x, y):
    """A round low table with a bowl of oranges and two books."""
    walnut = kit.principled("Walnut", (0.20, 0.105, 0.055), Roughness=0.48)
    rim = kit.arc((0.435, 0.395), 0.0149, -90.0, 90.0, 6)
    top = [(0.0, 0.3801), *kit.line((0.0, 0.38), rim[0], 3), *rim]
    top += [*kit.line(rim[-1], (0.0, 0.41), 3), (0.0, 0.4099)]
    kit.add_lathe("Table top", top, walnut, (x, y, 0.0), segments=64)
    for i in range(3):
        turn = math.radians(40.0 + 120.0 * i)
        points = [(x + r * math.cos(turn), y + r * math.sin(turn), z)
                  for r, z in ((0.34, 0.0005), (0.28, 0.384))]
        kit.add_tube("Leg", points, 0.02, walnut, 20)
    clay = kit.principled("Bowl", (0.55, 0.53, 0.48), Roughness=0.5)
    outside = [(0.0, 0.001), (0.05, 0.0), *kit.arc((0.0, 0.14), 0.14, -68.0, -20.0, 10)]
    inside = [*kit.arc((0.0, 0.14), 0.132, -20.0, -80.0, 10), (0.0, 0.009)]
    kit.add_lathe("Bowl", outside + inside, clay, (x - 0.10, y + 0.08, 0.4105), segments=48)
    orange = kit.principled("Orange", (0.72, 0.26, 0.02), Roughness=0.5)
    piled = ((-0.045, 0.02, 0.052), (0.035, 0.045, 0.052), (0.01, -0.04, 0.052))
    for dx, dy, dz in (*piled, (0.0, 0.012, 0.112)):
        place = (x - 0.10 + dx, y + 0.08 + dy, 0.4105 + dz)
        kit.add_sphere("Orange", place, 0.038, orange, 32, 16)
    for i, (color, turn) in enumerate((((0.10, 0.16, 0.13), 20.0), ((0.52, 0.50, 0.44), 34.0))):
        book = kit.principled(f"Book {i + 1}", color, Roughness=0.6)
        low = 0.4105 + 0.0285 * i
        near, far = (x + 0.08, y - 0.26, low), (x + 0.22, y - 0.06, low + 0.028)
        kit.add_cuboid("Book", near, far, book, turn)


def add_lamp(x, y):
    """A floor lamp, unlit: a paper shade, open at both ends, on a stem."""
    steel = kit.metal("Steel", (0.36, 0.36, 0.38), 0.5)
    paper = kit.lambert("Shade", (0.74, 0.68, 0.56))
    stem = [(0.0, 0.0004), (0.14, 0.0004), (0.145, 0.008), (0.14, 0.018), (0.012, 0.024),
            (0.011, 0.05), (0.011, 1.52), (0.0, 1.525)]
    kit.add_lathe("Stem", stem, steel, (x, y, 0.0), segments=32)
    shade = [(0.20, 1.30), (0.202, 1.302), (0.152, 1.648)]
    shade += [(0.15, 1.65), (0.148, 1.648), (0.198, 1.302)]
    kit.add_lathe("Shade", shade, paper, (x, y, 0.0), segments=48, closed=True)


def add_pictures():
    frame = kit.principled("Dark wood", (0.09, 0.05, 0.03), Roughness=0.5)
    mat = kit.lambert("Mat", (0.72, 0.70, 0.66))
    colors = ((0.55, 0.22, 0.10), (0.12, 0.26, 0.30))
    for i, (x, width, height) in enumerate(((-0.55, 0.50, 0.66), (0.15, 0.50, 0.66))):
        picture = kit.lambert(f"Picture {i + 1}", colors[i])
        layers = (("Frame", 0.0, 0.020, frame), ("Mat", 0.02, 0.022, mat),
                  ("Picture", 0.10, 0.024, picture))
        for name, shrink, out, material in layers:
            half_x, half_z = width / 2 - shrink, height / 2 - shrink
            kit.add_cuboid(name, (x - half_x, BACK - out, 1.60 - half_z),
                           (x + half_x, BACK - 0.001, 1.60 + half_z), material)


def add_rug():
    rug = kit.lambert("Rug", (0.50, 0.46, 0.40))
    border = kit.lambert("Rug border", (0.30, 0.11, 0.08))
    kit.add_cuboid("Rug border", (-1.45, -1.05, 0.0005), (1.15, 0.85, 0.008), border)
    kit.add_cuboid("Rug", (-1.33, -0.93, 0.001), (1.03, 0.73, 0.010), rug)


def add_shelf():
    """At the right wall, with two rows of books."""
    wood = kit.principled("Shelf", (0.34, 0.22, 0.12), Roughness=0.5)
    for z in (0.05, 0.45, 0.85):
        kit.add_cuboid("Board", (RIGHT - 0.36, 0.2, z), (RIGHT - 0.016, 1.5, z + 0.03), wood)
    for y in (0.2, 1.47):
        kit.add_cuboid("Side", (RIGHT - 0.362, y, 0.0), (RIGHT - 0.0155, y + 0.03, 0.879), wood)
    spines = ((0.42, 0.07, 0.05), (0.06, 0.14, 0.24), (0.52, 0.38, 0.10), (0.12, 0.22, 0.14),
              (0.50, 0.47, 0.40))
    materials = [kit.principled(f"Spine {i + 1}", c, Roughness=0.6) for i, c in enumerate(spines)]
    for shelf, (start, count) in enumerate(((0.25, 16), (0.72, 12))):
        y = start
        for i in range(count):
            wide, tall = 0.026 + 0.012 * ((i * 7) % 5) / 4, 0.22 + 0.08 * ((i * 5) % 7) / 6
            low = 0.0805 + 0.4 * shelf
            kit.add_cuboid("Book", (RIGHT - 0.33, y, low), (RIGHT - 0.12, y + wide, low + tall),
                           materials[(i * 3 + shelf) % len(materials)])
            y += wide + 0.001


def add_plant(x, y, z):
    """A pot with leaves on bent stalks, each turned from the last by the golden angle."""
    pot = kit.principled("Pot", (0.44, 0.20, 0.12), Roughness=0.6)
    profile = [(0.0, 0.0005), (0.07, 0.0005), (0.10, 0.16), (0.108, 0.165), (0.108, 0.185),
               (0.098, 0.185), (0.092, 0.16), (0.0, 0.16)]
    kit.add_lathe("Pot", profile, pot, (x, y, z), segments=48)
    leaf = kit.principled("Leaf", (0.06, 0.17, 0.05), Roughness=0.5)
    for i in range(14):
        turn, rise = math.radians(137.5 * i), 0.13 + 0.022 * i
        out = 0.24 - 0.011 * i
        points = []
        for step in range(7):
            t = step / 6
            r = out * t
            points.append((x + r * math.cos(turn) * 0.6, y + r * math.sin(turn),
                           z + 0.155 + rise * 1.6 * t - 0.22 * t * t))
        kit.add_tube("Stalk", points, 0.0045, leaf, 8)
        add_leaf(points[-2], points[-1], leaf)


def add_leaf(start, end, material):
    """A flat ellipsoid at the end of a stalk, tipped the way that it was heading."""
    leaf = kit.add_sphere("Leaf", end, 1.0, material, 16, 8)
    leaf.scale = (0.035, 0.006, 0.075)
    heading = [e - s for s, e in zip(start, end)]
    leaf.rotation_mode = "XYZ"
    leaf.rotation_euler = (math.atan2(-heading[1], 0.04), math.atan2(heading[0], 0.05), 0.0)


def main():
    kit.new_scene(960, 600)
    add_room()
    add_window()
    add_sofa(-0.2, 2.12)
    add_table(-0.15, 0.15)
    add_lamp(1.28, 1.82)
    add_pictures()
    add_rug()
    add_shelf()
    add_plant(RIGHT - 0.2, 0.6, 0.88)
    kit.add_camera((0.75, -2.65, 1.45), (-0.30, 1.0, 0.85), 68.0)
    kit.finish(__file__)


main()
