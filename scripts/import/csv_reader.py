"""CSV in any dialect, plain or gzipped."""

import gzip
import zlib

import dialect as dialects
from errors import BadInput, shown

MOST_BYTES, MOST_LINE, MOST_CELLS = 2 << 30, 16 << 20, 10000
NAMES = {";": "';'", "\t": "tab", ",": "','", "|": "'|'", " ": "spaces"}


def _bytes(path):
    """The file, unpacked if it is gzipped."""
    with open(path, "rb") as file:
        packed = file.read(2) == b"\x1f\x8b"
    try:
        with (gzip.open if packed else open)(path, "rb") as file:
            data = file.read(MOST_BYTES + 1)
    except EOFError as error:
        raise BadInput(f"{path}: the gzip file is cut: it ends before the end of its data; copy "
                       "it once more, or gunzip what is there") from error
    except (gzip.BadGzipFile, zlib.error) as error:
        raise BadInput(f"{path}: broken gzip: {shown(error)}") from error
    if len(data) > MOST_BYTES:
        raise BadInput(f"{path}: larger than 2 GiB; split it")
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
        if len(line) > MOST_CELLS and max(map(line.count, dialects.DELIMITERS)) > MOST_CELLS:
            raise BadInput(f"{path}:{number}: a line of more than {MOST_CELLS} cells")
        if line.startswith("#"):
            comments.append((number, line.lstrip("# ")))
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


def read(path, settings):
    """[RawTable]; settings: what the mapping states of delimiter, decimal, header_line, ..."""
    text = _text(path)
    lines, comments = _lines(path, text)
    if not lines:
        raise BadInput(f"{path}: no rows")
    delimiter, mark = dialects.choose([line for _, line in lines], settings.get("delimiter"),
                                      settings.get("decimal"))
    rows = [(number, dialects.cells_of(line, delimiter)) for number, line in lines]
    rows = _with_header(rows, comments, delimiter, mark)
    table = dialects.table_of(path, "", rows, mark, settings)
    table.delimiter = delimiter
    said = f"cells end at {NAMES.get(delimiter, delimiter)}"
    table.notes.insert(0, said + ("; decimal comma" if mark == "," else ""))
    if not text.endswith(("\n", "\r")):
        table.notes.append("warning: the last line has no line end, so its last cell may be cut")
    return [table]
