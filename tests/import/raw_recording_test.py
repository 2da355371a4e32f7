#!/usr/bin/python3
"""The bundled raw recording becomes a calibrated finger: the guide's commands.

Semicolons, decimal commas, counts, grams, a stage in metres with x flipped, force at 10 Hz,
gauges at 200 Hz, 40 ms apart, from an independent solver.
"""

import os
import pathlib
import re
import subprocess
import unittest

import numpy as np
import yaml
from fixture import ROOT, ImportCase

DATA = ROOT / "datasets/raw_recording"
BINARIES = pathlib.Path(os.environ.get("FINRAY_BINARY_DIR", ROOT / "build/dev")).resolve()
OFFSET_MS, BIAS_N = -40.0, 6.3 * 9.80665e-3  # scripts/make_raw_recording.py
ORIGIN_MM = (0.15, -0.2)


def truth():
    """{parameter: value} of the hidden finger."""
    finger = yaml.safe_load((DATA / "hidden_finger.yaml").read_text())
    out = {f"{side}_stiffness_N_mm2": beam["bending_stiffness_N_mm2"]
           for side, beam in finger["beams"].items()}
    for j, gauge in enumerate(finger["gauges"], 1):
        out[f"gauge_{j}_gain_V_per_rad"] = gauge["gain_V_per_rad"]
        out[f"gauge_{j}_offset_V"] = gauge["offset_V"]
    out.update(object_origin_x_mm=ORIGIN_MM[0], object_origin_y_mm=ORIGIN_MM[1])
    return out


class RawRecordingTest(ImportCase):
    def import_raw(self, *more):
        """The log, through the executable as a user calls it."""
        log = self.folder / "log.csv"
        done = subprocess.run(
            [BINARIES / "finray_import", "--logs", f"{DATA}/gauges.csv.gz,{DATA}/rig.csv",
             "--mapping", DATA / "mapping.yaml", "--out", log, *more],
            capture_output=True, text=True)
        self.assertEqual((done.returncode, done.stderr.count("warning")), (0, 0), done.stderr)
        offset, std = re.search(r"rig\.csv (\S+) ms against .*, std (\S+) ms", done.stdout).groups()
        self.assertLess(abs(float(offset) - OFFSET_MS), 2)
        self.assertLess(abs(float(offset) - OFFSET_MS), 3 * float(std))
        bias, std = re.search(r"force bias +(\S+) N \(std (\S+)\)", done.stdout).groups()
        self.assertLess(abs(float(bias) - BIAS_N), 3 * float(std))
        return log

    def test_a_clock_that_is_seconds_off_ends_with_its_remedy(self):
        rig = (DATA / "rig.csv").read_text().splitlines()
        late = [re.sub(r"^(\d{10}),", lambda t: f"{int(t[1]) + 7},", line)
                for line in rig]
        self.write("rig.csv", "\n".join(late) + "\n")
        given = ["--logs", f"{DATA}/gauges.csv.gz,{self.folder}/rig.csv", "--mapping",
                 DATA / "mapping.yaml", "--plateaus"]
        line = self.refused(*given, code=3)
        flag = re.search(r"clocks are 7\.0\d* s apart.*give (--longest_offset_s) (\d+)", line)
        self.log_of(*given, *flag.groups())
        found = float(re.search(r"rig\.csv (\S+) ms against", self.result.out)[1])
        self.assertLess(abs(found - OFFSET_MS + 7000), 2)

    def calibrate(self, plan, log):
        out = self.folder / "finger"
        done = subprocess.run(
            [BINARIES / "finray_calibrate", "--finger", ROOT / "configs/fingers/paper_140mm.yaml",
             "--plan", plan, "--logs", log, "--out_dir", out, "--noreport"],
            capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        found = yaml.safe_load((out / "calibration.yaml").read_text())
        self.assertEqual(found["verdict"], "good")
        self.finger = yaml.safe_load((out / "finger.yaml").read_text())
        return {p["name"]: p for p in found["parameters"]}, found["noise"]

    def check(self, parameters):
        z = {}
        for name, true in truth().items():
            z[name] = (parameters[name]["value"] - true) / parameters[name]["std"]
            self.assertEqual(parameters[name]["status"], "estimated")
        for name, parameter in parameters.items():
            if name.startswith("rib_"):  # the hidden finger has ribs as drawn
                z[name] = (parameter["value"] - parameter["initial"]) / parameter["std"]
        self.assertEqual(len(z), 17)
        self.assertLess(max(map(abs, z.values())), 3, z)
        # Not within 3 std because the std are large.
        for side in ("front", "back"):
            p = parameters[f"{side}_stiffness_N_mm2"]
            self.assertLess(p["std"] / p["value"], 0.01)

    def test_places_are_calibrated(self):
        log = self.import_raw("--plateaus")
        rows = np.genfromtxt(log, delimiter=",", names=True)
        self.assertEqual(len(rows), 57)
        self.check(self.calibrate(DATA / "plan.yaml", log)[0])
        # The plan has the noise of means, the finger senses by single readings.
        for gauge in self.finger["gauges"]:
            self.assertAlmostEqual(gauge["noise_V"], 3e-4, delta=3e-5)

    def test_moving_rows_are_calibrated(self):
        log = self.import_raw()
        self.check(self.calibrate(ROOT / "configs/plans/force_and_circle.yaml", log)[0])

    def test_the_dataset_is_small(self):
        self.assertLess(sum(p.stat().st_size for p in DATA.iterdir()), 300_000)


if __name__ == "__main__":
    unittest.main()
