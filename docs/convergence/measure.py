"""Renders pictures, each once, and measures them.

A render is kept in the work folder under a name that ends in a digest of all that decides what it
shows; what is there is not rendered again, so that a run which was interrupted goes on where it
stopped.
"""

import hashlib
import json
import os
import subprocess
import sys
from dataclasses import dataclass, field
from pathlib import Path

FIRST_REFERENCE_SEED = 1000001  # far from those of the curves: noise must not be shared


class Failure(Exception):
    """What went wrong, for the user."""


def say(text):
    print(text, file=sys.stderr, flush=True)


def run(command, environment=None):
    """Returns what the command prints."""
    try:
        done = subprocess.run(
            [str(word) for word in command],
            env=environment,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
            check=False,
        )
    except OSError as error:
        raise Failure(f"{command[0]}: {error.strerror}") from error
    if done.returncode != 0:
        words = " ".join(str(word) for word in command)
        raise Failure(f"{words}\nended with status {done.returncode}:\n{done.stderr.strip()}")
    return done.stdout


def digest(*parts):
    """Of bytes and of anything that JSON can say."""
    sha = hashlib.sha256()
    for part in parts:
        data = part if isinstance(part, bytes) else json.dumps(part).encode()
        sha.update(len(data).to_bytes(8, "little"))
        sha.update(data)
    return sha.hexdigest()[:12]


@dataclass(frozen=True)
class Render:
    """A finished picture and what ppm-render says about it."""

    picture: Path
    seconds: float
    passes: int
    photons: int


@dataclass(frozen=True)
class Errors:
    """Of a picture against a reference."""

    mse: float
    relative_mse: float
    relative_mse_trimmed: float
    flip: float
    broken: int


@dataclass(frozen=True)
class ReferencePicture:
    """The mean of several renders, and the relative MSE that its own noise adds to all others."""

    picture: Path
    noise: float
    noise_trimmed: float


@dataclass(frozen=True)
class Point:
    """One point of a curve."""

    integrator: str
    target_seconds: float
    seed: int
    render: Render
    errors: Errors


@dataclass
class Programs:
    """The programs of one build."""

    folder: Path
    oiiotool: str = "oiiotool"
    build: str = field(init=False)
    version: str = field(init=False)

    def __post_init__(self):
        self.render = self.folder / "ppm-render"
        self.compare = self.folder / "ppm-compare"
        self.version = " ".join(run([self.render, "--version"]).split("\n")).strip()
        run([self.compare, "--version"])
        run([self.oiiotool, "--version"])
        libraries = sorted((self.folder.parent / "lib").glob("**/libppm.so*"))
        files = [self.render, *libraries]
        self.build = digest(*[file.read_bytes() for file in files if file.is_file()])


@dataclass(frozen=True)
class Setting:
    """What all renders of a scene share."""

    programs: Programs
    scenes_folder: Path
    work: Path
    width: int
    threads: int
    photons: int  # a pass; 0: ppm-render's default
    trim: float

    def scene_file(self, scene):
        return self.scenes_folder / f"{scene.name}.glb"

    def scene_bytes(self, scene):
        try:
            return self.scene_file(scene).read_bytes()
        except OSError as error:
            raise Failure(f"{self.scene_file(scene)}: {error.strerror}") from error

    def options(self, scene, how, seconds, seed):
        words = ["-s", f"{self.width}x{scene.height_for(self.width)}", "-t", f"{seconds:g}"]
        words += ["--seed", str(seed), "--threads", str(self.threads)]
        if self.photons:
            words += ["-p", str(self.photons)]
        return words + list(scene.options) + list(how)


def _read_render(picture, stats):
    told = json.loads(stats.read_text())["render"]
    return Render(picture, told["seconds_render"], told["passes"], told["photons_emitted"])


def _render(setting, scene, name, options):
    """Picture and statistics get their names when both are complete. A render that was stopped by
    Ctrl-C ends well too, with a picture of too few passes: this program then ends before."""
    picture = setting.work / f"{name}.exr"
    stats = setting.work / f"{name}.json"
    if picture.is_file() and stats.is_file():
        return _read_render(picture, stats)
    new_picture = setting.work / f"{name}.new.exr"
    new_stats = setting.work / f"{name}.new.json"
    output = ["-q", "-o", new_picture, "--stats", new_stats]
    run([setting.programs.render, *options, *output, setting.scene_file(scene)])
    os.replace(new_picture, picture)
    os.replace(new_stats, stats)
    return _read_render(picture, stats)


def compare(setting, picture, reference):
    environment = dict(
        os.environ, OMP_NUM_THREADS=str(setting.threads), OMP_WAIT_POLICY="passive"
    )

    def numbers(*options):
        command = [setting.programs.compare, "--json", *options, picture, reference]
        return json.loads(run(command, environment))

    whole = numbers()
    # FLIP is known by now: at a single exposure it takes the least time.
    trimmed = numbers("--trim", f"{setting.trim:g}", "--exposure", "0")
    return Errors(
        whole["mse"],
        whole["relative_mse"],
        trimmed["relative_mse"],
        whole["flip"]["mean"],
        whole["area"]["broken_test"],
    )


def _average(setting, pictures, out):
    command = [setting.programs.oiiotool, pictures[0]]
    for picture in pictures[1:]:
        command += [picture, "--add"]
    new = out.with_suffix(".new.exr")
    run([*command, "--divc", str(len(pictures)), "-d", "float", "-o", new])
    os.replace(new, out)


def make_reference(setting, scene, seconds, parts):
    """The mean of `parts` renders of `seconds` each, with seeds of their own.

    With n parts of variance s^2, a part differs from the mean by s^2 (n - 1)/n, and the mean from
    what the parts converge to by s^2/n. So the noise of the mean is the first over n - 1."""
    renders = []
    kinds = []
    for part in range(parts):
        options = setting.options(
            scene, scene.reference.options, seconds, FIRST_REFERENCE_SEED + part
        )
        key = digest(setting.scene_bytes(scene), options)
        kinds.append(key)
        say(f"{scene.name}: reference {part + 1} of {parts}, {seconds:g} s")
        name = f"{scene.name}-reference-{part + 1}-{key}"
        renders.append(_render(setting, scene, name, options))
    pictures = [render.picture for render in renders]
    mean = setting.work / f"{scene.name}-reference-{digest(kinds)}.exr"
    _average(setting, pictures, mean)
    errors = [compare(setting, picture, mean) for picture in pictures]
    scale = 1.0 / (parts * (parts - 1))
    return ReferencePicture(
        mean,
        scale * sum(error.relative_mse for error in errors),
        scale * sum(error.relative_mse_trimmed for error in errors),
    )


def measure_point(setting, scene, integrator, seconds, seed, reference):
    """Unlike a reference, a point belongs to the build that took this time for it."""
    options = setting.options(scene, integrator.options, seconds, seed)
    key = digest(setting.scene_bytes(scene), setting.programs.build, options)
    name = f"{scene.name}-{integrator.name}-{seconds:g}s-seed{seed}-{key}"
    render = _render(setting, scene, name, options)
    errors = compare(setting, render.picture, reference.picture)
    say(
        f"{scene.name}: {integrator.name}, {render.seconds:.3g} s, {render.passes} passes: "
        f"relative MSE {errors.relative_mse:.3g}, trimmed {errors.relative_mse_trimmed:.3g}, "
        f"FLIP {errors.flip:.3g}"
    )
    if errors.broken:
        say(f"{scene.name}: warning: {errors.broken} pixels are no numbers, and not counted")
    return Point(integrator.name, seconds, seed, render, errors)
