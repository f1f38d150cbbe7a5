"""Renders small Blender scenes with Cycles, exports them as glTF, renders that with ppm-render, and
compares the means of blocks of pixels.

    blender -b --factory-startup -P tests/blender/round.py -- --program build/release/bin/ppm-render

Further options after `--`: --out FOLDER (out/blender), --samples N (400), --only NAME,NAME,
--markdown (the table for docs/blender.md). Ends with status 1 when a case is beyond its limit.
"""

import argparse
import os
import subprocess
import sys

import bpy
import numpy

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.dirname(os.path.dirname(HERE))
sys.path += [HERE, os.path.join(ROOT, "sample_scenes")]

import cases  # noqa: E402  (after the path)
import scene_kit as kit  # noqa: E402

BLOCK = 8  # pixels


def export(path, case):
    """As an artist does, with custom properties; then the kit's corrections for Lambert."""
    bpy.ops.export_scene.gltf(
        filepath=path, export_format="GLB", export_cameras=True, export_lights=True,
        export_extras=True, export_animations=case.frame is not None, export_tangents=False,
        export_colors=True)
    kit.edit_glb(path, kit.correct_materials)


def for_cycles():
    """Makes Cycles show the alpha that the kit's Diffuse nodes have lost."""
    for material in bpy.data.materials:
        tree = material.node_tree
        if not tree or not (material.get("alpha") or material.get("alpha_from")):
            continue
        output = tree.nodes["Material Output"]
        mix = tree.nodes.new("ShaderNodeMixShader")
        clear = tree.nodes.new("ShaderNodeBsdfTransparent")
        surface = output.inputs["Surface"].links[0].from_socket
        if material.get("alpha_from"):
            clip = tree.nodes.new("ShaderNodeMath")
            clip.operation = "GREATER_THAN"
            clip.inputs[1].default_value = material.alpha_threshold
            image = tree.nodes[material["alpha_from"]]
            tree.links.new(image.outputs["Alpha"], clip.inputs[0])
            tree.links.new(clip.outputs[0], mix.inputs["Fac"])
        else:
            mix.inputs["Fac"].default_value = material["alpha"]
        tree.links.new(clear.outputs[0], mix.inputs[1])
        tree.links.new(surface, mix.inputs[2])
        tree.links.new(mix.outputs[0], output.inputs["Surface"])


def keep_normal_maps():
    """The kit's Diffuse nodes take the normal map with them."""
    for material in bpy.data.materials:
        tree = material.node_tree
        if not tree:
            continue
        maps = [node for node in tree.nodes if node.type == "NORMAL_MAP"]
        for node in tree.nodes:
            if maps and node.type == "BSDF_DIFFUSE":
                tree.links.new(maps[0].outputs["Normal"], node.inputs["Normal"])


def render_cycles(path, case, samples):
    scene = bpy.context.scene
    for material in bpy.data.materials:
        if material.get("lambert"):
            kit.use_diffuse_node(material)
            del material["lambert"]
    keep_normal_maps()
    for_cycles()
    scene.frame_set(case.frame or 1)
    if case.blur:
        scene.render.use_motion_blur = True
        scene.render.motion_blur_shutter = case.blur
    kit.render_cycles(path, samples, threads=os.cpu_count())


def render_ours(program, model, path, case, samples):
    scene = bpy.context.scene
    size = f"{scene.render.resolution_x}x{scene.render.resolution_y}"
    command = [program, "-i", "path", model, "-o", path, "-s", size, "-n", str(samples),
               "--filter", "box,1", "--background", "black"]
    if case.frame is not None:
        command += ["--frame", str(case.frame), "--fps", str(scene.render.fps)]
    if case.blur:
        command += ["--shutter", f"{-case.blur / 2},{case.blur / 2}"]
    subprocess.run(command, check=True, capture_output=True, text=True)


def load(path):
    """Linear RGB, rows from below."""
    image = bpy.data.images.load(path)
    image.colorspace_settings.name = "Non-Color"
    pixels = numpy.empty(len(image.pixels), dtype=numpy.float32)
    image.pixels.foreach_get(pixels)
    width, height = image.size
    picture = pixels.reshape(height, width, image.channels)[:, :, :3]
    bpy.data.images.remove(image)
    return picture


def block_means(picture):
    """Means of BLOCK x BLOCK pixels, outliers bounded: a firefly is noise, not a difference."""
    height, width, _ = picture.shape
    rows, columns = height // BLOCK, width // BLOCK
    blocks = picture[: rows * BLOCK, : columns * BLOCK].reshape(rows, BLOCK, columns, BLOCK, 3)
    return blocks.mean(axis=(1, 3))


def difference(ours, theirs):
    """Largest and mean difference of blocks by the brightness there, and of the whole means. A
    block counts as at least a tenth of the picture's mean: black has no relative error."""
    a, b = block_means(ours), block_means(theirs)
    brightness = numpy.maximum(b.mean(axis=2, keepdims=True), 0.1 * b.mean())
    errors = numpy.abs(a.mean(axis=2) - b.mean(axis=2)) / brightness[:, :, 0]
    whole = ours.mean() / max(theirs.mean(), 1e-9) - 1.0
    return float(numpy.sort(errors.ravel())[-3]), float(errors.mean()), float(whole)


def run_case(options, case):
    name = case.name + ("_blurred" if case.blur else "")
    base = os.path.join(options.out, name)
    kit.new_scene(*cases.SIZE)
    case.build()
    bpy.context.scene.frame_set(case.frame or 1)
    export(base + ".glb", case)
    render_cycles(base + "_cycles.exr", case, options.samples)
    render_ours(options.program, base + ".glb", base + "_ours.exr", case, options.samples)
    largest, mean, whole = difference(load(base + "_ours.exr"), load(base + "_cycles.exr"))
    return name, largest, mean, whole


def parse_arguments():
    parser = argparse.ArgumentParser(prog="round.py")
    parser.add_argument("--program", required=True)
    parser.add_argument("--out", default=os.path.join(ROOT, "out", "blender"))
    parser.add_argument("--samples", type=int, default=400)
    parser.add_argument("--only", default="")
    parser.add_argument("--markdown", action="store_true")
    arguments = sys.argv[sys.argv.index("--") + 1 :] if "--" in sys.argv else []
    return parser.parse_args(arguments)


def main():
    options = parse_arguments()
    os.makedirs(options.out, exist_ok=True)
    wanted = [name for name in options.only.split(",") if name]
    failed, lines = [], []
    for case in cases.CASES:
        if wanted and case.name not in wanted:
            continue
        name, largest, mean, whole = run_case(options, case)
        is_good = largest <= case.limit
        if not is_good:
            failed.append(name)
        line = (name, f"{100 * largest:.1f} %", f"{100 * mean:.1f} %", f"{100 * whole:+.1f} %",
                f"{100 * case.limit:.0f} %", case.why)
        lines.append("| " + " | ".join(line) + " |" if options.markdown else
                     "{:24}{:>9}{:>9}{:>9}{:>7}  ".format(*line[:5]) + ("ok" if is_good else "FAR"))
        print(lines[-1], flush=True)
    with open(os.path.join(options.out, "results.txt"), "w", encoding="utf-8") as file:
        file.write("\n".join(lines) + "\n")
    if failed:
        print("beyond their limits:", *failed)
    sys.exit(1 if failed else 0)


main()
