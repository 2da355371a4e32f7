#!/usr/bin/python3
"""scripts/real: robust figures of docs/evidence/real_data.md, where the measurements are at
hand. The executables are in FINRAY_BINARY_DIR."""

import contextlib
import io
import os
import pathlib
import sys
import tempfile
import unittest
import unittest.mock

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.dont_write_bytecode = True
sys.path.insert(0, str(ROOT / "scripts" / "real"))

import bare_finger
import bench
import data
import gauged_finger
import outlines
import report
from sums import rms
from tools import Tools


class AbsentTest(unittest.TestCase):
    def test_without_the_measurements_the_page_stays(self):
        with tempfile.TemporaryDirectory() as folder, unittest.mock.patch.object(data, "FOLDER", pathlib.Path(folder)):
            page = pathlib.Path(folder) / "page.md"
            said = io.StringIO()
            with unittest.mock.patch.object(sys, "argv", ["report.py", folder, folder, str(page), folder]):
                with contextlib.redirect_stdout(said):
                    report.main()
            self.assertIn("the measurements are not here", said.getvalue())
            self.assertFalse(page.exists())


@unittest.skipUnless(data.there(), "the measurements are not here")
class RealDataTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.tools = Tools(pathlib.Path(os.environ["FINRAY_BINARY_DIR"]), pathlib.Path(folder.name))

    def test_pins_of_an_advance_that_was_held_out(self):
        entries = bare_finger.leave_advance_out(
            self.tools, "out", bare_finger.TRIALS["rib lengths, places of hinges"], bare_finger.all_series(), "circle_r20")
        self.assertEqual(len(bare_finger.pin_errors(entries, 2)), 96)
        self.assertLess(rms(bare_finger.pin_errors(entries, 2)), 0.7)
        self.assertLess(rms(bare_finger.force_errors(entries, 2)), 0.4)

    def test_a_finger_without_ribs_is_predicted_by_one_with_ribs(self):
        series = bare_finger.all_series()
        trained = bare_finger.train(self.tools, "r20", "circle_r20", bare_finger.TRIALS["rib lengths, places of hinges"], series)
        entries = bare_finger.judge(self.tools, "ribless", trained, series, "circle_r30_0_ribs_2021-05-17_1")
        self.assertEqual(len(entries), 10)
        self.assertLess(rms(bare_finger.force_errors(entries, 1)), 0.7)

    def test_forces_of_rows_that_were_held_out(self):
        rows = data.gauged()
        finger = data.FOLDER / "steel_finger.yaml"
        every = gauged_finger.leave_one_out(self.tools, "ten", finger, gauged_finger.PLAN, {}, rows)
        nine = gauged_finger.leave_one_out(self.tools, "nine", finger, gauged_finger.PLAN, {}, rows[:-1])
        self.assertEqual((len(every), len(nine)), (10, 9))
        self.assertLess(gauged_finger.summary(every, 0)["rms"], 0.9)
        self.assertLess(gauged_finger.summary(nine, 0)["rms"], 0.4)
        self.assertLess(gauged_finger.summary(nine, 1)["rms"], 0.25)
        self.assertGreaterEqual(gauged_finger.summary(nine, 1)["within_95"], 8)

    def test_a_curve_halves_the_error_on_the_same_day(self):
        series = data.cylinders()
        first, second = (series["rod1", "2021-04-26", trial] for trial in (1, 2))
        plain, curved = (rms(bench.transferred(self.tools, "bench", parameters, first, second))
                         for parameters in (bench.PLAIN, bench.CURVED))
        self.assertLess(curved, 0.5 * plain)

    def test_half_of_the_touches_bring_the_other_half_to_size(self):
        zero, *circle = data.touches("circle_r30")
        ready = outlines.zeroed(self.tools, "circle", outlines.calibrated(self.tools).finger, zero)
        plain = outlines.Outline(self.tools, "plain", ready, circle)
        by = outlines.correct(self.tools, "half", ready, {"object_origin": {"prior_std_mm": 5}}, circle[::2])
        place = [by.values[f"object_origin_{axis}_mm"] for axis in "xy"]
        corrected = outlines.Outline(self.tools, "corrected", by.finger, circle[1::2], place)
        self.assertLess(plain.circumference, 170)
        self.assertAlmostEqual(corrected.circumference, 188.5, delta=3)
        self.assertLess(corrected.off, 1)


if __name__ == "__main__":
    unittest.main()
