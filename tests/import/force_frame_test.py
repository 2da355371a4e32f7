#!/usr/bin/python3
"""Bias, tool weight and axes of a force sensor; what a recording does not determine is said."""

import re
import unittest

import numpy as np
from fixture import ROOT, ImportCase

import force_frame
from errors import NoSolution

CASE = ROOT.parent / "shared/cases/two_axis_force/import"
ANGLE_DEG, BIAS, WEIGHT = 30.0, np.array([0.4, -0.7]), np.array([0.2, -1.5])


def energy_force(x, y):
    """The gradient of U = 0.3 d^2 (1 + ((y - 70)/50)^2) (1 + d / 20): no line of it is straight."""
    d = x + 15
    height = 1 + ((y - 70) / 50)**2
    return np.stack((0.3 * height * (2 * d + 3 * d**2 / 20),
                     0.3 * d**2 * (1 + d / 20) * 2 * (y - 70) / 2500), axis=1)


def presses(draw, rows=300):
    return draw.uniform(-14, -9, rows), draw.uniform(30, 110, rows)


class RotationTest(unittest.TestCase):
    def test_axes_are_found_within_their_std(self):
        draw = np.random.default_rng(4)
        z = []
        for _ in range(10):
            x, y = presses(draw)
            force = force_frame.turned(energy_force(x, y), -np.radians(ANGLE_DEG))
            force += 0.02 * draw.normal(size=force.shape)
            places = {"object_x_mm": x + 0.02 * draw.normal(size=len(x)),
                      "object_y_mm": y + 0.02 * draw.normal(size=len(x))}
            degrees, std = force_frame.rotation(places, force)
            self.assertLess(std, 0.5)
            z.append((degrees - ANGLE_DEG) / std)
        self.assertLess(np.sqrt(np.mean(np.square(z))), 1.6)

    def test_a_turned_force_is_no_gradient(self):
        """A check of the premise by work along a closed path, which is not the code's."""
        corner = [(-14, 40), (-9, 40), (-9, 100), (-14, 100), (-14, 40)]
        work = []
        for degrees in (0, 20):
            total = 0.0
            for (x0, y0), (x1, y1) in zip(corner, corner[1:]):
                s = (np.arange(2000) + 0.5) / 2000
                force = force_frame.turned(energy_force(x0 + s * (x1 - x0), y0 + s * (y1 - y0)),
                                           np.radians(degrees))
                total += np.mean(force @ [x1 - x0, y1 - y0])
            work.append(abs(total))
        self.assertLess(work[0], 1e-4)
        self.assertGreater(work[1], 10)

    def test_a_wrong_sign_is_named_and_no_right_one(self):
        draw = np.random.default_rng(5)
        for turn in (0, 8, -20):
            for wrong, sides in (("force_sensor_x_N", [-1, 1]), ("force_sensor_y_N", [1, -1])):
                x, y = presses(draw)
                force = force_frame.turned(energy_force(x, y), np.radians(turn))
                force += 0.02 * draw.normal(size=force.shape)
                places = {"object_x_mm": x, "object_y_mm": y}
                self.assertIsNone(force_frame.mirrored(places, force, force_frame.SENSOR_AXES))
                self.assertLess(abs(force_frame.rotation(places, force)[0] + turn), 1)
                with self.subTest((turn, wrong)), self.assertRaisesRegex(
                        NoSolution, f"the sign of {wrong} is wrong: .* change the sign of its scale"):
                    force_frame.rotation(places, force * sides)

    def test_one_line_of_places_is_refused(self):
        draw = np.random.default_rng(4)
        x, y = presses(draw)
        with self.assertRaisesRegex(NoSolution, "one line"):
            force_frame.rotation({"object_x_mm": x, "object_y_mm": 0 * y + 70},
                                 energy_force(x, y))
        with self.assertRaisesRegex(NoSolution, "object_x_mm"):
            force_frame.rotation({}, energy_force(x, y))
        with self.assertRaisesRegex(NoSolution, "too few"):
            force_frame.rotation({"object_x_mm": x[:20], "object_y_mm": y[:20]},
                                 energy_force(x, y)[:20])


