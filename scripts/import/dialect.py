"""How a CSV is written: delimiter, decimal mark, preamble, header, row of units."""

import collections

import units
from errors import BadInput
from raw_table import NA_WORDS, NUMBER
from times import looks_iso

DELIMITERS = [";", "\t", ",", "|", " "]
SAMPLE = 60  # lines


class Dialect:
    """delimiter, decimal; header and units: indices of lines or None; first: of the data."""

    def __init__(self, delimiter, decimal, header, units_row, first):
        self.delimiter, self.decimal = delimiter, decimal
        self.header, self.units_row, self.first = header, units_row, first


def cells_of(line, delimiter):
    """The cells of a line, quotes taken off; doubled quotes inside are one."""
    if delimiter == " ":
        return line.split()
    if '"' not in line:
        return [cell.strip() for cell in line.split(delimiter)]
    cells, cell, quoted, i = [], [], False, 0
    while i < len(line):
        c = line[i]
        if quoted and line[i:i + 2] == '""':
            cell.append('"')
            i += 1
        elif c == '"':
            quoted = not quoted
        elif c == delimiter and not quoted:
            cells.append("".join(cell).strip())
            cell = []
        else:
            cell.append(c)
        i += 1
    return cells + ["".join(cell).strip()]


def is_number(cell, decimal):
    if decimal == ",":
        return "." not in cell and NUMBER.fullmatch(cell.replace(",", ".")) is not None
    return NUMBER.fullmatch(cell) is not None


def is_datum(cell, decimal):
    return is_number(cell, decimal) or cell.lower() in NA_WORDS or looks_iso(cell)


def _score(lines, delimiter, decimal):
    """(share of cells that are data, cells a line) of lines of the data."""
    counts = collections.Counter(len(cells_of(line, delimiter)) for line in lines)
    width = counts.most_common(1)[0][0]
    cells = [cell for line in lines for cell in cells_of(line, delimiter)]
    data = sum(is_datum(cell, decimal) for cell in cells)
    numbers = any(is_number(cell, decimal) or looks_iso(cell) for cell in cells)
    return (round(counts[width] / len(lines), 1), round(data / len(cells), 1) if numbers else 0,
            width if delimiter != " " or width > 1 else 0)


def _delimiter(lines, delimiter, decimal):
    """The pair of delimiter and decimal mark by which the data read best."""
    best, chosen = None, (",", ".")
    for d in [delimiter] if delimiter else DELIMITERS:
        for mark in [decimal] if decimal else [".", ","]:
            if d == mark:
                continue
            score = _score(lines, d, mark)
            if best is None or score > best:
                best, chosen = score, (d, mark)
    return chosen


def detect(path, lines, delimiter=None, decimal=None):
    """The dialect of (number, text) lines; a delimiter or decimal mark that is stated holds."""
    texts = [text for _, text in lines]
    tail = texts[len(texts) // 2:]
    step = max(1, len(tail) // SAMPLE)
    delimiter, mark = _delimiter(tail[::step], delimiter, decimal)
    width = collections.Counter(len(cells_of(t, delimiter)) for t in tail[::step])
    width = width.most_common(1)[0][0]

    def is_data(text):
        cells = cells_of(text, delimiter)
        return len(cells) == width and any(
            is_number(c, mark) or looks_iso(c) for c in cells) and \
            sum(is_datum(c, mark) for c in cells) * 2 >= width and not _is_units(cells, mark)

    # The data begin behind the last line that can only be a header or a preamble.
    first = next((i for i, t in enumerate(texts) if is_data(t)), None)
    if first is None:
        raise BadInput(f"{path}: no rows of numbers found; state `delimiter` and `decimal` in the "
                       "mapping if it is a table")
    before = [i for i in range(first) if len(cells_of(texts[i], delimiter)) == width]
    header = units_row = None
    if before and before[-1] == first - 1:
        header = before[-1]
        if _is_units(cells_of(texts[header], delimiter), mark) and len(before) > 1 and \
                before[-2] == header - 1:
            units_row, header = header, before[-2]
    return Dialect(delimiter, mark, header, units_row, first)


def _is_units(cells, mark):
    """Whether all cells are units or nothing, and one is a unit."""
    known = [units.find(c) is not None for c in cells]
    return any(known) and all(k or c in units.NO_UNIT for k, c in zip(known, cells))
