"""What Blender's compositor makes of a file of layers: it lists them, the light layers add up to the
picture, its Cryptomatte node takes each object out cleanly, numbers are exact whatever the compression,
and groups with long names are there.

blender -b --factory-startup --python-exit-code 1 -P layers.py -- --program PPM_RENDER --out FOLDER
"""

import argparse
import json
import os
import struct
import subprocess
import sys

import bpy
import numpy

FOLDER = os.path.dirname(os.path.abspath(__file__))
SCENE = os.path.join(FOLDER, "..", "..", "sample_scenes", "glass_table.glb")
OBJECTS = ["Lens", "Marble", "Panel", "Table", "Tumbler", "Wall"]
WIDTH, HEIGHT = 128, 96
PASSES = ["Combined", "Alpha", "Depth", "albedo", "caustics", "diffuse_direct", "diffuse_indirect",
          "emission", "environment", "glossy_direct", "glossy_indirect", "normal", "object_index",
          "position", "transmission", "volume", "CryptoObject00"]
LIGHT = ["diffuse_direct", "diffuse_indirect", "glossy_direct", "glossy_indirect", "transmission",
         "emission", "environment", "caustics", "volume"]


def check(is_true, text):
    if not is_true:
        raise AssertionError(text)


def render(program, path, *options):
    command = [program, "-q", "-s", f"{WIDTH}x{HEIGHT}", "-n", "4", "-p", "20000", "--aov", "all",
               "--light-groups=named", "-o", path, *options, SCENE]
    subprocess.run(command, check=True)


class Compositor:
    """Pixels of any socket, by a picture that is composited of it: without a render layer nothing is
    rendered."""

    def __init__(self, folder):
        scene = bpy.context.scene
        scene.use_nodes = True
        scene.render.resolution_x, scene.render.resolution_y = WIDTH, HEIGHT
        scene.render.resolution_percentage = 100
        scene.render.image_settings.file_format = "OPEN_EXR"
        scene.render.image_settings.color_depth = "32"
        self.path = os.path.join(folder, "socket.exr")
        scene.render.filepath = self.path
        self.nodes, self.links = scene.node_tree.nodes, scene.node_tree.links
        self.nodes.clear()
        self.composite = self.nodes.new("CompositorNodeComposite")
        self.composite.use_alpha = False

    def pixels(self, socket):
        self.links.new(socket, self.composite.inputs["Image"])
        bpy.ops.render.render(write_still=True)
        image = bpy.data.images.load(self.path)
        values = numpy.empty(4 * WIDTH * HEIGHT, dtype=numpy.float32)
        image.pixels.foreach_get(values)
        bpy.data.images.remove(image)
        return values.reshape(HEIGHT, WIDTH, 4)[:, :, :3]


def check_layers(compositor, image):
    node = compositor.nodes.new("CompositorNodeImage")
    node.image = image
    check(image.type == "MULTILAYER", f"{image.name} is read as {image.type}")
    names = [output.name for output in node.outputs]
    for name in PASSES:
        check(name in names, f"{name} is not among {names}")
    for layer in ("light", "caustics"):
        node.layer = layer
        names = [output.name for output in node.outputs]
        check({"Spot", "Panel"} <= set(names), f"the groups of {layer} are {names}")


def open_plain(compositor, image):
    """A node that shows the layer without a name, which is the first."""
    node = compositor.nodes.new("CompositorNodeImage")
    node.image = image
    return node


def check_sum(compositor, image):
    node = open_plain(compositor, image)
    picture = compositor.pixels(node.outputs["Combined"])
    total = sum(compositor.pixels(node.outputs[name]).astype(numpy.float64) for name in LIGHT)
    error = numpy.abs(total - picture).max() / picture.max()
    print(f"{image.name}: light layers differ from the picture by {error:.2g} of its maximum")
    check(error < 1e-5, f"the light layers do not add up: {error}")
    check(picture.max() > 0, "the picture is black")


