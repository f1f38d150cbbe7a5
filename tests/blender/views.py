"""Shows a picture of ppm-render through Blender's own configuration, by ppm-render and by Blender,
and compares the code values.

    blender -b --factory-startup -P tests/blender/views.py -- --program build/release/bin/ppm-render

Ends with status 1 where a code value of 8 bits differs by more than one step; 77 where Blender's
configuration is not where it is looked for.
"""

import argparse
import os
import subprocess
import sys

import bpy
import numpy

HERE = os.path.dirname(os.path.abspath(__file__))
SCENE = os.path.join(HERE, "..", "..", "sample_scenes", "caustic_box.glb")

# view, look (None: none), exposure, gamma
SETTINGS = (
    ("Standard", None, 0, 1),
    ("Filmic", None, 0, 1),
    ("Filmic", "High Contrast", 1.5, 1),
    ("Filmic", "Very Low Contrast", -1, 1.3),
    ("False Color", None, 0, 1),
    ("Raw", None, 0.5, 1),
)


def find_config():
    """Where Blender has it."""
    return os.path.join(
        bpy.utils.system_resource("DATAFILES", path="colormanagement"), "config.ocio")


def render(program, config, folder, setting, number):
    view, look, exposure, gamma = setting
    names = [os.path.join(folder, f"{number}{ending}") for ending in (".exr", ".png")]
    command = [program, "-q", "--size", "128x96", "--passes", "2", "--ocio", config, "--view", view,
               "--exposure", str(exposure), "--gamma", str(gamma), "--no-dither"]
    if look:
        command += ["--look", look]
    for name in names:
        command += ["--output", name]
    subprocess.run(command + [SCENE], check=True)
    return names


def save_by_blender(exr, setting, path):
    view, look, exposure, gamma = setting
    scene = bpy.context.scene
    settings = scene.view_settings
    scene.display_settings.display_device = "sRGB"
    settings.view_transform = view
    settings.look = look or "None"
    settings.exposure = exposure
    settings.gamma = gamma
    output = scene.render.image_settings
    output.file_format = "PNG"
    output.color_mode = "RGB"
    output.color_depth = "8"
    scene.render.dither_intensity = 0
    image = bpy.data.images.load(exr)
    image.save_render(path, scene=scene)
    bpy.data.images.remove(image)


def read_codes(path):
    """0 .. 255, without alpha."""
    image = bpy.data.images.load(path)
    image.colorspace_settings.name = "Non-Color"
    values = numpy.array(image.pixels[:]).reshape(-1, image.channels)[:, :3]
    bpy.data.images.remove(image)
    return numpy.rint(values * 255)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--program", required=True)
    parser.add_argument("--out", default="out/blender_views")
    args = parser.parse_args(sys.argv[sys.argv.index("--") + 1:])
    config = find_config()
    if not os.path.exists(config):
        print(f"skipped: {config} is not here")
        sys.exit(77)
    folder = os.path.abspath(args.out)
    os.makedirs(folder, exist_ok=True)
    is_good = True
    for number, setting in enumerate(SETTINGS):
        exr, png = render(args.program, config, folder, setting, number)
        blender_png = os.path.join(folder, f"{number}_blender.png")
        save_by_blender(exr, setting, blender_png)
        ours, theirs = read_codes(png), read_codes(blender_png)
        worst = numpy.abs(ours - theirs).max()
        other = (ours != theirs).mean()
        spread = theirs.max() - theirs.min()
        print(f"{setting}: worst difference {worst:.0f} of 255, {100 * other:.2f} % of the values, "
              f"which span {spread:.0f}")
        is_good = is_good and worst <= 1 and spread > 50
    sys.exit(0 if is_good else 1)


if __name__ == "__main__":
    main()
