"""Plots that follow the page: drawn in stand-in colours, which become the page's
CSS variables in the SVG. Colours are Okabe and Ito's, apart for colour-blind
readers; series differ in their markers too."""

import io
import pathlib
import re
import sys

sys.path.append(str(pathlib.Path(__file__).resolve().parents[2] / "scripts/common"))
import plain_matplotlib  # noqa: F401  before matplotlib

import matplotlib

matplotlib.use("svg")
import matplotlib.pyplot as plt

# Stand-in colour: CSS variable.
VARIABLES = {
    "#010203": "--ink", "#040506": "--quiet", "#070809": "--line",
    "#0a0b0c": "--before", "#0d0e0f": "--after", "#101112": "--held",
    "#131415": "--ground",
}
INK, QUIET, LINE, BEFORE, AFTER, HELD, GROUND = VARIABLES

plt.rcParams.update({
    "font.size": 9, "axes.labelsize": 9, "xtick.labelsize": 8.5,
    "ytick.labelsize": 8.5, "legend.fontsize": 8.5,
    "axes.edgecolor": LINE, "axes.labelcolor": QUIET, "axes.linewidth": 0.8,
    "xtick.color": LINE, "ytick.color": LINE, "text.color": INK,
    "xtick.labelcolor": QUIET, "ytick.labelcolor": QUIET,
    "xtick.major.size": 3, "ytick.major.size": 3,
    "axes.spines.top": False, "axes.spines.right": False,
    "axes.grid": True, "grid.color": LINE, "grid.linewidth": 0.5,
    "axes.axisbelow": True, "axes.labelpad": 5,
    "figure.facecolor": "none", "axes.facecolor": "none",
    "figure.constrained_layout.use": True,
    "svg.fonttype": "none", "svg.hashsalt": "finray", "legend.frameon": False,
    "legend.handletextpad": 0.3, "legend.columnspacing": 1.2,
    "font.family": "sans-serif",
})


def svg(figure, label):
    """The figure as inline SVG in the page's colours and font."""
    text = io.StringIO()
    figure.savefig(text, format="svg", metadata={"Date": None, "Creator": None})
    plt.close(figure)
    text = text.getvalue()
    text = text[text.index("<svg"):]
    for colour, variable in VARIABLES.items():
        text = text.replace(colour, f"var({variable})")
    text = re.sub(r"font: ([\d.]+)px [^;\"]*", r"font: \1px var(--font)", text)
    text = re.sub(r"<metadata>.*?</metadata>", "", text, flags=re.S)
    # Ids of plots in one page must differ, except those of equal elements.
    text = re.sub(r' id="(figure|patch|axes|text|matplotlib|xtick|ytick|line2d|legend|PathCollection|FillBetweenPolyCollection|LineCollection)[^"]*"', "", text)
    return text.replace("<svg", f'<svg role="img" aria-label="{label}"', 1)
