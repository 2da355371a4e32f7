#!/usr/bin/python3
"""Joins by time, event logs, plateaus and the mapping that is written beside a log."""

import unittest

import numpy as np
from fixture import ImportCase

import joining
import noise
import plateaus


def table(names, rows):
    return "\n".join([",".join(names)] + [",".join(map(repr, map(float, r))) for r in rows]) + "\n"


class InterpolationTest(unittest.TestCase):
    T, V = np.array([0.0, 1.0, 2.0, 5.0]), np.array([0.0, 10.0, 30.0, 0.0])

    def at(self, method, *times):
        out = joining.interpolate(self.T, self.V, np.array(times), method, 2.0)
        return [None if np.isnan(v) else float(v) for v in out]

    def test_values_between_readings(self):
        self.assertEqual(self.at("linear", 0, 0.25, 1, 1.75, 2), [0, 2.5, 10, 25, 30])
        self.assertEqual(self.at("previous", 0, 0.25, 1, 1.75, 2), [0, 0, 10, 10, 30])
        self.assertEqual(self.at("nearest", 0.25, 0.75, 1.25), [0, 10, 10])

    def test_nothing_is_extrapolated_nor_told_in_a_gap(self):
        for method in ("linear", "previous", "nearest"):
            self.assertEqual(self.at(method, -0.1, 5.1, 2.1, 4.9, 5), [None] * 4 + [0])

    def test_missing_readings_are_bridged_within_the_gap(self):
        v = np.array([0.0, np.nan, 30.0, 0.0])
        self.assertEqual(joining.interpolate(self.T, v, np.array([1.0]), "linear", 2.0)[0], 15)
        self.assertTrue(np.isnan(joining.interpolate(self.T, v, np.array([1.0]), "linear", 1.5)))

    def test_angles_take_the_short_way(self):
        out = joining.interpolate(np.array([0.0, 1.0]), np.array([350.0, 10.0]),
                                  np.array([0.5]), "linear", 2.0, True)
        self.assertEqual(out[0] % 360, 0)


