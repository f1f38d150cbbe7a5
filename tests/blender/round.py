"""Renders small Blender scenes with Cycles, exports them as glTF, renders that with ppm-render, and
compares the means of blocks of pixels.

    blender -b --factory-startup -P tests/blender/round.py -- --program build/release/bin/ppm-render

Further options after `--`: --out FOLDER (out/blender), --samples N (for a case that names no number
itself), --only NAME,NAME, --quick (a few cases), --markdown (the table for docs/blender.md). Ends
with status 1 when a case is beyond its limit, or too noisy to tell; 77 in another Blender than 3.4,
whose materials have other inputs.

Both renderers make PARTS pictures of a scene with different seeds. Their spread is the noise of a
block, so that noise is neither taken for a difference nor hides one unnoticed.
"""

import argparse
import contextlib
import os
import re
import subprocess
import sys

import bpy
import numpy

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.dirname(os.path.dirname(HERE))
sys.dont_write_bytecode = True
sys.path += [HERE, os.path.join(ROOT, "sample_scenes")]

import cases  # noqa: E402  (after the path)
import scene_kit as kit  # noqa: E402

BLOCK = 8  # pixels
PARTS = 4  # pictures of a scene by each renderer


# ---- the two pictures ------------------------------------------------------------------------


def prepare():
    """Runs the snippets of the documents: they note in extras what glTF has no words for."""
    for name in ("light-units.md", "blender.md"):
        with open(os.path.join(ROOT, "docs", name), encoding="utf-8") as file:
            snippet = re.search(r"```python\n(.*?)```", file.read(), re.DOTALL).group(1)
        exec(compile(snippet, name, "exec"), {})


def export(path, case):
    """As an artist does, with custom properties; then the kit's corrections for Lambert."""
    prepare()
    bpy.ops.export_scene.gltf(
        filepath=path, export_format="GLB", export_cameras=True, export_lights=True,
        export_extras=True, export_animations=case.frame is not None, export_tangents=False,
        export_colors=True)
    kit.edit_glb(path, kit.correct_materials)


def write_world(path):
    """The World's colour as a picture for --env: glTF has no World."""
    world = bpy.context.scene.world
    if not world:
        return False
    width, height = 8, 4
    with open(path, "wb") as file:
        file.write(f"PF\n{width} {height}\n-1.0\n".encode("ascii"))
        file.write(numpy.tile(numpy.array(world.color, dtype="<f4"), width * height).tobytes())
    return True


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
            alpha = tree.nodes[material["alpha_from"]].outputs["Alpha"]
            if material.blend_method == "CLIP":
                clip = tree.nodes.new("ShaderNodeMath")
                clip.operation = "GREATER_THAN"
                clip.inputs[1].default_value = material.alpha_threshold
                tree.links.new(alpha, clip.inputs[0])
                alpha = clip.outputs[0]
            tree.links.new(alpha, mix.inputs["Fac"])
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


def set_up_cycles(case):
    """What the file was corrected for, and the moment."""
    scene = bpy.context.scene
    for material in bpy.data.materials:
        if material.get("lambert"):
            if not material.get("keeps_nodes"):
                kit.use_diffuse_node(material)
            del material["lambert"]
    keep_normal_maps()
    for_cycles()
    scene.render.use_persistent_data = True
    scene.frame_set(case.frame or 1)
    if case.blur:
        scene.render.use_motion_blur = True
        scene.render.motion_blur_shutter = case.blur


