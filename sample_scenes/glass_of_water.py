"""A tumbler of water with a straw, on a table: the straw is bent by the water and broadened by the
round glass, and a spot lamp from behind throws the caustic towards the viewer.

    blender --background --factory-startup --threads 1 --python sample_scenes/glass_of_water.py

writes glass_of_water.glb beside this script. With `-- --reference OUT.exr SAMPLES` at the end it
also renders a reference by Cycles, which knows no priorities: a ray counts the water's surface
inside of the glass there, and its caustic is a little different.

The water is a closed body that reaches a little into the glass, so that no film of air is left
between them. Where both are, the glass has the higher priority and is what is there.
"""

import math
import os
import sys

sys.dont_write_bytecode = True  # leave no __pycache__ in the tree
sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import scene_kit as kit

# The tumbler, metres: it widens from the foot to the rim.
FOOT_RADIUS, RIM_RADIUS = 0.030, 0.038
WALL, BASE, HEIGHT = 0.0026, 0.009, 0.118
LEVEL = 0.079  # of the water
OVERLAP = 0.0004  # of the water into the glass


def inner_radius(height):
    """Of the tumbler's bore."""
    return FOOT_RADIUS - WALL + (RIM_RADIUS - FOOT_RADIUS) * height / HEIGHT


def bore(out):
    """Points from the wall at the water's level down to the middle of the floor, out of the way
    by out: the tumbler's inside, or the water's outside."""
    corner = 0.006
    center = (inner_radius(BASE + corner) - corner, BASE + corner)
    well = kit.arc(center, corner + out, 0.0, -90.0, 8)
    top = (inner_radius(LEVEL) + out, LEVEL)
    floor = (0.0, BASE - out)
    return [top, *kit.line(top, well[0], 8), *well, *kit.line(well[-1], floor, 5), floor]


def add_tumbler(location):
    """The middle of the foot is hollow, for a flat one would coincide with the table's top."""
    glass = kit.glass("Glass", 1.5, priority=1)
    middle = (0.0, 0.0025)
    foot = kit.arc((FOOT_RADIUS - 0.003, 0.003), 0.003, -130.0, -4.0, 8)
    rim = kit.arc((RIM_RADIUS - WALL / 2, HEIGHT), WALL / 2, -4.0, 176.0, 8)
    inside = bore(0.0)
    profile = [middle, *kit.line(middle, foot[0], 4), *foot]
    profile += [*kit.line(foot[-1], rim[0], 10), *rim, *kit.line(rim[-1], inside[0], 4), *inside]
    kit.add_lathe("Tumbler", profile, glass, location, segments=72)


def add_water(location):
    """Up from the middle of the floor, and at the wall a meniscus that creeps up by 1.5 mm."""
    water = kit.glass("Water", 1.33, color=(0.93, 0.98, 1.0))
    side = list(reversed(bore(OVERLAP)))[:-1]
    rim = (inner_radius(LEVEL + 0.0015) + OVERLAP, LEVEL + 0.0015)
    surface = []
    for step in range(8):
        inwards = 0.0008 * step**1.4
        height = LEVEL + 0.0015 * math.exp(-inwards / 0.0025)
        surface.append((inner_radius(LEVEL) - inwards, height))
    middle = (0.0, LEVEL)
    profile = [*side, rim, *surface, *kit.line(surface[-1], middle, 4), middle]
    kit.add_lathe("Water", profile, water, location, segments=72)


def add_straw(location):
    """A striped bar that leans in the glass, bent near its upper end. It stays clear of the glass:
    its lower end rests just above the floor, and it passes inside the rim."""
    x, y = location[:2]
    red = kit.ceramic("Red", (0.60, 0.03, 0.02), 0.2)
    white = kit.ceramic("Cream", (0.80, 0.78, 0.70), 0.2)
    low, knee = (x + 0.002, y - 0.006, BASE + 0.0045), (x + 0.0300, y + 0.0140, 0.128)
    end = (x + 0.061, y + 0.020, 0.152)
    stripes = 12
    for i in range(stripes):
        a, b = ([p + (q - p) * t / stripes for p, q in zip(low, knee)] for t in (i, i + 1))
        kit.add_tube("Straw", [a, b], 0.003, (red, white)[i % 2], 20)
    bend = []
    for step in range(9):  # a quadratic Bezier curve from the knee to the end
        t = step / 8
        middle = [k + 0.16 * (k - l) for k, l in zip(knee, low)]
        bend.append([(1 - t) ** 2 * k + 2 * t * (1 - t) * m + t * t * e
                     for k, m, e in zip(knee, middle, end)])
    kit.add_tube("Straw's end", bend, 0.003, red, 20)


def add_table():
    wood = kit.lambert("Table", (0.50, 0.36, 0.23))
    cloth = kit.lambert("Cloth", (0.62, 0.60, 0.55))
    stripe = kit.lambert("Stripe", (0.10, 0.20, 0.34))
    wall = kit.lambert("Wall", (0.55, 0.50, 0.42))
    kit.add_quad("Table", (-0.6, -0.5, 0), (1.2, 0, 0), (0, 0.9, 0), wood)
    kit.add_quad("Wall", (-0.6, 0.4, 0), (1.2, 0, 0), (0, 0, 0.8), wall)
    # the cloth lies on the table, its stripes on the cloth, each by a thread's width
    kit.add_quad("Cloth", (-0.19, -0.5, 0.0004), (0.42, 0, 0), (0, 0.8, 0), cloth)
    for x in (-0.175, -0.160, 0.200, 0.215):
        kit.add_quad("Stripe", (x - 0.004, -0.5, 0.0006), (0.008, 0, 0), (0, 0.8, 0), stripe)


def main():
    kit.new_scene(640, 640)
    add_table()
    place = (0.0, 0.03, 0.0006)
    add_tumbler(place)
    add_water(place)
    add_straw(place)
    lemon = kit.principled("Lemon", (0.75, 0.50, 0.04), Roughness=0.45)
    kit.add_sphere("Lemon", (-0.105, 0.10, 0.032), 0.0315, lemon, 48, 24)
    panel = kit.emitter("Panel", (0.82, 0.92, 1.0), 2.2)
    kit.add_quad("Panel", (0.55, -0.45, 0.05), (0, 0, 0.7), (0, 0.8, 0), panel)
    lamp, target = (-0.24, 0.36, 0.36), (0.01, 0.0, 0.03)
    kit.add_spot("Spot", lamp, target, 14.0, 48.0, 0.4, (1.0, 0.94, 0.84))
    kit.add_camera((0.06, -0.42, 0.235), (0.022, -0.02, 0.050), 31.0)
    kit.finish(__file__)


main()
