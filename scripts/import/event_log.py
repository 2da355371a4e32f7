"""Logs of events: rows of several kinds one under the other, told apart by a column."""

import numpy as np

from errors import shown


def split(table, name):
    """One table for each word of column `name`, with the columns that its rows fill in."""
    kinds = table.column(name)
    if kinds is None:
        return [table]
    words = np.array([str(cell).strip() for cell in kinds.cells])
    tables = []
    for word in dict.fromkeys(words):
        rows = table.subset(words == word, f"{table.part}.{word}" if table.part else word)
        rows.columns = [c for c in rows.columns if c.name != name and not _is_empty(rows, c)]
        rows.notes.append(f"rows with {name} = {shown(word)}")
        tables.append(rows)
    return tables


def _is_empty(table, column):
    if column.is_text:
        return all(table.is_na(cell) for cell in column.cells)
    return column.cells.dtype.kind == "f" and bool(np.all(np.isnan(column.cells)))
