#!/usr/bin/env python3
"""Renders worlds drawn at random by photons and by paths, and reports blocks that differ beyond noise.

    worlds.py --program build/release/bin/ppm-render [--worlds 1-100] [--out DIR]

Each world is rendered several times by both integrators, with different seeds. Means over blocks of
the picture are compared: a block fails where they are further apart than the bias that is allowed
and as many standard errors as leave one false alarm in a thousand worlds. Where paths are too
noisy to tell, the block is counted as undecided and passed over. A world that fails leaves
NAME.glb, its setup and the pictures in DIR, and its line says how to render it.
"""

import argparse
import json
import math
import subprocess
import sys
import time
from pathlib import Path

sys.dont_write_bytecode = True
sys.path.insert(0, str(Path(__file__).resolve().parent))
import exr
from draw import World

WIDTH, HEIGHT, BLOCK = 64, 48, 8
# Standard errors from a handful of seeds are uncertain, and light has heavy tails: a block has to be
# off by many of them.
ERRORS_BEYOND = 6.0
# Shares of a block's mean: what density estimation may be off by while the radius is finite, and
# the standard error beyond which a block says nothing.
BIAS, UNDECIDED = 0.04, 0.06


def parse():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--program", required=True)
    parser.add_argument("--worlds", default="1-20", help="their numbers, as 7, 1-100 or 1,3,5-9")
    parser.add_argument("--seeds", type=int, default=6, help="renders of each")
    parser.add_argument("--passes", type=int, default=48, help="by photons")
    parser.add_argument("--photons", default="32k", help="a pass")
    parser.add_argument("--path-passes", type=int, default=384)
    parser.add_argument("--integrator", default="sppm", help="that is compared with path")
    parser.add_argument("--minutes", type=float, help="begin no world after so many")
    parser.add_argument("--out", default="worlds")
    return parser.parse_args()


def block_means(path):
    """Three channels of (HEIGHT / BLOCK) x (WIDTH / BLOCK) blocks."""
    _, _, planes = exr.read_rgb(path)
    means = []
    for plane in planes:
        for y in range(0, HEIGHT, BLOCK):
            for x in range(0, WIDTH, BLOCK):
                values = [plane[row * WIDTH + x + i] for row in range(y, y + BLOCK) for i in range(BLOCK)]
                means.append(sum(values) / len(values))
    return means


def mean_and_error(values):
    mean = sum(values) / len(values)
    variance = sum((x - mean) ** 2 for x in values) / (len(values) - 1)
    return mean, math.sqrt(variance / len(values))


def render(options, model, integrator, seed, picture):
    passes = options.path_passes if integrator == "path" else options.passes
    command = [options.program, "-q", "-i", integrator, "-n", passes, "-p", options.photons,
               "-s", f"{WIDTH}x{HEIGHT}", "--seed", seed, "--filter", "box,1",
               "--exr-compression", "none", "-o", picture, model]
    done = subprocess.run([str(word) for word in command], stdout=subprocess.PIPE,
                          stderr=subprocess.STDOUT, text=True, check=False)
    if done.returncode != 0:
        raise RuntimeError(f"{model}: status {done.returncode}: {done.stdout.strip()}")
    return block_means(picture)


def compare(paths, photons):
    """The worst block that differs, as text, or None; and the share of undecided blocks."""
    worst, worst_by, undecided = None, 0.0, 0
    brightest = max(mean_and_error(values)[0] for values in paths)
    for i, (path_values, photon_values) in enumerate(zip(paths, photons)):
        path, path_error = mean_and_error(path_values)
        photon, photon_error = mean_and_error(photon_values)
        floor = 1e-4 * brightest  # darker than that nobody sees a difference
        error = math.hypot(path_error, photon_error)
        if path_error > UNDECIDED * (path + floor) and photon >= path - ERRORS_BEYOND * error:
            undecided += 1
            continue
        by = (abs(path - photon) - BIAS * path - floor) / (ERRORS_BEYOND * error + 1e-30)
        if by > 1.0 and by > worst_by:
            columns = WIDTH // BLOCK
            block = i % (columns * (HEIGHT // BLOCK))
            worst_by = by
            worst = (f"block {block % columns},{block // columns} {'RGB'[i * 3 // len(paths)]}: "
                     f"path {path:.5g} +- {path_error:.2g}, photons {photon:.5g} +- {photon_error:.2g}")
    return worst, undecided / len(paths)


def run_world(options, folder, number):
    world = World(number)
    model = folder / f"world_{number}.glb"
    world.file.write(model)
    (folder / f"world_{number}.ppm.json").write_text(json.dumps(world.setup))
    means, pictures = {}, []
    for integrator in ("path", options.integrator):
        rows = []
        for seed in range(1, options.seeds + 1):
            pictures.append(folder / f"world_{number}_{integrator}_{seed}.exr")
            rows.append(render(options, model, integrator, seed, pictures[-1]))
        means[integrator] = list(zip(*rows))
    worst, undecided = compare(means["path"], means[options.integrator])
    if not worst:
        for path in (model, folder / f"world_{number}.ppm.json", *pictures):
            path.unlink()
    print(f"{'FAILED' if worst else 'agrees'} {number}: {', '.join(world.words)}; "
          f"{100 * undecided:.0f} % undecided{'; ' + worst if worst else ''}", flush=True)
    return worst is None


def numbers(text):
    found = []
    for part in text.split(","):
        first, _, last = part.partition("-")
        found += range(int(first), int(last or first) + 1)
    return found


def main():
    options = parse()
    folder = Path(options.out)
    folder.mkdir(parents=True, exist_ok=True)
    start, failed, done = time.monotonic(), [], 0
    for number in numbers(options.worlds):
        if options.minutes and time.monotonic() - start > 60 * options.minutes:
            break
        done += 1
        if not run_world(options, folder, number):
            failed.append(number)
    print(f"{done} worlds, {len(failed)} failed{': ' if failed else ''}"
          f"{', '.join(map(str, failed))}")
    return 1 if failed else 0


sys.exit(main())
