#!/usr/bin/python3
"""Plots the results of two studies: plot_bounds.py OUT_DIR.

Draws error_by_height.png from by_height.csv of paper_protocol_study, and
two_contacts.png from two_contacts.csv of two_contacts_study.
"""

import csv
import pathlib
import sys

sys.path.append(str(pathlib.Path(__file__).resolve().parents[1] / "common"))
import guard  # noqa: E402

guard.protect("plot_bounds.py", __name__)

import numpy as np
from matplotlib.colors import LogNorm

from plot_style import BLUE, GREEN, INK, ORANGE, PALE, QUIET, plt, save

RIBS_MM = (17, 39, 61, 83, 105)
COLOURS = {"noise only": BLUE, "calibration only": GREEN, "noise and calibration": ORANGE}

# Two of the lines nearly coincide, so the first one is wider.
UNDER, OVER = {"linewidth": 5, "alpha": 0.4}, {"linewidth": 1.6, "marker": "o", "markersize": 3.2}


def read(path):
    with open(path, newline="") as file:
        return list(csv.DictReader(file))


def by_height(rows, path):
    figure, axes = plt.subplots(1, 2, figsize=(9, 3.8))
    for axis, column, title, paper in ((axes[0], "arc_rms_mm", "Contact location, rms error in mm", 0.58),
                                       (axes[1], "force_rms_N", "Contact force, rms error in N", 0.15)):
        for setting, colour in COLOURS.items():
            mine = [row for row in rows if row["setting"] == setting]
            axis.plot([float(row["height_mm"]) for row in mine], [float(row[column]) for row in mine], color=colour,
                      label=setting, **(UNDER if setting == "noise only" else OVER))
        axis.axhline(paper, color=QUIET, linewidth=1, linestyle=(0, (5, 3)))
        axis.text(64, paper * 1.12, f"the paper's mean error, {paper}", color=QUIET, ha="center", fontsize=9)
        axis.set_yscale("log")
        axis.yaxis.set_major_formatter(plt.FuncFormatter(lambda value, _: f"{value:g}"))
        axis.set_title(title)
        axis.set_xlabel("height of the circle, mm")
        axis.set_xlim(15, 115)
        axis.set_xticks(range(20, 111, 15))
    axes[0].set_ylim(0.015, 6)
    axes[1].set_ylim(0.001, 0.8)
    handles, labels = axes[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="lower center", ncol=3, bbox_to_anchor=(0.5, -0.07))
    figure.tight_layout()
    save(figure, path)


def two_contacts(rows, path):
    gauges = sorted({row["gauges"] for row in rows})
    forces = sorted({row["force_N"] for row in rows}, key=float)
    figure, axes = plt.subplots(len(gauges), len(forces), figsize=(9, 6.4), sharex=True, sharey=True)
    low, high = 0.05, 20
    for line, count in zip(axes, gauges):
        for axis, force in zip(line, forces):
            mine = [row for row in rows if (row["gauges"], row["force_N"]) == (count, force)]
            places = np.array(sorted({float(row["contact_1_mm"]) for row in mine} |
                                     {float(row["contact_2_mm"]) for row in mine}))
            at = {place: index for index, place in enumerate(places)}
            larger = np.full((len(places), len(places)), np.nan)
            usable = np.full(larger.shape, np.nan)
            for row in mine:
                cell = at[float(row["contact_2_mm"])], at[float(row["contact_1_mm"])]
                larger[cell] = max(float(row["contact_1_std_mm"]), float(row["contact_2_std_mm"]))
                usable[cell] = float(row["usable"])
            image = axis.pcolormesh(places, places, np.clip(larger, low, high), cmap="viridis_r",
                                    norm=LogNorm(low, high), shading="nearest", rasterized=True)
            axis.contourf(places, places, usable, levels=[-0.5, 0.5], colors="none", hatches=["////"])
            axis.contour(places, places, np.nan_to_num(usable), levels=[0.5], colors=[INK], linewidths=0.9)
            for rib in RIBS_MM:
                axis.axvline(rib, color="white", linewidth=0.5, alpha=0.7)
                axis.axhline(rib, color="white", linewidth=0.5, alpha=0.7)
            share = np.nanmean(usable)
            axis.set_title(f"{count} gauges, {force} N each")
            axis.text(0.97, 0.08, f"{100 * share:.0f} % usable", transform=axis.transAxes, ha="right", color=INK)
            axis.set_aspect("equal")
            axis.grid(False)
            axis.set_xlim(15, 129)
            axis.set_ylim(15, 129)
    for axis in axes[-1]:
        axis.set_xlabel("lower contact, mm")
    for axis in axes[:, 0]:
        axis.set_ylabel("upper contact, mm")
    figure.tight_layout(rect=(0, 0, 0.92, 1))
    bar = figure.colorbar(image, cax=figure.add_axes((0.935, 0.12, 0.016, 0.78)), ticks=[0.05, 0.1, 0.3, 1, 3, 7, 20])
    bar.ax.yaxis.set_major_formatter(plt.FuncFormatter(lambda value, _: f"{value:g}"))
    bar.ax.minorticks_off()
    bar.set_label("larger std of both places, mm")
    bar.outline.set_visible(False)
    save(figure, path)


def main():
    out = pathlib.Path(*guard.words(__doc__, 1, 1))
    by_height(read(out / "by_height.csv"), out / "error_by_height.png")
    two_contacts(read(out / "two_contacts.csv"), out / "two_contacts.png")


if __name__ == "__main__":
    main()