def check_mattes(compositor, image):
    index = compositor.pixels(open_plain(compositor, image).outputs["object_index"])[:, :, 0]
    matte_node = compositor.nodes.new("CompositorNodeCryptomatteV2")
    matte_node.source = "IMAGE"
    matte_node.image = image
    matte_node.layer_name = "CryptoObject"
    total = numpy.zeros((HEIGHT, WIDTH))
    for name in OBJECTS:
        matte_node.matte_id = name
        matte = compositor.pixels(matte_node.outputs["Matte"])[:, :, 0]
        inside, outside = matte > 0.999, matte < 0.001
        total += matte
        print(f"{image.name}: {name} {inside.sum()} pixels, {(~inside & ~outside).sum()} of an edge")
        check(matte.min() >= 0 and matte.max() < 1.0001, f"{name}: {matte.min()}..{matte.max()}")
        if not inside.any():
            continue
        numbers = numpy.unique(index[inside])
        check(len(numbers) == 1, f"inside {name} there are the objects {numbers}")
        check(not (index[outside] == numbers[0]).any(), f"outside {name} there is more of it")
    check(abs(total - 1).max() < 1e-3, f"the mattes add up to {total.min()}..{total.max()}")


DATA = ["normal", "position", "motion", "uv", "Depth", "object_index", "variance"]


def read_data(compositor, image):
    node = open_plain(compositor, image)
    outputs = {output.name: output for output in node.outputs}
    return {name: compositor.pixels(outputs[name]) for name in DATA if name in outputs}


def check_data(plain, packed, name):
    """Numbers that are no light are the same bits, whatever the compression."""
    check(set(plain) == set(packed) and len(plain) >= 5, f"{name}: {set(plain)}, {set(packed)}")
    for layer, values in plain.items():
        check(numpy.array_equal(values, packed[layer]), f"{name}: {layer} is not what it was")
    print(f"{name}: {', '.join(plain)} are exact")


def rename_lights(path):
    """The sample scene with lights whose names begin with the same 70 letters."""
    with open(SCENE, "rb") as file:
        data = file.read()
    length = struct.unpack_from("<I", data, 12)[0]
    document = json.loads(data[20:20 + length])
    for key in ("nodes", "materials", "meshes"):
        for item in document.get(key, []):
            if item.get("name") in ("Spot", "Panel"):
                item["name"] = "a" * 70 + item["name"]
    for light in document.get("extensions", {}).get("KHR_lights_punctual", {}).get("lights", []):
        light["name"] = "a" * 70 + light.get("name", "")
    text = json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    rest = data[20 + length:]
    with open(path, "wb") as file:
        file.write(struct.pack("<4sII", b"glTF", 2, 20 + len(text) + len(rest)))
        file.write(struct.pack("<I4s", len(text), b"JSON") + text + rest)


def check_long_names(compositor, program, folder):
    scene, path = os.path.join(folder, "long.glb"), os.path.join(folder, "long.exr")
    rename_lights(scene)
    subprocess.run([program, "-q", "-s", f"{WIDTH}x{HEIGHT}", "-n", "1", "-p", "1000", "--aov",
                    "light,caustics", "--light-groups=named", "-o", path, scene], check=True)
    node = open_plain(compositor, bpy.data.images.load(path))
    for layer in ("light", "caustics"):
        node.layer = layer
        names = [output.name for output in node.outputs if output.name.startswith("aaaa")]
        check(len(names) == 2 and all("~" in name for name in names), f"{layer} has {names}")
        print(f"{layer}: {names}")


def main():
    if bpy.app.version[:2] != (3, 4):  # whose nodes and scenes are these
        print("skipped: this is Blender", bpy.app.version_string, "and not 3.4")
        sys.exit(77)
    parser = argparse.ArgumentParser()
    parser.add_argument("--program", required=True)
    parser.add_argument("--out", required=True)
    arguments = parser.parse_args(sys.argv[sys.argv.index("--") + 1:])
    os.makedirs(arguments.out, exist_ok=True)
    for name, options in (("plain", []), ("parts", ["--exr-multipart"]),
                          ("packed", ["--exr-compression", "dwaa", "--exr-tiles"]),
                          ("rounded", ["--exr-compression", "pxr24"])):
        path = os.path.join(arguments.out, f"{name}.exr")
        render(arguments.program, path, *options)
        compositor = Compositor(arguments.out)
        image = bpy.data.images.load(path)
        check_layers(compositor, image)
        if name not in ("packed", "rounded"):  # which round colours
            check_sum(compositor, image)
        data = read_data(compositor, image)
        if name == "plain":
            plain = data
        check_data(plain, data, name)
        check_mattes(compositor, image)
    check_long_names(compositor, arguments.program, arguments.out)


main()
