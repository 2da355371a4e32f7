#!/usr/bin/python3
"""A log as a lab writes it gives every tool the result of the plain CSV with the same
values, to the last digit."""

import csv
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

import yaml

SOURCE = pathlib.Path(__file__).resolve().parents[2]
BINARIES = pathlib.Path(os.environ.get("FINRAY_BINARY_DIR", ".")).resolve()
DATA = SOURCE / "datasets/simulated_r15"
PAPER = SOURCE / "configs/fingers/paper_140mm.yaml"
PLAN = SOURCE / "configs/plans/force_and_circle.yaml"
BITS, FROM_V, TO_V = 16, -2.5, 2.5

# Semicolons, decimal commas, counts, grams, a stage in metres with x the other way.
MAPPING = f"""columns:
  t: {{to: time_s, format: iso8601, offset: -1795512600}}
""" + "".join(
    f"  ch{j}: {{to: gauge_{j}_V, unit: {{adc_bits: {BITS}, range_V: [{FROM_V}, {TO_V}]}}}}\n"
    for j in range(1, 5)) + """  "Fz [gf]": force_N
  stage_x: {to: object_x_mm, scale: -1000, offset: 150}
  stage_y: {to: object_y_mm, unit: m}
"""


def lab_row(row):
    """What the logger writes of a row."""
    volts = [float(row[f"gauge_{j}_V"]) for j in range(1, 5)]
    counts = [round((v - FROM_V) * 2 ** BITS / (TO_V - FROM_V)) for v in volts]
    return [f"2026-11-24T10:{30 + int(float(row['time_s'])) // 60:02d}:"
            f"{float(row['time_s']) % 60:06.3f}+01:00",
            *map(str, counts), f"{float(row['force_N']) / 9.80665e-3:.3f}",
            f"{0.150 - float(row['object_x_mm']) / 1000:.7f}",
            f"{float(row['object_y_mm']) / 1000:.7f}"]


def plain_row(cells):
    """The same in finray's columns and units."""
    minute, second = cells[0][14:16], cells[0][17:23]
    time_s = 1795512600 + 60 * (int(minute) - 30) + int(second[:2]) + float(second[2:]) - 1795512600
    volts = [int(c) * (TO_V - FROM_V) / 2 ** BITS + FROM_V for c in cells[1:5]]
    return [time_s, *volts, float(cells[5]) * 9.80665 / 1000,
            -1000 * float(cells[6]) + 150, float(cells[7]) * 1000]


