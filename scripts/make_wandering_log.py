#!/usr/bin/python3
"""A log as labs have it, for timings: one contact that wanders and comes and goes.

make_wandering_log.py BUILD_DIR OUT.csv [ROWS] [FINGER.yaml] [--steady]

At 100 Hz the contact wanders over 35 to 105 mm, and the force swings between 0 and
8 N and rests at zero now and then. With --steady it never lets go: 55 to 95 mm, 2 to
5 N, so that every frame but the first is followed. Rows: 200 000. Noise, gains and
offsets are those of the finger (configs/fingers/paper_140mm.yaml). The equilibria are
finray's own: the log measures speed, not accuracy.
"""

import csv
import math
import pathlib
import random
import subprocess
import sys
import tempfile

sys.path.append(str(pathlib.Path(__file__).resolve().parents[1] / "scripts/common"))
import guard  # noqa: E402

guard.protect("make_wandering_log.py", __name__)

ROOT = pathlib.Path(__file__).resolve().parents[1]
RATE_HZ = 100
LOW_MM, HIGH_MM, MOST_N = 35, 105, 8


def contacts(rows, seed=24):
    """(time_s, contact_1_mm, normal_1_N) of each row."""
    draw = random.Random(seed)
    waves = [(draw.uniform(0.03, 0.3), draw.uniform(0, 2 * math.pi)) for _ in range(4)]
    touch, peak, phase = 4.0, MOST_N, 0.0
    for i in range(rows):
        time = i / RATE_HZ
        wander = sum(math.sin(2 * math.pi * f * time + p) for f, p in waves) / 2
        arc = (LOW_MM + HIGH_MM) / 2 + (HIGH_MM - LOW_MM) / 2 * math.tanh(wander)
        phase += 1 / (RATE_HZ * touch)
        if phase >= 1:  # the next touch, of another length and force
            phase, touch, peak = 0.0, draw.uniform(2, 8), draw.uniform(0.2, MOST_N)
        # A sixth of each touch is free.
        swing = max(0.0, math.sin(math.pi * 1.2 * phase)) if phase < 1 / 1.2 else 0.0
        yield time, arc, peak * swing * swing


def steady_contacts(rows):
    """The same for a contact that never lets go."""
    for i in range(rows):
        time = i / RATE_HZ
        yield (time, 75 + 20 * math.sin(2 * math.pi * 0.11 * time),
               3.5 + 1.5 * math.sin(2 * math.pi * 0.23 * time))


def main():
    given = guard.words(__doc__, 2, 4, ["--steady"])
    arguments = [a for a in given if a != "--steady"]
    touches = steady_contacts if "--steady" in given else contacts
    build, out = pathlib.Path(arguments[0]), pathlib.Path(arguments[1])
    rows = int(arguments[2]) if len(arguments) > 2 else 200_000
    finger = arguments[3] if len(arguments) > 3 else ROOT / "configs/fingers/paper_140mm.yaml"
    with tempfile.TemporaryDirectory() as folder:
        frames = pathlib.Path(folder) / "frames.csv"
        with open(frames, "w", newline="") as file:
            writer = csv.writer(file, lineterminator="\n")
            writer.writerow(["time_s", "contact_1_mm", "normal_1_N"])
            for time, arc, force in touches(rows):
                writer.writerow([f"{time:.2f}", f"{arc:.6f}", f"{force:.6f}"])
        subprocess.run([build / "finray_simulate", "--finger", finger, "--frames", frames,
                        "--out", pathlib.Path(folder) / "truth.csv", "--log_out", out],
                       check=True)


if __name__ == "__main__":
    main()
