"""CSV in any dialect, plain or gzipped."""

import gzip
import zlib

import dialect as dialects
from errors import BadInput, shown

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
    """[RawTable]; settings: what the mapping states of delimiter, decimal, header_line, ..."""
    text = _text(path)
    lines = list(_lines(text))
    if not lines:
        raise BadInput(f"{path}: no rows")
    delimiter, mark = dialects.choose([line for _, line in lines], settings.get("delimiter"),
                                      settings.get("decimal"))
    rows = [(number, dialects.cells_of(line, delimiter)) for number, line in lines]
    table = dialects.table_of(path, "", rows, mark, settings)
    table.delimiter = delimiter
    said = f"cells end at {NAMES.get(delimiter, delimiter)}"
    table.notes.insert(0, said + ("; decimal comma" if mark == "," else ""))
    if not text.endswith(("\n", "\r")):
        table.notes.append("warning: the last line has no line end, so its last cell may be cut")
    return [table]
