#!/usr/bin/python3
"""Force over displacement and stiffness of each object: plot_compliance.py DIR.

Reads points.csv, laws.csv and stiffness.csv of finray_compliance, writes
compliance.svg and compliance.png."""

import csv
import itertools
import math
import pathlib
import sys

sys.path.append(str(pathlib.Path(__file__).resolve().parents[1] / "common"))
import guard  # noqa: E402

guard.protect("plot_compliance.py", __name__)

from perception_style import QUIET, plt, save

# The colours of Okabe and Ito, which colour-blind readers can tell apart.
COLOURS = ("#0072b2", "#d55e00", "#009e73", "#cc79a7", "#56b4e9", "#e69f00", "#8a7a00", "#555b66")
MARKERS = "os^Dv<>P"


def read(path):
    with open(path, newline="") as file:
        return list(csv.DictReader(file))


def number(cell):
    return float(cell) if cell else math.nan


def main(folder):
    folder = pathlib.Path(folder)
    points, laws = read(folder / "points.csv"), read(folder / "laws.csv")
    objects = read(folder / "stiffness.csv")
    figure, (left, right) = plt.subplots(1, 2, figsize=(10, 4.2), width_ratios=(1.5, 1))
    for k, item in enumerate(objects):
        colour, marker = COLOURS[k % len(COLOURS)], MARKERS[k % len(MARKERS)]
        mine = [p for p in points if p["object"] == item["object"]]
        left.errorbar([number(p["displacement_mm"]) for p in mine], [number(p["force_N"]) for p in mine],
                      xerr=[number(p["displacement_std_mm"]) for p in mine],
                      yerr=[number(p["force_std_N"]) for p in mine], fmt=marker, ms=2.5, lw=0.6,
                      color=colour, alpha=0.6, label=item["object"])
        of_object = [p for p in laws if p["object"] == item["object"]]
        for _, law in itertools.groupby(of_object, lambda p: p["trial"]):
            law = list(law)
            left.plot([number(p["displacement_mm"]) for p in law], [number(p["force_N"]) for p in law],
                      color=colour, lw=0.8)
        std = math.hypot(number(item["std_N_per_mm"]), number(item["calibration_std_N_per_mm"]))
        right.barh(k, number(item["stiffness_N_per_mm"]), color=colour, alpha=0.6, height=0.6)
        right.errorbar(number(item["stiffness_N_per_mm"]), k, xerr=1.96 * std, color=QUIET, capsize=3, lw=1)
    left.set(xlabel="displacement (mm)", ylabel="force (N)")
    left.legend()
    right.set(xlabel="stiffness (N/mm), with 1.96 std")
    right.set_yticks(range(len(objects)), [item["object"] for item in objects])
    right.invert_yaxis()
    right.grid(axis="y", visible=False)
    figure.tight_layout()
    save(figure, folder / "compliance")


if __name__ == "__main__":
    main(*guard.words(__doc__, 1, 1))
