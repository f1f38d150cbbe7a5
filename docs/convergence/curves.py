"""From single measurements to curves: medians over the seeds, values between points, slopes."""

import math
from dataclasses import dataclass
from statistics import median

METRICS = ("relative_mse", "relative_mse_trimmed", "flip")


@dataclass(frozen=True)
class CurvePoint:
    """Medians over the seeds."""

    seconds: float
    passes: float
    relative_mse: float
    relative_mse_trimmed: float
    flip: float


def make_curve(points, integrator):
    """Sorted by time. Where a pass takes longer than the step between two times, both give the same
    picture: it is one point, at the shorter time."""
    mine = [point for point in points if point.integrator == integrator]
    medians = []
    for target in sorted({point.target_seconds for point in mine}):
        same = [point for point in mine if point.target_seconds == target]
        medians.append(
            CurvePoint(
                median(point.render.seconds for point in same),
                median(point.render.passes for point in same),
                *(median(getattr(point.errors, metric) for point in same) for metric in METRICS),
            )
        )
    curve = {}
    for made in sorted(medians, key=lambda made: made.seconds):
        curve.setdefault(made.passes, made)
    return list(curve.values())


def _logarithms(curve, metric):
    """Of seconds and errors, where there is an error to take it of."""
    pairs = [(point.seconds, getattr(point, metric)) for point in curve]
    return [(math.log(x), math.log(y)) for x, y in pairs if x > 0 and y > 0]


def value_at(curve, metric, seconds):
    """Straight between the two nearest points on logarithmic axes; None outside of the curve, but
    for a tenth, since a render ends between two passes."""
    logs = _logarithms(curve, metric)
    if not logs:
        return None
    x = math.log(seconds)
    if x < logs[0][0] or x > logs[-1][0]:
        near = logs[0] if x < logs[0][0] else logs[-1]
        return math.exp(near[1]) if abs(x - near[0]) < math.log(1.1) else None
    for (x0, y0), (x1, y1) in zip(logs, logs[1:]):
        if x0 < x1 and x <= x1:
            return math.exp(y0 + (y1 - y0) * (x - x0) / (x1 - x0))
    return math.exp(logs[-1][1])


def slope(curve, metric, from_seconds):
    """Of the least-squares line on logarithmic axes; None with fewer than three points."""
    logs = [pair for pair in _logarithms(curve, metric) if pair[0] >= math.log(from_seconds)]
    if len(logs) < 3:
        return None
    mean_x = sum(x for x, _ in logs) / len(logs)
    mean_y = sum(y for _, y in logs) / len(logs)
    spread = sum((x - mean_x) ** 2 for x, _ in logs)
    return sum((x - mean_x) * (y - mean_y) for x, y in logs) / spread
