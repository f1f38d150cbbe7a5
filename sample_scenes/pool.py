"""Water waves over a tiled pool under a low sun: a net of caustics on floor and walls.

    blender --background --factory-startup --threads 1 --python sample_scenes/pool.py

writes pool.glb beside this script. With `-- --reference OUT.exr SAMPLES` at the end it also
renders a reference by Cycles (which cannot find these caustics: its sun is 2 degrees wide to
give it a chance).
"""

import math
import os
import sys

sys.dont_write_bytecode = True  # leave no __pycache__ in the tree
sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import bpy
import numpy
import scene_kit as kit

# The basin, metres: the water's mean level is z = 0, the deck lies above it.
HALF_X, HALF_Y = 2.0, 3.0
DEPTH = 1.4
DECK = 0.15
COPING = 2.0  # width of the deck around the basin

# Each wave: length (m), amplitude (m), heading (degrees), phase (degrees). Slopes of about 5 to
# 8 % and crests that focus the sun about as deep as the floor, as after a swimmer's turn.
WAVES = (
    (1.70, 0.0200, 20.0, 0.0),
    (1.15, 0.0140, 75.0, 130.0),
    (0.83, 0.0100, -35.0, 250.0),
    (0.61, 0.0070, 118.0, 40.0),
    (0.47, 0.0047, 160.0, 310.0),
    (0.36, 0.0030, 48.0, 205.0),
)
WATER_CELL = 0.035  # metres; ten cells to the shortest wave


def tile_image(name, tile_colors, joint_color, size=256, tiles=4, joint=0.05):
    """A packed texture of tiles x tiles tiles, each of one of the colours, with joints."""
    rows, columns = numpy.mgrid[0:size, 0:size]
    in_tile = [(axis * tiles % size) / size for axis in (rows, columns)]
    is_joint = numpy.minimum(*in_tile) < joint
    is_joint |= numpy.maximum(*in_tile) > 1.0 - joint
    # A small multiplicative hash picks each tile's colour, the same in every run.
    index = (rows * tiles // size) * tiles + columns * tiles // size
    choice = (index * 2654435761 >> 7) % len(tile_colors)
    pixels = numpy.ones((size, size, 4), dtype=numpy.float32)
    pixels[..., :3] = numpy.where(
        is_joint[..., None], joint_color, numpy.array(tile_colors)[choice]
    )
    image = bpy.data.images.new(name, size, size)
    image.pixels.foreach_set(pixels.ravel())
    image.pack()
    return image


def add_tiled(name, corner, edge_u, edge_v, material, image_side):
    """A wall or floor whose texture repeats every image_side metres."""
    u, v = (math.hypot(*edge) / image_side for edge in (edge_u, edge_v))
    uvs = [(0, 0), (u, 0), (u, v), (0, v)]
    kit.add_quad(name, corner, edge_u, edge_v, material, uvs)


def add_basin():
    # Colours of an image are sRGB values, not linear ones.
    blues = [(0.53, 0.80, 0.87), (0.60, 0.85, 0.90), (0.48, 0.75, 0.85), (0.56, 0.83, 0.86)]
    tiles = kit.lambert("Tiles", (1, 1, 1))
    kit.use_texture(tiles, tile_image("Tiles", blues, (0.90, 0.93, 0.93)))
    x, y, height = 2 * HALF_X, 2 * HALF_Y, DEPTH + DECK
    low = -DEPTH
    add_tiled("Floor", (-HALF_X, -HALF_Y, low), (x, 0, 0), (0, y, 0), tiles, 1.0)
    add_tiled("Wall -Y", (HALF_X, -HALF_Y, low), (-x, 0, 0), (0, 0, height), tiles, 1.0)
    add_tiled("Wall +Y", (-HALF_X, HALF_Y, low), (x, 0, 0), (0, 0, height), tiles, 1.0)
    add_tiled("Wall -X", (-HALF_X, -HALF_Y, low), (0, y, 0), (0, 0, height), tiles, 1.0)
    add_tiled("Wall +X", (HALF_X, HALF_Y, low), (0, -y, 0), (0, 0, height), tiles, 1.0)


def add_deck():
    stone = kit.lambert("Stone", (0.62, 0.56, 0.47))
    x, y, w = HALF_X, HALF_Y, COPING
    long_way, across = (2 * (x + w), 0, 0), (w, 0, 0)
    kit.add_quad("Deck -Y", (-x - w, -y - w, DECK), long_way, (0, w, 0), stone)
    kit.add_quad("Deck +Y", (-x - w, y, DECK), long_way, (0, w, 0), stone)
    kit.add_quad("Deck -X", (-x - w, -y, DECK), across, (0, 2 * y, 0), stone)
    kit.add_quad("Deck +X", (x, -y, DECK), across, (0, 2 * y, 0), stone)


def wave_height(x, y):
    height = 0.0
    for length, amplitude, heading, phase in WAVES:
        turn = math.radians(heading)
        along = x * math.cos(turn) + y * math.sin(turn)
        height += amplitude * math.sin(2.0 * math.pi * along / length + math.radians(phase))
    return height


def add_water():
    """An open sheet, normals up, that ends a little inside the walls' tiles: no gap lets light
    past it. Being open it has no inside of its own; the side of its normal is the air."""
    overlap = 0.005
    columns = round(2 * HALF_X / WATER_CELL)
    rows = round(2 * HALF_Y / WATER_CELL)
    vertices = []
    for j in range(rows + 1):
        y = (HALF_Y + overlap) * (2.0 * j / rows - 1.0)
        for i in range(columns + 1):
            x = (HALF_X + overlap) * (2.0 * i / columns - 1.0)
            vertices.append((x, y, wave_height(x, y)))
    faces = []
    for j in range(rows):
        for i in range(columns):
            k = j * (columns + 1) + i
            faces.append((k, k + 1, k + columns + 2, k + columns + 1))
    kit.add_mesh("Water", vertices, faces, kit.glass("Water", 1.33))


def add_sky():
    """A part of a bright dome behind the pool for the water to mirror, out of the sun's way. It
    is small, as photons of the sun that miss the pool are lost on the scene's extent."""
    radius, columns, rows = 6.8, 12, 6
    vertices = []
    for j in range(rows + 1):
        up = math.radians(-2.0 + 76.0 * j / rows)
        for i in range(columns + 1):
            turn = math.radians(18.0 + 128.0 * i / columns)
            x, y = math.cos(up) * math.cos(turn), math.cos(up) * math.sin(turn)
            vertices.append((radius * x, radius * y, radius * math.sin(up)))
    faces = []
    for j in range(rows):
        for i in range(columns):
            k = j * (columns + 1) + i
            faces.append((k, k + columns + 1, k + columns + 2, k + 1))  # inwards
    blue = kit.emitter("Sky", (0.42, 0.64, 1.0), 0.55)
    kit.add_mesh("Sky", vertices, faces, blue)


def add_sun():
    data = bpy.data.lights.new("Sun", "SUN")
    data.energy = 3.0  # W/m2: by the exporter's 683 lm/W, 2049 lux in the file
    data.color = (1.0, 0.94, 0.84)
    data.angle = math.radians(2.0)  # for Cycles; a glTF sun is a point at infinity
    sun = kit.link("Sun", data, (-4.0, -2.0, 4.6))
    kit.aim(sun, (0.0, 0.0, 0.0))


def main():
    kit.new_scene(960, 640)
    add_basin()
    add_deck()
    add_water()
    add_sky()
    add_sun()
    kit.add_camera((0.75, -5.2, 3.2), (0.13, -0.5, -0.52), 46.0)
    kit.finish(__file__)


main()
