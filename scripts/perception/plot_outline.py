#!/usr/bin/python3
"""Overlay of a reconstructed outline: plot_outline.py OUT_DIR [TRUTH.csv].

Reads outline.csv, touches.csv and beams.csv of finray_reconstruct, writes
outline.svg and outline.png."""

import csv
import itertools
import math
import pathlib
import sys

sys.path.append(str(pathlib.Path(__file__).resolve().parents[1] / "common"))
import guard  # noqa: E402

guard.protect("plot_outline.py", __name__)

from perception_style import BLUE, ORANGE, PALE, QUIET, plt, save


def read(path):
    with open(path, newline="") as file:
        return [row for row in csv.DictReader(line for line in file if not line.startswith("#"))]


def column(rows, name):
    return [float(row[name]) if row[name] else math.nan for row in rows]


def closed(values):
    return values + values[:1]


def stretches(rows, supported):
    """Runs of neighbouring points, each with the first point of the next run."""
    for flag, run in itertools.groupby(range(len(rows)), lambda i: rows[i]["supported"] == "1"):
        if flag == supported:
            run = list(run)
            yield [rows[i % len(rows)] for i in run + [run[-1] + 1]]


def draw_touches(axes, touches):
    """Contact points, and how far along the beam each may lie."""
    x, y, std, normal = (column(touches, name) for name in
                         ("point_x_mm", "point_y_mm", "along_std_mm", "normal_deg"))
    axes.scatter(x, y, s=9, color=QUIET, zorder=6, lw=0, label="contact points")
    for k, (px, py, s, a) in enumerate(zip(x, y, std, normal)):
        dx, dy = -1.96 * s * math.sin(math.radians(a)), 1.96 * s * math.cos(math.radians(a))
        axes.plot([px - dx, px + dx], [py - dy, py + dy], color=QUIET, lw=0.8, zorder=5,
                  label="1.96 std along the beam" if k == 0 else None)


def outline(axes, folder, truth):
    rows = read(folder / "outline.csv")
    touches = read(folder / "touches.csv")
    for _, piece in itertools.groupby(read(folder / "beams.csv"), lambda row: row["row"]):
        piece = list(piece)
        axes.plot(column(piece, "x_mm"), column(piece, "y_mm"), color=PALE, lw=1.2, zorder=1)
    x, y, radius, std, angle = (column(rows, name)
                                for name in ("x_mm", "y_mm", "radius_mm", "std_mm", "angle_deg"))
    for sign in (-1.96, 1.96):
        edge = [(px + sign * s * math.cos(math.radians(a)), py + sign * s * math.sin(math.radians(a)))
                for px, py, s, a in zip(x, y, std, angle)]
        axes.plot(*zip(*closed(edge)), color=BLUE, lw=0.5, alpha=0.6, zorder=3,
                  label="1.96 std" if sign < 0 else None)
    if truth:
        true = read(truth)
        axes.plot(closed(column(true, "x_mm")), closed(column(true, "y_mm")), color=ORANGE, lw=2.4,
                  alpha=0.6, zorder=2, label="true outline")
    for supported, style, label in ((True, "-", "outline"), (False, (0, (2, 2)), "no touch lies here")):
        for run in stretches(rows, supported):
            axes.plot(column(run, "x_mm"), column(run, "y_mm"), color=BLUE, lw=1.5, ls=style, zorder=4,
                      label=label)
            label = None
    draw_touches(axes, touches)
    axes.set(aspect="equal", xlabel="x of the object (mm)", ylabel="y of the object (mm)")
    axes.grid(False)


def error(axes, rows):
    angle = column(rows, "angle_deg")
    percent = column(rows, "radial_error_percent")
    band = [196 * s / r for s, r in zip(column(rows, "std_mm"), column(rows, "radius_mm"))]
    axes.fill_between(angle, [-b for b in band], band, color=BLUE, alpha=0.15, lw=0, label="1.96 std")
    axes.plot(angle, percent, color=BLUE, lw=1.2, label="radial error")
    axes.set(xlabel="polar angle (deg)", ylabel="radial error (%)", xlim=(0, 360))
    axes.set_xticks(range(0, 361, 90))


def main(folder, truth=None):
    folder = pathlib.Path(folder)
    rows = read(folder / "outline.csv")
    figure, axes = plt.subplots(1, 2 if truth else 1, figsize=(9.4 if truth else 5, 4.4), squeeze=False)
    outline(axes[0, 0], folder, truth)
    if truth:
        error(axes[0, 1], rows)
        axes[0, 1].legend(loc="lower left", bbox_to_anchor=(0, 1), ncols=2)
    axes[0, 0].legend(loc="lower left", bbox_to_anchor=(-0.05, 1), ncols=3, fontsize=8)
    figure.tight_layout()
    save(figure, folder / "outline")


if __name__ == "__main__":
    main(*guard.words(__doc__, 1, 2))
