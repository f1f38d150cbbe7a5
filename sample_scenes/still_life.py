"""A still life as OBJ and MTL: a glass of red wine, a celadon vase, a bowl of fruit, a lemon. Light
from a window on the left, and a spot from behind that throws the wine's caustic onto the cloth.

    blender --background --factory-startup --threads 1 --python sample_scenes/still_life.py

writes still_life.obj and still_life.mtl beside this script. What OBJ cannot say, camera, lights and
the better part of the materials, is in still_life.ppm.json, which is written by hand.

The wine is a closed body that reaches a little into the glass, so that no film of air is left
between them. Where both are, the glass has the higher priority and is what is there.
"""

import math
import os
import sys

sys.dont_write_bytecode = True  # leave no __pycache__ in the tree
sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import bpy
import mathutils
import scene_kit as kit

LEVEL = 0.122  # of the wine above the table
OVERLAP = 0.0004  # of the wine into the glass

# What of the materials MTL can say. Ks 0.5 is a dielectric of index 1.5.
MATERIALS = {
    "Table": ["Kd 0.16 0.085 0.045", "Ks 0.5 0.5 0.5", "Ns 40", "illum 2"],
    "Wall": ["Kd 0.16 0.17 0.155", "Ks 0 0 0", "illum 1"],
    "Cloth": ["Kd 0.46 0.43 0.37", "Ks 0 0 0", "illum 1"],
    "Hem": ["Kd 0.13 0.19 0.30", "Ks 0 0 0", "illum 1"],
    "Glass": ["Kd 0 0 0", "Ks 0.5 0.5 0.5", "Ni 1.52", "Tf 1 1 1", "illum 7"],
    "Wine": ["Kd 0 0 0", "Ks 0.5 0.5 0.5", "Ni 1.345", "Tf 1 1 1", "illum 7"],
    "Celadon": ["Kd 0.25 0.43 0.32", "Ks 0.5 0.5 0.5", "Ns 800", "illum 2"],
    "Cobalt": ["Kd 0.025 0.055 0.25", "Ks 0.5 0.5 0.5", "Ns 900", "illum 2"],
    "Lemon": ["Kd 0.72 0.48 0.03", "Ks 0.5 0.5 0.5", "Ns 30", "illum 2"],
    "Orange": ["Kd 0.70 0.22 0.02", "Ks 0.5 0.5 0.5", "Ns 30", "illum 2"],
    "Lime": ["Kd 0.22 0.36 0.04", "Ks 0.5 0.5 0.5", "Ns 40", "illum 2"],
}


def material(name):
    """A name to hang on meshes: the values are in MATERIALS."""
    return bpy.data.materials.get(name) or bpy.data.materials.new(name)


# ---- the wine glass ------------------------------------------------------------------------


def bore():
    """The inside of the glass's bowl, from the middle of its floor up to the rim."""
    knots = [(0.0, 0.0672), (0.005, 0.0674), (0.017, 0.0710), (0.0312, 0.0850), (0.0391, 0.1080)]
    knots += [(0.0391, 0.1300), (0.0346, 0.1600), (0.0314, 0.1820)]
    return kit.smooth_profile(knots, 4)


def add_wine_glass(location):
    """The middle of the foot is hollow, for a flat one would coincide with the cloth."""
    middle = (0.0, 0.0024)
    edge = kit.arc((0.0345, 0.0016), 0.0016, -120.0, 75.0, 7)
    knots = [edge[-1], (0.022, 0.0050), (0.0088, 0.0088), (0.0046, 0.0180), (0.0038, 0.0320)]
    knots += [(0.0041, 0.0450), (0.0066, 0.0580), (0.0185, 0.0668), (0.0330, 0.0830)]
    knots += [(0.0406, 0.1080), (0.0406, 0.1300), (0.0360, 0.1600), (0.0326, 0.1820)]
    outside = kit.smooth_profile(knots, 4)
    rim = kit.arc((0.0320, 0.1820), 0.0006, 20.0, 160.0, 4)
    profile = [middle, *kit.line(middle, edge[0], 4), *edge, *outside[1:], *rim, *reversed(bore())]
    kit.add_lathe("Wine glass", profile, material("Glass"), location, segments=72)


