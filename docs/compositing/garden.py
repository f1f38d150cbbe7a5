"""Things that are put into a photograph of a garden: balls of glass and a golden ring on a lawn that
is a catcher.

    blender --background --factory-startup --threads 1 --python docs/compositing/garden.py

writes garden.glb beside this script. The photograph is a latitude-longitude picture, so the camera
stands where it was taken from: above the origin, at the height of the tripod.
"""

import math
import os
import sys

sys.dont_write_bytecode = True  # leave no __pycache__ in the tree
here = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(here, "..", "..", "sample_scenes"))
import scene_kit as kit

TRIPOD = 1.5
AZIMUTH = math.radians(-11.0)  # of the camera, clockwise from north


def ahead(far, right):
    """A place on the lawn, in metres from below the camera."""
    x, y = math.sin(AZIMUTH), math.cos(AZIMUTH)
    return (far * x + right * y, far * y - right * x)


def main():
    kit.new_scene(480, 320)
    grass = kit.lambert("Grass", (0.075, 0.105, 0.035))
    corner, right, far = ahead(1.2, -2.2), ahead(0.0, 4.8), ahead(4.2, 0.0)
    kit.add_quad("Lawn", (*corner, 0), (*right, 0), (*far, 0), grass)
    clear = kit.glass("Glass", 1.5)
    amber = kit.glass("Amber", 1.5, color=(0.98, 0.74, 0.38))
    gold = kit.metal("Gold", (1.0, 0.71, 0.29), 0.05)
    kit.add_sphere("Ball", (*ahead(3.1, -0.15), 0.40), 0.40, clear, 96, 48)
    kit.add_sphere("Amber ball", (*ahead(2.55, 0.62), 0.22), 0.22, amber, 96, 48)
    width, height, thick = 0.34, 0.10, 0.012
    ring = [(width + thick * math.cos(turn), height * (0.5 + 0.5 * math.sin(turn)))
            for turn in (math.tau * i / 48 for i in range(48))]
    kit.add_lathe("Ring", ring, gold, (*ahead(2.35, -0.62), 0.0), 128, closed=True)
    kit.add_quad("Tripod", (-0.01, -0.01, 0), (0.02, 0, 0), (0, 0.02, 0), grass)  # out of sight
    target = (*ahead(3.2, 0.25), 0.3)
    kit.add_camera((0, 0, TRIPOD), target, 66.0)
    kit.export_glb(os.path.join(here, "garden.glb"))


main()
