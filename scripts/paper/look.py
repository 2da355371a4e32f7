"""The look of the calibration's report: its theme, its style sheet, its numbers."""

import pathlib
import sys

REPORT = pathlib.Path(__file__).resolve().parents[2] / "calib" / "report"
sys.path.append(str(REPORT))

from theme import AFTER, BEFORE, GROUND, HELD, INK, LINE, QUIET, plt, svg  # noqa: E402,F401


def legend(axes, columns, **options):
    """Above the axes, so that it hides nothing."""
    axes.legend(loc="lower left", bbox_to_anchor=(-0.02, 1.0), ncols=columns, borderaxespad=0.2,
                **options)


def paper_line(axes, value, text, horizontal=True, at=0.98):
    """The paper's figure, dashed, its name beside it."""
    style = {"color": QUIET, "lw": 1, "ls": (0, (4, 3)), "zorder": 1}
    if horizontal:
        axes.axhline(value, **style)
        axes.text(at, value, text, transform=axes.get_yaxis_transform(), ha="right", va="bottom",
                  color=QUIET, fontsize=8.5)
    else:
        axes.axvline(value, **style)
