"""What is written: a table of all points, a plot and a section of results.md for each scene."""

import math
import platform
import subprocess
from pathlib import Path

from cases import INTEGRATORS
from curves import METRICS, make_curve, slope, value_at
from measure import Failure

COLUMNS = (
    "scene",
    "integrator",
    "target_seconds",
    "seed",
    "seconds",
    "passes",
    "photons",
    "mse",
    "relative_mse",
    "relative_mse_trimmed",
    "flip",
    "broken_pixels",
)


def write_tsv(path, scene, points):
    rows = ["\t".join(COLUMNS)]
    for point in points:
        render, errors = point.render, point.errors
        row = (
            scene.name,
            point.integrator,
            f"{point.target_seconds:g}",
            str(point.seed),
            f"{render.seconds:.6g}",
            str(render.passes),
            str(render.photons),
            f"{errors.mse:.6g}",
            f"{errors.relative_mse:.6g}",
            f"{errors.relative_mse_trimmed:.6g}",
            f"{errors.flip:.6g}",
            str(errors.broken),
        )
        rows.append("\t".join(row))
    path.write_text("\n".join(rows) + "\n")


# ---- plots ---------------------------------------------------------------------------------------

_PLOT_HEAD = """\
set terminal pngcairo size 1500,560 font "sans,12" background "white"
set output "{file}"
set multiplot title "{title}" font "sans,14"
set logscale xy
set xrange [{x_low:g}:{x_high:g}]
set xtics ({x_ticks})
set xlabel "rendering time in seconds, {threads} threads"
set grid xtics ytics mytics linecolor rgb "#c0c0c0", linecolor rgb "#ececec"
set border linecolor rgb "#606060"
set tmargin at screen 0.88
set bmargin at screen 0.23
unset key
"""

# The key has a plot of its own, as wide as the picture, in which nothing is drawn.
_PLOT_KEY = """\
unset border
unset tics
unset grid
unset xlabel
unset ylabel
set lmargin at screen 0.02
set rmargin at screen 0.98
set tmargin at screen 0.11
set bmargin at screen 0.01
set key horizontal center center samplen 2.5 width 2
set yrange [1:2]
"""

_LEFT_SIDES = (0.06, 0.392, 0.724)  # of the panels, as shares of the picture's width
_PANEL_WIDTH = 0.262


def _ticks(low, high):
    """1, 2, 5 of each decade: gnuplot itself would label the decades only."""
    decades = range(math.floor(math.log10(low)), math.ceil(math.log10(high)) + 1)
    ticks = [digit * 10.0**decade for decade in decades for digit in (1, 2, 5)]
    return ", ".join(f"{tick:g}" for tick in ticks if low <= tick <= high)


def _quote(text):
    return text.replace("\\", "\\\\").replace('"', '\\"').replace("_", "\\\\_")


def _data_block(integrator, curve):
    rows = [
        " ".join(f"{value:.6g}" if value > 0 else "NaN" for value in values)
        for values in (
            (point.seconds, *(getattr(point, metric) for metric in METRICS)) for point in curve
        )
    ]
    return "\n".join([f"${integrator} << EOD", *rows, "EOD"])


def _line(name, what):
    look = INTEGRATORS[name]
    return (
        f'{what} with linespoints title "{_quote(look.title)}" linewidth 2 '
        f'linecolor rgb "{look.colour}" pointtype {look.point} pointsize 1.2'
    )


def _noise_line(what):
    look = 'linewidth 1.5 dashtype 2 linecolor rgb "#404040"'
    return f'{what} with lines title "noise of the reference" {look}'


def _panel(curves, metric, label, noise):
    """noise: 0 for none."""
    values = [getattr(point, metric) for curve in curves.values() for point in curve]
    values = [value for value in [*values, noise] if value > 0] or [1.0]
    low, high = min(values) / 1.4, max(values) * 1.4
    column = METRICS.index(metric)
    left = _LEFT_SIDES[column]
    lines = [_line(name, f"${name} using 1:{2 + column}") for name in curves]
    if noise > 0:
        lines.append(_noise_line(f"{noise:.6g}"))
    commands = [
        f"set lmargin at screen {left}",
        f"set rmargin at screen {left + _PANEL_WIDTH}",
        f"set yrange [{low:g}:{high:g}]",
        f'set ylabel "{label}" offset 1',
    ]
    if high / low < 100:
        commands += ['set format y "%g"', f"set ytics ({_ticks(low, high)})"]
    else:
        commands += ['set format y "10^{%T}"', "set ytics autofreq"]
    return "\n".join([*commands, "plot " + ", \\\n     ".join(lines)])


def _key(curves):
    lines = [*(_line(name, "NaN") for name in curves), _noise_line("NaN")]
    return _PLOT_KEY + "plot " + ", \\\n     ".join(lines)


def _plot_script(file, scene, setting, curves, reference):
    seconds = [point.seconds for curve in curves.values() for point in curve]
    low, high = min(seconds) / 1.25, max(seconds) * 1.25
    height = scene.height_for(setting.width)
    head = _PLOT_HEAD.format(
        file=file,
        title=_quote(f"{scene.name}, {setting.width} x {height}"),
        x_low=low,
        x_high=high,
        x_ticks=_ticks(low, high),
        threads=setting.threads,
    )
    trimmed = f"relative MSE without the worst {100 * setting.trim:g} %"
    panels = [
        _panel(curves, "relative_mse", "relative MSE", reference.noise),
        _panel(curves, "relative_mse_trimmed", trimmed, reference.noise_trimmed),
        _panel(curves, "flip", "mean FLIP", 0),
    ]
    blocks = [_data_block(name, curve) for name, curve in curves.items()]
    return "\n".join([head, *blocks, *panels, _key(curves), "unset multiplot", ""])


