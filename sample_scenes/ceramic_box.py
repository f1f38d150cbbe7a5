"""Glazed pottery in a closed box under a small lamp: the glaze is a smooth clear coat over a
coloured body, and what it reflects draws caustics: inside the bowl and the cup, and in front of
the plate that leans at the back wall.

    blender --background --factory-startup --threads 1 --python sample_scenes/ceramic_box.py

writes ceramic_box.glb beside this script. With `-- --reference OUT.exr SAMPLES` at the end it
also renders a reference by Cycles.
"""

import math
import os
import sys

sys.dont_write_bytecode = True  # leave no __pycache__ in the tree
sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import bpy
import mathutils
import scene_kit as kit

# Inner faces of the box, metres: a display case. The camera stands inside, before the front wall.
LEFT, RIGHT = -0.50, 0.50
FRONT, BACK = -1.15, 0.45
HEIGHT = 0.80

# Low, so that the hollows lie in their own shade, which the caustics then stand out from.
LAMP = (-0.48, -0.60, 0.35)
LAMP_SIDE = 0.05


def add_box():
    white = kit.lambert("Plaster", (0.70, 0.68, 0.64))
    floor = kit.lambert("Floor", (0.33, 0.30, 0.27))
    ochre = kit.lambert("Ochre", (0.60, 0.33, 0.09))
    blue = kit.lambert("Blue grey", (0.16, 0.24, 0.34))
    across, deep, up = (RIGHT - LEFT, 0, 0), (0, BACK - FRONT, 0), (0, 0, HEIGHT)
    kit.add_quad("Floor", (LEFT, FRONT, 0), across, deep, floor)
    kit.add_quad("Ceiling", (LEFT, FRONT, HEIGHT), deep, across, white)
    kit.add_quad("Back wall", (LEFT, BACK, 0), across, up, white)
    kit.add_quad("Front wall", (LEFT, FRONT, 0), up, across, white)
    kit.add_quad("Left wall", (LEFT, FRONT, 0), deep, up, ochre)
    kit.add_quad("Right wall", (RIGHT, FRONT, 0), up, deep, blue)


def add_lamp():
    """A small square that faces the middle of the box."""
    warm = kit.emitter("Lamp", (1.0, 0.95, 0.87), 1300.0)
    half = LAMP_SIDE / 2
    lamp = kit.add_quad("Lamp", (-half, half, 0), (2 * half, 0, 0), (0, -2 * half, 0), warm)
    lamp.location = LAMP
    bpy.context.view_layer.update()
    kit.aim(lamp, (0.0, 0.05, 0.10))


def add_vase(location):
    celadon = kit.ceramic("Celadon", (0.25, 0.46, 0.33), 0.03)
    outside = [(0.0, 0.002), (0.03, 0.001)]
    outside += kit.smooth_profile(
        [(0.052, 0.0), (0.085, 0.07), (0.098, 0.15), (0.07, 0.24), (0.032, 0.31), (0.033, 0.35),
         (0.050, 0.375)]
    )
    kit.add_lathe("Vase", kit.shell(outside, 0.005), celadon, location, segments=56)


def add_bowl(location):
    """A hemisphere, deep blue, on a foot: it gathers the lamp's mirror image into a cusp."""
    cobalt = kit.ceramic("Cobalt", (0.020, 0.045, 0.22))
    foot = [(0.0, 0.004), (0.02, 0.004), (0.034, 0.004), (0.036, 0.0), (0.042, 0.0)]
    outside = foot + kit.arc((0.0, 0.128), 0.120, -69.0, 0.0, 16)
    kit.add_lathe("Bowl", kit.shell(outside, 0.006), cobalt, location, segments=72)


def add_cup(location, turn_degrees):
    oxblood = kit.ceramic("Oxblood", (0.26, 0.022, 0.016))
    corner = kit.arc((0.033, 0.008), 0.008, -90.0, 0.0, 5)
    outside = [(0.0, 0.002), (0.015, 0.002), (0.028, 0.002), *corner]
    outside += [*kit.line(corner[-1], (0.042, 0.092), 6), (0.042, 0.092)]
    kit.add_lathe("Cup", kit.shell(outside, 0.004), oxblood, location, segments=56)
    turn = math.radians(turn_degrees)
    points = []
    for step in range(17):
        angle = math.radians(-95.0 + 190.0 * step / 16)
        out = 0.040 + 0.024 * math.cos(angle)
        up = 0.049 + 0.028 * math.sin(angle)
        points.append(
            (location[0] + out * math.cos(turn), location[1] + out * math.sin(turn), up)
        )
    kit.add_tube("Handle", points, 0.0055, oxblood, 16)


def add_plate(middle, focus):
    """A shallow hollow plate on its rim, turned so that the lamp's image falls on focus."""
    middle = mathutils.Vector(middle)
    to_lamp = mathutils.Vector(LAMP) - middle
    to_focus = mathutils.Vector(focus) - middle
    normal = (to_lamp.normalized() + to_focus.normalized()).normalized()
    # the mirror equation, 2 / R = 1 / a + 1 / b
    radius = 2.0 / (1.0 / to_lamp.length + 1.0 / to_focus.length)
    half, thickness = 0.135, 0.007
    opening = math.degrees(math.asin(half / radius))
    bottom = kit.arc((0.0, radius), radius + thickness, -90.0, -90.0 + opening, 12)
    top = kit.arc((0.0, radius), radius, -90.0 + opening, -90.0, 12)
    white = kit.ceramic("White", (0.72, 0.70, 0.66))
    plate = kit.add_lathe("Plate", [(0.0, -thickness), *bottom[1:], *top[:-1], (0.0, 0.0)], white,
                          middle, segments=64)
    plate.rotation_euler = normal.to_track_quat("Z", "Y").to_euler()


def add_tiles(corner):
    """Three glazed tiles, stacked askew, under a ball."""
    yellow = kit.ceramic("Yellow", (0.62, 0.36, 0.035))
    turquoise = kit.ceramic("Turquoise", (0.03, 0.30, 0.31))
    x, y = corner
    for i, (glaze, turn) in enumerate(((yellow, 8.0), (turquoise, -14.0), (yellow, 27.0))):
        low, high = (x, y, 0.0005 + 0.017 * i), (x + 0.14, y + 0.14, 0.0165 + 0.017 * i)
        kit.add_cuboid("Tile", low, high, glaze, turn)
    white = kit.ceramic("Egg white", (0.75, 0.73, 0.70))
    kit.add_sphere("Ball", (x + 0.07, y + 0.07, 0.0515 + 0.045), 0.045, white, 48, 24)


def main():
    kit.new_scene(640, 512)
    add_box()
    add_lamp()
    add_vase((-0.26, 0.20, 0.0))
    add_bowl((-0.16, -0.26, 0.0))
    add_cup((0.16, -0.27, 0.0), -35.0)
    add_plate((0.08, 0.365, 0.139), (-0.02, 0.08, 0.0))
    add_tiles((0.245, 0.02))
    kit.add_camera((0.12, -1.10, 0.66), (0.01, 0.0, 0.115), 44.0)
    kit.finish(__file__)


main()
