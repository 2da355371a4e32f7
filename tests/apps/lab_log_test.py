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
        inputs = yaml.safe_load((self.folder / "lab_v/validation.yaml").read_text())["inputs"]
        self.assertEqual(inputs["columns"]["path"], "lab_columns.yaml")
        self.expect_equal_tables("lab_e/lab_holdout.frames.csv",
                                 "plain_e/plain_holdout.frames.csv")
        self.expect_equal_tables("lab_live.csv", "plain_live.csv")
        self.expect_equal_tables("lab_s.csv", "plain_s.csv")
        zeroed = [yaml.safe_load((self.folder / f"{kind}_zero.yaml").read_text())["gauges"]
                  for kind in ("lab", "plain")]
        self.assertEqual(*zeroed)

    def test_the_configuration_has_the_mapping(self):
        plan = ("--finger", PAPER, "--plan", "lab_plan.yaml", "--logs", "lab_train.csv", "--out_dir", "o")
        scene = ("--finger", PAPER, "--scene", "lab_scene.yaml", "--logs", "lab_train.csv", "--out_dir", "o")
        for tool, flags in (("calibrate", plan), ("validate", plan), ("estimate", scene)):
            dump = yaml.safe_load(self.run_tool(tool, *flags, "--dump_config"))
            self.assertEqual(dump["columns"]["stage_x"],
                             {"to": "object_x_mm", "scale": -1000, "offset": 150})
            self.assertEqual(dump["columns"]["ch2"]["unit"]["range_V"], [FROM_V, TO_V])
            self.assertEqual(dump["columns"]["Fz [gf]"], {"to": "force_N"})
        self.assertFalse((self.folder / "o").exists())

    def test_touches_of_an_object(self):
        """finray_reconstruct, with a stage in metres and headers of its own."""
        with open(SOURCE / "datasets/touches_square/touches.csv", newline="") as file:
            rows = list(csv.reader(file))[::2]
        headers = ["ch1", "ch2", "ch3", "ch4", "sx", "sy", "turn", "F"]
        lines = [";".join(headers)] + [";".join([*row[:4], f"{float(row[4]) / 1000:.9f}", *row[5:]])
                                       for row in rows[1:]]
        (self.folder / "lab_touches.csv").write_text("\n".join(lines).replace(".", ",") + "\n")
        plain = [",".join(rows[0])] + [",".join([*row[:4], repr(float(f"{float(row[4]) / 1000:.9f}") * 1000),
                                                 *row[5:]]) for row in rows[1:]]
        (self.folder / "plain_touches.csv").write_text("\n".join(plain) + "\n")
        (self.folder / "touch_scene.yaml").write_text(
            "contacts: 1\ncolumns: {ch1: gauge_1_V, ch2: gauge_2_V, ch3: gauge_3_V, ch4: gauge_4_V,\n"
            "  sx: {to: object_x_mm, unit: m}, sy: object_y_mm, turn: object_angle_deg, F: force_N}\n")
        (self.folder / "plain_touch_scene.yaml").write_text("contacts: 1\n")
        self.run_tool("reconstruct", "--finger", PAPER, "--scene", "touch_scene.yaml", "--logs",
                      "lab_touches.csv", "--out_dir", "lab_r", "--noplots")
        self.run_tool("reconstruct", "--finger", PAPER, "--scene", "plain_touch_scene.yaml", "--logs",
                      "plain_touches.csv", "--out_dir", "plain_r", "--noplots")
        for name in ("outline.csv", "touches.csv"):
            self.expect_equal_tables(f"lab_r/{name}", f"plain_r/{name}")

    def test_bad_rows_are_left_out_of_a_joint_estimate(self):
        rows = (self.folder / "plain_holdout.csv").read_text().splitlines(keepends=True)[:40]
        (self.folder / "good.csv").write_text("".join(rows))
        bad = rows[5].replace(",", ",x", 1)
        (self.folder / "bad.csv").write_text("".join(rows[:11] + [bad, "1,2\n"] + rows[11:]))
        (self.folder / "joint.yaml").write_text(
            "contacts: 1\ngauge_offset_walk: {start_std_V: 0.001, std_V_per_sqrt_s: 1.0e-5}\n")
        joint = ("--joint", "--finger", PAPER, "--scene", "joint.yaml", "--logs")
        for name, more in (("good", ()), ("bad", ("--bad_rows", "skip"))):
            said = self.run_tool("estimate", *joint, f"{name}.csv", "--out_dir", "j", *more)
        self.assertIn("2 bad rows left out", said)
        self.expect_equal_tables("j/bad.frames.csv", "j/good.frames.csv")
        listed = self.numbers((self.folder / "j/bad.bad_rows.csv").read_text())
        self.assertEqual(len(listed), 3)
        self.assertEqual([row[0] for row in listed[1:]], [12, 13])
        self.run_tool("estimate", *joint, "bad.csv", "--out_dir", "k", codes=(2,))
        self.assertFalse((self.folder / "k").exists())


if __name__ == "__main__":
    if not (BINARIES / "finray_calibrate").exists():
        print("skipped: no finray_calibrate in FINRAY_BINARY_DIR")
        sys.exit(77)
    unittest.main()