def write_plot(path, scene, setting, points, reference):
    """With gnuplot. The picture gets its name when it is complete."""
    names = dict.fromkeys(point.integrator for point in points)
    curves = {name: make_curve(points, name) for name in names}
    new = path.with_name(f"{path.stem}.new.png")
    script = _plot_script(new.name, scene, setting, curves, reference)
    try:
        done = subprocess.run(
            ["gnuplot"],
            input=script,
            cwd=path.parent,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            check=False,
        )
    except OSError as error:
        raise Failure(f"gnuplot: {error.strerror}") from error
    if done.returncode != 0:
        raise Failure(f"gnuplot ended with status {done.returncode}:\n{done.stdout.strip()}")
    new.replace(path)


# ---- results.md ----------------------------------------------------------------------------------


def _number(value):
    """Three digits, never as a power of ten that has to be read twice."""
    if value is None:
        return "-"
    if value == 0:
        return "0"
    if value < 1e-4 or value >= 1e6:
        return f"{value:.2e}"
    return f"{float(f'{value:.3g}'):.7f}".rstrip("0").rstrip(".")


def _factor(ours, theirs):
    return "-" if not ours or theirs is None else _number(theirs / ours)


def _table(head, rows):
    lines = [f"| {' | '.join(head)} |", "|---" + "|---:" * (len(head) - 1) + "|"]
    return "\n".join(lines + [f"| {' | '.join(row)} |" for row in rows])


def _summary(results, metric, at_seconds, names):
    has_factor = "sppm" in names and "path" in names
    head = ["scene", *(INTEGRATORS[name].title for name in names)]
    if has_factor:
        head.append("path / sppm")
    rows = []
    for scene, points, _ in results:
        values = {
            name: value_at(make_curve(points, name), metric, at_seconds) for name in names
        }
        row = [scene.name + (" *" if scene.path_misses else ""), *map(_number, values.values())]
        if has_factor:
            row.append(_factor(values["sppm"], values["path"]))
        rows.append(row)
    return _table(head, rows)


def _processor():
    try:
        for line in Path("/proc/cpuinfo").read_text().splitlines():
            if line.startswith("model name"):
                return line.split(":", 1)[1].strip()
    except OSError:
        pass
    return platform.processor() or platform.machine()


def _slope_text(curve, metric, from_seconds):
    value = slope(curve, metric, from_seconds)
    return "-" if value is None else f"{value:.2f}"


def _scene_section(scene, points, reference, names, seconds):
    options = f" `{' '.join(scene.options)}`" if scene.options else ""
    rows = []
    for name in names:
        curve = make_curve(points, name)
        last = curve[-1]
        rows.append(
            [
                INTEGRATORS[name].title,
                f"{last.seconds:.1f}",
                f"{last.passes:.0f}",
                *(_number(getattr(last, metric)) for metric in METRICS),
                _slope_text(curve, "relative_mse_trimmed", seconds / 8),
            ]
        )
    head = ["integrator", "seconds", "passes", "relative MSE", "trimmed", "FLIP", "slope"]
    parts = [
        f"## {scene.name}{options}",
        f"![error over time: {scene.name}]({scene.name}.png)",
        _table(head, rows),
        f"Reference: {scene.reference.method}; {scene.reference.reason}. Its own noise: "
        f"{_number(reference.noise)}, trimmed {_number(reference.noise_trimmed)}.",
    ]
    if scene.path_misses and "path" in names:
        parts.append(
            f"No path from the camera finds {scene.path_misses}: the error of `path` ends at what "
            "is missing, however long it renders."
        )
    return "\n\n".join(parts)


def _introduction(setting, seconds, seeds, reference_seconds, reference_parts):
    median = f", medians of {seeds} seeds" if seeds > 1 else ", one seed"
    photons = f"{setting.photons} photons a pass" if setting.photons else "default photons a pass"
    return (
        "Written by `convergence.py`; [README.md](README.md) says what is measured and how to read "
        f"it.\n\n- {setting.programs.version}\n- {_processor()}, {setting.threads} threads\n"
        f"- pictures {setting.width} pixels wide, {photons}, renders of up to "
        f"{seconds:g} s{median}\n- references: mean of {reference_parts} renders of "
        f"{reference_seconds:g} s each"
    )


def write_results(path, results, setting, names, args):
    """results: of each scene, (scene, points, reference)."""
    trimmed = f"relative MSE without the worst {100 * setting.trim:g} % of the pixels"
    parts = [
        "# Error over time: results",
        _introduction(setting, args.time, args.seeds, args.reference_time, args.reference_parts),
        f"## After {args.at:g} seconds",
    ]
    titles = ("Relative MSE", trimmed[0].upper() + trimmed[1:], "Mean FLIP")
    for metric, title in zip(METRICS, titles):
        parts += [f"{title}:", _summary(results, metric, args.at, names)]
    if "path" in names and any(scene.path_misses for scene, _, _ in results):
        parts.append("\\* has light that no path from the camera finds.")
    parts += [_scene_section(*result, names, args.time) for result in results]
    path.write_text("\n\n".join(parts) + "\n")