class JoinTest(ImportCase):
    def test_a_force_without_gauges_is_a_log(self):
        rows = [(0.01 * i, 0.1 * i) for i in range(400)]
        for names in (["time_s", "force_N"], ["time_s", "force_x_N"]):
            with self.subTest(names):
                more = ["force_y_N"] if names[1] == "force_x_N" else []
                path = self.write("f.csv", table(names + more, [r + (0.5,) * len(more) for r in rows]))
                log = self.log_of("--logs", path)
                self.assertEqual(len(log[names[1]]), 400)
                self.assertIn("0 free rows", self.result.err)

    def test_times_too_coarse_to_join_by_are_refused(self):
        fine = self.write("f.csv", table(["time_s", "force_N"], [(0.01 * i, 0.1 * i) for i in range(400)]))
        coarse = self.write("g.csv", table(["time_s", "gauge_1_V"], [(i // 100, 0.1 * i) for i in range(400)]))
        line = self.refused("--logs", f"{fine},{coarse}")
        self.assertIn("g.csv: 396 of the 400 rows of g.csv have the time of the row before: its clock steps by 1 s", line)

    def test_readings_in_packets_become_their_mean(self):
        """1 kHz stamped in packets of 4 ms, one reading of which is missing, joined with 100 Hz."""
        slow, fast = 0.01 * np.arange(200), 0.001 * np.arange(2000)
        gauges = self.write("g.csv", table(["time_s", "gauge_1_V"], np.stack((slow, 0.1 * slow), axis=1)))
        rows = [f"{np.floor(t / 0.004 + 1e-9) * 0.004:.3f},{'' if i == 2 else repr(3 * t)}" for i, t in enumerate(fast)]
        force = self.write("f.csv", "time_s,force_N\n" + "\n".join(rows) + "\n")
        self.log_of("--logs", f"{gauges},{force}", "--force_bias_N", "0")
        log = self.log_of("--logs", f"{gauges},{force}", "--force_time_offset_s", "0", "--force_bias_N", "0")
        log = {name: np.array(cells, dtype=float) for name, cells in log.items()}
        self.assertEqual(len(log["time_s"]), 200)
        # A packet of 4 is stamped 1.5 ms before its mean; the first one lacks its third reading.
        np.testing.assert_allclose(log["force_N"][1:], 3 * (log["time_s"][1:] + 0.0015), atol=1e-9)
        self.assertAlmostEqual(log["force_N"][0], 3 * (0 + 1 + 3) / 3 * 0.001)
        said = [line for line in self.result.err.splitlines() if "time of the row before" in line]
        self.assertEqual(said, ["warning: f.csv: 1500 of the 2000 rows of f.csv have the time of the row before; rows of "
                                "one time become their mean, one every 0.004 s"])

    def test_plateaus_count_the_readings_of_packets(self):
        time = 0.01 * np.arange(3000)
        gauge = 0.1 * np.floor(time / 10) + 1e-4 * np.random.default_rng(1).standard_normal(3000)
        force = self.write("f.csv", table(["time_s", "force_N"], [(0.1 * i, float(i // 100)) for i in range(300)]))
        logs = []
        for stamps in (time, np.floor(time / 0.05 + 1e-9) * 0.05):
            gauges = self.write("g.csv", table(["time_s", "gauge_1_V"], np.stack((stamps, gauge), axis=1)))
            log = self.log_of("--logs", f"{gauges},{force}", "--force_time_offset_s", "0", "--force_bias_N", "0", "--plateaus")
            logs.append({name: np.array(cells, dtype=float) for name, cells in log.items()})
        for name in ("gauge_1_scatter_V", "gauge_readings"):
            np.testing.assert_allclose(logs[1][name], logs[0][name], rtol=0.2)

    def test_a_table_of_one_time_is_not_joined(self):
        force = self.write("f.csv", table(["time_s", "force_N"], [(0.1 * i, 1) for i in range(99)]))
        gauges = self.write("g.csv", table(["time_s", "gauge_1_V"], [(7, 0.1 * i) for i in range(99)]))
        line = self.refused("--logs", f"{force},{gauges}", "--force_time_offset_s", "0")
        self.assertIn("g.csv: all rows of g.csv have one time", line)

    def test_rows_that_are_there_twice_are_no_coarse_clock(self):
        """At 5 Hz, each row twice; and a gauge and a force in rows of their own."""
        twice = [(0.2 * (i // 2), 0.1 * (i // 2)) for i in range(80)]
        force = self.write("f.csv", table(["time_s", "force_N"], [(0.01 * i, 0.1 * i) for i in range(900)]))
        flags = ["--force_time_offset_s", "0", "--force_bias_N", "0"]
        log = self.log_of("--logs", f"{force},{self.write('g.csv', table(['time_s', 'gauge_1_V'], twice))}", *flags)
        self.assertEqual(len(log["time_s"]), 40)
        apart = "time_s,gauge_1_V,temperature_C\n" + "".join(f"{t},{v},\n{t},,20\n" for t, v in twice[::2])
        apart = self.log_of("--logs", f"{force},{self.write('g.csv', apart)}", *flags)
        self.assertEqual(apart["gauge_1_V"], log["gauge_1_V"])
        self.assertEqual(set(apart["temperature_C"]), {"20.0"})

    def test_a_table_without_readings_tells_no_time_offset(self):
        force = self.write("f.csv", "time_s,force_N\n" + "".join(f"{i},\n" for i in range(99)))
        gauges = self.write("g.csv", table(["time_s", "gauge_1_V"], [(i, 0.1 * i) for i in range(99)]))
        line = self.refused("--logs", f"{force},{gauges}", "--force_time_offset_s", "estimate", code=3)
        self.assertIn("f.csv has no readings in most of its rows", line)

    def two_files(self, gap=False):
        t = np.round(np.arange(0, 10, 0.005), 6)
        if gap:
            t = t[(t < 4) | (t > 5)]
        gauges = self.write("g.csv", table(["time_s", "gauge_1_V"], np.stack((t, 2 * t), axis=1)))
        t = np.round(np.arange(-0.5, 11, 0.1), 6)
        force = self.write("f.csv", table(["time_s", "force_N"], np.stack((t, 3 * t), axis=1)))
        return ["--logs", f"{gauges},{force}", "--force_time_offset_s", "0", "--force_bias_N", "0"]

    def test_rows_are_those_of_the_slower_table(self):
        log = self.log_of(*self.two_files())
        t = np.array(log["time_s"], dtype=float)
        self.assertEqual(len(t), 100)
        np.testing.assert_allclose(np.array(log["gauge_1_V"], dtype=float), 2 * t, atol=1e-12)
        self.assertIn("15 rows of f.csv at its ends", self.result.err)

    def test_another_base_can_be_named(self):
        log = self.log_of(*self.two_files(), "--base", "g.csv")
        t = np.array(log["time_s"], dtype=float)
        self.assertEqual(len(t), 2000)
        np.testing.assert_allclose(np.array(log["force_N"], dtype=float), 3 * t, atol=1e-12)
        self.assertIn("'g.csv'", self.refused(*self.two_files(), "--base", "h.csv"))

    def test_gaps_stay_empty_and_are_said(self):
        log = self.log_of(*self.two_files(gap=True))
        t = np.array(log["time_s"], dtype=float)
        empty = np.array([cell == "" for cell in log["gauge_1_V"]])
        np.testing.assert_array_equal(empty, (t >= 4.0) & (t <= 5.0))
        self.assertIn("g.csv has a gap from 3.995 to 5.005 s", self.result.err)
        log = self.log_of(*self.two_files(gap=True), "--longest_gap_s", "2")
        self.assertNotIn("", log["gauge_1_V"])

    def test_tables_that_do_not_meet_are_refused(self):
        a = self.write("a.csv", "time_s,gauge_1_V\n0,1\n1,2\n")
        b = self.write("b.csv", "time_s,force_N\n5,1\n6,2\n")
        self.assertIn("share no time", self.refused("--logs", f"{a},{b}"))
        b = self.write("b.csv", "time,force_N\n1773237907,1\n1773237908,2\n")
        self.assertIn("time of day", self.refused("--logs", f"{a},{b}"))
        b = self.write("b.csv", "force_N\n1\n2\n")
        self.assertIn("no column that becomes time_s", self.refused("--logs", f"{a},{b}"))

    def test_an_event_log_is_taken_apart(self):
        rows = ["kind;t;F;ch0"]
        for i in range(200):
            rows.append(f"sensor;{i * 0.01:.2f};;{i}")
            if i % 10 == 5:
                rows.append(f"force;{i * 0.01:.2f};{3 * i};")
        path = self.write("events.csv", "\n".join(rows) + "\n")
        mapping = self.write("m.yaml", "row_type: kind\ncolumns: {F: force_N, ch0: gauge_1_V}\n")
        log = self.log_of("--logs", path, "--mapping", mapping, "--force_bias_N", "0")
        self.assertEqual(len(log["time_s"]), 20)
        gauges = np.array(log["gauge_1_V"], dtype=float)
        np.testing.assert_allclose(np.array(log["force_N"], dtype=float), 3 * gauges, atol=1e-9)
        self.assertIn("events.csv:force", self.result.out)

    def test_the_written_mapping_makes_the_same_log(self):
        for more in ([], ["--plateaus"]):
            t = np.arange(0, 30, 0.01)
            place = np.floor(t / 1.5) % 2 * (1 + np.floor(t / 3))
            draw = np.random.default_rng(1)
            a = self.write("a.csv", table(["t", "ch"], np.stack(
                (t, 100 + 50 * place + draw.normal(size=len(t))), axis=1)))
            t, place = t[::10], place[::10]
            b = self.write("b.csv", table(["t", "Fz"], np.stack(
                (t, 20 + 100 * place + draw.normal(size=len(t))), axis=1)))
            mapping = self.write("m.yaml", "columns:\n  ch: {to: gauge_1_V, unit: mV, offset: "
                                 "0.5}\n  Fz: {to: force_N, unit: gf, scale: 1.001}\n")
            first = self.log_of("--logs", f"{a},{b}", "--mapping", mapping, *more)
            again = self.write("again.yaml", (self.folder / "log.mapping.yaml").read_text())
            self.assertEqual(self.log_of("--logs", f"{a},{b}", "--mapping", again), first)
            self.assertEqual((self.folder / "log.mapping.yaml").read_text(), again.read_text())


class PlateauTest(ImportCase):
    def test_every_place_is_one_row_with_its_scatter(self):
        draw = np.random.default_rng(2)
        t = np.arange(0, 40, 0.005)
        level = np.interp(t, *np.array([(k + d, k // 2 * 0.01 * (k % 4 == 2) + 0.002 * (k % 3))
                                        for k in range(0, 40, 2) for d in (0.2, 1.8)]).T)
        gauges = table(["time_s", "gauge_1_V"],
                       np.stack((t, level + 3e-4 * draw.normal(size=len(t))), axis=1))
        slow = np.arange(0, 40, 0.1)
        forces = 20 * np.interp(slow, t, level) + 0.02 * draw.normal(size=len(slow))
        force = table(["time_s", "force_N"], np.stack((slow, forces), axis=1))
        log = self.log_of("--logs", f"{self.write('g.csv', gauges)},{self.write('f.csv', force)}",
                          "--plateaus", "--force_time_offset_s", "0", "--force_bias_N", "0")
        value = {name: np.array(cells, dtype=float) for name, cells in log.items()}
        self.assertEqual(len(value["time_s"]), 20)
        np.testing.assert_allclose(value["time_s"], np.arange(20) * 2 + 1, atol=0.2)
        truth = np.interp(value["time_s"], t, level)
        z = (value["gauge_1_V"] - truth) / (3e-4 / np.sqrt(value["gauge_readings"]))
        self.assertLess(np.sqrt(np.mean(z**2)), 1.6)
        z = (value["force_N"] - 20 * truth) / (0.02 / np.sqrt(value["force_readings"]))
        self.assertLess(np.sqrt(np.mean(z**2)), 1.6)
        np.testing.assert_allclose(value["gauge_1_scatter_V"], 3e-4, rtol=0.2)
        self.assertTrue((value["gauge_readings"] > 200).all())

    def test_axes_that_no_place_holds_two_readings_of(self):
        """The axes of the sensor do not get into the log, whatever is known of their noise."""
        draw = np.random.default_rng(3)
        t = 0.01 * np.arange(2000)
        gauge = 0.1 * (t // 0.8 % 3) + 1e-4 * draw.normal(size=len(t))
        gauges = self.write("g.csv", table(["time_s", "gauge_1_V"], np.stack((t, gauge), axis=1)))
        t = np.arange(20.0)
        axes = self.write("f.csv", table(["time_s", "force_sensor_x_N", "force_sensor_y_N"],
                                         np.stack((t, 3 * (t // 0.8 % 3), 4 * (t // 0.8 % 3)), axis=1)))
        log = self.log_of("--logs", f"{gauges},{axes}", "--plateaus", "--force_time_offset_s", "0", "--force_bias_N", "0")
        self.assertFalse([name for name in log if "sensor" in name])
        self.assertTrue({"force_N", "force_readings", "force_scatter_N"} <= set(log))
        self.assertIn("force_N is the size of noisy readings", self.result.err)
        # A place that the sensor did not read at has no readings of it.
        readings = np.array(log["force_readings"], dtype=float)
        np.testing.assert_array_equal(readings, np.where([cell == "" for cell in log["force_N"]], 0, 1))
        self.assertIn(0, readings)

    def test_cells_that_are_not_measured_do_not_count_as_readings(self):
        draw = np.random.default_rng(4)
        t = 0.01 * np.arange(3000)
        force = 0.1 * (t // 1.5 % 3)
        lines = [f"{a:.2f},{f / 10 + 1e-4 * draw.normal():.6f},{f + 0.01 * draw.normal() if i % 10 == 0 else ''}"
                 for i, (a, f) in enumerate(zip(t, force))]
        log = self.log_of("--logs", self.write("a.csv", "time_s,gauge_1_V,force_N\n" + "\n".join(lines) + "\n"),
                          "--plateaus", "--force_bias_N", "0")
        gauges, forces = (np.array(log[f"{kind}_readings"], dtype=float) for kind in ("gauge", "force"))
        self.assertLess(np.abs(gauges / forces - 10).max(), 3)

    def test_a_motion_without_rest_has_no_plateau(self):
        t = np.arange(0, 10, 0.01)
        path = self.write("a.csv", table(["time_s", "gauge_1_V"],
                                         np.stack((t, np.sin(3 * t)), axis=1)))
        self.assertIn("no place is held", self.refused("--logs", path, "--plateaus", code=3))

    def test_noise_is_told_from_motion(self):
        draw = np.random.default_rng(3)
        values = np.sin(np.arange(5000) / 300) + 1e-3 * draw.normal(size=5000)
        self.assertAlmostEqual(noise.reading_std(values) / 1e-3, 1, delta=0.1)
        self.assertLess(noise.reading_std(np.round(np.arange(5000) / 999.0)), 0.3)

    def test_correlated_readings_are_worth_less(self):
        draw = np.random.default_rng(4)
        white = [draw.normal(size=50) for _ in range(200)]
        self.assertAlmostEqual(noise.mean_std_factor(white), 1, delta=0.1)
        slow = [np.convolve(draw.normal(size=60), 0.5**np.arange(10), "valid")
                for _ in range(200)]
        self.assertAlmostEqual(noise.mean_std_factor(slow), np.sqrt(3), delta=0.2)

    def test_readings_that_go_together_are_counted_as_fewer(self):
        draw = np.random.default_rng(5)
        t = np.arange(0, 40, 0.005)
        level = 0.01 * (t // 2 % 3)
        one = 3e-4 * draw.normal(size=len(t) + 9)
        slow = np.convolve(one, 0.5**np.arange(10), "valid")
        counts = {}
        for name, values in (("white", level + one[9:]), ("slow", level + slow)):
            log = self.log_of("--logs", self.write(f"{name}.csv", table(
                ["time_s", "gauge_1_V"], np.stack((t, values), axis=1))), "--plateaus")
            counts[name] = np.median(np.array(log["gauge_readings"], dtype=float))
        self.assertAlmostEqual(counts["white"] / counts["slow"], 3, delta=0.6)

    def test_names_of_scatter(self):
        self.assertEqual(plateaus.scatter_name("gauge_1_V"), "gauge_1_scatter_V")


if __name__ == "__main__":
    unittest.main()
