"""A beam from a slit falls through a prism of dense flint onto a screen: the spectrum, on the table
and on the screen.

    blender --background --factory-startup --threads 1 --python sample_scenes/prism.py

writes prism.glb beside this script. With `-- --reference OUT.exr SAMPLES` at the end it also
renders a reference by Cycles, which has no dispersion: its beam stays white.

The glass is Schott's N-SF11 (n_d = 1.78472, V_d = 25.68), as it is, not exaggerated. Everything is
laid out by Snell's law from the angle of least deviation of the d line, where the beam stays
narrowest: with a refracting angle A the incidence is asin(n sin(A / 2)), the deviation twice that
less A. The script prints where a few wavelengths meet the screen.
"""

import math
import os
import sys

sys.dont_write_bytecode = True  # leave no __pycache__ in the tree
sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import mathutils
import scene_kit as kit

N_D, ABBE = 1.78472, 25.68
APEX = math.radians(60.0)
INCIDENCE = math.asin(N_D * math.sin(APEX / 2))
DEVIATION = 2.0 * INCIDENCE - APEX

# Metres. The beam runs along +x at y = 0 and enters the prism at the origin.
SIDE, PRISM_HEIGHT = 0.09, 0.13
SLIT_X, SLIT_WIDTH, SLIT_HEIGHT = -0.24, 0.0022, 0.085
LAMP_X, LAMP_Z = -0.74, 0.068  # above the slit's middle, so that the lower half grazes the table
SCREEN_DISTANCE = 1.10  # along the beam, from the prism


def index(wavelength_um):
    """Cauchy's formula A + B / w^2 through n_d and the Abbe number."""
    d, f, c = 0.5876, 0.4861, 0.6563
    b = (N_D - 1.0) / ABBE / (1.0 / f**2 - 1.0 / c**2)
    return N_D + b * (1.0 / wavelength_um**2 - 1.0 / d**2)


def prism_corners():
    """Counter-clockwise. The beam turns left, to +y, away from the apex on the right of its way.

    The entry face holds the origin, its outer normal turned by INCIDENCE from the beam's source:
    at least deviation the light crosses the prism parallel to its base.
    """
    along_face = mathutils.Vector((math.sin(INCIDENCE), -math.cos(INCIDENCE)))  # to the apex
    apex = along_face * (0.5 * SIDE)
    foot = along_face * (-0.5 * SIDE)
    edge = foot - apex
    turn = math.cos(APEX), math.sin(-APEX)
    other = apex + mathutils.Vector((edge.x * turn[0] - edge.y * turn[1],
                                     edge.x * turn[1] + edge.y * turn[0]))
    return [tuple(apex), tuple(other), tuple(foot)]


def trace(n):
    """Where the middle of the beam leaves the prism for the index n, and its heading there."""
    apex, other, _ = (mathutils.Vector(corner) for corner in prism_corners())
    inside = math.asin(math.sin(INCIDENCE) / n)
    heading = INCIDENCE - inside  # turned left by the entry
    edge = other - apex
    # the ray t (cos, sin) meets the exit face at apex + s edge
    c, s = math.cos(heading), math.sin(heading)
    t = (apex.x * edge.y - apex.y * edge.x) / (c * edge.y - s * edge.x)
    leaving = math.asin(n * math.sin(APEX - inside))
    return mathutils.Vector((c * t, s * t)), INCIDENCE + leaving - APEX


def screen_axes():
    """The screen's middle, across it (to the viewer's right) and its normal towards the prism."""
    start, heading = trace(N_D)
    ahead = mathutils.Vector((math.cos(heading), math.sin(heading)))
    return start + SCREEN_DISTANCE * ahead, mathutils.Vector((ahead.y, -ahead.x)), -ahead


