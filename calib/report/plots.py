"""The plots of a calibration's report, each an SVG, or None without data."""

import math

import matplotlib.pyplot as plt
from matplotlib.ticker import MaxNLocator

from theme import AFTER, BEFORE, GROUND, HELD, INK, LINE, QUIET, svg


def number(cell):
    return float(cell) if cell else math.nan


def known(*values):
    return not any(math.isnan(v) for v in values)


# Name, colour, marker, column of the force, held out or not (None: both).
SERIES = (("before", BEFORE, "^", "before", None),
          ("after, fitted", AFTER, "o", "after", False),
          ("after, held out", HELD, "s", "after", True))


def held_out(frame):
    return frame["held_out"] == "1"


def fitted(frame):
    return not held_out(frame) and not frame["rejected"]


def scatter(axes, points, colour, marker, label=None, size=14):
    if points:
        axes.scatter(*zip(*points), s=size, color=colour, marker=marker, alpha=0.7,
                     lw=0, label=label)


def legend(axes, columns):
    """Puts the legend above the axes, where it hides nothing."""
    if axes.get_legend_handles_labels()[0]:
        axes.legend(loc="lower left", bbox_to_anchor=(-0.02, 1.0), ncols=columns, borderaxespad=0.2)


def forces(frames):
    """Says also how many frames lie above the plot."""
    points = [f for f in frames if known(number(f["force_N"]))]
    if not points:
        return None, 0
    top = 1.06 * max(max(number(f["force_N"]) for f in points), 0.1)
    figure, axes = plt.subplots(figsize=(4.6, 3.9))
    axes.plot([0, top], [0, top], color=QUIET, lw=1, zorder=1)
    above = 0
    for name, colour, marker, column, held in SERIES:
        chosen = [(number(f["force_N"]), number(f[f"force_{column}_N"])) for f in points
                  if held is None or held_out(f) == held]
        chosen = [p for p in chosen if known(*p)]
        if column == "before":
            above = sum(1 for p in chosen if p[1] > 1.25 * top)
        scatter(axes, [p for p in chosen if p[1] <= 1.25 * top], colour, marker, name)
    axes.set(xlim=(-0.02 * top, top), ylim=(-0.03 * top, 1.25 * top),
             xlabel="reference force (N)", ylabel="force from the gauges alone (N)")
    legend(axes, 3)
    return svg(figure, "Force from the gauges against the force sensor"), above


def errors_by_height(frames):
    figure, axes = plt.subplots(figsize=(4.6, 3.9))
    any_point, largest = False, 0
    for name, colour, marker, column, held in SERIES[1:]:
        points = []
        for f in frames:
            if held_out(f) != held or f["status_after"] != "ok":
                continue
            place = number(f["contact_after_mm"])
            error = number(f["force_after_N"]) - number(f["force_N"])
            std = number(f["force_after_std_N"])
            if known(place, error):
                points.append((place, error))
                if known(std):
                    axes.plot([place, place], [error - std, error + std], color=colour,
                              lw=0.7, alpha=0.45)
        scatter(axes, points, colour, marker, name)
        any_point |= bool(points)
        largest = max([largest] + [abs(p[1]) for p in points])
    if not any_point:
        plt.close(figure)
        return None
    axes.axhline(0, color=QUIET, lw=1, zorder=1)
    axes.set(xlabel="contact, arc length on the front beam (mm)",
             ylabel="force from the gauges − reference (N)",
             ylim=(-1.15 * largest, 1.15 * largest))
    legend(axes, 2)
    return svg(figure, "Force error by contact height")


def residuals(frames, gauges):
    figure, all_axes = plt.subplots(
        gauges, 2, figsize=(9.2, 1.2 * gauges + 0.7), sharex="col", sharey="row",
        squeeze=False, width_ratios=(6, 1))
    for j in range(gauges):
        axes, side = all_axes[j]
        column = f"gauge_{j + 1}_residual_std"
        values = []
        for kind, colour, marker in (("contact", AFTER, "o"), ("free", BEFORE, "^")):
            points = [(i + 1, number(f[column])) for i, f in enumerate(frames)
                      if f["kind"] == kind and known(number(f[column]))]
            scatter(axes, points, colour, marker, kind if j == 0 else None, 9)
            values += [p[1] for p in points]
        reach = max([3.5] + [1.1 * abs(v) for v in values])
        axes.axhspan(-2, 2, color=QUIET, alpha=0.1, lw=0, zorder=0)
        axes.axhline(0, color=QUIET, lw=0.8, zorder=1)
        axes.set(ylabel=f"gauge {j + 1} (std)", ylim=(-reach, reach))
        axes.yaxis.set_major_locator(MaxNLocator(5, integer=True))
        for start in (i + 1 for i in range(1, len(frames))
                      if frames[i]["log"] != frames[i - 1]["log"]):
            axes.axvline(start - 0.5, color=QUIET, lw=1, ls=(0, (4, 3)))
        side.grid(False)
        if values:
            step = reach / 14
            edges = [-reach + k * step for k in range(29)]
            side.hist(values, bins=edges, orientation="horizontal", color=AFTER, alpha=0.5)
            curve = [-reach + k * reach / 60 for k in range(121)]
            side.plot([len(values) * step * math.exp(-v * v / 2) / math.sqrt(2 * math.pi)
                       for v in curve], curve, color=INK, lw=1)
        side.tick_params(labelbottom=False, bottom=False)
        side.spines["bottom"].set_visible(False)
    all_axes[-1, 0].set_xlabel("frame, in the order of the logs")
    all_axes[-1, 1].set_xlabel("count, and the\nstandard normal", fontsize=8)
    legend(all_axes[0, 0], 2)
    return svg(figure, "Residuals of each gauge over the frames")


