"""The caustic box: glass ball, gold ring and mirror ball in a closed box under a small lamp.

    blender --background --factory-startup --threads 1 --python sample_scenes/caustic_box.py

writes caustic_box.glb beside this script. With `-- --reference OUT.exr SAMPLES` at the end it
also renders a reference by Cycles, which needs many samples: the caustics are the point.
"""

import math
import os
import sys

sys.dont_write_bytecode = True  # leave no __pycache__ in the tree
sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import scene_kit as kit

# Inner faces of the box, metres. The camera stands inside, before the front wall.
LEFT, RIGHT = -1.2, 1.2
FRONT, BACK = -2.9, 1.2
HEIGHT = 2.0


def add_box():
    white = kit.lambert("White", (0.74, 0.74, 0.72))
    red = kit.lambert("Red", (0.52, 0.06, 0.045))
    teal = kit.lambert("Teal", (0.06, 0.30, 0.38))
    across, deep, up = (RIGHT - LEFT, 0, 0), (0, BACK - FRONT, 0), (0, 0, HEIGHT)
    kit.add_quad("Floor", (LEFT, FRONT, 0), across, deep, white)
    kit.add_quad("Ceiling", (LEFT, FRONT, HEIGHT), deep, across, white)
    kit.add_quad("Back wall", (LEFT, BACK, 0), across, up, white)
    kit.add_quad("Front wall", (LEFT, FRONT, 0), up, across, white)
    kit.add_quad("Left wall", (LEFT, FRONT, 0), deep, up, red)
    kit.add_quad("Right wall", (RIGHT, FRONT, 0), up, deep, teal)


def add_lamp(x, y, side, strength):
    """A square just below the ceiling that shines downwards."""
    warm = kit.emitter("Lamp", (1.0, 0.97, 0.92), strength)
    corner = (x - side / 2, y - side / 2, HEIGHT - 0.01)
    kit.add_quad("Lamp", corner, (0, side, 0), (side, 0, 0), warm)


def add_ring(location, radius, height, thickness):
    """A wide band with round rims. Its inner wall, lit from the side, throws the heart-shaped
    caustic: light that comes in over one side is gathered by the hollow of the other."""
    gold = kit.principled("Gold", (1.0, 0.71, 0.29), Metallic=1.0, Roughness=0.08)
    half = thickness / 2
    profile = []
    for rim, start in ((half, math.pi), (height - half, 0.0)):
        for step in range(9):
            turn = start + math.pi * step / 8
            profile.append((radius + half * math.cos(turn), rim + half * math.sin(turn)))
    kit.add_lathe("Gold ring", profile, gold, location, segments=128, closed=True)


def main():
    kit.new_scene(512, 512)
    add_box()
    add_lamp(-0.75, -0.65, side=0.28, strength=100.0)
    mirror = kit.principled("Mirror", (0.95, 0.95, 0.95), Metallic=1.0, Roughness=0.0)
    kit.add_sphere("Mirror ball", (-0.58, 0.66, 0.42), 0.42, mirror)
    # held above the floor by its focal length, so that its caustic is sharp and in view
    kit.add_sphere("Glass ball", (-0.16, -0.5, 0.47), 0.28, kit.glass("Glass", 1.5))
    add_ring((0.6, 0.22, 0.0), radius=0.35, height=0.19, thickness=0.03)
    kit.add_camera((0.0, -2.8, 1.88), (0.0, 0.0, 0.45), 39.5)
    kit.finish(__file__)


main()
