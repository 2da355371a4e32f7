#!/usr/bin/python3
"""Makes the bundled raw recording, as two instruments of a lab would write it.

make_raw_recording.py [DATASET_DIR]     (default datasets/raw_recording)

A circle on a stage presses a finger at random heights and depths. The equilibria come
from continuum_finger.py, which shares nothing with libfinray. The logger writes counts
of its converter at 200 Hz with ISO times. The rig writes grams and metres at 10 Hz with
a clock that is 40 ms late. Both write semicolons and decimal commas.
"""

import datetime
import gzip
import pathlib
import random
import sys

sys.path.append(str(pathlib.Path(__file__).resolve().parents[1] / "scripts/common"))
import guard  # noqa: E402

guard.protect("make_raw_recording.py", __name__)

import numpy as np
import yaml
from scipy.interpolate import CubicSpline

from continuum_finger import Contact, Geometry, REAL, System

ROOT = pathlib.Path(__file__).resolve().parent.parent
RADIUS_MM, FREE_GAP_MM, PRESSES, NODES, POINTS = 15, 2.0, 48, 14, 14
GAUGE_HZ, FORCE_HZ = 200, 10
MOVE_S, HOLD_S, SHIFT_S, REST_S = 0.4, 0.7, 0.2, 0.8
RIG_LATE_S = 0.040
GAUGE_NOISE_V, FORCE_NOISE_N, STAGE_STD_MM = 3e-4, 0.02, 0.03
COUNT_V, MIDDLE = 10 / 65536, 32768        # 16 bits over -5 to 5 V
GRAM_N, TARE_G = 9.80665e-3, 6.3
STAGE_ORIGIN_MM = (150.15, 4.8)            # the drawing says 150 and 5
START = datetime.datetime(2026, 3, 11, 14, 5, 7)
# Roughly the force in N that 1 mm of indentation costs, by height in mm.
HEIGHTS, STIFFNESS = (20, 40, 60, 80, 100, 115), (9.7, 2.0, 1.0, 0.83, 1.04, 1.9)


def press(geometry, height, depth):
    """Force in N and gauge angles in rad as splines of the depth in mm."""
    unit, force = float(geometry.unit_mm), float(geometry.force_N)
    radius = RADIUS_MM / unit
    circle = (REAL(radius), (REAL(-radius), REAL(height / unit)),
              (REAL(-radius + depth / unit), REAL(height / unit)))
    system = System(geometry, [Contact(height / unit, 0, 0)], POINTS, circle)
    state, rows = system.zero(), []
    shares = np.linspace(0, 1, NODES)
    for share in shares:
        found = system.solve(state, REAL(share))
        if found is None:
            raise SystemExit(f"no equilibrium: height {height}, share {share}")
        state = found[0]
        rows.append([float(state[-1]) * force] +
                    [float(system.angle_at(state, side, end)
                           - system.angle_at(state, side, start))
                     for side, start, end in geometry.gauges])
    return CubicSpline(shares * depth, rows)


def places(draw):
    """(height, depth) of every press in mm."""
    for _ in range(PRESSES):
        height = draw.uniform(24, 110)
        yield height, draw.uniform(1.0, 6.5) / np.interp(height, HEIGHTS, STIFFNESS)


def glide(share):
    return (1 - np.cos(np.pi * share)) / 2


class Motion:
    """Where the circle truly is: knots of time, x and y, and the press in force."""

    def __init__(self, presses):
        self.knots, self.presses = [(0.0, -RADIUS_MM - FREE_GAP_MM, presses[0][0])], []
        self.wait(REST_S)
        for i, (height, depth) in enumerate(presses):
            self.to(SHIFT_S, -RADIUS_MM - FREE_GAP_MM, height)
            begin = self.knots[-1][0]
            self.to(MOVE_S, -RADIUS_MM + depth, height)
            self.wait(HOLD_S)
            self.to(MOVE_S, -RADIUS_MM - FREE_GAP_MM, height)
            self.presses.append((begin, self.knots[-1][0]))
            if i % 6 == 5:
                self.wait(REST_S)
        self.end = self.knots[-1][0]

    def to(self, seconds, x, y):
        self.knots.append((self.knots[-1][0] + seconds, x, y))

    def wait(self, seconds):
        self.to(seconds, *self.knots[-1][1:])

    def at(self, times):
        times = np.asarray(times)
        starts = np.array([k[0] for k in self.knots])
        k = np.clip(np.searchsorted(starts, times, side="right") - 1, 0, len(starts) - 2)
        values = np.array([k[1:] for k in self.knots])
        share = glide((times - starts[k]) / (starts[k + 1] - starts[k]))[:, None]
        return values[k] + share * (values[k + 1] - values[k])