class LabLogTest(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="finray_lab_"))
        self.addCleanup(shutil.rmtree, self.folder)
        for name in ("train", "holdout"):
            self.write_logs(name)
        (self.folder / "lab_columns.yaml").write_text(MAPPING)
        plan = yaml.safe_load(PLAN.read_text())
        plan.pop("columns", None)
        scene = {"contacts": "auto", "object": {"shape": "circle", "radius_mm": 15}}
        for name, content in (("plan", plan), ("scene", scene)):
            (self.folder / f"plain_{name}.yaml").write_text(yaml.safe_dump(content))
            (self.folder / f"lab_{name}.yaml").write_text(
                yaml.safe_dump({**content, "columns": "lab_columns.yaml"}))

    def write_logs(self, name):
        with open(DATA / f"{name}.csv", encoding="ascii", newline="") as file:
            rows = [lab_row(row) for row in csv.DictReader(file)]
        header = ["t", "ch1", "ch2", "ch3", "ch4", "Fz [gf]", "stage_x", "stage_y"]
        lines = ["DAQ 7; 4 channels", "", ";".join(header)]
        lines += [";".join(row).replace(".", ",") for row in rows]
        (self.folder / f"lab_{name}.csv").write_text("\ufeff" + "\r\n".join(lines) + "\r\n",
                                                     encoding="utf-8")
        columns = ["time_s", *(f"gauge_{j}_V" for j in range(1, 5)), "force_N",
                   "object_x_mm", "object_y_mm"]
        text = ",".join(columns) + "\n" + "".join(
            ",".join(map(repr, plain_row(row))) + "\n" for row in rows)
        (self.folder / f"plain_{name}.csv").write_text(text)

    def run_tool(self, tool, *arguments, stdin=None, codes=(0,)):
        with open(self.folder / stdin, "rb") if stdin else open(os.devnull, "rb") as file:
            done = subprocess.run([BINARIES / f"finray_{tool}", *map(str, arguments)],
                                  cwd=self.folder, stdin=file, check=False,
                                  stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        self.assertIn(done.returncode, codes, done.stderr)
        return done.stdout

    def numbers(self, text):
        """Cells as numbers where they are."""
        def value(cell):
            try:
                return float(cell)
            except ValueError:
                return cell
        return [[value(cell) for cell in row] for row in csv.reader(text.splitlines())]

    def expect_equal_tables(self, lab, plain):
        self.assertEqual(self.numbers((self.folder / lab).read_text()),
                         self.numbers((self.folder / plain).read_text()))

    def test_every_tool(self):
        values = {}
        for kind in ("plain", "lab"):
            self.run_tool("calibrate", "--finger", PAPER, "--plan", f"{kind}_plan.yaml",
                          "--logs", f"{kind}_train.csv", "--out_dir", f"{kind}_c",
                          "--noreport", codes=(0, 4))
            result = yaml.safe_load((self.folder / f"{kind}_c/calibration.yaml").read_text())
            values[kind] = result["parameters"], result["noise"]
            finger = f"{kind}_c/finger.yaml"
            self.run_tool("validate", "--finger", finger, "--plan", f"{kind}_plan.yaml",
                          "--logs", f"{kind}_holdout.csv", "--out_dir", f"{kind}_v")
            scene = ("--scene", f"{kind}_scene.yaml")
            self.run_tool("estimate", "--finger", finger, *scene, "--logs",
                          f"{kind}_holdout.csv", "--out_dir", f"{kind}_e")
            live = self.run_tool("estimate", "--follow", "--finger", finger, *scene,
                                 stdin=f"{kind}_holdout.csv")
            (self.folder / f"{kind}_live.csv").write_text(live)
            self.run_tool("zero", "--finger", finger, *scene, "--logs",
                          f"{kind}_holdout.csv", "--out", f"{kind}_zero.yaml")
            self.run_tool("zero", "--follow", "--finger", finger, *scene, "--out",
                          f"{kind}_zero_live.yaml", "--zero_rows", "1:10",
                          stdin=f"{kind}_holdout.csv", codes=(0, 2))
            self.run_tool("simulate", "--finger", finger, *scene, "--frames",
                          f"{kind}_holdout.csv", "--out", f"{kind}_s.csv", "--nostrict",
                          codes=(0, 3))
            self.run_tool("compliance", "--finger", finger, *scene, "--logs",
                          f"{kind}_holdout.csv", "--out_dir", f"{kind}_k", "--noplots",
                          codes=(0, 2, 4))
        self.assertEqual(values["lab"], values["plain"])
        inputs = yaml.safe_load((self.folder / "lab_c/calibration.yaml").read_text())["inputs"]
        self.assertEqual(inputs["columns"]["path"], "lab_columns.yaml")
        self.expect_equal_tables("lab_e/lab_holdout.frames.csv",
                                 "plain_e/plain_holdout.frames.csv")
        self.expect_equal_tables("lab_live.csv", "plain_live.csv")
        self.expect_equal_tables("lab_s.csv", "plain_s.csv")
        zeroed = [yaml.safe_load((self.folder / f"{kind}_zero.yaml").read_text())["gauges"]
                  for kind in ("lab", "plain")]
        self.assertEqual(*zeroed)


if __name__ == "__main__":
    if not (BINARIES / "finray_calibrate").exists():
        print("skipped: no finray_calibrate in FINRAY_BINARY_DIR")
        sys.exit(77)
    unittest.main()
