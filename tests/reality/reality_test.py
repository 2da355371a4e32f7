#!/usr/bin/python3
"""scripts/reality without CalculiX: the mesh, the gauges, the bundled logs, and what
finray makes of them. The executables are in FINRAY_BINARY_DIR."""

import itertools
import math
import os
import pathlib
import statistics
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.dont_write_bytecode = True
sys.path.insert(0, str(ROOT / "scripts" / "reality"))

import beams
import gauges
import make_logs
import outcome
import plant as plants
import report
from solid import Solid

DATA = ROOT / "datasets" / "reality"
BUILD = pathlib.Path(os.environ["FINRAY_BINARY_DIR"])


def plant(name):
    return plants.read(DATA / name / "plant.yaml")


def area(solid):
    """Of all elements by the corners, each of which must be convex and counter-clockwise."""
    total = 0.0
    for element in itertools.chain(*solid.elements.values()):
        corners = [solid.nodes[n - 1] for n in element[:4]]
        for a, b, c in zip(corners, corners[1:] + corners, corners[2:] + corners):
            assert (b[0] - a[0]) * (c[1] - b[1]) - (b[1] - a[1]) * (c[0] - b[0]) > 0, corners
        total += sum(a[0] * b[1] - a[1] * b[0] for a, b in zip(corners, corners[1:] + corners)) / 2
    return total


class SolidTest(unittest.TestCase):
    def test_elements_fill_beams_and_ribs(self):
        for name, contact in (("strip", None), ("strip", 39.0), ("printed", None), ("printed", 35.2), ("printed", 22.0)):
            solid = Solid(plant(name), contact)
            # Beams to the section through P and ribs between the inner surfaces.
            expected = sum(solid.ends[side] * solid.plant.thickness[side] for side in solid.ends)
            ribs = sum(rib.thickness_mm * (math.dist(solid.point("front", rib.front_mm, 0),
                                                     solid.point("back", rib.back_mm, 0))
                                           - sum(solid.plant.thickness.values()) / 2) for rib in solid.plant.ribs)
            found = area(solid)
            cap = 1.5 * max(solid.plant.thickness.values()) ** 2
            self.assertGreater(found, expected + 0.97 * ribs, (name, contact))
            self.assertLess(found, expected + 1.03 * ribs + cap, (name, contact))

    def test_ribs_with_thickness_share_nodes_with_both_beams(self):
        solid = Solid(plant("printed"), 35.0)
        ribs = {n for element in solid.elements["RIBS"] for n in element}
        for side in ("FRONT", "BACK"):
            shared = ribs & {n for element in solid.elements[side] for n in element}
            self.assertGreaterEqual(len(shared), 3 * len(solid.plant.ribs))
        self.assertEqual(solid.springs, [])

    def test_hinges_are_on_the_neutral_lines(self):
        solid = Solid(plant("strip"))
        for rib, (a, b) in zip(solid.plant.ribs, solid.springs):
            for node, side, s in ((a, "front", rib.front_mm), (b, "back", rib.back_mm)):
                self.assertLess(math.dist(solid.nodes[node - 1], solid.point(side, s, 0)), 1e-9)


class GaugesTest(unittest.TestCase):
    def test_a_beam_bent_to_a_circle_reads_its_angle(self):
        for curvature in (0.004, -0.002):
            solid = Solid(plant("strip"))
            moved = {}
            for s, column in solid.columns["back"].items():
                self.bend(solid, moved, s, column, curvature)
            for a, b, column in solid._middles["back"]:
                self.bend(solid, moved, (a + b) / 2, column, curvature)
            for gauge, angle in zip(solid.plant.gauges, gauges.angles(solid, moved)):
                self.assertAlmostEqual(angle, curvature * gauge.length_mm, delta=1e-6)

    @staticmethod
    def bend(solid, moved, s, column, curvature):
        """A section of the back beam at s on a circle around a point to its left."""
        half, phi = solid.plant.thickness["back"] / 2, solid.plant.angle["back"]
        for k, node in enumerate(column):
            across = half * (2 * k / (len(column) - 1) - 1)
            radius = 1 / curvature - across
            turned = phi + curvature * s
            x = solid.plant.base["back"][0] - math.sin(phi) / curvature + radius * math.sin(turned)
            y = math.cos(phi) / curvature - radius * math.cos(turned)
            moved[node] = (x - solid.nodes[node - 1][0], y - solid.nodes[node - 1][1])

    def test_the_place_on_the_surface_is_an_arc_length(self):
        solid = Solid(plant("printed"), 40.0)
        still = {n + 1: (0.0, 0.0) for n in range(len(solid.nodes))}
        half = solid.plant.thickness["front"] / 2
        for s in (20.0, 40.13, 61.7):
            self.assertAlmostEqual(gauges.arc_of(solid, still, (-half - 0.01, s)), s, delta=0.03)


