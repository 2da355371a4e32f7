"""Colours and markers of solver families, beside those of the calibration's
report."""

import math

import theme  # before matplotlib, which it brings as it comes

from matplotlib import ticker

CERES = "#161718"
theme.VARIABLES[CERES] = "--ceres"

# Family: colour, name.
FAMILIES = {
    "taylor": (theme.AFTER, "series of order 4 to 16"),
    "chain": (theme.HELD, "linear-time chain"),
    "paper": (theme.BEFORE, "the paper’s dense Newton"),
    "ceres": (CERES, "ceres::Solve"),
    "scipy": (theme.INK, "SciPy"),
    "octave": (theme.INK, "Octave"),
    "calculix": (theme.INK, "CalculiX"),
    "getfem": (theme.INK, "GetFEM"),
    "mujoco": (theme.INK, "MuJoCo"),
}
MARKERS = {"scipy": "P", "octave": "X", "calculix": "D", "getfem": "p", "mujoco": "*"}
HOW_MARKERS = {"surface": "s", "block": "s", "to_rounding": "^", "cold": "v", "search": "v"}


def look(setting):
    """Colour and marker of a setting."""
    family = setting["family"]
    return (FAMILIES[family][0],
            MARKERS.get(family) or HOW_MARKERS.get(setting["how"], "o"))


def log_axis(axis):
    """Makes an axis logarithmic, with labels at 1, 2 and 5 where its powers of ten alone would be
    fewer than two, and at all digits where these would be too few as well."""
    axis.axes.set(**{f"{axis.axis_name}scale": "log"})
    low, high = sorted(axis.get_view_interval())
    for digits in ((1,), (1, 2, 5), range(1, 10)):
        axis.set_major_locator(ticker.LogLocator(subs=digits, numticks=12))
        if sum(low <= tick <= high for tick in axis.get_majorticklocs()) > 1:
            break
    if len(digits) > 1:
        axis.set_major_formatter(ticker.FuncFormatter(_short))
    axis.set_minor_locator(ticker.NullLocator())


def _short(value, _position):
    """A number without a power of ten where it is readable."""
    return f"{value:g}" if 1e-3 <= value < 1e5 else \
        f"{value / 10**math.floor(math.log10(value)):g}e{math.floor(math.log10(value))}"
