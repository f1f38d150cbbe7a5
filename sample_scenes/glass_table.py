"""Glassware on a table: a spot lamp from behind throws its caustics towards the viewer, and a
large soft panel lights the rest.

    blender --background --factory-startup --threads 1 --python sample_scenes/glass_table.py

writes glass_table.glb beside this script. With `-- --reference OUT.exr SAMPLES` at the end it
also renders a reference by Cycles.
"""

import math
import os
import sys

sys.dont_write_bytecode = True  # leave no __pycache__ in the tree
sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import scene_kit as kit


def add_tumbler(location, material):
    """A heavy tumbler, metres: outside from the foot's middle up, over the rim, down inside. The
    middle of the foot is hollow, for a flat one would coincide with the table's top."""
    middle = (0.0, 0.003)
    foot = kit.arc((0.031, 0.004), 0.004, -150.0, -5.0, 10)
    rim = kit.arc((0.0395, 0.100), 0.0015, -5.0, 185.0, 8)
    well = kit.arc((0.027, 0.020), 0.008, 0.0, -90.0, 6)
    profile = [middle, *kit.line(middle, foot[0], 4), *foot]
    profile += [*kit.line(foot[-1], rim[0], 8), *rim]
    floor = (0.0, 0.012)
    profile += [*kit.line(rim[-1], well[0], 8), *well, *kit.line(well[-1], floor, 4), floor]
    kit.add_lathe("Tumbler", profile, material, location, segments=96)


def add_lens(location, radius, thickness, material):
    """A thick lens with a round edge that lies on the table: a flattened ball."""
    turns = [math.pi * (i / 48 - 0.5) for i in range(49)]
    half = thickness / 2
    profile = [(radius * math.cos(turn), half * (1.0 + math.sin(turn))) for turn in turns]
    kit.add_lathe("Lens", profile, material, location, segments=96)


def main():
    kit.new_scene(800, 600)
    wood = kit.lambert("Table", (0.55, 0.40, 0.27))
    kit.add_quad("Table", (-0.6, -0.6, 0), (1.2, 0, 0), (0, 1.1, 0), wood)
    wall = kit.lambert("Wall", (0.30, 0.34, 0.38))
    kit.add_quad("Wall", (-0.6, 0.5, 0), (1.2, 0, 0), (0, 0, 0.9), wall)
    panel = kit.emitter("Panel", (0.85, 0.93, 1.0), 1.2)
    kit.add_quad("Panel", (0.55, -0.5, 0.05), (0, 0, 0.7), (0, 0.9, 0), panel)
    glass = kit.glass("Glass", 1.5)
    green = kit.glass("Green glass", 1.52, color=(0.55, 0.90, 0.65))
    add_tumbler((-0.06, 0.02, 0.0), glass)
    kit.add_sphere("Marble", (0.07, -0.03, 0.022), 0.022, green, 64, 32)
    add_lens((0.0, -0.12, 0.0), 0.03, 0.016, glass)
    kit.add_spot(
        "Spot", (-0.28, 0.40, 0.42), (0.0, -0.03, 0.02), 15.0, 50.0, 0.4, (1.0, 0.93, 0.82)
    )
    kit.add_camera((0.10, -0.52, 0.30), (0.005, -0.035, 0.03), 30.0)
    kit.finish(__file__)


main()
