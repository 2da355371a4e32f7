#!/usr/bin/python3
"""The time offset between force and gauges: its error, its std, and when it is refused."""

import re
import unittest

import fixture  # noqa: F401  finds scripts/import
import numpy as np

import time_offset
from errors import NoSolution


class Series:
    """As much of a Recording as an estimate reads."""

    def __init__(self, name, time, channels):
        self.name, self.time, self.channels = name, time, channels
        self.period_s = float(np.median(np.diff(time)))


def pressed(t, draw, ramp_s=0.4):
    """Place in mm and force in N of presses at random places."""
    knots, force, place = [0.0], [0.0], [70.0]
    while knots[-1] < t[-1]:
        where = draw.uniform(25, 110)
        peak = draw.uniform(1, 6)
        for seconds, value in ((0.3, 0), (ramp_s, peak), (0.6, peak), (ramp_s, 0)):
            knots.append(knots[-1] + seconds)
            force.append(value)
            place.append(where)
    k = np.clip(np.searchsorted(knots, t, side="right") - 1, 0, len(knots) - 2)
    knots, force, place = map(np.array, (knots, force, place))
    share = (1 - np.cos(np.pi * (t - knots[k]) / (knots[k + 1] - knots[k]))) / 2
    return place[k + 1], force[k] + share * (force[k + 1] - force[k])


def gauges_of(place, force):
    """Volts of four gauges: linear in the force but for a share, each of another shape."""
    return {f"gauge_{j}_V": 0.02 * force * np.cos(place / 30 + j) + 2e-4 * force**2 * j
            for j in range(1, 5)}


def recordings(draw, offset_s, gauge_hz=200, force_hz=10, seconds=90, ramp_s=0.4):
    """(force, gauges): the stamps of the force are late by -offset_s."""
    seed = int(draw.integers(1 << 30))
    t = np.arange(0, seconds, 1 / gauge_hz)
    gauges = gauges_of(*pressed(t, np.random.default_rng(seed), ramp_s))
    gauges = {n: v + 3e-4 * draw.normal(size=len(t)) for n, v in gauges.items()}
    u = draw.uniform(0, 1 / force_hz) + np.arange(0, seconds - 1, 1 / force_hz)
    force = pressed(u, np.random.default_rng(seed), ramp_s)[1] + 0.02 * draw.normal(size=len(u))
    return Series("force", u - offset_s, {"force_N": force}), Series("gauges", t, gauges)


