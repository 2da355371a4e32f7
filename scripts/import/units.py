"""Units by name: how a reading becomes one in finray's unit. The units and their factors are units.inc, and the
order of the arithmetic is that of libfinray/finray/io, so that digits agree."""

import os
import re

from errors import did_you_mean


class Unit:
    """value in V, N, mm, rad, s or deg C = reading * multiply / divide + shift."""

    def __init__(self, name, dimension, multiply=1.0, divide=1.0, shift=0.0):
        self.name, self.dimension = name, dimension
        self.multiply, self.divide, self.shift = multiply, divide, shift

    def apply(self, readings):
        if self.multiply == self.divide and not self.shift:
            return readings
        return readings * self.multiply / self.divide + self.shift


with open(os.path.join(os.path.dirname(os.path.abspath(__file__)), "units.inc"), encoding="utf-8") as _list:
    _LINES = _list.read()
UNITS = {name: Unit(name, dimension.lower(), float(multiply), float(divide), float(shift)) for name, dimension, multiply,
         divide, shift in re.findall(r"^FINRAY_UNIT\((\w+), k(\w+), (\S+), (\S+), (\S+)\)$", _LINES, re.M)}
FILE_WORDS = dict(re.findall(r"^FINRAY_FILE_WORD\((\w+), (\w+)\)$", _LINES, re.M))
COUNTS = {"counts", "count", "LSB"}
NO_UNIT = {"", "-", "1"}
# What the last word of a column's name says.
SUFFIX = {"s": "s", "mm": "mm", "N": "N", "V": "V", "rad": "rad", "deg": "deg", "C": "degC"}


def find(name):
    """The Unit of a name, or None."""
    for letter in "µμ":
        name = name.replace(letter, "u")
    name = re.sub(r"(?<=N)\s?[ .·⋅*-]\s?(?=[mc]?m)", "", name)  # N mm
    return UNITS.get(name.replace("°", "deg"))


def find_in_file(word):
    """The Unit that a file means by a word of its header, or None."""
    word = word.strip().strip("[]()").strip()
    return find(word) or UNITS.get(FILE_WORDS.get(word, ""))


def is_word_of_file(word):
    return find_in_file(word) is not None or word.strip("[]() ") in COUNTS


def of_column(target):
    """finray's Unit of a column of the vocabulary, or None."""
    return UNITS.get(SUFFIX.get(target.rsplit("_", 1)[-1], ""))


def conversion(unit, target):
    """The Unit that turns readings in `unit` into those of column `target`; degrees stay
    degrees. None if they measure different things."""
    own = of_column(target)
    if own is None or own.dimension != unit.dimension:
        return None
    return Unit(unit.name, unit.dimension, *(
        (1, 1) if unit.name == own.name else
        (unit.multiply * own.divide, unit.divide * own.multiply)), unit.shift)


def why_not(name, target):
    """Why readings in unit `name` cannot become `target`."""
    own = of_column(target)
    if own is None:
        return f"{target} has no unit, so '{name}' says nothing"
    names = [u.name for u in UNITS.values() if u.dimension == own.dimension]
    counts = ["{adc_bits, range_V}"] if own.dimension == "voltage" else []
    return f"{target} takes one of {', '.join(names + counts)}, found '{name}'" + \
        did_you_mean(name, names)


class Counts:
    """Counts of a converter: from 0, or of two's complement."""

    name = "counts"

    def __init__(self, bits, low_V, high_V, signed):
        self.bits, self.low_V, self.high_V, self.signed = bits, low_V, high_V, signed

    @property
    def least(self):
        return -2**(self.bits - 1) if self.signed else 0

    @property
    def most(self):
        return self.least + 2**self.bits - 1

    def apply(self, readings):
        span = self.high_V - self.low_V
        return readings * span / 2.0**self.bits + (
            self.low_V + span / 2 if self.signed else self.low_V)