def render_cycles(path, case, samples):
    set_up_cycles(case)
    for part in range(PARTS):
        bpy.context.scene.cycles.seed = part
        kit.render_cycles(path.format(part), samples // PARTS, threads=os.cpu_count())


def render_ours(program, model, path, case, samples):
    scene = bpy.context.scene
    size = f"{scene.render.resolution_x}x{scene.render.resolution_y}"
    command = [program, "-i", "path", model, "-s", size, "-n", str(samples // PARTS),
               "--filter", "box,1"]
    world = os.path.splitext(model)[0] + "_world.pfm"
    command += ["--env", world] if write_world(world) else ["--background", "black"]
    if case.frame is not None:
        command += ["--frame", str(case.frame), "--fps", str(scene.render.fps)]
    if case.blur:
        command += ["--shutter", f"{-case.blur / 2},{case.blur / 2}"]
    for part in range(PARTS):
        run = subprocess.run(command + ["--seed", str(part), "-o", path.format(part)],
                             capture_output=True, text=True)
        if run.returncode:
            sys.exit(f"{' '.join(command)}\n{run.stderr}")


# ---- comparing -------------------------------------------------------------------------------


def load(path):
    """Linear RGB, rows from below."""
    image = bpy.data.images.load(path)
    image.colorspace_settings.name = "Non-Color"
    pixels = numpy.empty(len(image.pixels), dtype=numpy.float32)
    image.pixels.foreach_get(pixels)
    width, height = image.size
    picture = pixels.reshape(height, width, image.channels)[:, :, :3]
    bpy.data.images.remove(image)
    return picture.astype(numpy.float64)


def block_means(picture):
    height, width, _ = picture.shape
    rows, columns = height // BLOCK, width // BLOCK
    blocks = picture[: rows * BLOCK, : columns * BLOCK].reshape(rows, BLOCK, columns, BLOCK, 3)
    return blocks.mean(axis=(1, 3))


class Measure:
    """Differences of two sets of pictures by blocks and channels, as shares of the block's
    brightness. A block counts as at least a tenth of the picture's mean: black has no relative
    error. noise is that of a difference, one standard deviation; largest is what is beyond two of
    them; root_mean_square has the noise subtracted; whole is of the mean of all pixels."""

    def __init__(self, ours, theirs):
        a, b = (numpy.array([block_means(load(path)) for path in paths])
                for paths in (ours, theirs))
        mean = b.mean(axis=0)
        brightness = numpy.maximum(mean.mean(axis=2, keepdims=True), 0.1 * mean.mean())
        variance = (a.var(axis=0, ddof=1) + b.var(axis=0, ddof=1)) / PARTS / brightness**2
        difference = (a.mean(axis=0) - mean) / brightness
        # Four pictures tell little of the noise of one block; all blocks together tell more.
        noise = numpy.sqrt(0.5 * variance + 0.5 * numpy.mean(variance))
        self.noise = float(numpy.sqrt(numpy.mean(variance)))
        self.largest = float(numpy.max(numpy.maximum(numpy.abs(difference) - 2.0 * noise, 0.0)))
        square = numpy.mean(difference**2) - numpy.mean(variance)
        self.root_mean_square = float(numpy.sqrt(max(square, 0.0)))
        self.whole = float(a.mean() / max(b.mean(), 1e-9) - 1.0)


@contextlib.contextmanager
def quiet(path):
    """What Blender and Cycles print goes to a file."""
    sys.stdout.flush()
    kept = os.dup(1)
    with open(path, "w", encoding="utf-8") as log:
        os.dup2(log.fileno(), 1)
        try:
            yield
        finally:
            sys.stdout.flush()
            os.dup2(kept, 1)
            os.close(kept)


def run_case(options, case):
    base = os.path.join(options.out, case.name)
    samples = case.samples or options.samples
    kit.new_scene(*cases.SIZE)
    case.build()
    bpy.context.scene.frame_set(case.frame or 1)
    export(base + ".glb", case)
    render_cycles(base + "_cycles{}.exr", case, samples)
    render_ours(options.program, base + ".glb", base + "_ours{}.exr", case, samples)
    return Measure(*([base + f"_{who}{part}.exr" for part in range(PARTS)]
                     for who in ("ours", "cycles")))


def verdict(measure, case):
    if measure.noise > 0.5 * case.limit:
        return "NOISY"
    return "ok" if measure.largest <= case.limit else "FAR"


def describe(case, measure, options):
    numbers = [f"{100 * value:{sign}.1f} %" for value, sign in (
        (measure.largest, ""), (measure.root_mean_square, ""), (measure.whole, "+"),
        (measure.noise, ""))]
    if options.markdown:
        return "| " + " | ".join([case.what, *numbers, case.why]) + " |"
    return "{:22}{:>9}{:>9}{:>9}{:>9}{:>6.0f} %  {}".format(
        case.name, *numbers, 100 * case.limit, verdict(measure, case))


def parse_arguments():
    parser = argparse.ArgumentParser(prog="round.py")
    parser.add_argument("--program", required=True)
    parser.add_argument("--out", default=os.path.join(ROOT, "out", "blender"))
    parser.add_argument("--samples", type=int, default=64)
    parser.add_argument("--only", default="")
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--markdown", action="store_true")
    arguments = sys.argv[sys.argv.index("--") + 1 :] if "--" in sys.argv else []
    return parser.parse_args(arguments)


def choose_cases(options):
    wanted = [name for name in options.only.split(",") if name]
    unknown = set(wanted) - {case.name for case in cases.CASES}
    if unknown:
        sys.exit(f"round.py: no such case: {', '.join(sorted(unknown))}")
    return [case for case in cases.CASES
            if (not wanted or case.name in wanted) and (not options.quick or case.is_quick)]


def main():
    if bpy.app.version[:2] != (3, 4):
        print("skipped: this is Blender", bpy.app.version_string, "and not 3.4")
        sys.exit(77)
    options = parse_arguments()
    os.makedirs(options.out, exist_ok=True)
    failed, lines = [], []
    for case in choose_cases(options):
        with quiet(os.path.join(options.out, case.name + ".log")):
            measure = run_case(options, case)
        if verdict(measure, case) != "ok":
            failed.append(case.name)
        lines.append(describe(case, measure, options))
        print(lines[-1], flush=True)
    with open(os.path.join(options.out, "results.txt"), "w", encoding="utf-8") as file:
        file.write("\n".join(lines) + "\n")
    if failed:
        print("beyond their limits:", *failed)
    sys.exit(1 if failed else 0)


main()