class TimeOffsetTest(unittest.TestCase):
    def errors(self, draws, **how):
        draw = np.random.default_rng(11)
        for _ in range(draws):
            truth = draw.uniform(-0.3, 0.3)
            found = time_offset.estimate(*recordings(draw, truth, **how), longest_s=0.5)
            yield found.offset_s - truth, found.std_s

    def test_errors_follow_the_std(self):
        errors = np.array(list(self.errors(8)))
        z = errors[:, 0] / errors[:, 1]
        self.assertLess(np.abs(errors[:, 0]).max(), 0.002)
        self.assertLess(errors[:, 1].max(), 0.002)
        self.assertLess(np.sqrt(np.mean(z**2)), 1.5)
        self.assertGreater(np.sqrt(np.mean(z**2)), 0.2)

    def test_the_gauges_may_be_the_slower_ones(self):
        for error, std in self.errors(3, gauge_hz=20, force_hz=500):
            self.assertLess(abs(error), max(4 * std, 1e-3))

    def test_both_may_be_fast(self):
        errors = np.array(list(self.errors(4, gauge_hz=1000, force_hz=1000, seconds=40)))
        self.assertLess(np.abs(errors[:, 0]).max(), 1e-3)
        self.assertLess(np.abs(errors[:, 0] / errors[:, 1]).max(), 3)
        self.assertLess(errors[:, 1].max(), 1e-3)

    def test_gauges_that_are_dead_do_no_harm(self):
        force, gauges = recordings(np.random.default_rng(8), 0.02)
        gauges.channels["gauge_2_V"] = np.full(len(gauges.time), 0.1)
        gauges.channels["gauge_5_V"] = np.full(len(gauges.time), np.nan)
        found = time_offset.estimate(force, gauges, 0.5)
        self.assertLess(abs(found.offset_s - 0.02), 0.002)
        gauges.channels = {"gauge_1_V": np.full(len(gauges.time), 0.1)}
        with self.assertRaises(NoSolution):
            time_offset.estimate(force, gauges, 0.5)
        gauges.channels = {"gauge_1_V": np.full(len(gauges.time), np.nan)}
        with self.assertRaises(NoSolution):
            time_offset.estimate(force, gauges, 0.5)

    def test_clocks_that_are_far_apart_are_said_and_found_if_asked_for(self):
        how = {"gauge_hz": 100, "seconds": 60}
        for offset_s, longest_s in ((7.3, 1.0), (-20, 2.0)):
            with self.subTest(offset_s):
                given = recordings(np.random.default_rng(735), offset_s, **how)
                with self.assertRaisesRegex(time_offset.ClocksApart, "clocks are .* s apart") as said:
                    time_offset.estimate(*given, longest_s)
                flag = float(re.search(r"--longest_offset_s (\d+) ", str(said.exception))[1])
                found = time_offset.estimate(*given, flag)
                self.assertLess(abs(found.offset_s - offset_s), 3 * found.std_s + 1e-3)

    def test_a_match_at_the_end_of_the_range_is_none(self):
        with self.assertRaisesRegex(time_offset.ClocksApart, r"clocks are 0\.(3|29)\S* s apart"):
            time_offset.estimate(*recordings(np.random.default_rng(8), 0.3), longest_s=0.25)

    def test_times_are_taken_as_they_are_only_where_gauges_do_not_contradict(self):
        draw = np.random.default_rng(8)
        force, gauges = recordings(draw, 0.0)
        other = recordings(np.random.default_rng(9), 0.0)[0]  # of another recording
        with self.assertRaisesRegex(time_offset.ClocksApart, "larger --longest_offset_s; if they agree,"):
            time_offset.estimate(other, gauges, 1.0)
        still = Series("force", force.time, {"force_N": draw.normal(size=len(force.time))})
        with self.assertRaises(NoSolution) as said:
            time_offset.estimate(still, gauges, 1.0)
        self.assertNotIsInstance(said.exception, time_offset.ClocksApart)

    def test_jumps_of_the_force_have_a_wide_std_or_none(self):
        draw = np.random.default_rng(7)
        for _ in range(3):
            try:
                found = time_offset.estimate(*recordings(draw, 0.03, ramp_s=1e-3), longest_s=0.5)
            except NoSolution:
                continue
            self.assertLess(abs(found.offset_s - 0.03), 4 * found.std_s)

    def test_what_is_not_determined_is_refused(self):
        draw = np.random.default_rng(3)
        force, gauges = recordings(draw, 0.0)
        still = Series("force", force.time, {"force_N": draw.normal(size=len(force.time))})
        with self.assertRaisesRegex(NoSolution, "explain only|larger --longest|alike|std"):
            time_offset.estimate(still, gauges, 1.0)
        short = Series("force", force.time[:20], {"force_N": force.channels["force_N"][:20]})
        with self.assertRaisesRegex(NoSolution, "rows in common"):
            time_offset.estimate(short, gauges, 1.0)
        late = Series("force", force.time + 5, force.channels)
        with self.assertRaises(NoSolution):
            time_offset.estimate(late, gauges, 1.0)
        t = gauges.time
        wave = {"gauge_1_V": np.sin(2 * np.pi * t) + 1e-3 * draw.normal(size=len(t))}
        again = Series("force", force.time, {"force_N": np.sin(2 * np.pi * force.time)})
        with self.assertRaisesRegex(NoSolution, "motion that repeats"):
            time_offset.estimate(again, Series("gauges", t, wave), 2.0)


if __name__ == "__main__":
    unittest.main()