class SensorTest(ImportCase):
    def recording(self, turns=False, angles=True):
        """Rows of one clock: free ones and presses, gauges, stage and a sensor with axes."""
        draw = np.random.default_rng(9)
        x, y = presses(draw, 400)
        free = np.arange(400) % 8 < 2
        x[free] = -20
        force = np.where(free[:, None], 0, energy_force(np.maximum(x, -15), y))
        angle = draw.uniform(-60, 60, 400) if angles else np.full(400, 15.0)
        sensor = force_frame.turned(force, -np.radians(ANGLE_DEG + (angle if turns else 0)))
        if turns:
            sensor = force_frame.turned(force_frame.turned(force, -np.radians(ANGLE_DEG)) + WEIGHT,
                                        -np.radians(angle))
        sensor = sensor + BIAS + 0.02 * draw.normal(size=sensor.shape)
        gauge = 0.01 * np.hypot(*force.T) + 3e-4 * draw.normal(size=400)
        header = "time_s,gauge_1_V,force_sensor_x_N,force_sensor_y_N,object_x_mm,object_y_mm," \
            "object_angle_deg"
        rows = np.stack((0.1 * np.arange(400), gauge, *sensor.T, x, y, angle), axis=1)
        text = header + "\n" + "\n".join(",".join(map(repr, map(float, r))) for r in rows) + "\n"
        return self.write("a.csv", text), force

    def forces(self, log):
        return np.stack([np.array(log[n], dtype=float) for n in ("force_x_N", "force_y_N")], axis=1)

    def test_bias_and_axes_become_forces_in_frame_s(self):
        path, truth = self.recording()
        forces = self.forces(self.log_of("--logs", path))
        self.assertLess(np.sqrt(np.mean((forces - truth)**2)), 0.03)
        self.assertIn("force axes", self.result.out)
        text = (self.folder / "log.mapping.yaml").read_text()
        again = self.write("again.yaml", text)
        np.testing.assert_array_equal(
            self.forces(self.log_of("--logs", path, "--mapping", again)), forces)

    def test_the_weight_of_a_tool_that_turns_is_taken_off(self):
        path, truth = self.recording(turns=True)
        mapping = self.write("m.yaml", "force: {turns_with_object: true}\n")
        forces = self.forces(self.log_of("--logs", path, "--mapping", mapping))
        self.assertLess(np.sqrt(np.mean((forces - truth)**2)), 0.05)
        said = re.search(r"tool weight +(\S+) N .*?, (\S+) N", self.result.out)
        np.testing.assert_allclose([float(said[1]), float(said[2])], WEIGHT, atol=0.015)
        again = self.write("again.yaml", (self.folder / "log.mapping.yaml").read_text())
        np.testing.assert_array_equal(
            self.forces(self.log_of("--logs", path, "--mapping", again)), forces)

    def test_a_weight_without_turns_is_not_determined(self):
        path, _ = self.recording(turns=True, angles=False)
        mapping = self.write("m.yaml", "force: {turns_with_object: true}\n")
        self.log_of("--logs", path, "--mapping", mapping)
        self.assertIn("tool weight: the free rows do not have enough different",
                      self.result.err)
        self.assertIn("enough different", self.refused(
            "--logs", path, "--mapping", mapping, "--force_bias_N", "estimate", code=3))

    def test_axes_that_stay_unknown_leave_the_magnitude(self):
        path, truth = self.recording()
        text = path.read_text().replace("object_x_mm", "x").replace("object_y_mm", "y")
        log = self.log_of("--logs", self.write("b.csv", text))
        size = np.array(log["force_N"], dtype=float)
        self.assertLess(np.abs(size - np.hypot(*truth.T)).max(), 0.15)
        self.assertIn("magnitude force_N", self.result.err)

    def test_axes_that_stay_unknown_are_averaged_before_their_magnitude_is_taken(self):
        """Free places read 0 within the noise of means, not the size of single readings' noise."""
        draw = np.random.default_rng(6)
        size, held = 40, 50
        x, y = presses(draw, size)
        force = energy_force(x, y)
        force[::2] = 0
        truth = np.repeat(force, held, axis=0)
        sensor = truth + BIAS + 0.03 * draw.normal(size=truth.shape)
        gauge = 0.01 * np.hypot(*truth.T) + 1e-4 * draw.normal(size=len(truth))
        rows = np.column_stack((0.02 * np.arange(len(truth)), gauge, sensor))
        path = self.write("a.csv", "time_s,gauge_1_V,force_sensor_x_N,force_sensor_y_N\n" + "\n".join(
            ",".join(map(repr, map(float, r))) for r in rows) + "\n")
        log = self.log_of("--logs", path, "--plateaus")
        found, row = np.array(log["force_N"], dtype=float), 0.03 / np.sqrt(held)
        at = np.round(np.array(log["time_s"], dtype=float) // (0.02 * held)).astype(int)
        expected = np.hypot(*force[at].T)
        self.assertGreater(len(at), 35)
        self.assertLess(found[expected == 0].mean(), 0.8 * row)
        self.assertLess(found[expected == 0].max(), 4 * row)
        self.assertLess(np.abs(found - expected).max(), 5 * row)
        self.assertLess(abs((found - expected)[expected > 0].mean()), 4 * row / np.sqrt(size / 2))
        self.assertLess(abs(float(log["force_scatter_N"][1]) - 0.03), 0.01)

    @unittest.skipUnless(CASE.exists(), "the shared cases are absent")
    def test_a_mirrored_mapping_is_named_and_leaves_free_rows_at_zero(self):
        logs = ",".join(str(CASE / n) for n in ("dms.csv.gz", "ft.csv.gz", "stage.txt"))
        log = self.log_of("--logs", logs, "--mapping", CASE / "mirrored.yaml", "--plateaus")
        self.assertLess(float(log["force_N"][0]), 0.003)
        self.assertIn("the sign of force_sensor_x_N is wrong", self.result.err)
        self.log_of("--logs", logs, "--mapping", CASE / "right.yaml", "--plateaus")
        self.assertNotIn("sign", self.result.err)
        said = re.search(r"force_tilt: \{prior_std_deg: ([0-9.]+)\}", self.result.out)
        self.assertLess(float(said[1]), 0.5)

    def test_a_wrong_sign_is_said_of_stated_axes_too(self):
        path, _ = self.recording()
        right = ["--logs", path, "--force_rotation_deg", "30"]
        self.log_of(*right)
        self.assertNotIn("sign", self.result.err)
        mapping = self.write("m.yaml", "columns: {force_sensor_y_N: {to: force_sensor_y_N, scale: -1}}")
        self.log_of(*right, "--mapping", mapping)
        self.assertIn("the sign of force_sensor_y_N is wrong", self.result.err)

    def test_a_start_that_is_not_free_is_refused(self):
        t = np.arange(0, 30, 0.1)
        level = np.where(t % 6 < 3, 1.0, 0.0)  # begins with a press
        draw = np.random.default_rng(1)
        rows = np.stack((t, 0.1 * level + 1e-4 * draw.normal(size=len(t)),
                         2 * level + 0.3 + 0.01 * draw.normal(size=len(t))), axis=1)
        path = self.write("a.csv", "time_s,gauge_1_V,force_N\n" + "\n".join(
            ",".join(map(repr, map(float, r))) for r in rows) + "\n")
        self.log_of("--logs", path)
        self.assertIn("state when the finger is free with --free_s", self.result.err)
        log = self.log_of("--logs", path, "--free_s", "3.5:5.5")
        self.assertAlmostEqual(float(log["force_N"][0]), 2, delta=0.05)

    def test_no_bias_comes_from_rows_that_touch(self):
        """Every row is another place, so neighbouring readings differ as much as any, and all rows look free."""
        self.log_of("--logs", ROOT / "datasets/simulated_r15/train.csv")
        self.assertIn("follows the gauges; state when the finger is free with --free_s", self.result.err)
        self.assertNotIn("force bias", self.result.out)


if __name__ == "__main__":
    unittest.main()
