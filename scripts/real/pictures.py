"""The pictures of the page, as PNG."""

import math
import pathlib
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.append(str(ROOT / "scripts" / "perception"))

from perception_style import BLUE as AFTER, ORANGE as BEFORE, QUIET, plt  # noqa: E402

import figure_file  # noqa: E402
import gauged_finger  # noqa: E402


def save(figure, path):
    figure_file.write(figure, path, dpi=80, bbox_inches="tight")
    plt.close(figure)


def bare_forces(path, entries):
    """Measured forces and those that other rows predict, over the advance."""
    panels = [("circle_r20", 4, "circle, R = 20 mm"), ("circle_r30", 4, "circle, R = 30 mm"),
              ("ellipse_a20_b30", 4, "ellipse"), ("circle_r30", 0, "R = 30 mm, no ribs")]
    figure, axes = plt.subplots(1, 4, figsize=(11, 2.9), sharey=True)
    for panel, (name, ribs, title) in zip(axes, panels):
        rows = [e for e in entries if "force" in e and (e["object"], e["ribs"]) == (name, ribs)]
        for log in dict.fromkeys(e["log"] for e in rows):
            mine = [e for e in rows if e["log"] == log]
            x = [e["advance_mm"] for e in mine]
            panel.plot(x, [e["force"][2] for e in mine], color=AFTER, lw=1.2)
            panel.plot(x, [e["force"][1] for e in mine], color=QUIET, lw=1, ls=(0, (4, 3)))
            panel.scatter(x, [e["force"][0] for e in mine], s=12, color=BEFORE, lw=0, zorder=5)
        panel.set(xlabel="advance (mm)", title=title)
    axes[0].set(ylabel="force (N)")
    axes[0].legend(["place by other rows", "place as written", "measured"], fontsize=7,
                   loc="upper left")
    save(figure, path)


def bare_pins(path, entries):
    """Pins that the camera saw and those predicted, one panel an object."""
    names = list(dict.fromkeys(e["object"] for e in entries if "pins" in e))
    figure, axes = plt.subplots(1, len(names), figsize=(9, 4.2), sharey=True)
    for panel, name in zip(axes, names):
        for entry in (e for e in entries if "pins" in e and e["object"] == name):
            for which, marker, color in ((1, "o", BEFORE), (3, "+", AFTER)):
                x, y = ([pin[which] for pin in entry["pins"] if pin[0][-4] == axis] for axis in "xy")
                panel.scatter(x, y, s=14 if which == 1 else 34, marker=marker, color=color, lw=0 if which == 1 else 1)
        panel.set(xlabel="x (mm)", title=name.replace("_", " "), aspect="equal")
    axes[0].set(ylabel="y (mm)")
    axes[0].legend(["camera", "predicted"], fontsize=7)
    save(figure, path)


def gauged_forces(path, entries):
    """Each row's force from its gauges by the other rows, over the measured force."""
    figure, axes = plt.subplots(1, 2, figsize=(8, 3.2), sharey=True)
    for panel, which, title in zip(axes, (0, 1), ("gauges alone", "gauges and the place of the circle")):
        measured = [e[0] for e in entries]
        stds = gauged_finger.stds(entries, which, gauged_finger.FORCE_STD)
        panel.axhline(0, color=QUIET, lw=0.8)
        panel.errorbar(measured, gauged_finger.errors(entries, which), [1.96 * s for s in stds], fmt="o", ms=4, color=AFTER,
                       lw=1)
        panel.set(xlabel="measured force (N)", title=title, ylim=(-3, 3))
    axes[0].set(ylabel="sensed less measured (N)")
    save(figure, path)


def outlines(path, plain, corrected, plain_irregular, irregular):
    figure, axes = plt.subplots(1, 2, figsize=(8, 4))
    turn = [2 * math.pi * k / 180 for k in range(181)]
    axes[0].plot([30 * math.cos(a) for a in turn], [30 * math.sin(a) for a in turn], color=QUIET, lw=1, ls=(0, (4, 3)),
                 label="R = 30 mm")
    for panel, shapes in ((axes[0], ((plain, BEFORE, "as written"), (corrected, AFTER, "axis from the other half"))),
                          (axes[1], ((plain_irregular, BEFORE, "as written"), (irregular, AFTER, "axis from the circle")))):
        for shape, color, label in shapes:
            if shape.refused:
                continue
            panel.plot(*zip(*(shape.points + shape.points[:1])), color=color, lw=1.2, label=label)
            panel.scatter(*zip(*shape.contacts), s=9, color=color, lw=0)
        panel.set(aspect="equal", xlabel="x (mm)")
        panel.legend(fontsize=7, loc="center")
    axes[0].set(ylabel="y (mm)", title="circle")
    axes[1].set(title="irregular object")
    save(figure, path)
