"""The look of the calibration's report: its theme, its style sheet, its numbers."""

import pathlib
import sys

REPORT = pathlib.Path(__file__).resolve().parents[2] / "calib" / "report"
sys.path.append(str(REPORT))

from theme import AFTER, BEFORE, HELD, INK, QUIET, plt, svg  # noqa: E402,F401


def legend(axes, columns):
    """Puts the legend above the axes, where it hides nothing."""
    axes.legend(loc="lower left", bbox_to_anchor=(-0.02, 1.0), ncols=columns, borderaxespad=0.2)


def paper_line(axes, value, text, at):
    """The paper's figure, dashed, its name on it, ending at this share of the width."""
    axes.axhline(value, color=QUIET, lw=1, ls=(0, (4, 3)), zorder=1)
    axes.text(at, value, text, transform=axes.get_yaxis_transform(), ha="right", va="bottom",
              color=QUIET, fontsize=8.5)
