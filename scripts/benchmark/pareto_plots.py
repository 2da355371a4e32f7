"""Plots error over time with the Pareto front, one for each task and scene."""

import matplotlib.pyplot as plt

from plot_style import FAMILIES, HOW_MARKERS, MARKERS, log_axis, look
from theme import INK, LINE, QUIET, svg

LEAST_ERROR = 1e-13
HOWS = {"s": "load surface, blocks of a log", "^": "to rounding", "v": "cold, every frame searched"}


def error_of(setting):
    """The error of a plot and its name: that of l_c where the setting finds it."""
    if "contact_error_mm" in setting:
        return setting["contact_error_mm"], "largest error of l_c (mm)"
    return setting.get("gauges_error_rad"), "largest error of a gauge angle (rad)"


def floor_of(settings, noise):
    """What the finger's own gauge noise leaves of the error of a plot, and its words."""
    place = any("contact_error_mm" in s for s in settings)
    if place:
        floor = noise.get("contact_mm")
        return floor, f"noise of {noise['gauge_rad']:.1g} rad: {floor:.2g} mm" if floor else ""
    floor = noise.get("gauge_rad")
    return floor, f"noise of the gauges: {floor:.1g} rad" if floor else ""


def pareto(settings, front, yardstick_us, noise):
    """Times are ratios to the yardstick, as for the front, times its usual time."""
    points = []
    for s in settings:
        error, label = error_of(s)
        if error is not None:
            points.append((s, s["quartile_1_over_yardstick"] * yardstick_us,
                           max(error, LEAST_ERROR)))
    # Without a load there is no error to plot, only time.
    if len(points) < 4 or all(e <= 1e-12 for _, _, e in points):
        return None
    figure, axes = plt.subplots(figsize=(4.7, 3.7))
    line = sorted((t, e) for s, t, e in points if s["id"] in front)
    axes.step(*zip(*line), where="post", color=QUIET, lw=1, zorder=1)
    for s, t, e in points:
        colour, marker = look(s)
        on = s["id"] in front
        solved = s["solved_percent"] >= 100
        axes.scatter([t], [e], s=34 if on else 20, marker=marker, zorder=3 if on else 2,
                     facecolors=colour if solved else "none", edgecolors=colour,
                     linewidths=0 if solved else 1, alpha=1 if on else 0.55)
    floor, words = floor_of(settings, noise)
    if floor:
        axes.axhline(floor, color=INK, lw=1, ls="--", zorder=1)
        axes.annotate(words, (1, floor), xycoords=("axes fraction", "data"), xytext=(-2, 3),
                      textcoords="offset points", ha="right", fontsize=7.5, color=INK)
    axes.set(xscale="log", yscale="log", xlabel="time a frame (µs)", ylabel=label)
    # Leave room for the names.
    left, right = axes.get_xlim()
    axes.set_xlim(left, right * (right / left)**0.2)
    log_axis(axes.xaxis)
    log_axis(axes.yaxis)
    name(axes, [p for p in points if p[0]["id"] in front])
    axes.grid(True, which="major", color=LINE, lw=0.5)
    return svg(figure, f"{settings[0]['task']}, {settings[0]['scene']}: time against error")


def name(axes, points):
    """Names beside the points of the front, except where they would collide."""
    axes.figure.canvas.draw()
    taken = []
    for s, t, e in sorted(points, key=lambda p: p[1]):
        x, y = axes.transData.transform((t, e))
        if any(abs(x - a) < 110 and abs(y - b) < 10 for a, b in taken):
            continue
        taken.append((x, y))
        axes.annotate(f"{s['solver']}/{s['how']}", (t, e), xytext=(6, 3), textcoords="offset points",
                      fontsize=7.5)


def key(settings):
    """The legend of all plots, once."""
    figure, axes = plt.subplots(figsize=(9.4, 0.75))
    axes.axis("off")
    there = {s["family"] for s in settings}
    for family, (colour, words) in FAMILIES.items():
        if family in there:
            axes.scatter([], [], color=colour, marker=MARKERS.get(family, "o"), label=words)
    for marker, words in HOWS.items():
        if any(HOW_MARKERS.get(s["how"]) == marker for s in settings):
            axes.scatter([], [], color=QUIET, marker=marker, label=words)
    axes.scatter([], [], facecolors="none", edgecolors=QUIET, label="some frames not solved")
    axes.legend(loc="center", ncols=4)
    return svg(figure, "Key of the plots")
