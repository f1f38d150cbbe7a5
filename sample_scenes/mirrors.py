"""Mirrors that face each other, with mirror balls and a glass ball between: light takes dozens of
bounces to the end of the row. A path that is cut short leaves a black pixel there.

    blender --background --factory-startup --threads 1 --python sample_scenes/mirrors.py

writes mirrors.glb beside this script. With `-- --reference OUT.exr SAMPLES` at the end it also
renders a reference by Cycles, whose paths end after 32 bounces here.
"""

import math
import os
import sys

sys.dont_write_bytecode = True  # leave no __pycache__ in the tree
sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import scene_kit as kit

# The room, metres: mirrors left and right, bright walls at the ends, a bright ceiling.
LEFT, RIGHT = -1.5, 1.5
FRONT, BACK = -2.4, 2.0
HEIGHT = 2.4
TILE = 0.5


def add_room():
    plaster = kit.lambert("Plaster", (0.72, 0.70, 0.66))
    coral = kit.lambert("Coral", (0.62, 0.20, 0.13))
    across, deep, up = (RIGHT - LEFT, 0, 0), (0, BACK - FRONT, 0), (0, 0, HEIGHT)
    kit.add_quad("Ceiling", (LEFT, FRONT, HEIGHT), deep, across, plaster)
    kit.add_quad("Back wall", (LEFT, BACK, 0), across, up, coral)
    kit.add_quad("Front wall", (LEFT, FRONT, 0), up, across, plaster)


def add_floor():
    """Two meshes, the dark and the light tiles of a chequered floor."""
    colors = ((0.58, 0.55, 0.48), (0.045, 0.10, 0.12))
    columns, rows = round((RIGHT - LEFT) / TILE), round((BACK - FRONT) / TILE + 0.5)
    for parity, (name, color) in enumerate(zip(("Light tiles", "Dark tiles"), colors)):
        vertices, faces = [], []
        for row in range(rows):
            for column in range(parity ^ (row & 1), columns, 2):
                x, y = LEFT + column * TILE, FRONT + row * TILE
                end = min(y + TILE, BACK)
                first = len(vertices)
                vertices += [(x, y, 0), (x + TILE, y, 0), (x + TILE, end, 0), (x, end, 0)]
                faces.append((first, first + 1, first + 2, first + 3))
        kit.add_mesh(name, vertices, faces, kit.lambert(name, color), smooth=False)


def add_mirrors():
    """Silvered glass reflects 0.96, a little less in blue and red: deep images turn green."""
    silver = kit.metal("Mirror", (0.955, 0.965, 0.955), 0.0)
    deep, up = (0, BACK - FRONT, 0), (0, 0, HEIGHT)
    kit.add_quad("Left mirror", (LEFT, FRONT, 0), deep, up, silver)
    kit.add_quad("Right mirror", (RIGHT, FRONT, 0), up, deep, silver)
    kit.add_sphere("Mirror ball", (0.40, 0.98, 0.42), 0.42, silver, 64, 32)
    gold = kit.metal("Gold", (1.0, 0.72, 0.32), 0.0)
    kit.add_sphere("Gold ball", (0.78, -0.30, 0.30), 0.30, gold, 64, 32)
    # two balls that nearly touch: between them paths bounce longest
    kit.add_sphere("Mirror ball", (0.05, 0.16, 0.2), 0.2, silver, 48, 24)
    kit.add_sphere("Mirror ball", (0.44, 0.30, 0.2), 0.2, silver, 48, 24)
    kit.add_sphere("Glass ball", (0.22, -0.50, 0.19), 0.19, kit.glass("Glass", 1.5), 64, 32)


def add_lamps():
    """Two panels below the ceiling and three glowing balls."""
    warm = kit.emitter("Panel", (1.0, 0.93, 0.82), 6.0)
    for y in (-1.2, 0.7):
        kit.add_quad("Panel", (-0.5, y, HEIGHT - 0.01), (0, 0.6, 0), (1.0, 0, 0), warm)
    glow = kit.emitter("Glow", (1.0, 0.55, 0.22), 5.0)
    for y in (-0.75, 0.15, 1.05):
        kit.add_sphere("Glow", (0.75, y, 1.50), 0.08, glow, 32, 16)


def main():
    kit.new_scene(900, 600)
    add_room()
    add_floor()
    add_mirrors()
    add_lamps()
    kit.add_camera((-1.40, -0.55, 1.05), (1.5, 0.40, 0.66), 70.0)
    kit.finish(__file__)


main()
