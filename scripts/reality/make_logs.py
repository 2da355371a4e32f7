#!/usr/bin/python3
"""Makes logs of fingers that CalculiX bends: make_logs.py OUT_DIR [JOBS]

For each finger of datasets/reality, without friction and with 0.3, writes
OUT_DIR/<finger>/<smooth|rough>/{train,holdout}.csv, the log of a lab, and beside
them {train,holdout}_truth.csv. Seeds are fixed.
"""

import csv
import math
import multiprocessing
import os
import pathlib
import random
import sys
import tempfile

sys.dont_write_bytecode = True

sys.path.append(str(pathlib.Path(__file__).resolve().parents[1] / "common"))
import guard  # noqa: E402

guard.protect("make_logs.py", __name__)

import ccx
import plant as plants
from touch import RADIUS_MM, touch

ROOT = pathlib.Path(__file__).resolve().parents[2]
BUNDLED = ROOT / "datasets" / "reality"
FRICTIONS = {"smooth": 0.0, "rough": 0.3}
FORCE_STD_N, OBJECT_STD_MM, PERIOD_S = 0.02, 0.05, 1.0
PEAK_N = (2.0, 7.0)
# Heights of the circle in mm, and about how many N a millimetre costs there.
HEIGHTS = {
    "strip": [(22, 8.0), (30, 3.6), (45, 1.6), (60, 1.04), (80, 0.85), (100, 1.07), (112, 1.7)],
    "printed": [(18, 18), (20, 15), (30, 7.4), (45, 5.0), (54, 4.9), (65, 5.5), (78, 9.0), (80, 10)],
}
# Shares of the depth, and the way along the finger in mm, at which the log has a
# row: a train touch goes in and half out, a hold-out touch slides when it is in.
COURSES = {"train": [(0.35, 0), (0.7, 0), (1.0, 0), (0.6, 0)], "holdout": [(0.5, 0), (1.0, 0), (1.0, 1.5)]}
TOUCHES = {"train": (30, 41), "holdout": (20, 42)}  # how many, seed
FREE_EVERY = 4  # touches


def stiffness(table, height):
    for (low, k_low), (high, k_high) in zip(table, table[1:]):
        if height <= high:
            return k_low + (k_high - k_low) * (height - low) / (high - low)
    raise ValueError(height)


def paths(finger, log):
    """[(depth, height)] of each touch; heights are spread evenly, in random order."""
    count, seed = TOUCHES[log]
    table, draw = HEIGHTS[finger], random.Random(seed)
    low, high = table[0][0], table[-1][0]
    heights = [low + (high - low) * (k + draw.random()) / count for k in range(count)]
    draw.shuffle(heights)
    found = []
    for k, height in enumerate(heights):
        depth = draw.uniform(*PEAK_N) / stiffness(table, height)
        way = 1 if k % 2 else -1
        found.append([(share * depth, height + way * slide) for share, slide in COURSES[log]])
    return found


def one_touch(job):
    finger, path, friction = job
    plant = plants.read(BUNDLED / finger / "plant.yaml")
    with tempfile.TemporaryDirectory() as folder:
        for increment in (0.2, 0.02):
            try:
                return touch(plant, path, friction, pathlib.Path(folder), increment=increment)
            except ccx.NotSolved as error:
                reason = error
    print(f"{finger}: a touch at {path[0][1]:.1f} mm is left out: {reason}", file=sys.stderr)
    return []


def rows(touches):
    """(time, Frame or None) with free rows before every few touches."""
    frames = []
    for k, found in enumerate(touches):
        frames += [None] * (k % FREE_EVERY == 0) + found
    return [(PERIOD_S * i, frame) for i, frame in enumerate(frames)]


def write(path, header, table):
    temporary = path.with_name(path.name + ".part")
    with open(temporary, "w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(header)
        writer.writerows(table)
    temporary.rename(path)


def write_log(folder, log, plant, table, seed):
    draw = random.Random(seed)
    count = len(plant.gauges)
    logged, truth = [], []
    for time, frame in table:
        angles = frame.gauges_rad if frame else [0.0] * count
        force = frame.force_N if frame else (0.0, 0.0)
        place = frame.object_mm if frame else (-RADIUS_MM - 5, 0.5 * plant.front_length_mm)
        volts = [gauge.offset_V + gauge.gain_V_per_rad * angle + draw.gauss(0, gauge.noise_V)
                 for gauge, angle in zip(plant.gauges, angles)]
        logged.append([f"{time:.1f}", *(f"{v:.6f}" for v in volts),
                       f"{math.hypot(*force) + draw.gauss(0, FORCE_STD_N):.4f}",
                       *(f"{x + draw.gauss(0, OBJECT_STD_MM):.4f}" for x in place)])
        cells = (frame.contact_mm, frame.normal_N, frame.friction, *frame.point_mm, frame.tangent_rad) if frame \
            else [""] * 6
        truth.append([f"{time:.1f}", *(f"{x:.5f}" if x != "" else "" for x in cells),
                      *(f"{x:.5f}" for x in (*force, *place)), *(f"{angle:.7f}" for angle in angles)])
    numbers = range(1, count + 1)
    write(folder / f"{log}.csv", ["time_s", *(f"gauge_{j}_V" for j in numbers), "force_N",
                                  "object_x_mm", "object_y_mm"], logged)
    write(folder / f"{log}_truth.csv",
          ["time_s", "contact_1_mm", "normal_1_N", "friction_1", "contact_1_x_mm", "contact_1_y_mm",
           "contact_1_angle_rad", "force_x_N", "force_y_N", "object_x_mm", "object_y_mm",
           *(f"gauge_{j}_rad" for j in numbers)], truth)


def main():
    given = guard.words(__doc__, 1, 2)
    out = pathlib.Path(given[0])
    try:
        print(ccx.version(), flush=True)
    except ccx.NotInstalled as error:
        sys.exit(print(f"make_logs.py: {error}", file=sys.stderr) or 2)
    with multiprocessing.Pool(int(given[1]) if len(given) > 1 else os.cpu_count()) as pool:
        for finger in HEIGHTS:
            plant = plants.read(BUNDLED / finger / "plant.yaml")
            for name, friction in FRICTIONS.items():
                folder = out / finger / name
                folder.mkdir(parents=True, exist_ok=True)
                for log, (_, seed) in TOUCHES.items():
                    jobs = [(finger, path, friction) for path in paths(finger, log)]
                    touches = pool.map(one_touch, jobs, chunksize=1)
                    write_log(folder, log, plant, rows(touches), seed + 100)
                    print(f"{folder / log}.csv: {sum(map(len, touches))} rows with contact", flush=True)


if __name__ == "__main__":
    main()
