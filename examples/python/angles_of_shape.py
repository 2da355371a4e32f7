#!/usr/bin/env python3
"""Makes a log of gauge angles from shapes of the back beam, as any simulator or camera gives them.

usage: angles_of_shape.py FINGER.yaml SHAPE.csv LOG.csv

SHAPE.csv has the columns row, arc_mm, x_mm, y_mm: points along the back beam from its base to the tip, in frame S. A
gauge reads how far the tangent turns between its ends, beside how far it turns in the finger at rest.
"""

import csv
import sys
from typing import Any

import numpy as np
import yaml


def turn_rad(arc_mm: Any, points_mm: Any, start_mm: float, end_mm: float) -> float:
    """The turn of the tangent between two places. Chords have the tangent's angle at their middle, to second order."""
    chords = np.diff(points_mm, axis=0)
    angles = np.unwrap(np.arctan2(chords[:, 1], chords[:, 0]))
    middles = (arc_mm[1:] + arc_mm[:-1]) / 2
    return float(np.interp(end_mm, middles, angles) - np.interp(start_mm, middles, angles))


def main() -> None:
    finger_path, shape_path, log_path = sys.argv[1:]
    with open(finger_path, encoding="utf-8") as file:
        gauges = yaml.safe_load(file)["gauges"]
    with open(shape_path, newline="", encoding="utf-8") as file:
        points = [line for line in csv.DictReader(file) if line.get("beam", "back") == "back"]
    shapes: dict[str, list[list[float]]] = {}
    for line in points:
        shapes.setdefault(line["row"], []).append([float(line[name]) for name in ("arc_mm", "x_mm", "y_mm")])
    with open(log_path, "w", newline="", encoding="utf-8") as file:
        log = csv.writer(file)
        log.writerow([f"gauge_{j}_rad" for j in range(1, len(gauges) + 1)])
        for shape in shapes.values():  # a straight beam turns nowhere at rest
            arc_mm, points_mm = np.array(shape)[:, 0], np.array(shape)[:, 1:]
            log.writerow([turn_rad(arc_mm, points_mm, g["start_mm"], g["start_mm"] + g["length_mm"]) for g in gauges])


if __name__ == "__main__":
    main()
