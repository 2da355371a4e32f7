#!/usr/bin/python3
"""Makes the bundled simulated logs: a circle pressed into a hidden finger.

make_dataset.py BUILD_DIR [DATASET_DIR]

Writes train.csv (200 frames with contact, 10 without) and holdout.csv (100 and
10) with the noise of a lab, from hidden_finger.yaml of the dataset folder.
"""

import csv
import pathlib
import random
import subprocess
import sys
import tempfile

sys.path.append(str(pathlib.Path(__file__).resolve().parents[1] / "scripts/common"))
import guard  # noqa: E402

guard.protect("make_dataset.py", __name__)

RADIUS_MM = 15
# Roughly the force in N that 1 mm of indentation costs, by height in mm.
STIFFNESS = [(20, 9.7), (40, 2.0), (60, 1.0), (80, 0.83), (100, 1.04), (115, 1.9)]


def stiffness(height):
    for (low, k_low), (high, k_high) in zip(STIFFNESS, STIFFNESS[1:]):
        if height <= high:
            return k_low + (k_high - k_low) * (height - low) / (high - low)
    return STIFFNESS[-1][1]


def places(contacts, free, seed):
    """(time, x, y) of the circle's centre, with free frames in between."""
    draw = random.Random(seed)
    rows = []
    for i in range(contacts):
        height = 22 + 90 * draw.random()
        force = 0.5 + 6.5 * draw.random()
        rows.append((-RADIUS_MM + force / stiffness(height), height))
    step = len(rows) // free
    for i in range(free):
        rows.insert(i * (step + 1), (-RADIUS_MM - 5.0, 70.0))
    return [(0.1 * i, x, y) for i, (x, y) in enumerate(rows)]


def main():
    root = pathlib.Path(__file__).resolve().parent.parent
    build, *dataset = map(pathlib.Path, guard.words(__doc__, 1, 2))
    dataset, = dataset or [root / "datasets" / "simulated_r15"]
    for name, contacts, free, seed in (("train", 200, 10, 7), ("holdout", 100, 10, 8)):
        with tempfile.TemporaryDirectory() as folder:
            folder = pathlib.Path(folder)
            with open(folder / "frames.csv", "w", newline="") as file:
                writer = csv.writer(file, lineterminator="\n")
                writer.writerow(["time_s", "object_x_mm", "object_y_mm"])
                for time, x, y in places(contacts, free, seed):
                    writer.writerow([f"{time:.1f}", f"{x:.6f}", f"{y:.6f}"])
            (folder / "scene.yaml").write_text(
                f"object: {{shape: circle, radius_mm: {RADIUS_MM}}}\n")
            subprocess.run(
                [build / "finray_simulate", "--finger", dataset / "hidden_finger.yaml",
                 "--scene", folder / "scene.yaml", "--frames", folder / "frames.csv",
                 "--out", folder / "truth.csv", "--log_out", folder / "log.csv",
                 "--force_std_N", "0.02", "--object_std_mm", "0.05",
                 "--seed", str(seed), "--strict"],
                check=True)
            with open(folder / "log.csv") as file, open(
                    dataset / f"{name}.csv", "w", newline="") as out:
                rows = list(csv.reader(file))
                writer = csv.writer(out, lineterminator="\n")
                writer.writerow(rows[0])
                # As many digits as instruments give.
                for row in rows[1:]:
                    writer.writerow([f"{float(cell):.6f}" for cell in row])


if __name__ == "__main__":
    main()