def truth(motion, splines, times):
    """Force and gauge angles at each time."""
    x = motion.at(times)[:, 0]
    out = np.zeros((len(times), 5))
    for (begin, end), spline in zip(motion.presses, splines):
        inside = (times >= begin) & (times <= end) & (x > -RADIUS_MM)
        out[inside] = spline(x[inside] + RADIUS_MM)
    return out


def comma(value, digits):
    return f"{value:.{digits}f}".replace(".", ",")


def write_gauges(path, hidden, motion, splines, noise):
    times = np.arange(int(motion.end * GAUGE_HZ)) / GAUGE_HZ
    angles = truth(motion, splines, times)[:, 1:]
    gains = [g["gain_V_per_rad"] for g in hidden["gauges"]]
    offsets = [g["offset_V"] for g in hidden["gauges"]]
    volts = angles * gains + offsets + GAUGE_NOISE_V * noise.standard_normal(angles.shape)
    counts = np.rint(volts / COUNT_V).astype(int) + MIDDLE
    lines = ["Logger 7, export", "Range;-5 V;5 V;16 bit", "",
             "Time;ch0;ch1;ch2;ch3", ";counts;counts;counts;counts"]
    for t, row in zip(times, counts):
        stamp = START + datetime.timedelta(milliseconds=round(1000 * t))
        text = stamp.isoformat(timespec="milliseconds").replace(".", ",")
        lines.append(f"{text};" + ";".join(map(str, row)))
    with open(path, "wb") as raw, gzip.GzipFile("", "wb", 9, raw, mtime=0) as file:
        file.write(("\n".join(lines) + "\n").encode())


def write_rig(path, motion, splines, noise):
    times = 0.013 + np.arange(int((motion.end - 0.013) * FORCE_HZ)) / FORCE_HZ
    forces = truth(motion, splines, times)[:, 0]
    forces = forces + FORCE_NOISE_N * noise.standard_normal(len(times))
    places_mm = motion.at(times)
    # A stage returns to a place within its repeatability; there it stands still.
    errors = STAGE_STD_MM * noise.standard_normal((len(motion.presses) + 1, 2))
    press_at = np.searchsorted([begin for begin, _ in motion.presses], times, side="right")
    read_mm = places_mm + errors[press_at]
    epoch = START.replace(tzinfo=datetime.timezone.utc).timestamp()
    lines = ["t;Fz;stage_x;stage_y", "s;g;m;m"]
    for t, force, (x, y) in zip(times, forces, read_mm):
        lines.append(";".join((comma(epoch + t + RIG_LATE_S, 3), comma(force / GRAM_N + TARE_G, 1),
                               comma((STAGE_ORIGIN_MM[0] - x) / 1000, 6),
                               comma((y - STAGE_ORIGIN_MM[1]) / 1000, 6))))
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")


def main():
    folder = pathlib.Path(*guard.words(__doc__, 0, 1) or [ROOT / "datasets/raw_recording"])
    hidden = yaml.safe_load((ROOT / "datasets/raw_recording/hidden_finger.yaml").read_text())
    front, back = (hidden["beams"][b]["bending_stiffness_N_mm2"] for b in ("front", "back"))
    geometry = Geometry(hidden, front, back)
    presses = list(places(random.Random(22)))
    splines = [press(geometry, *p) for p in presses]
    motion, noise = Motion(presses), np.random.default_rng(22)
    write_gauges(folder / "gauges.csv.gz", hidden, motion, splines, noise)
    write_rig(folder / "rig.csv", motion, splines, noise)


if __name__ == "__main__":
    main()
