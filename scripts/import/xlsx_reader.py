"""XLSX: every sheet with rows of numbers is a table."""

import datetime

import openpyxl

import dialect as dialects
import limits
from errors import BadInput, shown
from limits import MOST_COLUMNS


def _text(value):
    if value is None:
        return ""
    if isinstance(value, datetime.datetime):
        return value.isoformat()
    return repr(value) if isinstance(value, float) else str(value).strip()


def _rows(sheet, path):
    """(number, cells) of rows that hold something, all of one length."""
    sheet.reset_dimensions()  # what the file says of them may be of any size
    rows, width = [], 0
    for number, row in enumerate(sheet.iter_rows(values_only=True), 1):
        filled = max((i for i, value in enumerate(row, 1) if _text(value)), default=0)
        if filled > MOST_COLUMNS:
            raise BadInput(f"{path}: row {number} of '{shown(sheet.title)}' has more than {MOST_COLUMNS} cells")
        if filled:
            rows.append((number, [_text(value) for value in row[:filled]]))
            width = max(width, filled)
    for _, cells in rows:
        cells += [""] * (width - len(cells))
    return rows


def read(path):
    limits.refuse_large_zip(path)
    book = openpyxl.load_workbook(path, read_only=True, data_only=True)
    tables, faults = [], []
    for sheet in book.worksheets:
        rows = _rows(sheet, path)
        if not rows:
            continue
        part = sheet.title if len(book.worksheets) > 1 else ""
        try:
            tables.append(dialects.table_of(path, part, rows, "."))
        except BadInput as error:
            faults.append(error)
    book.close()
    if not tables and faults:
        raise faults[0]
    return tables
