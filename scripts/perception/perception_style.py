"""The look of the perception plots; each is written as SVG and PNG."""

import io
import pathlib
import sys

sys.path.append(str(pathlib.Path(__file__).resolve().parents[1] / "common"))
import plain_matplotlib  # noqa: F401  before matplotlib

sys.path.append(str(pathlib.Path(__file__).parents[2] / "calib" / "report"))

import matplotlib
import whole_file

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
    """Saves SVG and PNG without version and date: equal numbers give equal bytes."""
    for ending, metadata in (("svg", {"Date": None, "Creator": None}), ("png", {"Software": None})):
        image = io.BytesIO()
        figure.savefig(image, format=ending, bbox_inches="tight", metadata=metadata)
        whole_file.write(f"{stem}.{ending}", image.getvalue())
    plt.close(figure)
