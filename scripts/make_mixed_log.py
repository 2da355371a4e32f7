#!/usr/bin/python3
"""Makes the bundled log of mixed touches, with its truth.

make_mixed_log.py [DATASET_DIR]     (default datasets/mixed)

A finger of the dataset's geometry is touched at one place or at two: forces
ramp from zero to a peak and back, light touches and gaps are in between. The
equilibria come from continuum_finger.py, which shares nothing with libfinray.
Writes log.csv (gauges with noise, force sensor) and truth.csv (contacts).
"""

import csv
import pathlib
import random
import sys

sys.path.append(str(pathlib.Path(__file__).resolve().parents[1] / "scripts/common"))
import guard  # noqa: E402

guard.protect("make_mixed_log.py", __name__)

import numpy as np
import yaml

from continuum_finger import Contact, Geometry, REAL, System

ROOT = pathlib.Path(__file__).resolve().parent.parent
FRONT, BACK = 11150, 13900
GAINS, OFFSETS = (1.90, 2.15, 1.62, 2.40), (0.041, -0.027, 0.013, -0.055)
NOISE_V, FORCE_STD_N = 3e-4, 0.02
POINTS, PERIOD_S = 14, 0.05
# Contacts of each touch: (l_c in mm, peak force in N); frames of the ramp.
TOUCHES = [
    ([(72, 4.0)], 24), ([(45, 6.0)], 24), ([(95, 3.0)], 24), ([(60, 0.15)], 12),
    ([(40, 3.0), (100, 3.0)], 24), ([(25, 7.0)], 24), ([(108, 2.5)], 24),
    ([(83, 0.3)], 12), ([(118, 3.0)], 24), ([(52, 5.0)], 24), ([(10, 6.0)], 24),
    ([(66, 0.6)], 12), ([(50, 4.0), (90, 4.0)], 24), ([(78, 7.0)], 24),
    ([(128, 4.0)], 24), ([(33, 0.4)], 12), ([(88, 5.0)], 24), ([(100, 0.2)], 12),
]


def angles(geometry, contacts, shares):
    """The gauge angles at each share of the load, in rad."""
    unit = float(geometry.force_N)
    length = float(geometry.unit_mm)
    system = System(geometry, [Contact(arc / length, force / unit, 0)
                               for arc, force in contacts], POINTS)
    out, state, at = [], system.solve(system.zero(), REAL(0))[0], 0.0
    for share in shares:
        steps = max(1, int(np.ceil(abs(share - at) / 0.1)))
        for k in range(1, steps + 1):
            to = at + (share - at) * k / steps
            found = system.solve(state, REAL(to))
            if found is None:
                raise SystemExit(f"no equilibrium: {contacts} at {to}")
            state = found[0]
        at = share
        out.append([float(system.angle_at(state, side, end)
                          - system.angle_at(state, side, start))
                    for side, start, end in geometry.gauges])
    return out


def main():
    folder = pathlib.Path(*guard.words(__doc__, 0, 1) or [ROOT / "datasets/mixed"])
    finger = yaml.safe_load((folder / "finger.yaml").read_text())
    geometry = Geometry(finger, FRONT, BACK)
    draw = random.Random(11)
    rows = []  # (angles, contacts)
    free = [0.0] * len(GAINS)
    rows += [(free, [])] * 20
    for contacts, frames in TOUCHES:
        shares = [np.sin(np.pi * (i + 1) / (frames + 1)) ** 2 for i in range(frames)]
        for share, bent in zip(shares, angles(geometry, contacts, shares)):
            rows.append((bent, [(arc, force * share) for arc, force in contacts]))
        rows += [(free, [])] * 6
        print(contacts, flush=True)
    with open(folder / "log.csv", "w", newline="") as log, \
            open(folder / "truth.csv", "w", newline="") as truth:
        log, truth = (csv.writer(f, lineterminator="\n") for f in (log, truth))
        log.writerow(["time_s"] + [f"gauge_{j + 1}_V" for j in range(4)] + ["force_N"])
        truth.writerow(["time_s", "contact_1_mm", "normal_1_N", "contact_2_mm", "normal_2_N"])
        for i, (bent, contacts) in enumerate(rows):
            volts = [gain * angle + offset + draw.gauss(0, NOISE_V)
                     for gain, angle, offset in zip(GAINS, bent, OFFSETS)]
            # Normals turn little, so the sensor's force is about the sum.
            force = sum(f for _, f in contacts) + draw.gauss(0, FORCE_STD_N)
            log.writerow([f"{i * PERIOD_S:.2f}"] + [f"{v:.6f}" for v in volts]
                         + [f"{force:.4f}"])
            cells = [f"{x:.6g}" for contact in contacts for x in contact]
            truth.writerow([f"{i * PERIOD_S:.2f}"] + cells + [""] * (4 - len(cells)))


if __name__ == "__main__":
    main()
