#!/usr/bin/python3
"""finray_calibrate and finray_plan where something does not work out: what works is written, and a line says what does
not and what helps."""

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

    def planned(self, arguments):
        done = self.run_tool("plan", f"--finger {FINGER} --plan {PLAN} --force_max_N 8 --force_N 3 --noreport --out_dir out {arguments}")
        self.assertEqual(done.returncode, 4, done.stderr)
        return done.stderr

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
