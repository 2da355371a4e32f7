"""CSV in any dialect, plain or gzipped."""

import gzip
import zlib

import dialect as dialects
from errors import BadInput, shown
from raw_table import Column, RawTable
from vocabulary import split_unit

NAMES = {";": "';'", "\t": "tab", ",": "','", "|": "'|'", " ": "spaces"}


def _text(path):
    with open(path, "rb") as file:
        data = file.read()
    if data[:2] == b"\x1f\x8b":
        try:
            data = gzip.decompress(data)
        except (OSError, EOFError, zlib.error) as error:
            raise BadInput(f"{path}: broken gzip: {shown(error)}") from error
    if data[:2] in (b"\xff\xfe", b"\xfe\xff"):
        encodings = ["utf-16"]
    else:
        encodings = ["utf-8-sig", "latin-1"]
    for encoding in encodings:
        try:
            text = data.decode(encoding)
            break
        except UnicodeDecodeError:
            continue
    else:
        raise BadInput(f"{path}: broken UTF-16")
    if "\0" in text:
        line = text[:text.index("\0")].count("\n") + 1
        raise BadInput(f"{path}:{line}: a NUL byte: this is not a text file")
    return text


def _lines(text):
    """(number from 1, text) of the lines that say something."""
    for number, line in enumerate(text.replace("\r\n", "\n").replace("\r", "\n").split("\n"), 1):
        if line.strip() and not line.startswith("#"):
            yield number, line


def read(path, settings):
    """[RawTable]; settings: delimiter, decimal, na_words of the mapping, each optional."""
    text = _text(path)
    lines = list(_lines(text))
    if not lines:
        raise BadInput(f"{path}: no rows")
    found = dialects.detect(path, lines, settings.get("delimiter"), settings.get("decimal"))
    split = [(number, dialects.cells_of(line, found.delimiter)) for number, line in lines]
    width = len(split[found.first][1])
    if found.header is None:
        names, units = [f"column_{i + 1}" for i in range(width)], [""] * width
    else:
        named = [split_unit(cell) for cell in split[found.header][1]]
        names = split[found.header][1]
        units = [unit for _, unit in named]
        if found.units_row is not None:
            units = [c.strip("[]()") for c in split[found.units_row][1]]
    if len(set(names)) < len(names):
        twice = next(n for n in names if names.count(n) > 1)
        raise BadInput(f"{path}:{split[found.header][0]}: two columns are named '{shown(twice)}'")
    rows = split[found.first:]
    for number, cells in rows:
        if len(cells) != width:
            raise BadInput(f"{path}:{number}: expected {width} cells, found {len(cells)}")
    by_column = zip(*(cells for _, cells in rows))
    columns = [Column(n, list(cells), u) for n, cells, u in zip(names, by_column, units)]
    table = RawTable(path, "", columns, rows[0][0], found.decimal,
                     settings.get("na_words") or (), [number for number, _ in rows])
    table.dialect = found
    _note(table, text, lines, found)
    return [table]


def _note(table, text, lines, found):
    said = [f"cells end at {NAMES.get(found.delimiter, found.delimiter)}"]
    if found.decimal == ",":
        said.append("decimal comma")
    top = found.header if found.header is not None else found.first
    if top:
        said.append(f"{top} preamble line{'s' if top > 1 else ''}")
    if found.units_row is not None:
        said.append(f"units in line {lines[found.units_row][0]}")
    if found.header is None:
        said.append("no header: columns are column_1, column_2, ...")
    table.notes.append("; ".join(said))
    if not text.endswith(("\n", "\r")):
        table.notes.append("warning: the last line has no line end, so its last cell may be cut")
