"""docs/convergence: its arithmetic, and a run on a tiny picture. Nothing depends on what is fast."""

import csv
import math
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path
from types import SimpleNamespace

FOLDER = Path(__file__).resolve().parent.parent.parent / "docs/convergence"
SCRIPT = FOLDER / "convergence.py"
sys.path.insert(0, str(FOLDER))

from curves import CurvePoint, make_curve, slope, value_at  # noqa: E402
from report import COLUMNS  # noqa: E402

PROGRAMS = None  # the folder of ppm-render and ppm-compare
INTEGRATORS = ("sppm", "epochs", "path")


def power_law(exponent, times):
    return [CurvePoint(t, 100 * t, t**exponent, 2 * t**exponent, 0.1) for t in times]


def point(target, seconds, passes, error, seed=0):
    render = SimpleNamespace(seconds=seconds, passes=passes)
    errors = SimpleNamespace(relative_mse=error, relative_mse_trimmed=error / 2, flip=error / 4)
    return SimpleNamespace(
        integrator="sppm", target_seconds=target, seed=seed, render=render, errors=errors
    )


def convergence(*words):
    return subprocess.run(
        [sys.executable, "-B", str(SCRIPT), *map(str, words)],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        check=False,
    )


class Curves(unittest.TestCase):
    def test_no_value_is_told_outside_of_the_curve(self):
        curve = power_law(-1, (1, 2, 4))
        self.assertIsNone(value_at(curve, "relative_mse", 0.5))
        self.assertIsNone(value_at(curve, "relative_mse", 5))
        self.assertIsNone(value_at([], "relative_mse", 1))

    def test_a_render_that_ends_a_little_early_has_the_value_of_its_end(self):
        curve = power_law(-1, (1, 2, 3.9))
        self.assertAlmostEqual(value_at(curve, "relative_mse", 4), 1 / 3.9)

    def test_values_between_points_follow_a_power_law(self):
        curve = power_law(-2 / 3, (1, 2, 4))
        for t in (1, 1.3, 2, 3.1, 4):
            self.assertAlmostEqual(value_at(curve, "relative_mse", t), t ** (-2 / 3))

    def test_the_slope_of_a_power_law_is_its_exponent(self):
        curve = power_law(-2 / 3, (1, 2, 4, 8))
        self.assertAlmostEqual(slope(curve, "relative_mse_trimmed", 1), -2 / 3)
        self.assertIsNone(slope(curve, "relative_mse_trimmed", 3))

    def test_a_picture_that_two_times_share_is_one_point(self):
        same = (point(1, 3.0, 1, 0.5), point(2, 3.1, 1, 0.5), point(4, 6.0, 2, 0.2))
        self.assertEqual([made.passes for made in make_curve(same, "sppm")], [1, 2])

    def test_a_point_is_the_median_of_its_seeds(self):
        seeds = [point(1, 1.0, 10, error, seed) for seed, error in enumerate((0.1, 9.0, 0.2))]
        (made,) = make_curve(seeds, "sppm")
        self.assertEqual((made.relative_mse, made.flip), (0.2, 0.05))


class Usage(unittest.TestCase):
    def test_an_unknown_scene_is_answered_with_those_that_exist(self):
        done = convergence("--scenes", "caustic_bax")
        self.assertEqual(done.returncode, 2)
        self.assertIn("caustic_bax", done.stderr)
        self.assertIn("caustic_box", done.stderr)

    def test_one_part_cannot_tell_the_noise_of_a_reference(self):
        self.assertEqual(convergence("--reference-parts", 1).returncode, 2)

    def test_no_table_is_made_of_a_time_after_the_end(self):
        done = convergence("--time", 60, "--at", 90)
        self.assertEqual(done.returncode, 2)
        self.assertIn("--at 90", done.stderr)

    def test_missing_programs_are_named(self):
        with tempfile.TemporaryDirectory() as folder:
            done = convergence("--bin", folder, "--work", folder, "--output", folder)
        self.assertEqual(done.returncode, 1)
        self.assertIn("ppm-render", done.stderr)


class TinyRun(unittest.TestCase):
    """One run, looked at by all; the order of the tests does not matter."""

    @classmethod
    def setUpClass(cls):
        cls.folder = Path(tempfile.mkdtemp())
        cls.addClassCleanup(shutil.rmtree, cls.folder)
        cls.work, cls.output = cls.folder / "work", cls.folder / "output"
        cls.done = cls.run_script()

    @classmethod
    def run_script(cls):
        words = ["--quick", "--bin", PROGRAMS, "--work", cls.work, "--output", cls.output]
        words += ["--width", 32, "--photons", 2048, "--time", 0.1, "--steps", 1]
        words += ["--reference-time", 0.2, "--integrators", ",".join(INTEGRATORS)]
        return convergence(*words)

    def rows(self):
        with open(self.output / "caustic_box.tsv", newline="") as file:
            return list(csv.DictReader(file, delimiter="\t"))

    def test_the_run_succeeds(self):
        self.assertEqual(self.done.returncode, 0, self.done.stderr)

    def test_the_table_has_a_row_for_each_point(self):
        rows = self.rows()
        self.assertEqual(tuple(rows[0]), COLUMNS)
        points = [(row["integrator"], row["target_seconds"]) for row in rows]
        expected = [(name, seconds) for name in INTEGRATORS for seconds in ("0.05", "0.1")]
        self.assertEqual(points, expected)

    def test_the_numbers_are_measurements(self):
        for row in self.rows():
            for column in ("seconds", "passes", "mse", "relative_mse", "relative_mse_trimmed"):
                value = float(row[column])
                self.assertTrue(math.isfinite(value) and value > 0, f"{column}: {row}")
            self.assertTrue(0 < float(row["flip"]) < 1, row)
            self.assertLessEqual(float(row["relative_mse_trimmed"]), float(row["relative_mse"]))
            self.assertEqual(row["broken_pixels"], "0")
            self.assertEqual(row["photons"] == "0", row["integrator"] == "path", row)

    def test_there_is_a_plot(self):
        data = (self.output / "caustic_box.png").read_bytes()
        self.assertEqual(data[:8], b"\x89PNG\r\n\x1a\n")
        self.assertGreater(len(data), 5000)

    def test_the_results_name_scene_reference_and_plot(self):
        text = (self.output / "results.md").read_text()
        for words in ("## caustic_box", "(caustic_box.png)", "Reference: sppm", "path / sppm"):
            self.assertIn(words, text)

    def test_another_run_renders_only_what_is_not_complete(self):
        def kept():
            return {path: path.stat().st_mtime_ns for path in self.work.glob("*.json")}

        def complete_rows():
            return [row for row in self.rows() if row["integrator"] != "epochs"]

        for stats in self.work.glob("*-epochs-*.json"):
            stats.unlink()
        before, rows = kept(), complete_rows()
        again = self.run_script()
        self.assertEqual(again.returncode, 0, again.stderr)
        after = kept()
        self.assertEqual({path: after[path] for path in before}, before)
        self.assertEqual(len(after) - len(before), 2)
        self.assertEqual(complete_rows(), rows)


if __name__ == "__main__":
    PROGRAMS = Path(sys.argv[1])
    for tool in ("gnuplot", "oiiotool"):
        if not shutil.which(tool):
            print(f"skipped: no {tool}")
            sys.exit(77)
    unittest.main(argv=sys.argv[:1], verbosity=2)