class BundledLogsTest(unittest.TestCase):
    def test_readings_are_the_truth_with_noise(self):
        for finger in make_logs.HEIGHTS:
            of = plant(finger)
            for world, friction in make_logs.FRICTIONS.items():
                for log in make_logs.TOUCHES:
                    folder = DATA / finger / world
                    readings, truth = (outcome.rows(folder / f"{log}{end}.csv") for end in ("", "_truth"))
                    self.assertEqual(len(readings), len(truth))
                    for j, gauge in enumerate(of.gauges, 1):
                        noise = [float(a[f"gauge_{j}_V"]) - gauge.offset_V
                                 - gauge.gain_V_per_rad * float(b[f"gauge_{j}_rad"]) for a, b in zip(readings, truth)]
                        self.assertLess(abs(statistics.pstdev(noise) / gauge.noise_V - 1), 0.3)
                    touched = [row for row in truth if row["normal_1_N"]]
                    self.assertGreater(len(touched), 50)
                    rubbing = [abs(float(row["friction_1"])) for row in touched]
                    # Penalty and increments let the normals of both surfaces differ a little.
                    self.assertLess(max(rubbing), friction + 0.01)
                    if friction:
                        self.assertGreater(max(rubbing), 0.29)

    def test_paths_are_the_same_with_and_without_friction(self):
        for finger in make_logs.HEIGHTS:
            for log in make_logs.TOUCHES:
                places = [[(row["object_x_mm"], row["object_y_mm"])
                           for row in outcome.rows(DATA / finger / world / f"{log}_truth.csv")]
                          for world in make_logs.FRICTIONS]
                self.assertEqual(*places)


class OnePieceTest(unittest.TestCase):
    def test_ribs_that_bend_are_those_of_calculix(self):
        """Gauge angles at all 360 touches of the bundled logs: light to 7 N, at all heights."""
        with tempfile.TemporaryDirectory() as folder:
            found = beams.bundled(BUILD, plant("printed"), sorted((DATA / "printed").glob("*/*_truth.csv")),
                                  pathlib.Path(folder), plants.RIGID_SHARE)
        self.assertEqual(len(found), 360)
        self.assertLess(min(force for force, _ in found), 1)
        self.assertGreater(max(force for force, _ in found), 6)
        self.assertLess(max(off for _, off in found), 2)
        self.assertLess(statistics.fmean(off for _, off in found), 1)


