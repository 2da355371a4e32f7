"""Colours and markers of solver families, beside those of the calibration's
report."""

import theme

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
}
MARKERS = {"scipy": "P", "octave": "X", "calculix": "D"}
HOW_MARKERS = {"lanes": "s", "block": "s", "to_rounding": "^", "cold": "v", "search": "v"}


def look(setting):
    """Colour and marker of a setting."""
    family = setting["family"]
    return (FAMILIES[family][0],
            MARKERS.get(family) or HOW_MARKERS.get(setting["how"], "o"))
