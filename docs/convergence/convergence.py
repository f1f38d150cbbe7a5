#!/usr/bin/env python3
"""Error over time of all integrators on the sample scenes: tables, plots and results.md.

README.md beside this file says what is measured, what is needed, and how to read it.
"""

import argparse
import os
import sys
from pathlib import Path

from cases import DEFAULT_INTEGRATORS, DEFAULT_SCENES, INTEGRATORS, SCENES
from measure import Failure, Programs, Setting, make_reference, measure_point, say
from report import write_plot, write_results, write_tsv

HERE = Path(__file__).resolve().parent
PROJECT = HERE.parent.parent

FULL = {"time": 60.0, "steps": 6, "width": 320, "reference_parts": 4, "photons": 0}
QUICK = {"time": 1.0, "steps": 2, "width": 64, "reference_parts": 2, "photons": 16384}
QUICK_SCENES = ("caustic_box",)


def _names(known):
    def parse(text):
        names = text.split(",")
        for name in names:
            if name not in known:
                raise argparse.ArgumentTypeError(f"no '{name}'; there are {', '.join(known)}")
        return tuple(dict.fromkeys(names))

    return parse


def _at_least(kind, least):
    def parse(text):
        value = kind(text)
        if not least <= value < 1e9:
            raise argparse.ArgumentTypeError(f"{text} is not from {least} to 1e9")
        return value

    parse.__name__ = "number"
    return parse


def _trim(text):
    value = float(text)
    if not 0 <= value < 1:
        raise argparse.ArgumentTypeError(f"{text} is not from 0 to below 1")
    return value


def _parser():
    parser = argparse.ArgumentParser(
        description="Renders the error-over-time curves of all integrators and plots them.",
        epilog="What was rendered before is not rendered again: stop it, start it again.",
        allow_abbrev=False,
    )
    add = parser.add_argument
    add("--scenes", type=_names(SCENES), metavar="NAME,...", help=f"of {', '.join(SCENES)}")
    add(
        "--integrators",
        type=_names(INTEGRATORS),
        default=DEFAULT_INTEGRATORS,
        metavar="NAME,...",
        help=f"of {', '.join(INTEGRATORS)} (default: {','.join(DEFAULT_INTEGRATORS)})",
    )
    seconds = _at_least(float, 0.01)
    add("--time", type=seconds, metavar="SECONDS", help="of each curve's last point (60)")
    add("--steps", type=_at_least(int, 0), metavar="N", help="halvings of it before (6)")
    add("--at", type=seconds, metavar="SECONDS", help="time of the summary (half of --time)")
    add("--width", type=_at_least(int, 8), metavar="PIXELS", help="of the pictures (320)")
    add("--photons", type=_at_least(int, 0), metavar="N", help="a pass (0: the program's default)")
    add("--seeds", type=_at_least(int, 1), default=1, metavar="N", help="take medians of N (1)")
    add("--threads", type=_at_least(int, 1), default=2, metavar="N", help="(2)")
    add("--trim", type=_trim, default=0.001, metavar="F", help="share of worst pixels (0.001)")
    add("--reference-time", type=seconds, metavar="SECONDS", help="of each part (4 * --time)")
    add("--reference-parts", type=_at_least(int, 2), metavar="N", help="averaged (4)")
    add("--quick", action="store_true", help="a smoke test: other defaults, small and short")
    add(
        "--bin",
        type=Path,
        default=PROJECT / "build/release/bin",
        metavar="DIR",
        help="where ppm-render and ppm-compare are (build/release/bin)",
    )
    add("--work", type=Path, metavar="DIR", help="pictures are kept here (out/convergence)")
    add(
        "--output",
        type=Path,
        metavar="DIR",
        help="for tables and plots (beside this script; with --quick out/convergence-quick)",
    )
    return parser


def _arguments(words):
    """All defaults filled in."""
    parser = _parser()
    args = parser.parse_args(words)
    for name, value in (QUICK if args.quick else FULL).items():
        if getattr(args, name) is None:
            setattr(args, name, value)
    args.scenes = args.scenes or (QUICK_SCENES if args.quick else DEFAULT_SCENES)
    args.at = args.at or args.time / 2
    if args.at > args.time:
        parser.error(f"--at {args.at:g} is after the end of the curves, --time {args.time:g}")
    args.reference_time = args.reference_time or 4 * args.time
    args.work = args.work or PROJECT / "out/convergence"
    args.output = args.output or (PROJECT / "out/convergence-quick" if args.quick else HERE)
    return args


def _announce(args, times):
    curves = len(args.integrators) * args.seeds * sum(times)
    total = len(args.scenes) * (curves + args.reference_parts * args.reference_time)
    say(f"{len(args.scenes)} scenes: {total / 60:.0f} minutes of rendering, less what is there")


def _measure_scene(setting, scene, args, times):
    reference = make_reference(setting, scene, args.reference_time, args.reference_parts)
    points = [
        measure_point(setting, scene, INTEGRATORS[name], seconds, seed, reference)
        for name in args.integrators
        for seconds in times
        for seed in range(args.seeds)
    ]
    write_tsv(args.output / f"{scene.name}.tsv", scene, points)
    write_plot(args.output / f"{scene.name}.png", scene, setting, points, reference)
    return scene, points, reference


def _run(args):
    args.work.mkdir(parents=True, exist_ok=True)
    args.output.mkdir(parents=True, exist_ok=True)
    setting = Setting(
        programs=Programs(args.bin),
        scenes_folder=PROJECT / "sample_scenes",
        work=args.work,
        width=args.width,
        threads=args.threads,
        photons=args.photons,
        trim=args.trim,
    )
    times = [args.time / 2**halvings for halvings in range(args.steps, -1, -1)]
    _announce(args, times)
    results = [_measure_scene(setting, SCENES[name], args, times) for name in args.scenes]
    write_results(args.output / "results.md", results, setting, args.integrators, args)
    say(f"wrote {args.output / 'results.md'}")


def main():
    os.environ["LC_ALL"] = "C"
    try:
        _run(_arguments(sys.argv[1:]))
    except (Failure, OSError) as error:
        say(f"convergence.py: {error}")
        return 1
    except KeyboardInterrupt:
        say("convergence.py: interrupted; the same command goes on from here")
        return 130
    return 0


if __name__ == "__main__":
    sys.exit(main())
