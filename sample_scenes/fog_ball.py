"""A glass ball in fog: a spot lamp from the left lights it, and behind it the light runs together
in a caustic cone, crosses, and spreads again. Seen from the side, for rendering with --fog.

    blender --background --factory-startup --threads 1 --python sample_scenes/fog_ball.py

writes fog_ball.glb beside this script. glTF has no fog, so the file has none: `--fog 0.1,0` adds
it. `-- --reference OUT.exr SAMPLES` renders a reference by Cycles, without fog too.

The ball's focal length from its middle is R n / (2 (n - 1)), 1.5 R for n = 1.5. With the lamp 3 m
away the middle rays meet 1 m behind the middle of a ball of 0.5 m, and the outer ones before.
"""

import math
import os
import sys

sys.dont_write_bytecode = True  # leave no __pycache__ in the tree
sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import scene_kit as kit

RADIUS = 0.5
HEIGHT = 1.25  # of the beam's axis above the floor, metres
LAMP_X = -2.6


def add_stage():
    """A dark floor and a dark curtain; the beam ends in the wings, on black cloth."""
    floor = kit.lambert("Floor", (0.060, 0.045, 0.035))
    velvet = kit.lambert("Velvet", (0.010, 0.010, 0.014))
    kit.add_quad("Floor", (-3.4, -2.0, 0), (7.2, 0, 0), (0, 4.0, 0), floor)
    kit.add_quad("Back", (-3.4, 2.0, 0), (7.2, 0, 0), (0, 0, 3.2), velvet)
    kit.add_quad("Right wing", (3.8, -2.0, 0), (0, 0, 3.2), (0, 4.0, 0), velvet)
    kit.add_quad("Left wing", (-3.4, -2.0, 0), (0, 4.0, 0), (0, 0, 3.2), velvet)


def add_ball():
    kit.add_sphere("Ball", (0, 0, HEIGHT), RADIUS, kit.glass("Glass", 1.5), 96, 48)
    # a ring on a stem, below the beam's middle: it takes the least light
    brass = kit.metal("Brass", (0.75, 0.52, 0.26), 0.5)
    seat = HEIGHT - RADIUS
    stem = [(0.0, 0.0005), *kit.arc((0.26, 0.02), 0.0195, -90.0, 90.0, 6), (0.10, 0.05),
            (0.035, 0.14), (0.03, 0.30), (0.03, seat - 0.16), (0.05, seat - 0.10),
            (0.13, seat - 0.03), (0.148, seat + 0.0135), (0.138, seat + 0.0135),
            (0.12, seat - 0.018), (0.0, seat - 0.022)]
    kit.add_lathe("Stand", stem, brass, segments=64)


def add_lamp():
    """A theatre lamp: a tube, black, open to the right, with the point of light in it."""
    black = kit.lambert("Lamp", (0.03, 0.03, 0.03))
    steel = kit.metal("Steel", (0.30, 0.30, 0.32), 0.5)
    outer, inner, back, front = 0.15, 0.14, -0.16, 0.42
    profile = [(0.0, back), (outer, back), (outer, front), (inner, front), (inner, back + 0.01),
               (0.0, back + 0.01)]
    tube = kit.add_lathe("Lamp", profile, black, (LAMP_X, 0, HEIGHT), segments=48)
    for polygon in tube.data.polygons:
        polygon.use_smooth = False
    tube.rotation_euler.y = math.radians(90.0)
    kit.add_tube("Post", [(LAMP_X, 0, 0.0005), (LAMP_X, 0, HEIGHT - outer - 0.001)], 0.03, steel)
    # the cone is a little wider than the ball, so that its edge is seen in the fog
    half = math.degrees(math.asin(RADIUS / -LAMP_X)) + 0.8
    kit.add_spot("Beam", (LAMP_X, 0, HEIGHT), (0, 0, HEIGHT), 3600.0, 2.0 * half, 0.05,
                 (1.0, 0.96, 0.90))


def main():
    kit.new_scene(960, 540)
    add_stage()
    add_ball()
    add_lamp()
    # from high up behind, to draw the rims of things
    rim = kit.emitter("Rim", (0.45, 0.62, 1.0), 1.0)
    kit.add_quad("Rim", (-1.6, 1.5, 3.3), (0, 0.4, -0.3), (3.6, 0, 0), rim)
    kit.add_camera((0.45, -4.6, 1.50), (0.32, 0.0, 1.215), 38.0)
    kit.finish(__file__)


main()
