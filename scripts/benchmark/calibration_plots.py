"""Plots of calibration.json: time against error, and time against frames."""

import matplotlib.pyplot as plt

from plot_style import log_axis
from theme import AFTER, BEFORE, HELD, INK, LINE, svg

COLOURS = (HELD, AFTER, BEFORE)
KINDS = {"default": ("*", "default"), "threads": ("s", "two threads"),
         "tolerance": ("^", "other tolerance"), "scheme": ("D", "other scheme")}
LEAST_ERROR = 1e-7  # the reference is no better


def of_frames(rows):
    """Rows by their number of frames, each with its colour."""
    counts = sorted({r["frames"] for r in rows})
    return [(n, COLOURS[k % len(COLOURS)], [r for r in rows if r["frames"] == n])
            for k, n in enumerate(counts)]


def error(rows):
    figure, axes = plt.subplots(figsize=(4.7, 3.7))
    for frames, colour, mine in of_frames(rows):
        for r in mine:
            axes.scatter([r["cpu_s"]], [max(r["error_std"], LEAST_ERROR)], color=colour,
                         marker=KINDS[r["kind"]][0], s=60 if r["kind"] == "default" else 22)
        axes.scatter([], [], color=colour, label=f"{frames} frames")
    for marker, words in KINDS.values():
        axes.scatter([], [], color=INK, marker=marker, label=words)
    axes.axhline(1, color=INK, lw=1, ls="--", zorder=1)
    axes.annotate("noise of the log", (1, 1), xycoords=("axes fraction", "data"), xytext=(-2, 3),
                  textcoords="offset points", ha="right", fontsize=7.5, color=INK)
    axes.set(xscale="log", yscale="log", xlabel="CPU time of a calibration (s)",
             ylabel="error of the worst parameter (std)")
    log_axis(axes.xaxis)
    log_axis(axes.yaxis)
    axes.grid(True, which="major", color=LINE, lw=0.5)
    axes.legend(loc="lower left", bbox_to_anchor=(-0.02, 1.0), ncols=3, borderaxespad=0.2)
    return svg(figure, "Calibration: time against error")


def frames(rows):
    figure, axes = plt.subplots(figsize=(4.7, 3.7))
    for kind, words, colour, marker in (("default", "one thread", AFTER, "o"),
                                        ("threads", "two threads", HELD, "s")):
        mine = [r for r in rows if r["kind"] == kind]
        axes.plot([r["clock_s"] for r in mine], [r["stiffness_std_percent"] for r in mine],
                  color=colour, marker=marker, ms=4, lw=1.2, label=words)
        for r in mine:
            axes.annotate(f"{r['frames']}", (r["clock_s"], r["stiffness_std_percent"]),
                          xytext=(5, 3), textcoords="offset points", fontsize=7.5)
    axes.set(xscale="log", yscale="log", xlabel="time of a calibration (s)",
             ylabel="std of the front beam's stiffness (%)")
    log_axis(axes.xaxis)
    log_axis(axes.yaxis)
    axes.grid(True, which="major", color=LINE, lw=0.5)
    axes.legend(loc="upper right")
    return svg(figure, "Calibration: what more frames cost and bring")
