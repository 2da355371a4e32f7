"""Units by name: what a reading is multiplied by to become finray's unit."""

import math

from errors import did_you_mean

# dimension: (finray's unit, {name: factor})
STANDARD_GRAVITY = 9.80665  # m/s^2
UNITS = {
    "time": ("s", {"s": 1.0, "sec": 1.0, "ms": 1e-3, "us": 1e-6, "µs": 1e-6, "ns": 1e-9,
                   "min": 60.0, "h": 3600.0}),
    "length": ("mm", {"mm": 1.0, "cm": 10.0, "m": 1e3, "um": 1e-3, "µm": 1e-3, "in": 25.4,
                      "inch": 25.4}),
    "force": ("N", {"N": 1.0, "mN": 1e-3, "cN": 1e-2, "kN": 1e3, "gf": STANDARD_GRAVITY * 1e-3,
                    "g": STANDARD_GRAVITY * 1e-3, "kgf": STANDARD_GRAVITY,
                    "kg": STANDARD_GRAVITY, "lbf": 4.4482216152605}),
    "voltage": ("V", {"V": 1.0, "mV": 1e-3, "uV": 1e-6, "µV": 1e-6}),
    "angle": ("rad", {"rad": 1.0, "mrad": 1e-3, "deg": math.pi / 180, "°": math.pi / 180}),
    "temperature": ("C", {"C": 1.0, "degC": 1.0, "°C": 1.0}),
    "count": ("counts", {"counts": 1.0, "count": 1.0, "LSB": 1.0}),
}
NO_UNIT = {"", "-", "1", "[]", "[-]"}
# What the last word of a column's name says.
SUFFIX = {"s": "time", "mm": "length", "N": "force", "V": "voltage", "rad": "angle",
          "deg": "angle", "C": "temperature"}


def find(name):
    """(dimension, factor to finray's unit of it) of a unit, or None."""
    name = name.strip().strip("[]()").strip()
    for dimension, (_, factors) in UNITS.items():
        if name in factors:
            return dimension, factors[name]
    return None


def names():
    return [name for _, factors in UNITS.values() for name in factors]


def dimension_of(target):
    """The dimension of a column of the vocabulary, by its last word, or None."""
    return SUFFIX.get(target.rsplit("_", 1)[-1])


def factor(unit, target):
    """(factor, '') or (None, why not) for readings in `unit` that become `target`."""
    found = find(unit)
    if found is None:
        return None, f"'{unit}' is not a unit{did_you_mean(unit, names())}"
    dimension, value = found
    wanted = dimension_of(target)
    if dimension == "count" and wanted == "voltage":
        return None, "counts need `bits` and `range_V: [low, high]`, or a `scale`"
    if dimension != wanted:
        return None, f"'{unit}' is a {dimension}, {target} is " + (
            f"a {wanted}" if wanted else "without a unit")
    if target.endswith("_deg"):  # degrees stay degrees, to the digit
        return (1.0 if unit in ("deg", "°") else value * 180 / math.pi), ""
    return value, ""