class OutcomeTest(unittest.TestCase):
    def test_only_frames_that_are_ok_and_touch_count(self):
        truth = [{"normal_1_N": "2", "contact_1_mm": "50", "contact_1_angle_rad": "1.5"}, {"normal_1_N": ""},
                 {"normal_1_N": "3", "contact_1_mm": "60", "contact_1_angle_rad": "1.5"}]
        row = {"status": "ok", "normal_1_N": "2.5", "normal_1_std_N": "0.4", "contact_1_mm": "49",
               "contact_1_std_mm": "2", "contact_1_angle_rad": "1.5"}
        found = outcome.errors([row, row, {**row, "status": "unobservable"}], truth)
        self.assertEqual(found, {"force": [(0.5, 0.4)], "place": [(-1.0, 2.0)], "angle": [0.0], "percent": [25.0]})
        self.assertEqual(outcome.means(found), {"place_mm": 1, "angle_deg": 0, "force_N": 0.5, "force_percent": 25})
        self.assertEqual(outcome.summary(found["force"]), {"rms": 0.5, "max": 0.5, "covered_68": 0, "covered_95": 100})

    def test_the_one_piece_finger_is_calibrated_and_covered(self):
        with tempfile.TemporaryDirectory() as folder:
            found = outcome.outcome(BUILD, DATA / "printed/finger_bending.yaml", DATA / "printed/plan_bending.yaml",
                                    DATA / "printed/smooth", plant("printed"), ROOT / "configs/scenes/auto.yaml",
                                    pathlib.Path(folder) / "out")
        self.assertEqual(found["exit"], 0)
        self.assertGreater(found["ok"], 50)
        self.assertLess(found["force"]["rms"], 0.2)
        self.assertGreater(found["force"]["covered_95"], 85)
        for entry in found["parameters"]:
            self.assertLess(abs(entry["value"] - entry["true"]), 4 * entry["std"], entry["name"])

    def test_friction_that_follows_the_motion_costs_no_force(self):
        with tempfile.TemporaryDirectory() as folder:
            found = outcome.outcome(BUILD, DATA / "strip/finger.yaml", DATA / "strip/plan_sliding.yaml",
                                    DATA / "strip/rough", plant("strip"), ROOT / "configs/scenes/auto.yaml",
                                    pathlib.Path(folder) / "out")
        friction = next(p for p in found["parameters"] if p["name"] == "friction_coefficient")
        self.assertLess(abs(friction["value"] - 0.3), 0.02)
        self.assertGreater(found["ok"], 50)
        self.assertLess(found["force"]["rms"], 0.06)  # 0.09 without the motion
        self.assertGreater(found["force"]["covered_95"], 85)

    def test_a_parameter_that_one_plan_alone_varies_has_a_row(self):
        ei, rib = ({"name": name, "true": 2.0, "value": 3.0, "std": 0.5} for name in ("ei", "rib"))
        self.assertEqual(report.parameters([{"parameters": [ei]}, {"parameters": [ei, rib]}]),
                         [["`ei`", "2", "3.00 ± 0.50, +2.0 std", "3.00 ± 0.50, +2.0 std"],
                          ["`rib`", "2", "", "3.00 ± 0.50, +2.0 std"]])

    def test_the_strip_without_friction_is_calibrated_and_covered(self):
        with tempfile.TemporaryDirectory() as folder:
            found = outcome.outcome(BUILD, DATA / "strip/finger.yaml", DATA / "strip/plan_thickness.yaml",
                                    DATA / "strip/smooth", plant("strip"), ROOT / "configs/scenes/auto.yaml",
                                    pathlib.Path(folder) / "out")
        self.assertEqual(found["exit"], 0)
        self.assertGreater(found["ok"], 50)
        self.assertLess(found["force"]["rms"], 0.08)
        self.assertGreater(found["force"]["covered_95"], 80)
        for entry in found["parameters"]:
            self.assertLess(abs(entry["value"] - entry["true"]), 4 * entry["std"], entry["name"])
        solved = {"finger": "strip", "world": "smooth", "plan": "thickness", **found}
        refused = {"finger": "printed", "world": "rough", "plan": "bundled", "exit": 2, "refused": "no such log"}
        text = report.markdown([solved, refused])
        page = report.rendered([solved, refused])
        self.assertIn("| printed | rough | bundled | no such log |", text)
        self.assertIn("<td>no such log</td>", page)
        self.assertIn(f"| strip | smooth | thickness | good, exit 0 | {found['ok']} of {found['touched']} |", text)
        self.assertIn("| `rib_5_longer_by_mm` | 0 |", text)


class MissingPackageTest(unittest.TestCase):
    def test_a_missing_package_is_named_in_one_line(self):
        with tempfile.TemporaryDirectory() as folder:
            (pathlib.Path(folder) / "scipy.py").write_text("raise ImportError\n")
            for name, hidden, package in (("verify", {"PYTHONPATH": folder}, "python3-scipy"),
                                          ("make_logs", {"PATH": folder}, "calculix-ccx")):
                ended = subprocess.run([sys.executable, ROOT / f"scripts/reality/{name}.py", folder], capture_output=True, text=True,
                                       env={**os.environ, **hidden})
                self.assertEqual((ended.returncode, ended.stderr), (
                    2, f"{name}.py: {package} is not installed: scripts/install_dependencies reality\n"), name)


if __name__ == "__main__":
    unittest.main()