def add_wine(location):
    """Up from the middle of the floor, and at the wall a meniscus that creeps up by 1.2 mm."""
    points = [mathutils.Vector(point) for point in bore()]
    side = []
    for i, point in enumerate(points):
        along = (points[min(i + 1, len(points) - 1)] - points[max(i - 1, 0)]).normalized()
        outer = point + OVERLAP * mathutils.Vector((along.y, -along.x))
        if i == 0:
            outer.x = 0.0
        if outer.y < LEVEL - 0.001:
            side.append(tuple(outer))
    wall = side[-1][0]
    surface = []
    for step in range(8):
        inwards = 0.0006 + 0.0008 * step**1.4
        surface.append((wall - inwards, LEVEL + 0.0012 * math.exp(-inwards / 0.0025)))
    top = (wall, LEVEL + 0.0012)
    middle = (0.0, LEVEL)
    profile = [*side, top, *surface, *kit.line(surface[-1], middle, 4), middle]
    kit.add_lathe("Wine", profile, material("Wine"), location, segments=72)


# ---- ceramics and fruit --------------------------------------------------------------------


def add_vase(location):
    outside = [(0.0, 0.002), (0.018, 0.001)]
    knots = [(0.034, 0.0), (0.048, 0.030), (0.062, 0.080), (0.060, 0.130), (0.038, 0.185)]
    knots += [(0.0195, 0.225), (0.0170, 0.260), (0.0240, 0.292), (0.0310, 0.302)]
    outside += kit.smooth_profile(knots, 4)
    profile = kit.shell(outside, 0.004)
    kit.add_lathe("Vase", profile, material("Celadon"), location, segments=64)


def add_bowl(location):
    """A part of a ball's surface on a foot."""
    foot = [(0.0, 0.004), (0.020, 0.004), (0.036, 0.004), (0.0375, 0.0), (0.043, 0.0)]
    outside = foot + kit.arc((0.0, 0.115), 0.105, -66.0, -18.0, 14)
    profile = kit.shell(outside, 0.005)
    kit.add_lathe("Bowl", profile, material("Cobalt"), location, segments=72)


def add_lemon(name, location, turn_degrees, tilt_degrees=90.0):
    """It lies; turned about the vertical, its tip towards +x at 0."""
    knots = [(0.0, -0.0415), (0.006, -0.0385), (0.0195, -0.0285), (0.0282, -0.0100)]
    knots += [(0.0285, 0.0060), (0.0215, 0.0240), (0.0092, 0.0350), (0.0052, 0.0400), (0.0, 0.0425)]
    profile = kit.smooth_profile(knots, 4)
    profile[0], profile[-1] = (0.0, profile[0][1]), (0.0, profile[-1][1])
    lemon = kit.add_lathe(name, profile, material("Lemon"), location, segments=40)
    lemon.rotation_euler = (0.0, math.radians(tilt_degrees), math.radians(turn_degrees))


def add_fruit(location):
    """In the bowl, whose inside is of radius 0.1 about a point 0.115 above the table."""
    x, y, z = location
    orange = material("Orange")
    kit.add_sphere("Orange", (x + 0.0365, y - 0.006, z + 0.0640), 0.0365, orange, 48, 24)
    add_lemon("Lemon in the bowl", (x - 0.0400, y - 0.012, z + 0.0600), 70.0)
    kit.add_sphere("Lime", (x - 0.002, y + 0.0510, z + 0.0650), 0.0270, material("Lime"), 40, 20)


# ---- the table -----------------------------------------------------------------------------


def add_table():
    kit.add_cuboid("Table", (-0.55, -0.32, -0.03), (0.55, 0.42, 0.0), material("Table"))
    kit.add_quad("Wall", (-1.0, 0.62, -0.5), (2.0, 0, 0), (0, 0, 1.5), material("Wall"))
    # the cloth lies on the table, its hems on the cloth, each by a thread's width
    kit.add_quad("Cloth", (-0.215, -0.32, 0.0004), (0.43, 0, 0), (0, 0.70, 0), material("Cloth"))
    for x in (-0.205, -0.190, 0.190, 0.205):
        corner = (x - 0.003, -0.32, 0.0006)
        kit.add_quad("Hem", corner, (0.006, 0, 0), (0, 0.70, 0), material("Hem"))


def main():
    kit.new_scene(640, 480)
    add_table()
    glass = (0.100, -0.060, 0.0006)
    bowl = (-0.035, 0.130, 0.0004)
    add_wine_glass(glass)
    add_wine(glass)
    add_vase((-0.165, 0.115, 0.0004))
    add_bowl(bowl)
    add_fruit(bowl)
    add_lemon("Lemon", (-0.125, -0.085, 0.0290), 24.0)
    bpy.context.view_layer.update()
    path = os.path.splitext(os.path.abspath(__file__))[0]
    kit.export_obj(path, MATERIALS, "still_life, made by still_life.py")


main()
