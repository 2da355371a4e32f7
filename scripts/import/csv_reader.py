"""CSV in any dialect, plain or gzipped."""

import gzip
import os
import zlib

import dialect as dialects
from errors import BadInput, shown
from limits import MOST_COLUMNS, Room

MOST_BYTES, MOST_LINE = 2 << 30, 16 << 20
MOST_SHARED = 100000  # cells of one text are one object, among so many
NAMES = {";": "';'", "\t": "tab", ",": "','", "|": "'|'", " ": "spaces"}


def _bytes(path):
    """The file, unpacked if it is gzipped."""
    if os.path.getsize(path) > MOST_BYTES:
        raise BadInput(f"{path}: larger than 2 GiB; split it")
    with open(path, "rb") as file:
        data = file.read()
    if data[:2] != b"\x1f\x8b":
        return data
    room = Room(path)
    try:
        with gzip.open(path, "rb") as file:
            data = file.read(min(MOST_BYTES, room.left) + 1)
    except EOFError as error:
        raise BadInput(f"{path}: the gzip file is cut: it ends before the end of its data; copy "
                       "it once more, or gunzip what is there") from error
    except (gzip.BadGzipFile, zlib.error) as error:
        raise BadInput(f"{path}: broken gzip: {shown(error)}") from error
    room.take(len(data))
    if len(data) > MOST_BYTES:
        raise BadInput(f"{path}: unpacks to more than 2 GiB; split it")
    return data


def _text(path):
    data = _bytes(path)
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


def _lines(path, text):
    """(lines, comments): (number from 1, text) of those that say something; comments are
    without their #."""
    lines, comments = [], []
    for number, line in enumerate(text.replace("\r\n", "\n").replace("\r", "\n").split("\n"), 1):
        if len(line) > MOST_LINE:
            raise BadInput(f"{path}:{number}: a line of more than 16 MiB")
        wide = len(line) > MOST_COLUMNS and max(map(line.count, dialects.DELIMITERS)) > MOST_COLUMNS
        if line.startswith("#"):
            if not wide:  # else it is no header
                comments.append((number, line.lstrip("# ")))
        elif wide:
            raise BadInput(f"{path}:{number}: a line of more than {MOST_COLUMNS} cells")
        elif line.strip():
            lines.append((number, line))
    return lines, comments


def _with_header(rows, comments, delimiter, mark):
    """The rows below the comment that is their header, as numpy.savetxt writes it, if their
    own first one holds data."""
    if not any(dialects.is_number(cell, mark) for cell in rows[0][1]):
        return rows
    above = [(n, dialects.cells_of(c, delimiter)) for n, c in comments if n < rows[0][0]]
    fits = above and len(above[-1][1]) == len(rows[0][1]) and \
        not any(dialects.is_number(cell, mark) for cell in above[-1][1])
    return [above[-1]] + rows if fits else rows


def _rows(lines, delimiter):
    """(number, cells) of lines, which it empties: both do not have to be in memory."""
    rows, shared = [], {}
    lines.reverse()
    while lines:
        number, line = lines.pop()
        if len(shared) > MOST_SHARED:
            shared.clear()
        rows.append((number, [shared.setdefault(c, c) for c in dialects.cells_of(line, delimiter)]))
    return rows


def read(path, settings):
    """[RawTable]; settings: what the mapping states of delimiter, decimal, header_line, ..."""
    text = _text(path)
    whole = text.endswith(("\n", "\r"))
    lines, comments = _lines(path, text)
    del text
    if not lines:
        raise BadInput(f"{path}: no rows")
    delimiter, mark = dialects.choose([line for _, line in lines], settings.get("delimiter"),
                                      settings.get("decimal"))
    rows = _rows(lines, delimiter)
    rows = _with_header(rows, comments, delimiter, mark)
    table = dialects.table_of(path, "", rows, mark, settings)
    table.delimiter = delimiter
    said = f"cells end at {NAMES.get(delimiter, delimiter)}"
    table.notes.insert(0, said + ("; decimal comma" if mark == "," else ""))
    if not whole:
        table.notes.append("warning: the last line has no line end, so its last cell may be cut")
    return [table]
