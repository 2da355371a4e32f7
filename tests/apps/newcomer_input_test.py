#!/usr/bin/python3
"""Mistakes of newcomers with the tools that come before and after an estimate: one clear line that names the flag or
the file, an exit code, and nothing written; or a warning that says what is implausible."""

import os
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

sys.dont_write_bytecode = True
ROOT = pathlib.Path(__file__).resolve().parents[2]
BINARIES = pathlib.Path(os.environ.get("FINRAY_BINARY_DIR", ROOT / "build/dev")).resolve()
FINGER = ROOT / "configs/fingers/paper_140mm.yaml"
PLAN = ROOT / "configs/plans/force_and_circle.yaml"
TRAIN = ROOT / "datasets/simulated_r15/train.csv"
STRIP = "--front_length_mm 140 --ribs 17:10,39:13,61:16 --gauges 4 --out_dir out "


class NewcomerInputTest(unittest.TestCase):
    def setUp(self):
        self.temporary = tempfile.TemporaryDirectory()
        self.addCleanup(self.temporary.cleanup)
        self.folder = pathlib.Path(self.temporary.name)
        self.plan = (f"--finger {FINGER} --plan {PLAN} --x_mm -30:10 --y_mm 0:140 --force_max_N 8 --target_force_N 0.3 "
                     "--most_frames 12 --report=false --out_dir out ")

    def run_tool(self, tool, arguments):
        return subprocess.run([BINARIES / f"finray_{tool}", *arguments.split()], cwd=self.folder, capture_output=True, text=True)

    def refused(self, tool, arguments, words, code=2):
        with self.subTest(tool, arguments=arguments):
            done = self.run_tool(tool, arguments)
            self.assertEqual((done.returncode, done.stdout, done.stderr.count("\n")), (code, "", 1), done.stderr)
            self.assertTrue(done.stderr.startswith(f"finray_{tool}: "), done.stderr)
            self.assertIn(words, done.stderr)
            self.assertFalse((self.folder / "out").exists())

    def test_flag_values_of_another_kind(self):
        for flag, words in (("--threads two", "--threads: expected a whole number, found 'two'"),
                            ("--threads=1.5", "--threads: expected a whole number, found '1.5'"),
                            ("--threads 99999999999", "--threads: expected a whole number of fewer digits, found '99999999999'"),
                            ("--seed -1", "--seed: expected a whole number, 0 or more"),
                            ("--force_max_N 8N", "--force_max_N: expected a number, found '8N'"),
                            ("--report=maybe", "--report: expected true or false, found 'maybe'"),
                            ("--force_max_N", "--force_max_N needs a value")):
            self.refused("plan", self.plan + flag, words, code=1)

    def test_the_picture_of_a_check_needs_a_place(self):
        (self.folder / "pictures").mkdir()
        self.refused("check", f"--finger {FINGER} --out pictures", "pictures: is a folder, expected a file to write")
        self.refused("check", f"--finger {FINGER} --out f.png", "f.png: the picture is an SVG, not .png")
        self.refused("check", f"--finger {FINGER} --out none/f.svg", "none/f.svg: cannot be written: No such file")

    def test_long_names_stay_in_the_picture(self):
        for name in ("left_index_finger_of_the_gripper_in_room_3_with_the_new_glue_and_the_old_cable_as_of_march",
                     "x" * 300, "\u6307" * 200, "f"):
            (self.folder / "f.yaml").write_text(re.sub("(?m)^name:.*$", f"name: {name}", FINGER.read_text()))
            self.assertEqual(self.run_tool("check", "--finger f.yaml --out f.svg").returncode, 0)
            svg = (self.folder / "f.svg").read_text()
            width = float(re.search(r'<svg[^>]* width="([\d.]+)"', svg)[1])
            lines = re.findall(r'<text x="40\.0" y="([\d.-]+)"[^>]*>([^<]*)<', svg)
            heights = [float(y) for y, _ in lines]
            self.assertEqual(len(set(heights)), len(heights), lines)
            self.assertGreater(min(heights), 12)
            for _, words in lines:
                pixels = sum(14 if letter == "\u6307" else 8 for letter in words)
                self.assertLess(40 + pixels, width, words)

    def test_a_touched_finger_is_not_zeroed_and_three_rows_are_enough(self):
        (self.folder / "scene.yaml").write_text("contacts: 1\n")
        (self.folder / "in.csv").write_text("contact_1_mm,normal_1_N\n59.4,2\n50,0\n")
        self.assertEqual(self.run_tool("simulate", f"--finger {FINGER} --scene scene.yaml --frames in.csv --out s.csv").returncode, 0)
        header, *rows = [line.split(",") for line in (self.folder / "s.csv").read_text().splitlines()]
        names = [f"gauge_{j}_V" for j in range(1, 5)]
        for name, row in zip(("touched", "free"), rows):
            volts = [float(row[header.index(n)]) for n in names]
            lines = [",".join(repr(v + noise) for v in volts) for noise in [3e-4, -3e-4, 0] * 7]
            (self.folder / f"{name}.csv").write_text("\n".join([",".join(names + ["force_N"]),
                                                               *(line + ",0.01" for line in lines)]))
        zero = f"--finger {FINGER} --out out --logs "
        for rows in ("", " --zero_rows 1:20", " --zero_rows 1:5"):
            self.refused("zero", f"{zero}touched.csv{rows}", "touched.csv: a contact of 2 N at 59")
            done = self.run_tool("zero", f"{zero}touched.csv{rows} --allow_touch")
            self.assertEqual(done.returncode, 0, done.stderr)
            (self.folder / "out").unlink()
        self.refused("zero", f"{zero}free.csv --zero_rows 1:2", "gauge_1_V has 2 readings in the free rows, expected at least 3")
        for last, warned in ((3, True), (5, True), (20, False)):
            done = self.run_tool("zero", f"{zero}free.csv --zero_rows 1:{last}")
            self.assertEqual((done.returncode, f"warning: {last} readings" in done.stderr), (0, warned), done.stderr)

    def test_dead_gauges_are_not_zeroed_without_a_word(self):
        names = ",".join(f"gauge_{j}_V" for j in range(1, 5))
        (self.folder / "dead.csv").write_text("\n".join([names] + ["0.001,0.001,0.001,0.001"] * 120))
        zero = f"--finger {FINGER} --out out --logs dead.csv --zero_rows 1:50"
        self.refused("zero", zero, "dead.csv: gauges 1, 2, 3, 4 do not move in 50 rows, not even by noise: dead, unplugged")
        done = self.run_tool("zero", zero + " --allow_touch")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(done.stderr.count("hardly moves, by 0 mV in 50 rows"), 4)
        done = self.run_tool("estimate", f"--finger out --logs dead.csv --out_dir frames --strict")
        self.assertEqual(done.returncode, 4, done.stderr)
        self.assertIn("in dead.csv gauges 1 to 4 do not move in 120 rows", done.stderr)
        self.assertIn("gauge_fault", (self.folder / "frames/summary.yaml").read_text())

    def test_mixed_up_units_are_implausible(self):
        for flags, words in (("--width_mm 20 --thickness_mm 1 --youngs_modulus_GPa 7000", "both beams: a modulus of 7000 GPa"),
                             ("--width_mm 20 --thickness_mm 0.001 --youngs_modulus_GPa 7", "both beams: 0.001 mm is thinner than foil; is it in m?"),
                             ("--width_mm 0.02 --thickness_mm 1 --youngs_modulus_GPa 7", "are they exchanged?"),
                             ("--width_mm 20 --thickness_mm 1 --youngs_modulus_GPa 7", "")):
            done = self.run_tool("design", STRIP + flags)
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertIn(words, done.stderr)
            if not words:
                self.assertEqual(done.stderr, "")
        plates = FINGER.read_text().replace("{bending_stiffness_N_mm2: 12500}",
                                            "{width_mm: 20, thickness_mm: 1, youngs_modulus_GPa: 7000}")
        (self.folder / "f.yaml").write_text(plates)
        self.assertRegex(self.run_tool("design", "--finger f.yaml --out_dir out").stderr,
                         r"warning: f.yaml:\d+:\d+: front beam: a modulus of 7000 GPa")

    def test_logs_to_plan_from_without_readings(self):
        header, first, *_ = TRAIN.read_text().splitlines()
        gauges = [i for i, name in enumerate(header.split(",")) if name.startswith("gauge_")]
        cells = ["" if i in gauges else cell for i, cell in enumerate(first.split(","))]
        for rows in (["," * header.count(",")] * 3, [",".join(cells)] * 20):
            (self.folder / "log.csv").write_text("\n".join([header, *rows]) + "\n")
            self.refused("plan", self.plan + "--from log.csv", "log.csv: no row has a reading of a gauge")
        (self.folder / "log.csv").write_text(f"{header}\n{first}\n")
        self.assertIn("warning: --from has 1 row that can be fitted, which tells next to nothing",
                      self.run_tool("plan", self.plan + "--from log.csv").stderr)

    def test_a_finger_in_place_of_a_log(self):
        words = f"{FINGER}: is a YAML file, expected a log: a CSV table with a header and rows"
        for tool, arguments in (("plan", f"{self.plan}--from {FINGER}"),
                                ("estimate", f"--finger {FINGER} --logs {FINGER} --out_dir out"),
                                ("calibrate", f"--finger {FINGER} --plan {PLAN} --logs {FINGER} --out_dir out"),
                                ("validate", f"--finger {FINGER} --logs {FINGER} --out_dir out"),
                                ("zero", f"--finger {FINGER} --logs {FINGER} --out out"),
                                ("reconstruct", f"--finger {FINGER} --logs {FINGER} --out_dir out"),
                                ("simulate", f"--finger {FINGER} --frames {FINGER} --out out"),
                                ("view", f"--finger {FINGER} --results {FINGER} --out_dir out")):
            self.refused(tool, arguments, words)

    def test_tabs_in_the_indentation_of_a_yaml(self):
        for lines, place in (("geometry:\n\tfront_length_mm: 140", "3:1"), ("ribs:\n  \t- {front_mm: 17}", "3:3"),
                             ("geometry:\n  front_length_mm: 140\n\tback_angle_deg: 112", "4:1"),
                             ("ribs:\n  - front_mm: 17\n  \tangle_deg: 10", "4:3")):
            (self.folder / "f.yaml").write_text(f"name: f\n{lines}\n")
            self.refused("check", "--finger f.yaml", f"f.yaml:{place}: not valid YAML: tab in the indentation, YAML wants spaces")

    def test_results_that_were_changed(self):
        head = "contact_1_mm,normal_1_N,status\n"
        for text, words in (("1,1,ok\n1,1,2,ok\n", ":3: expected 3 cells as in the header, found 4; finray_estimate has not written this"),
                            ("1,\"1,5\",ok\n", ":2:2: normal_1_N: expected a number")):
            (self.folder / "a.frames.csv").write_text(head + text)
            self.refused("view", "--results a.frames.csv --out_dir out", "a.frames.csv" + words)
            done = self.run_tool("view", "--results a.frames.csv --out_dir out")
            self.assertNotIn("scene or plan", done.stderr)
        self.refused("view", "--results a.frames.csv,a.frames.csv --compare --out_dir out", "--compare: expected two different <log>.frames.csv in --results", code=1)

    def test_results_of_another_finger(self):
        (self.folder / "a.frames.csv").write_text("contact_1_mm,normal_1_N,status\n100,1,ok\n150,1,ok\n")
        self.refused("view", f"--results a.frames.csv --finger {FINGER} --out_dir out",
                     "a.frames.csv:3: a contact at 150 mm, and the finger ends at 140 mm; is it the finger of the result?")

    def test_flags_that_would_do_nothing(self):
        for flags, words in ((f"--finger {FINGER} --thickness_mm 3", "--thickness_mm goes with --front_length_mm"),
                             (f"--finger {FINGER} --width_mm 3", "--width_mm: the beams are those of --finger"),
                             (f"--finger {FINGER} --calibration_frames 5", "--calibration_frames goes with --plan"),
                             (f"--finger {FINGER} --gauge_beams=", "--gauge_beams: expected back, front or both"),
                             (f"--finger {FINGER} --friction nan", "--friction: expected a coefficient"),
                             ("--front_length_mm 0.14 --ribs 17:10 --width_mm 20 --thickness_mm 1 --youngs_modulus_GPa 7 --gauges 4",
                              "--ribs: the rib 17:10 leaves the front beam, which is 0.14 mm long")):
            self.refused("design", flags + " --out_dir out", words, code=1)
        done = self.run_tool("design", STRIP.replace("--ribs 17:10,39:13,61:16", "") + "--width_mm 20 --thickness_mm 1 --youngs_modulus_GPa 7")
        self.assertIn("the finger has no ribs", done.stderr)


if __name__ == "__main__":
    unittest.main()
