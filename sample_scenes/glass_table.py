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
import bpy
import scene_kit as kit


def arc(center, radius, start, end, steps):
    """Points of (radius, height) on a circle; angles in degrees, 90 is up."""
    turns = [math.radians(start + (end - start) * i / steps) for i in range(steps + 1)]
    return [
        (center[0] + radius * math.cos(turn), center[1] + radius * math.sin(turn))
        for turn in turns
    ]


def line(start, end, steps):
    """Points between start and end, without them: they keep the normals of long walls straight."""
    (x, y), (dx, dy) = start, (end[0] - start[0], end[1] - start[1])
    return [(x + dx * i / steps, y + dy * i / steps) for i in range(1, steps)]


def add_tumbler(location, material):
    """A heavy tumbler, metres: outside from the foot's middle up, over the rim, down inside. The
    middle of the foot is hollow, for a flat one would coincide with the table's top."""
    middle = (0.0, 0.003)
    foot = arc((0.031, 0.004), 0.004, -150.0, -5.0, 10)
    rim = arc((0.0395, 0.100), 0.0015, -5.0, 185.0, 8)
    well = arc((0.027, 0.020), 0.008, 0.0, -90.0, 6)
    profile = [middle, *line(middle, foot[0], 4), *foot]
    profile += [*line(foot[-1], rim[0], 8), *rim]
    profile += [*line(rim[-1], well[0], 8), *well, *line(well[-1], (0.0, 0.012), 4), (0.0, 0.012)]
    kit.add_lathe("Tumbler", profile, material, location, segments=96)


def add_lens(location, radius, thickness, material):
    """A thick lens with a round edge that lies on the table: a flattened ball."""
    turns = [math.pi * (i / 48 - 0.5) for i in range(49)]
    half = thickness / 2
    profile = [(radius * math.cos(turn), half * (1.0 + math.sin(turn))) for turn in turns]
    kit.add_lathe("Lens", profile, material, location, segments=96)


def add_spot(location, target):
    data = bpy.data.lights.new("Spot", "SPOT")
    data.energy = 15.0  # watts as Blender counts them: 815 cd in the file
    data.color = (1.0, 0.93, 0.82)
    data.spot_size = math.radians(50.0)
    data.spot_blend = 0.4
    data.shadow_soft_size = 0.004  # for Cycles; a glTF spot is a point
    kit.aim(kit.link("Spot", data, location), target)


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
    add_spot((-0.28, 0.40, 0.42), (0.0, -0.03, 0.02))
    kit.add_camera((0.10, -0.52, 0.30), (0.005, -0.035, 0.03), 30.0)
    kit.finish(__file__)


main()
