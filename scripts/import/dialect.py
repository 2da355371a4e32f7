"""How a CSV is written: delimiter, decimal mark, preamble, header, row of units."""

import collections
import csv

import units
import vocabulary
from errors import BadInput, shown
from raw_table import NA_WORDS, NUMBER, Column, RawTable
from times import looks_like_time

DELIMITERS = [";", "\t", ",", "|", " "]
SAMPLE = 60  # lines
csv.field_size_limit(1 << 25)  # longer than any line that is read


def cells_of(line, delimiter):
    """The cells of a line, with quotes taken off."""
    if delimiter == " ":
        return line.split()
    cells = next(csv.reader([line], delimiter=delimiter, skipinitialspace=True)) \
        if '"' in line else line.split(delimiter)
    return [cell.strip() for cell in cells]


def is_number(cell, decimal):
    if decimal == ",":
        return "." not in cell and NUMBER.fullmatch(cell.replace(",", ".")) is not None
    return NUMBER.fullmatch(cell) is not None


def is_datum(cell, decimal):
    return is_number(cell, decimal) or cell.lower() in NA_WORDS or looks_like_time(cell)


def _score(lines, delimiter, decimal):
    """(share of cells that are data in lines of one length, cells a line)."""
    split = [cells_of(line, delimiter) for line in lines]
    counts = collections.Counter(map(len, split))
    width = counts.most_common(1)[0][0]
    cells = [cell for row in split for cell in row]
    data = sum(is_datum(cell, decimal) for cell in cells)
    if not any(is_number(cell, decimal) or looks_like_time(cell) for cell in cells):
        data = 0
    share = counts[width] / len(lines) * data / len(cells)
    return round(share, 1), 0 if delimiter == " " and width == 1 else width


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


def choose(texts, delimiter=None, decimal=None):
    """(delimiter, decimal mark) of lines; what is stated holds."""
    tail = texts[len(texts) // 2:]
    return _delimiter(tail[::max(1, len(tail) // SAMPLE)], delimiter, decimal)


def _is_units(cells, header, mapped):
    """Whether cells below the cells of a header are its row of units, as frame_parser.cc has it:
    one is a unit, and those of columns that have a meaning may be unknown words, no numbers.
    mapped: headers of the mapping. Without a column that has a meaning half of the words are
    units."""
    def means(name):
        return name in mapped or vocabulary.guess(name, "") is not None

    known = [units.is_word_of_file(c) for c in cells]
    words = sum(c.strip("[]()") not in units.NO_UNIT for c in cells)
    if len(cells) != len(header) or not any(known) or \
            any(NUMBER.fullmatch(c.replace(",", ".")) and c != "1" or means(c) for c in cells):
        return False
    return any(map(means, header)) or 2 * sum(known) >= words


def _layout(path, rows, mark, settings):
    """Indices of the header (or None), the row of units (or None) and the first row of data."""
    header_line, units_row = settings.get("header_line"), settings.get("units_row")
    mapped = settings.get("mapped") or ()

    def has_units(i):
        """Whether row i is the row of units of the row above."""
        return units_row is not False and 0 < i < len(rows) and (
            bool(units_row) or _is_units(rows[i][1], rows[i - 1][1], mapped))

    if header_line is not None:
        header = next((i for i, (line, _) in enumerate(rows) if line == header_line), None)
        below = 1 if header is not None and has_units(header + 1) else 0
        if header is None or header + 1 + below >= len(rows):
            raise BadInput(f"{path}: header_line {header_line} of the mapping has no rows below it")
        return header, header + 1 if below else None, header + 1 + below
    # The preamble may be longer than the data, but few lines of it are in the second half.
    widths = collections.Counter(len(cells) for _, cells in rows)
    late = collections.Counter(len(cells) for _, cells in rows[len(rows) // 2:])
    width = max(late, key=lambda w: (late[w], widths[w]))

    def is_data(i):
        cells = rows[i][1]
        return len(cells) == width and any(
            is_number(c, mark) or looks_like_time(c) for c in cells) and \
            sum(is_datum(c, mark) for c in cells) * 2 >= width and \
            not (i and _is_units(cells, rows[i - 1][1], mapped))

    first = next((i for i in range(len(rows)) if is_data(i)), None)
    if first is None:
        raise BadInput(f"{path}: no rows of numbers found; state delimiter, decimal and "
                       "header_line in the mapping if it is a table")
    header = first - 1 if first > 0 and len(rows[first - 1][1]) == width else None
    found = header and len(rows[header - 1][1]) == width and has_units(header)
    return (header - 1, header, first) if found else (header, None, first)


def _told_apart(names):
    """(names, new ones): the second Time is Time.2."""
    out, new, seen = [], [], collections.Counter()
    for name in names:
        seen[name] += 1
        out.append(f"{name}.{seen[name]}" if name and seen[name] > 1 else name)
        if out[-1] != name:
            new.append(shown(out[-1], 20))
    return out, new[:8]


def table_of(path, part, rows, mark, settings=None):
    """RawTable of (line, cells) rows with preamble, header and row of units, if any.

    settings: header_line, units_row, not_measured of the mapping, where it states them, and
    mapped, the headers that it names.
    """
    settings = settings or {}
    header, units_row, first = _layout(path, rows, mark, settings)
    width = len(rows[first][1])
    if header is None:
        names, unit_of = [f"column_{i + 1}" for i in range(width)], [""] * width
    else:
        names = rows[header][1]
        unit_of = [vocabulary.split_unit(cell)[1] for cell in names]
        if units_row is not None:
            unit_of = [c.strip("[]()") or own for c, own in zip(rows[units_row][1], unit_of)]
        names, twice = _told_apart(names)
    for number, cells in rows[first:]:
        if len(cells) != width:
            raise BadInput(f"{path}:{number}: expected {width} cells, found {len(cells)}")
    by_column = zip(*(cells for _, cells in rows[first:]))
    # A column without a name is empty, as behind a delimiter at the end of every line.
    columns = [Column(n, list(c), u) for n, c, u in zip(names, by_column, unit_of) if n]
    table = RawTable(path, part, columns, mark, settings.get("not_measured") or (),
 [number for number, _ in rows[first:]])
    top = header if header is not None else first
    if top:
        table.notes.append(f"{top} preamble line{'s' if top > 1 else ''}")
    if units_row is not None:
        table.notes.append(f"units in line {rows[units_row][0]}")
    if header is not None and twice:
        table.notes.append(f"columns of one name are {', '.join(twice)}")
    if header is None:
        table.notes.append("no header: columns are column_1, column_2, ...")
    return table
