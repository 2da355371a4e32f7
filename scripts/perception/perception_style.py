"""The look of the perception plots; each is written as SVG and PNG."""

import pathlib
import sys

sys.path.append(str(pathlib.Path(__file__).resolve().parents[1] / "common"))
import plain_matplotlib  # noqa: F401  before matplotlib

import figure_file
import matplotlib

matplotlib.use("agg")
import matplotlib.pyplot as plt

BLUE, ORANGE, GREEN, RED = "#2f6fab", "#d1793b", "#3a9a6a", "#b3382c"
INK, QUIET, PALE = "#22272e", "#6b7480", "#d3dae1"

plt.rcParams.update({
    "font.size": 9, "axes.edgecolor": QUIET, "axes.labelcolor": INK, "xtick.color": QUIET,
    "ytick.color": QUIET, "text.color": INK, "axes.spines.top": False, "axes.spines.right": False,
    "axes.grid": True, "grid.color": "#e4e8ec", "grid.linewidth": 0.7, "axes.axisbelow": True,
    "legend.frameon": False, "font.family": "sans-serif", "figure.dpi": 150,
    "svg.fonttype": "none", "svg.hashsalt": "finray",
})


def save(figure, stem):
    """Saves SVG and PNG."""
    for ending in ("svg", "png"):
        figure_file.write(figure, f"{stem}.{ending}", bbox_inches="tight")
    plt.close(figure)
