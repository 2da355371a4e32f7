#!/usr/bin/python3
"""Renders report.html of a calibration: render.py RESULT_FOLDER.

Reads calibration.yaml, calibration.frames.csv and calibration.shape.csv and
writes one self-contained page, plots inside as SVG.
"""

import csv
import datetime
import io
import math
import os
import pathlib
import re
import sys
import tempfile

os.environ.setdefault("MPLCONFIGDIR", tempfile.mkdtemp(prefix="finray_mpl_"))

import jinja2
import matplotlib

matplotlib.use("svg")
import matplotlib.pyplot as plt
import yaml

# Colours that read on light and on dark ground.
BEFORE, AFTER, HELD_OUT, INK = "#d1793b", "#2f7fc1", "#3a9a6a", "#8a8f98"

plt.rcParams.update({
    "font.size": 9, "axes.edgecolor": INK, "axes.labelcolor": INK,
    "xtick.color": INK, "ytick.color": INK, "text.color": INK,
    "axes.spines.top": False, "axes.spines.right": False,
    "figure.facecolor": "none", "axes.facecolor": "none",
    "svg.fonttype": "none", "svg.hashsalt": "finray", "legend.frameon": False,
    "font.family": "sans-serif",
})


def read_csv(path):
    with open(path, newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


def number(cell):
    return float(cell) if cell else math.nan


def svg(figure):
    text = io.StringIO()
    figure.savefig(text, format="svg", bbox_inches="tight",
                   metadata={"Date": None, "Creator": None})
    plt.close(figure)
    text = text.getvalue()
    return text[text.index("<svg"):]


def plot_forces(frames):
    points = [f for f in frames if not math.isnan(number(f["force_N"]))]
    if not points:
        return None
    reference = [number(f["force_N"]) for f in points]
    top = 1.15 * max(max(reference), 0.1)
    figure, axes = plt.subplots(figsize=(4.6, 4.2))
    axes.plot([0, top], [0, top], color=INK, lw=0.8, zorder=1)
    outside = 0
    for name, colour, column, held in (
            ("before", BEFORE, "force_before_N", None),
            ("after, fitted", AFTER, "force_after_N", False),
            ("after, held out", HELD_OUT, "force_after_N", True)):
        chosen = [f for f in points if held is None or (f["held_out"] == "1") == held]
        y = [number(f[column]) for f in chosen]
        if column == "force_before_N":
            outside = sum(1 for v in y if v > 1.3 * top)
        if chosen:
            axes.scatter([number(f["force_N"]) for f in chosen], y, s=12,
                         color=colour, label=name, alpha=0.75, lw=0, zorder=2)
    axes.set(xlim=(-0.03 * top, top), ylim=(-0.03 * top, 1.3 * top),
             xlabel="reference force (N)", ylabel="force from the gauges (N)")
    if outside:
        axes.annotate(f"{outside} frames “before” lie above", (0.98, 0.99),
                      xycoords="axes fraction", ha="right", va="top", fontsize=8)
    axes.legend(loc="upper left", fontsize=8)
    return svg(figure)


def plot_residuals(frames, gauges):
    figure, all_axes = plt.subplots(gauges, 1, figsize=(7.4, 1.25 * gauges + 0.5),
                                    sharex=True, squeeze=False)
    for j, axes in enumerate(all_axes[:, 0]):
        column = f"gauge_{j + 1}_residual_std"
        for kind, colour in (("contact", AFTER), ("free", HELD_OUT)):
            points = [(i + 1, number(f[column])) for i, f in enumerate(frames)
                      if f["kind"] == kind and not math.isnan(number(f[column]))]
            if points:
                axes.scatter(*zip(*points), s=7, color=colour, lw=0,
                             label=kind if j == 0 else None)
        axes.axhline(0, color=INK, lw=0.6)
        axes.axhspan(-2, 2, color=INK, alpha=0.12, lw=0)
        axes.set_ylabel(f"gauge {j + 1}\n(std)")
    all_axes[-1, 0].set_xlabel("frame")
    all_axes[0, 0].legend(loc="upper right", ncols=2, fontsize=8)
    return svg(figure)


def plot_shape(points):
    figure, axes = plt.subplots(figsize=(3.6, 4.2))
    parts = {}
    for p in points:
        parts.setdefault((p["state"], p["part"]), []).append(
            (number(p["x_mm"]), number(p["y_mm"])))
    for (state, part), line in parts.items():
        x, y = zip(*line)
        if part == "contact":
            axes.annotate("", xy=line[0], xytext=line[1],
                          arrowprops={"arrowstyle": "-|>", "color": BEFORE, "lw": 1.6})
            continue
        rib = part.startswith("rib")
        style = {"color": INK, "lw": 0.7, "ls": (0, (3, 3))} if state == "undeformed" else {
            "color": INK if rib else AFTER, "lw": 1.1 if rib else 2.2}
        axes.plot(x, y, **style)
    axes.set(aspect="equal", xlabel="x (mm)", ylabel="y (mm)")
    axes.margins(0.08)
    return svg(figure)


def plot_coverage(frames):
    figure, axes = plt.subplots(figsize=(4.6, 2.9))
    points = [(number(f["fit_contact_mm"]), number(f["fit_normal_N"])) for f in frames]
    points = [p for p in points if not math.isnan(p[0])]
    if not points:
        plt.close(figure)
        return None
    axes.scatter(*zip(*points), s=12, color=AFTER, alpha=0.75, lw=0)
    axes.set(xlabel="contact, arc length on the front beam (mm)",
             ylabel="normal force (N)")
    axes.set_ylim(bottom=0)
    return svg(figure)


def plot_correlations(names, matrix):
    n = len(names)
    figure, axes = plt.subplots(figsize=(0.32 * n + 2.2, 0.32 * n + 1.6))
    image = axes.imshow(matrix, vmin=-1, vmax=1, cmap="RdBu_r")
    axes.set_xticks(range(n), names, rotation=90, fontsize=7)
    axes.set_yticks(range(n), names, fontsize=7)
    axes.spines[:].set_visible(False)
    figure.colorbar(image, shrink=0.7)
    return svg(figure)


def digits(value, std):
    """A value to the digits that its std leaves meaningful."""
    if value is None or math.isnan(value):
        return "–"
    if std and math.isfinite(std):
        places = max(0, 1 - math.floor(math.log10(abs(std))))
        return f"{value:.{places}f}"
    return f"{value:.6g}"


def three(value):
    if value is None or (isinstance(value, float) and math.isnan(value)):
        return "–"
    if isinstance(value, float) and math.isinf(value):
        return "∞"
    return f"{float(value):.3g}"


def short(name):
    return re.sub(r"_(N_mm2|V_per_rad|V|mm)$", "", name).replace("_", " ")


def main():
    folder = pathlib.Path(sys.argv[1])
    calibration = yaml.safe_load((folder / "calibration.yaml").read_text("utf-8"))
    frames = read_csv(folder / "calibration.frames.csv")
    shape = read_csv(folder / "calibration.shape.csv")
    gauges = sum(1 for p in calibration["parameters"] if "_gain_" in p["name"])
    correlations = calibration["correlations"]
    environment = jinja2.Environment(
        loader=jinja2.FileSystemLoader(pathlib.Path(__file__).parent),
        autoescape=True, trim_blocks=True, lstrip_blocks=True)
    environment.filters.update(three=three, short=short)
    environment.globals.update(digits=digits)
    page = environment.get_template("report.html.jinja").render(
        c=calibration,
        frames={"contact": sum(f["kind"] == "contact" and f["held_out"] == "0" for f in frames),
                "free": sum(f["kind"] == "free" and f["held_out"] == "0" for f in frames),
                "held_out": sum(f["held_out"] == "1" for f in frames)},
        forces=plot_forces(frames), shape=plot_shape(shape),
        residuals=plot_residuals(frames, gauges) if gauges else None,
        coverage=plot_coverage(frames),
        correlations=plot_correlations([short(n) for n in correlations["names"]],
                                       correlations["matrix"]),
        date=datetime.date.today().isoformat())
    temporary = folder / "report.html.part"
    temporary.write_text(page, "utf-8")
    temporary.rename(folder / "report.html")


if __name__ == "__main__":
    main()
