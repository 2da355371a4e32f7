"""XLSX: every sheet with rows of numbers is a table."""

import datetime

import openpyxl

import dialect as dialects
from errors import BadInput


def _text(value):
    if value is None:
        return ""
    if isinstance(value, datetime.datetime):
        return value.isoformat()
    return repr(value) if isinstance(value, float) else str(value).strip()


def read(path):
    book = openpyxl.load_workbook(path, read_only=True, data_only=True)
    tables, faults = [], []
    for sheet in book.worksheets:
        rows = [(number, [_text(v) for v in row])
                for number, row in enumerate(sheet.iter_rows(values_only=True), 1)]
        rows = [(number, cells) for number, cells in rows if any(cells)]
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