def shape(points):
    figure, axes = plt.subplots(figsize=(2.7, 3.9))
    parts = {}
    for p in points:
        parts.setdefault((p["state"], p["part"]), []).append(
            (number(p["x_mm"]), number(p["y_mm"])))
    for (state, part), line in parts.items():
        x, y = zip(*line)
        if part == "contact":
            axes.annotate("", xy=line[0], xytext=line[1], arrowprops={
                "arrowstyle": "-|>", "color": BEFORE, "lw": 1.8, "shrinkA": 0, "shrinkB": 0})
            axes.update_datalim(line)
            continue
        rib = part.startswith("rib")
        style = {"color": QUIET, "lw": 0.7, "ls": (0, (3, 3))} if state == "undeformed" else {
            "color": QUIET if rib else AFTER, "lw": 1.1 if rib else 2.2}
        axes.plot(x, y, solid_capstyle="round", **style)
    axes.grid(False)
    axes.set(aspect="equal", xlabel="x (mm)", ylabel="y (mm)")
    axes.margins(0.1)
    return svg(figure, "The calibrated finger in its heaviest frame")


def coverage(frames, advice):
    fitted = [(number(f["fit_contact_mm"]), number(f["fit_normal_N"])) for f in frames]
    fitted = [p for p in fitted if known(*p)]
    if not fitted:
        return None
    held = [(number(f["contact_after_mm"]), number(f["force_after_N"])) for f in frames
            if held_out(f) and f["kind"] == "contact"]
    figure, axes = plt.subplots(figsize=(6.2, 3.9))
    scatter(axes, fitted, AFTER, "o", "fitted")
    scatter(axes, [p for p in held if known(*p)], HELD, "s", "held out")
    spots, lines = [], []
    for a in advice:
        if a.get("kind") != "contact_frames":
            continue
        if known(a["contact_mm"]):
            spots.append((a["contact_mm"], a["normal_N"]))
        else:
            lines.append(a["normal_N"])
    label = "to record next"
    for x, y in dict.fromkeys(spots):
        axes.scatter([x], [y], s=90, facecolor=GROUND, edgecolor=BEFORE, lw=2, marker="D",
                     label=label)
        label = None
    for y in dict.fromkeys(lines):
        axes.axhline(y, color=BEFORE, lw=1.6, ls=(0, (6, 3)), label=label)
        label = None
    axes.set(xlabel="contact, arc length on the front beam (mm)", ylabel="normal force (N)")
    axes.set_ylim(bottom=0)
    legend(axes, 3)
    return svg(figure, "Load and contact height of the frames")


def correlations(names, matrix):
    """Drawn by hand: squares whose opacity is the correlation, on the page's ground."""
    n, cell = len(names), 26
    left = top = max(60, 5.8 * max(map(len, names)) + 14)
    size_x, size_y = left + n * cell + 4, top + n * cell + 4
    out = [f'<svg role="img" aria-label="Correlations of the free parameters" '
           f'viewBox="0 0 {size_x} {size_y}" width="{size_x}" '
           'style="font: 10px var(--font); fill: var(--ink)">']
    for i, name in enumerate(names):
        middle = cell * i + cell / 2
        out.append(f'<text x="{left - 6}" y="{top + middle + 3.5}" text-anchor="end">{name}</text>')
        out.append(f'<text transform="translate({left + middle + 3.5} {top - 6}) rotate(-90)">'
                   f'{name}</text>')
        for j in range(i + 1):
            value = matrix[i][j]
            x, y = left + j * cell, top + i * cell
            colour = "var(--after)" if value < 0 else "var(--before)"
            opacity = 0.12 if i == j else 0.65 * abs(value)
            colour = "var(--quiet)" if i == j else colour
            out.append(f'<rect x="{x + 1}" y="{y + 1}" width="{cell - 2}" height="{cell - 2}" '
                       f'rx="3" style="fill:{colour};fill-opacity:{opacity:.3f}">'
                       f"<title>{names[j]}, {name}: {value:+.2f}</title></rect>")
            if i != j and abs(value) >= 0.5:
                text = f"{value:+.2f}".replace("0.", ".").replace("-", "−")
                out.append(f'<text x="{x + cell / 2}" y="{y + cell / 2 + 3}" '
                           f'text-anchor="middle" font-size="8.5">{text}</text>')
    out.append("</svg>")
    return "".join(out)


def weak_direction(components, short):
    """Shares of the parameters in a direction, as bars about a middle line."""
    items = sorted(components.items(), key=lambda c: -abs(c[1]))
    row, left, half = 17, 150, 90
    out = [f'<svg role="img" aria-label="Shares in the weak direction" '
           f'viewBox="0 0 {left + 2 * half + 40} {row * len(items) + 4}" '
           f'width="{left + 2 * half + 40}" style="font: 10.5px var(--font); fill: var(--ink)">']
    middle = left + half
    for k, (name, share) in enumerate(items):
        y = k * row
        x = middle if share > 0 else middle - half * abs(share)
        colour = "var(--before)" if share > 0 else "var(--after)"
        out.append(f'<text x="{left - 8}" y="{y + 12}" text-anchor="end">{short(name)}</text>'
                   f'<rect x="{x:.1f}" y="{y + 3}" width="{half * abs(share):.1f}" height="{row - 6}" '
                   f'rx="2" style="fill:{colour}"/>')
        text = f"{share:+.2f}".replace("-", "−")
        end = middle + half + 6
        out.append(f'<text x="{end}" y="{y + 12}" style="fill:var(--quiet)">{text}</text>')
    out.append(f'<line x1="{middle}" x2="{middle}" y1="0" y2="{row * len(items)}" '
               'style="stroke:var(--line)"/></svg>')
    return "".join(out)
