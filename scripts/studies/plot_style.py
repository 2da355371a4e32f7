"""The look of all plots of docs/evidence/accuracy.md."""

import pathlib
import sys

sys.path.append(str(pathlib.Path(__file__).resolve().parents[1] / "common"))
import plain_matplotlib  # noqa: F401  before matplotlib

import figure_file
import matplotlib

matplotlib.use("agg")
import matplotlib.pyplot as plt

BLUE, ORANGE, GREEN, RED = "#2f6fab", "#d1793b", "#3a9a6a", "#b3382c"
INK, QUIET, PALE = "#22272e", "#6b7480", "#e4e8ec"

plt.rcParams.update({
    "font.size": 10, "axes.titlesize": 10.5, "axes.titleweight": "bold", "axes.titlelocation": "left",
    "axes.edgecolor": QUIET, "axes.labelcolor": INK, "xtick.color": QUIET, "ytick.color": QUIET,
    "text.color": INK, "axes.spines.top": False, "axes.spines.right": False,
    "axes.grid": True, "grid.color": PALE, "grid.linewidth": 0.8, "axes.axisbelow": True,
    "legend.frameon": False, "font.family": "sans-serif", "figure.dpi": 150,
})


def save(figure, path):
    figure_file.write(figure, path, bbox_inches="tight", pad_inches=0.12)
    plt.close(figure)
    print(path)
