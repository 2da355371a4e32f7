#!/usr/bin/python3
"""Files that released versions of finray read and wrote, tests/data/formats/VERSION, are read by every tool of today."""
import csv
import hashlib
import math
import os
import pathlib
import subprocess
import tempfile
import unittest

import yaml

ROOT = pathlib.Path(__file__).resolve().parents[2]
BINARIES = pathlib.Path(os.environ.get("FINRAY_BINARY_DIR", ROOT / "build/dev")).resolve()
VERSIONS = sorted((ROOT / "tests/data/formats").iterdir())


def cells(path):
    with open(path, newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


class FormatsTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.out = pathlib.Path(folder.name)

    def run_tool(self, tool, *arguments, codes=(0,)):
        # The build tree's launchers of tools in Python lie beside the executables.
        ended = subprocess.run([BINARIES / tool, *map(str, arguments)], capture_output=True, text=True, cwd=ROOT)
        self.assertIn(ended.returncode, codes, f"{tool}: {ended.stderr}")
        return ended.stdout

    def test_frozen_files_are_as_they_were(self):
        self.assertIn("1.0", [frozen.name for frozen in VERSIONS])
        for frozen in VERSIONS:
            sums = dict(reversed(line.split("  ", 1)) for line in (frozen / "SHA256SUMS").read_text().splitlines())
            found = {str(path.relative_to(frozen)) for path in frozen.rglob("*") if path.is_file()} - {"SHA256SUMS"}
            self.assertEqual(found, set(sums))
            for name, digest in sums.items():
                self.assertEqual(hashlib.sha256((frozen / name).read_bytes()).hexdigest(), digest, name)

    def test_estimate_and_view(self):
        for frozen in VERSIONS:
            finger = frozen / "calibration/finger.yaml"
            self.run_tool("finray_estimate", "--finger", finger, "--logs", frozen / "log.csv", "--out_dir", self.out / "estimated")
            old, new = cells(frozen / "estimated/log.frames.csv"), cells(self.out / "estimated/log.frames.csv")
            self.assertEqual(len(old), len(new))
            self.assertLessEqual(set(old[0]), set(new[0]), "a column of then is gone")
            # The numbers of then, as far as an estimator that has become better leaves them.
            both = [(a, b) for a, b in zip(old, new) if a["status"] == b["status"] == "ok"]
            self.assertGreaterEqual(len(both), len([row for row in old if row["status"] == "ok"]) - 2)
            for then, now in both:
                self.assertLess(abs(float(then["normal_1_N"]) - float(now["normal_1_N"])), float(then["normal_1_std_N"]))
            self.run_tool("finray_view", "--results", frozen / "estimated", "--finger", finger, "--out_dir", self.out / "view")
            self.assertIn("log", (self.out / "view/index.html").read_text())

    def test_a_labs_own_log_by_scene_and_by_mapping(self):
        for frozen in VERSIONS:
            self.run_tool("finray_estimate", "--finger", ROOT / "configs/fingers/paper_140mm.yaml", "--scene", frozen / "scene.yaml",
                          "--logs", frozen / "lab_log.csv", "--out_dir", self.out / "lab")
            rows = cells(self.out / "lab/lab_log.frames.csv")
            self.assertEqual([float(row["time_s"]) for row in rows], [0, 0.1, 0.2])
            self.assertAlmostEqual(float(rows[1]["gauge_2_V"]), 0.01344, 12)
            self.assertEqual([row["note"] for row in rows], ["free", "touch", ""])
            self.assertEqual(rows[2]["gauge_1_V"], "")
            self.run_tool("finray_import", "--logs", frozen / "lab_log.csv", "--mapping", frozen / "mapping.yaml", "--out",
                          self.out / "imported.csv")
            self.assertAlmostEqual(float(cells(self.out / "imported.csv")[1]["gauge_2_V"]), 0.01344, 12)

    def test_calibrate_compare_validate_zero(self):
        for frozen in VERSIONS:
            made = self.out / "calibrated"
            nominal = ROOT / "configs/fingers/paper_140mm.yaml"
            self.run_tool("finray_calibrate", "--finger", nominal, "--plan", frozen / "plan.yaml", "--logs", frozen / "train.csv",
                          "--out_dir", made, "--leave_one_log_out=false")
            self.run_tool("finray_compare", frozen / "calibration", made, "--out_dir", self.out / "compared")
            then = {p["name"]: p for p in yaml.safe_load((frozen / "calibration/calibration.yaml").read_text())["parameters"]}
            now = {p["name"]: p for p in yaml.safe_load((made / "calibration.yaml").read_text())["parameters"]}
            self.assertLessEqual(set(then), set(now))
            for name, parameter in then.items():
                if parameter["status"] == "estimated":
                    self.assertLess(abs(parameter["value"] - now[name]["value"]), parameter["std"], name)
            finger = frozen / "calibration/finger.yaml"
            self.run_tool("finray_validate", "--finger", finger, "--plan", frozen / "plan.yaml", "--logs", frozen / "log.csv",
                          "--out_dir", self.out / "validated")
            self.run_tool("finray_zero", "--finger", finger, "--logs", frozen / "train.csv", "--out", self.out / "today.yaml")
            self.run_tool("finray_check", "--finger", frozen / "drawn_finger.yaml", "--out", self.out / "finger.svg")

    def test_simulate_design_plan(self):
        for frozen in VERSIONS:
            finger = frozen / "calibration/finger.yaml"
            self.run_tool("finray_simulate", "--finger", finger, "--frames", frozen / "estimated/log.frames.csv", "--out",
                          self.out / "simulated.csv", "--strict=false")
            # finray_simulate reads back what the estimator found.
            for row, then in zip(cells(self.out / "simulated.csv"), cells(frozen / "estimated/log.frames.csv")):
                if then["status"] == "ok" and not then.get("contact_2_mm"):
                    self.assertTrue(math.isclose(float(row["tip_x_mm"]), float(then["tip_x_mm"]), abs_tol=1e-3))
            # Both predict, and may find that the finger does not suffice (exit code 4).
            self.run_tool("finray_design", "--finger", frozen / "drawn_finger.yaml", "--plan", frozen / "plan.yaml", "--force_N", 2,
                          "--out_dir", self.out / "design", codes=(0, 4))
            self.run_tool("finray_plan", "--finger", finger, "--plan", frozen / "plan.yaml", "--x_mm", "-30:15", "--y_mm", "30:110",
                          "--force_max_N", 8, "--target_force_N", 0.5, "--most_frames", 60, "--report=false", "--out_dir",
                          self.out / "plan", codes=(0, 4))

    def test_touches_springs_experiment(self):
        for frozen in VERSIONS:
            finger = ROOT / "configs/fingers/paper_140mm.yaml"
            # Forty touches leave most of an outline open: exit code 4.
            self.run_tool("finray_reconstruct", "--finger", finger, "--logs", frozen / "touches.csv", "--out_dir", self.out / "outline",
                          "--plots=false", codes=(0, 4))
            self.run_tool("finray_compliance", "--finger", finger, "--scene", frozen / "spring_scene.yaml", "--logs",
                          ",".join(map(str, sorted(frozen.glob("spring_*_*.csv")))), "--out_dir", self.out / "springs", "--plots=false")
            self.run_tool("finray_control", "--finger", finger, "--experiment", frozen / "experiment.yaml", "--draws", 1, "--out_dir",
                          self.out / "control")

    def test_convert(self):
        for frozen in VERSIONS:
            files = sorted(frozen.rglob("*.yaml"))
            for number, path in enumerate(files):
                self.run_tool("finray_convert", "--files", path, "--out_dir", self.out / str(number))


if __name__ == "__main__":
    unittest.main()