def report():
    middle, across, normal = screen_axes()
    for wavelength in (0.42, 0.45, 0.4861, 0.55, 0.5876, 0.65, 0.6563, 0.68):
        n = index(wavelength)
        start, heading = trace(n)
        ahead = mathutils.Vector((math.cos(heading), math.sin(heading)))
        t = (middle - start).dot(normal) / ahead.dot(normal)
        place = (start + t * ahead - middle).dot(across)
        print(f"prism: {1000 * wavelength:.0f} nm, n {n:.5f}: deviation "
              f"{math.degrees(heading):.3f} degrees, {1000 * place:+.1f} mm on the screen")


def add_screen():
    white = kit.lambert("Screen", (0.80, 0.80, 0.80))
    middle, across, normal = screen_axes()
    half_width, height = 0.25, 0.25
    corner = middle - half_width * across
    kit.add_quad("Screen", (*corner, 0.0005), (*(2 * half_width * across), 0), (0, 0, height),
                 white)


def add_lamp():
    """A closed housing, black inside, with the slit in its front."""
    black = kit.lambert("Housing", (0.12, 0.12, 0.13))
    back, half, top = LAMP_X - 0.04, 0.06, 0.16
    gap = SLIT_WIDTH / 2
    kit.add_cuboid("Front, left", (SLIT_X - 0.003, gap, 0.0005), (SLIT_X, half, top), black)
    kit.add_cuboid("Front, right", (SLIT_X - 0.003, -half, 0.0005), (SLIT_X, -gap, top), black)
    kit.add_cuboid("Front, top", (SLIT_X - 0.0029, -gap - 0.001, SLIT_HEIGHT),
                   (SLIT_X - 0.0001, gap + 0.001, top - 0.0005), black)
    kit.add_cuboid("Side, left", (back, half, 0.0005), (SLIT_X, half + 0.004, top), black)
    kit.add_cuboid("Side, right", (back, -half - 0.004, 0.0005), (SLIT_X, -half, top), black)
    kit.add_cuboid("Back", (back - 0.004, -half - 0.004, 0.0005), (back, half + 0.004, top), black)
    kit.add_cuboid("Lid", (back - 0.004, -half - 0.004, top), (SLIT_X, half + 0.004, top + 0.004),
                   black)
    drop = math.atan2(LAMP_Z, SLIT_X - LAMP_X)
    lift = math.atan2(SLIT_HEIGHT - LAMP_Z, SLIT_X - LAMP_X)
    middle = LAMP_Z + (SLIT_X - LAMP_X) * math.tan((lift - drop) / 2)
    cone = math.degrees(drop + lift) + 1.0  # holds the whole slit
    kit.add_spot("Beam", (LAMP_X, 0.0, LAMP_Z), (SLIT_X, 0.0, middle), 2500.0, cone, 0.02)


def main():
    kit.new_scene(960, 600)
    table = kit.lambert("Table", (0.26, 0.26, 0.27))
    kit.add_quad("Table", (-1.0, -0.7, 0), (2.4, 0, 0), (0, 2.2, 0), table)
    flint = kit.glass("N-SF11", N_D, abbe=ABBE)
    corners = prism_corners()
    kit.add_column("Prism", corners, 0.002, PRISM_HEIGHT, flint)
    # it stands in a black foot, which takes the light that would be thrown up from its bottom
    center = [sum(axis) / 3 for axis in zip(*corners)]
    foot = [tuple(c + 1.12 * (p - c) for p, c in zip(corner, center)) for corner in corners]
    black = kit.lambert("Foot", (0.02, 0.02, 0.02))
    kit.add_column("Foot", foot, 0.0004, 0.005, black)
    add_lamp()
    add_screen()
    glow = kit.emitter("Glow", (0.60, 0.74, 1.0), 0.6)
    # mostly from above, so that the screen's front stays dark
    kit.add_quad("Glow", (-0.8, -0.1, 0.8), (0, 0.9, 0), (1.5, 0, 0), glow)
    report()
    kit.add_camera((-0.31, -0.66, 0.37), (0.075, 0.255, 0.058), 39.0)
    kit.finish(__file__)


main()
