#!/usr/bin/python3
"""The Python package: doctests, the numbers of the command line, errors, views, pickles, and types by mypy."""
import csv
import doctest
import importlib.util
import math
import os
import pathlib
import pickle
import pkgutil
import re
import subprocess
import sys
import tempfile
import threading
import unittest
import warnings

from built_package import BUILD, ROOT, finray, np

FINGER = ROOT / "configs/fingers/paper_140mm.yaml"
HIDDEN = ROOT / "datasets/simulated_r15/hidden_finger.yaml"
PLAN = ROOT / "configs/plans/force_and_circle.yaml"
TRAIN = ROOT / "datasets/simulated_r15/train.csv"
HOLDOUT = ROOT / "datasets/simulated_r15/holdout.csv"


def run(tool, *arguments, code=0):
    found = subprocess.run([BUILD / tool, *map(str, arguments)], capture_output=True, text=True, check=False)
    assert found.returncode == code, (found.args, found.returncode, found.stderr)
    return found


def column(path, name):
    with open(path, newline="", encoding="utf-8") as file:
        return [row[name] for row in csv.DictReader(file)]


def same(text, number):
    """A cell of a CSV and a number are the same double."""
    return math.isnan(number) if text == "" else float(text) == number


class PackageTest(unittest.TestCase):
    def setUp(self):
        warnings.simplefilter("ignore", finray.FinrayWarning)
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def assert_columns_equal(self, path, columns):
        with open(path, newline="", encoding="utf-8") as file:
            rows = list(csv.DictReader(file))
        for name, values in columns.items():
            self.assertEqual(len(rows), len(values))
            for row, value in zip(rows, values):
                if isinstance(value, str):
                    self.assertEqual(row[name], value, name)
                else:
                    self.assertTrue(same(row[name], value), (name, row[name], value))

    def test_doctests(self):
        # Every module, so that a new one is not forgotten; plots need matplotlib.
        names = ["finray", *(f"finray.{module.name}" for module in pkgutil.iter_modules(finray.__path__) if module.name != "_finray")]
        self.assertGreaterEqual(len(names), 9)
        for name in names:
            if name == "finray.plots" and not importlib.util.find_spec("matplotlib"):
                continue
            found = doctest.testmod(importlib.import_module(name), optionflags=doctest.NORMALIZE_WHITESPACE)
            self.assertEqual(found.failed, 0, name)
            self.assertGreater(found.attempted, 0, name)

    def test_estimates_are_those_of_the_command_line(self):
        hidden = finray.Finger.read(HIDDEN)
        scene = self.folder / "scene.yaml"
        scene.write_text("contacts: 1\nsmoothing: {contact_std_mm: 1, normal_std_N: 0.1}\n")
        for options, flags in (({}, []), ({"solver": "ceres"}, ["--solver", "ceres"]),
                               ({"scene": finray.Scene.read(scene)}, ["--scene", scene]),
                               ({"scene": finray.Scene.read(scene), "joint": True}, ["--scene", scene, "--joint"])):
            for threads in (1, 2):
                run("finray_estimate", "--finger", HIDDEN, "--logs", HOLDOUT, "--out_dir", self.folder, *flags)
                found = finray.estimate(hidden, HOLDOUT, threads=threads, **options)
                self.assert_columns_equal(self.folder / "holdout.frames.csv", dict(found))
        self.assertEqual(found.summary["frames"], 110)

    def test_live_is_that_of_the_command_line(self):
        hidden = finray.Finger.read(HIDDEN)
        with open(HOLDOUT, encoding="utf-8") as log:
            rows = subprocess.run([BUILD / "finray_estimate", "--follow", "--finger", HIDDEN], stdin=log,
                                  capture_output=True, text=True, check=True).stdout
        (self.folder / "live.csv").write_text(rows)
        live = finray.Live(hidden)
        volts = np.array([[float(v) for v in column(HOLDOUT, f"gauge_{j}_V")] for j in range(1, 5)]).T
        frames = [live.next(row) for row in volts]
        self.assertEqual(column(self.folder / "live.csv", "status"), [frame.status for frame in frames])
        for text, frame in zip(column(self.folder / "live.csv", "contact_1_mm"), frames):
            self.assertTrue(same(text, frame.contacts[0].arc_mm if frame.contacts else math.nan))

    def test_simulation_is_that_of_the_command_line(self):
        loads = self.folder / "loads.csv"
        loads.write_text("contact_1_mm,normal_1_N\n40,1\n70,2\n100,3\n")
        run("finray_simulate", "--finger", FINGER, "--frames", loads, "--out", self.folder / "out.csv", "--shape_out",
            self.folder / "shape.csv")
        found = finray.simulate(finray.Finger.read(FINGER), {"contact_1_mm": [40, 70, 100], "normal_1_N": [1, 2, 3.0]},
                                shapes=True)
        self.assert_columns_equal(self.folder / "out.csv", dict(found))
        self.assert_columns_equal(self.folder / "shape.csv", {"x_mm": found.shapes["x_mm"]})

    def test_calibration_is_that_of_the_command_line(self):
        run("finray_calibrate", "--finger", FINGER, "--plan", PLAN, "--logs", TRAIN, "--out_dir", self.folder / "a",
            "--report=false")
        finger, plan = finray.Finger.read(FINGER), finray.Plan.read(PLAN)
        found = finray.calibrate(finger, plan, TRAIN)
        found.write(self.folder / "b", report=False)
        for name in ("finger.yaml", "calibration.frames.csv", "calibration.shape.csv"):
            self.assertEqual((self.folder / "a" / name).read_bytes(), (self.folder / "b" / name).read_bytes(), name)
        lines = [[line for line in (self.folder / part / "calibration.yaml").read_text().splitlines()
                  if "command" not in line] for part in "ab"]
        self.assertEqual(*lines)
        self.assertEqual(found.verdict, "good")
        self.assertEqual(len(found.free_names), len(found.covariance))
        for i, name in enumerate(found.free_names):
            self.assertAlmostEqual(math.sqrt(found.covariance[i, i]) / found[name].std, 1, places=12)
        # From memory: the same numbers, without any file.
        with open(TRAIN, newline="", encoding="utf-8") as file:
            rows = list(csv.DictReader(file))
        log = {name: np.array([float(row[name] or "nan") for row in rows]) for name in rows[0]}
        again = finray.calibrate(finger, plan, log)
        self.assertEqual([p.value for p in again.parameters], [p.value for p in found.parameters])
        kept = pickle.loads(pickle.dumps(found))
        self.assertEqual((kept.finger, kept.parameters), (found.finger, found.parameters))
        with self.assertRaises(finray.Error):
            kept.write(self.folder / "c")

    def test_errors_are_those_of_the_command_line(self):
        broken = self.folder / "broken.yaml"
        broken.write_text(FINGER.read_text().replace("front_length_mm", "front_lenght_mm"))
        loads = self.folder / "no_gauges.csv"
        loads.write_text("time_s\n0\n")
        cases = [(lambda: finray.Finger.read(broken), ("--finger", broken, "--logs", HOLDOUT)),
                 (lambda: finray.Finger.read("missing.yaml"), ("--finger", "missing.yaml", "--logs", HOLDOUT)),
                 (lambda: finray.estimate(finray.Finger.read(FINGER), loads), ("--finger", FINGER, "--logs", loads))]
        for call, flags in cases:
            with self.assertRaises(finray.InputError) as raised:
                call()
            told = run("finray_estimate", *flags, "--out_dir", self.folder / "out", code=2).stderr
            self.assertEqual(told, f"finray_estimate: {raised.exception}\n")
            self.assertIsInstance(raised.exception, ValueError)

    def test_bad_arguments(self):
        finger = finray.Finger.read(FINGER)
        log = {f"gauge_{j}_V": np.zeros(3) for j in range(1, 5)}
        for text, call in (
                ("solver: expected fast or ceres, found 'fats'", lambda: finray.estimate(finger, log, solver="fats")),
                ("^threads: expected 0 .* to 1024, found -1$", lambda: finray.estimate(finger, log, threads=-1)),
                ("^threads: expected 0 .* to 1024, found 100000$", lambda: finray.estimate(finger, log, threads=100000)),
                ("found 100000$", lambda: finray.calibrate(finger, finray.Plan.read(PLAN), HOLDOUT, threads=100000)),
                ("'gauge_4_V': expected 3 values, found 2",
                 lambda: finray.estimate(finger, {**log, "gauge_4_V": np.zeros(2)})),
                ("one-dimensional", lambda: finray.estimate(finger, {**log, "gauge_4_V": np.zeros((3, 2))})),
                ("expected a path", lambda: finray.estimate(finger, 7)),
                ("holds numbers, found text", lambda: finray.estimate(finger, {**log, "gauge_4_V": ["a", "b", "c"]})),
                ("expected 4 readings", lambda: finray.Live(finger).next([0.0])),
                ("gauge 4", lambda: finger.gauge_volts(4, 0.0)),
                ("scene:1:", lambda: finray.Scene(contact=1))):
            with self.assertRaisesRegex(finray.InputError, text):
                call()

    def test_readings_that_no_gauge_gives(self):
        finger = finray.Finger.read(FINGER)
        log = {f"gauge_{j}_V": np.array([float(v) for v in column(HOLDOUT, f"gauge_{j}_V")]) for j in range(1, 5)}
        before = list(finray.estimate(finger, log).status)
        readings = [math.inf, -math.inf, 9.9e37, 100.0, math.nan]
        log["gauge_2_V"] = log["gauge_2_V"].copy()
        log["gauge_2_V"][:5] = readings
        after = list(finray.estimate(finger, log).status)
        self.assertEqual(after[:4], ["bad_input"] * 4)
        self.assertNotEqual(after[4], "bad_input")
        self.assertEqual(after[5:], before[5:])
        live = finray.Live(finger)
        for row in range(5):
            self.assertEqual(live.next([log[f"gauge_{j}_V"][row] for j in range(1, 5)]).status, after[row])

    def test_views_are_read_without_a_copy(self):
        finger = finray.Finger.read(FINGER)
        matrix = np.array([[float(v) for v in column(HOLDOUT, f"gauge_{j}_V")] for j in range(1, 5)]).T
        whole = finray.estimate(finger, {f"gauge_{j + 1}_V": matrix[:, j].copy() for j in range(4)})
        strided = finray.estimate(finger, {f"gauge_{j + 1}_V": matrix[:, j] for j in range(4)})
        backwards = finray.estimate(finger, {f"gauge_{j + 1}_V": matrix[::-1][:, j].copy()[::-1] for j in range(4)})
        for other in (strided, backwards):
            self.assertTrue(np.array_equal(whole["contact_1_mm"], other["contact_1_mm"], equal_nan=True))
        table = finray._finray.Table({"gauge_1_V": matrix[:, 0]}, "view")
        self.assertTrue(np.shares_memory(table.to_dict()["gauge_1_V"], matrix))
        single = finray.estimate(finger, {f"gauge_{j + 1}_V": matrix[:, j].astype(np.float32) for j in range(4)})
        self.assertEqual(len(single.codes), 110)
        self.assertTrue(whole["chi2"].flags.owndata is False)

    def test_data_frames(self):
        try:
            import pandas
        except ImportError:
            self.skipTest("no pandas")
        finger, log = finray.Finger.read(HIDDEN), pandas.read_csv(HOLDOUT)
        found = finray.estimate(finger, log)
        frame = found.to_dataframe(log)
        self.assertEqual(list(frame.columns[:len(log.columns)]), list(log.columns))
        run("finray_estimate", "--finger", HIDDEN, "--logs", HOLDOUT, "--out_dir", self.folder)
        self.assertEqual(list(frame.columns), list(pandas.read_csv(self.folder / "holdout.frames.csv").columns))
        self.assert_columns_equal(self.folder / "holdout.frames.csv", {"normal_1_N": frame["normal_1_N"].to_numpy()})

    def test_pickles(self):
        finger = finray.Finger.read(HIDDEN)
        for thing in (finger, finray.Scene(contacts=1), finray.Plan.read(PLAN)):
            self.assertEqual(pickle.loads(pickle.dumps(thing)), thing)
        found = finray.estimate(finger, HOLDOUT)
        kept = pickle.loads(pickle.dumps(found))
        self.assertTrue(np.array_equal(kept["contact_1_mm"], found["contact_1_mm"], equal_nan=True))

    def test_other_threads_run_meanwhile(self):
        finger = finray.Finger.read(FINGER)
        log = {f"gauge_{j}_V": np.zeros(64 * 200) for j in range(1, 5)}
        estimator = finray.Estimator(finger, threads=1)
        done, counted = threading.Event(), []

        def count():
            while not done.is_set():
                counted.append(1)

        thread = threading.Thread(target=count)
        thread.start()
        estimator.estimate(log)
        done.set()
        thread.join()
        self.assertGreater(len(counted), 1)

    def test_reconstruction_is_that_of_the_command_line(self):
        touches = ROOT / "datasets/touches_square/touches.csv"
        run("finray_reconstruct", "--finger", FINGER, "--logs", touches, "--out_dir", self.folder, "--plots=false")
        found = finray.reconstruct(finray.Finger.read(FINGER), touches)
        self.assert_columns_equal(self.folder / "outline.csv", found.outline)
        self.assert_columns_equal(self.folder / "touches.csv", found.touches)

    def test_plots_return_axes(self):
        try:
            import matplotlib
        except ImportError:
            self.skipTest("no matplotlib")
        matplotlib.use("Agg")
        finger = finray.Finger.read(HIDDEN)
        axes = finray.plot_finger(finger, 70.0, 2.0)
        self.assertIs(finray.plot_estimates(finray.estimate(finger, HOLDOUT), axes=axes), axes)
        found = finray.reconstruct(finray.Finger.read(FINGER), ROOT / "datasets/touches_square/touches.csv")
        self.assertTrue(finray.plot_outline(found).lines)

    def test_types(self):
        try:
            importlib.import_module("mypy")
        except ImportError:
            self.skipTest("no mypy")
        found = subprocess.run([sys.executable, "-m", "mypy", "--strict", "--config-file", ROOT / "pyproject.toml",
                                "--cache-dir", self.folder, "python/finray", *sorted(
                                    map(str, (ROOT / "examples/python").glob("*.py")))],
                               cwd=ROOT, env={**os.environ, "MYPYPATH": "python"}, capture_output=True, text=True,
                               check=False)
        self.assertEqual(found.returncode, 0, found.stdout + found.stderr)

    def test_stubs_are_those_of_the_module(self):
        try:
            importlib.import_module("mypy.stubtest")
        except ImportError:
            self.skipTest("no mypy")
        found = subprocess.run([sys.executable, "-m", "mypy.stubtest", "finray._finray", "--concise",
                                "--mypy-config-file", ROOT / "pyproject.toml"], cwd=self.folder,
                               env={**os.environ, "PYTHONPATH": BUILD / "python"}, capture_output=True, text=True,
                               check=False)
        # pybind11 has a metaclass of its own, and an __init__ that refuses, where a class has no constructor.
        faults = [line for line in found.stdout.splitlines() if "metaclass differs" not in line
                  and not re.search(r"\.__init__ is inconsistent, stub does not have \*args", line)]
        self.assertEqual(faults, [], found.stderr)
        self.assertIn("metaclass differs", found.stdout)  # it has looked

    def test_from_import_to_a_calibrated_finger_takes_20_lines(self):
        example = ROOT / "examples/python/calibrate.py"
        code = example.read_text().split('"""')[2]
        self.assertLessEqual(len([line for line in code.splitlines() if line.strip()]), 20)
        done = subprocess.run([sys.executable, example, self.folder / "own", TRAIN], capture_output=True, text=True,
                              env={**os.environ, "PYTHONPATH": BUILD / "python"}, check=True)
        self.assertEqual(done.stdout.splitlines()[-1], "verdict: good")
        self.assertTrue(finray.Finger.read(self.folder / "own/finger.yaml").calibrated)


if __name__ == "__main__":
    unittest.main()
