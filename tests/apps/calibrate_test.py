#!/usr/bin/python3
"""finray_calibrate and finray_plan where something does not work out: what works is written, and a line says what does
not and what helps."""

import csv
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

import yaml

sys.dont_write_bytecode = True
ROOT = pathlib.Path(__file__).resolve().parents[2]
BINARIES = pathlib.Path(os.environ.get("FINRAY_BINARY_DIR", ROOT / "build/dev")).resolve()
FINGER = ROOT / "configs/fingers/paper_140mm.yaml"
PLAN = ROOT / "configs/plans/force_and_circle.yaml"
TRAIN = ROOT / "datasets/simulated_r15/train.csv"
PRINTED = ROOT / "datasets/reality/printed"


class CalibrateTest(unittest.TestCase):
    def setUp(self):
        self.temporary = tempfile.TemporaryDirectory()
        self.addCleanup(self.temporary.cleanup)
        self.folder = pathlib.Path(self.temporary.name)

    def run_tool(self, tool, arguments):
        return subprocess.run([BINARIES / f"finray_{tool}", *arguments.split()], cwd=self.folder, capture_output=True, text=True)

    def calibrated(self, logs, finger=FINGER, plan=PLAN, more=""):
        """Returns the exit code, stderr, and calibration.yaml."""
        done = self.run_tool("calibrate", f"--finger {finger} --plan {plan} --logs {logs} --report=false --out_dir out {more}")
        self.assertIn(done.returncode, (0, 4), done.stderr)
        return done.returncode, done.stderr, yaml.safe_load((self.folder / "out/calibration.yaml").read_text())

    def test_explore_falls_back_to_what_works(self):
        for load in ("smooth", "rough"):
            with self.subTest(load):
                code, _, found = self.calibrated(PRINTED / load / "train.csv", PRINTED / "finger.yaml",
                                                 PRINTED / "plan_thickness.yaml", "--explore")
                self.assertEqual(code, 4)
                self.assertTrue((self.folder / "out/finger.yaml").exists())
                self.assertTrue((self.folder / "out/plan.yaml").exists())
                self.assertNotEqual(found["verdict"], "good")

    def test_friction_that_the_plan_leaves_out_is_named(self):
        # Solids of another solver press with a friction of 0.3; without it the finger fits too.
        for load, code in (("smooth", 0), ("rough", 4)):
            with self.subTest(load):
                done, errors, found = self.calibrated(PRINTED / load / "train.csv", PRINTED / "finger_bending.yaml",
                                                      PRINTED / "plan_bending.yaml")
                self.assertEqual(done, code, errors)
        self.assertEqual(found["verdict"], "doubtful")
        self.assertIn("likeliest cause: residuals look like friction", errors)
        friction = next(e for e in found["effect_scores"]["effects"] if e["family"] == "friction")["values"][0]
        self.assertLess(abs(friction["value"] - 0.3), 3 * friction["std"])

    def test_rows_written_twice_count_once(self):
        with open(TRAIN) as file:
            header, *rows = csv.reader(file)
        half = 0.05
        later = [[repr(float(row[0]) + half), *row[1:]] for row in rows]
        copies = {"each.csv": [row for row in rows for _ in range(2)],
                  "later.csv": [row for pair in zip(rows, later) for row in pair],
                  "whole.csv": rows + rows,
                  "after.csv": rows + [[repr(float(row[0]) + 100), *row[1:]] for row in rows]}
        for name, written in copies.items():
            with open(self.folder / name, "w", newline="") as file:
                csv.writer(file).writerows([header, *written])
        once = self.calibrated(TRAIN)[2]
        self.assertFalse([w for w in once["warnings"] if w["code"] == "rows_written_twice"])
        second = {"each.csv": "each.csv row 2, which repeats each.csv row 1", "later.csv": "later.csv row 2, which repeats later.csv row 1",
                  "whole.csv": "whole.csv row 211, which repeats whole.csv row 1", "after.csv": "after.csv row 211, which repeats after.csv row 1"}
        second[f"{TRAIN},{self.folder}/each.csv"] = "each.csv row 1, which repeats train.csv row 1"
        for logs, words in second.items():
            with self.subTest(logs):
                code, errors, found = self.calibrated(logs)
                self.assertEqual(code, 0, errors)
                self.assertIn(f"rows have all the numbers of an earlier row, the first of them {words}; they count once", errors)
                self.assertEqual(found["parameters"], once["parameters"])
        self.assertIn("; nothing is left of each.csv", errors)
        self.assertEqual([log["path"] for log in found["inputs"]["left_out"]], [f"{self.folder}/each.csv"])

    def test_noise_told_twice_too_large_is_not_good(self):
        finger = self.folder / "loud.yaml"
        finger.write_text(re.sub(r"noise_V: ([0-9.e-]+)", lambda found: f"noise_V: {2 * float(found[1])}", FINGER.read_text()))
        code, errors, found = self.calibrated(TRAIN, finger)
        self.assertEqual((code, found["verdict"]), (4, "doubtful"))
        self.assertRegex(errors, r"likeliest cause: the noise that is stated is too large; gauge residuals are 0\.[45]")
        self.assertRegex(errors, r"noise_V of the gauges times 0\.(4[5-9]|5[0-5]) fits")
        plan = self.folder / "loud_plan.yaml"
        plan.write_text(PLAN.read_text().replace("force_std_N: 0.02", "force_std_N: 0.04"))
        code, errors, _ = self.calibrated(TRAIN, plan=plan)
        self.assertEqual(code, 4)
        self.assertRegex(errors, r"force residuals are 0\.[45].*force_std_N: 0.0(1[6-9]|2[0-4]?) instead of 0.04 fits")

    def planned(self, arguments):
        done = self.run_tool("plan", f"--finger {FINGER} --plan {PLAN} --force_max_N 8 --force_N 3 --noreport --out_dir out {arguments}")
        self.assertEqual(done.returncode, 4, done.stderr)
        return done.stderr

    def test_forces_that_no_finger_bears_are_refused(self):
        done = self.run_tool("plan", f"--finger {FINGER} --plan {PLAN} --force_max_N 1e18 --target_force_N 0.1 --noreport --out_dir out "
                             "--x_mm -30:15 --y_mm 0:150")
        self.assertEqual(done.returncode, 1)
        self.assertRegex(done.stderr, "--force_max_N 1e.18: expected at most [0-9.]+, 400 EI / l_0\\^2")

    # 100 rows and 400 rows give 83.2 and 83.3 %.
    def test_rows_that_do_not_help_are_not_advised(self):
        errors = self.planned("--x_mm -30:-12 --y_mm 0:150 --target_force_N 0.08 --most_frames 100")
        self.assertIn("no number of rows suffices (64 times as many meet it in 8", errors)
        self.assertNotIn("more rows", errors)
        self.assertRegex(errors, "in [1-9][0-9]* of 24 fingers within the priors")

    def test_rows_that_help_are_counted(self):
        errors = self.planned("--x_mm -30:15 --y_mm 0:40 --target_force_N 0.08 --confidence_percent 75 --most_frames 100")
        found = re.search("about ([0-9]+) rows would suffice", errors)
        self.assertTrue(found, errors)
        done = self.run_tool("plan", f"--finger {FINGER} --plan {PLAN} --force_max_N 8 --force_N 3 --noreport --out_dir out "
                             f"--x_mm -30:15 --y_mm 0:40 --target_force_N 0.08 --confidence_percent 75 --most_frames {found[1]}")
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)


if __name__ == "__main__":
    unittest.main()
