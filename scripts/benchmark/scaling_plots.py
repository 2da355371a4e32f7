"""Plots of time by links, frames and threads."""

import matplotlib.pyplot as plt
import numpy as np

from plot_style import FAMILIES, log_axis
from theme import AFTER, LINE, QUIET, svg


def links(settings):
    """Time by n of the chains on one contact, with the exponent of time ~ n^e."""
    solvers = {}
    for s in settings:
        if s["scene"] == "one_contact" and s["task"] != "estimation" and \
                s["family"] in ("paper", "chain"):
            solvers.setdefault((s["task"], s["family"]), []).append((s["links"], s["median_us"]))
    # From n = 50 on the time that does not depend on n is small.
    long = {key: np.log([p for p in points if p[0] >= 50]) for key, points in solvers.items()}
    if not any(len(points) > 1 for points in long.values()):
        return None
    figure, axes = plt.subplots(figsize=(4.7, 3.4))
    for (task, family), points in solvers.items():
        if len(long[task, family]) < 2:
            continue
        exponent = np.polyfit(*long[task, family].T, 1)[0]
        axes.plot(*zip(*points), color=FAMILIES[family][0],
                  marker="o" if task == "forward" else "s", ms=4, lw=1.2,
                  ls="-" if task == "forward" else "--",
                  label=f"{task} {family}, n to the {exponent:.2f}")
    axes.set(xscale="log", xlabel="links n", ylabel="time a frame (µs)")
    log_axis(axes.yaxis)
    axes.grid(True, which="major", color=LINE, lw=0.5)
    axes.minorticks_off()
    axes.set_xticks([25, 50, 100, 200, 400, 800, 1600],
                    labels=["25", "50", "100", "200", "400", "800", "1600"])
    axes.legend(loc="lower left", bbox_to_anchor=(-0.02, 1.0), ncols=2, borderaxespad=0.2)
    return svg(figure, "Time by the number of links")


def frames(batches):
    if not batches:
        return None
    figure, axes = plt.subplots(figsize=(4.7, 3.4))
    axes.plot([b["frames"] for b in batches],
              [1e6 * b["median_s"] / b["frames"] for b in batches], color=AFTER, marker="o",
              ms=4, lw=1.2)
    axes.axhline(1e6 * batches[-1]["median_s"] / batches[-1]["frames"], color=QUIET, lw=1, ls=":")
    axes.set(xlabel="frames of a batch", ylabel="time a frame, all told (µs)")
    log_axis(axes.xaxis)
    log_axis(axes.yaxis)
    axes.grid(True, which="major", color=LINE, lw=0.5)
    return svg(figure, "Time a frame by the number of frames")


def threads(batches):
    if len(batches) < 2:
        return None
    figure, axes = plt.subplots(figsize=(4.7, 3.4))
    counts = [b["threads"] for b in batches]
    one = batches[0]["frames_per_s"]
    axes.plot(counts, [c * one / 1e3 for c in counts], color=QUIET, lw=1, ls=":",
              label="in proportion")
    axes.plot(counts, [b["frames_per_s"] / 1e3 for b in batches], color=AFTER, marker="o",
              ms=4, lw=1.2, label="measured")
    axes.set(xlabel="threads", ylabel="1000 frames / s", xticks=counts)
    axes.set_ylim(bottom=0)
    axes.legend(loc="upper left")
    return svg(figure, "Frames a second by threads")
