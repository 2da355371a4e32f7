"""What a reader returns: columns as the file has them, with names and units.

A file is one table, or several: sheets, topics, groups. Cells are text, as of a CSV, or
numbers, as of a binary file. Text becomes numbers only where a mapping uses the column.
"""

import re

import numpy as np

from errors import BadInput, shown

# In any case of letters; those of libfinray/finray/io/column_mapping.cc.
NA_WORDS = {"", "-", "--", "---", "?", "na", "n/a", "#n/a", "#nv", "null", "none", "missing",
            "nan", "+nan", "-nan"}
NUMBER = re.compile(r"[+-]?(\d+(\.\d*)?|\.\d+)([eE][+-]?\d+)?")


class Column:
    """name, unit ('' if the file has none), and cells: a list of texts or a float array."""

    def __init__(self, name, cells, unit=""):
        self.name, self.cells, self.unit = name, cells, unit

    @property
    def is_text(self):
        return isinstance(self.cells, list)


class RawTable:
    """columns: Column in order, all of the same length; lines: the line of each row of a text
    file; delimiter: of a CSV; notes: what to tell the user of how it was read; headers: names of
    all columns in the file, where rows of other kinds had more."""

    def __init__(self, path, part, columns, decimal=".", not_measured=(), lines=None):
        self.path, self.part, self.columns = path, part, columns
        self.decimal, self.lines, self.delimiter = decimal, lines, None
        self.not_measured = tuple(not_measured)
        self.notes, self.headers = [], [c.name for c in columns]

    @property
    def name(self):
        """The table as a mapping names it: the file, and its part behind a colon."""
        file = self.path.replace("\\", "/").rsplit("/", 1)[-1]
        return f"{file}:{self.part}" if self.part else file

    @property
    def rows(self):
        return len(self.columns[0].cells) if self.columns else 0

    def column(self, name):
        return next((c for c in self.columns if c.name == name), None)

    def where(self, row):
        if self.lines is not None:
            return f"{self.path}:{self.lines[row]}"
        part = f" {self.part}" if self.part else ""
        return f"{self.path}{part}: row {row + 1}"

    def is_na(self, text):
        return text.strip() in self.not_measured or text.strip().lower() in NA_WORDS

    def numbers(self, column):
        """The column as floats, NaN where nothing was measured."""
        if not column.is_text:
            values = np.asarray(column.cells, dtype=float)
            infinite = np.flatnonzero(np.isinf(values))
            if len(infinite):
                raise BadInput(f"{self.where(infinite[0])}: column '{shown(column.name)}': "
                               f"expected a finite number, found {values[infinite[0]]}")
            return values
        out = np.empty(len(column.cells))
        comma = self.decimal == ","
        for i, text in enumerate(column.cells):
            text = text.strip()
            plain = text.replace(",", ".") if comma and "." not in text else text
            if text in self.not_measured:  # it may be a number: -9999
                out[i] = np.nan
                continue
            if NUMBER.fullmatch(plain) and not (comma and "." in text):
                out[i] = float(plain)
                if np.isfinite(out[i]):
                    continue
            elif self.is_na(text):
                out[i] = np.nan
                continue
            raise BadInput(f"{self.where(i)}: column '{shown(column.name)}': expected a number"
                           f"{' with a decimal comma' if comma else ''}, found '{shown(text)}'")
        return out

    def subset(self, keep, part):
        """The rows of a boolean array as a table of their own."""
        at = np.flatnonzero(keep)
        columns = [Column(c.name, [c.cells[i] for i in at] if c.is_text else c.cells[at], c.unit)
                   for c in self.columns]
        out = RawTable(self.path, part, columns, self.decimal, self.not_measured,
                       [self.lines[i] for i in at] if self.lines else None)
        out.notes, out.delimiter, out.headers = list(self.notes), self.delimiter, self.headers
        return out
