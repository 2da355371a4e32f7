"""Arrays by name become tables: those of one length go together."""

import numpy as np

from limits import MOST_COLUMNS
from raw_table import Column, RawTable


def vectors(name, array):
    """(name, 1-D array) of an array's columns; nothing of what is no table."""
    array = np.asarray(array)
    if array.dtype.names:
        for field in array.dtype.names:
            yield from vectors(f"{name}.{field}" if name else field, array[field])
        return
    if array.ndim == 2 and 1 in array.shape:
        array = array.ravel()
    if array.dtype.kind not in "fiubSUOM" or array.ndim not in (1, 2) or array.size < 2 or \
            array.shape[-1] > MOST_COLUMNS and array.ndim == 2:
        return
    if array.ndim == 1:
        yield name, array
    else:
        for i in range(array.shape[1]):
            yield f"{name}_{i + 1}", array[:, i]


def cells(array):
    """What a Column holds: floats, whole numbers as they are, or texts; None if neither."""
    if array.dtype.kind == "M":
        return [str(t) for t in np.datetime_as_string(array)]
    if array.dtype.kind in "iu":
        return array
    if array.dtype.kind in "fb":
        return array.astype(float)
    if array.dtype.kind == "S":
        return [t.decode("utf-8", "replace").strip("\0 ") for t in array]
    if array.dtype.kind in "UO" and all(isinstance(t, (str, bytes)) for t in array):
        return [t.decode("utf-8", "replace") if isinstance(t, bytes) else str(t) for t in array]
    return None


def tables(path, part, named, units=None):
    """RawTables of {name: array}; of several lengths each is a part of its own."""
    by_length, left_out = {}, []
    for name, array in named.items():
        found = [(n, cells(v)) for n, v in vectors(name, array)]
        found = [(n, c) for n, c in found if c is not None]
        if not found:
            left_out.append(name)
        for n, c in found:
            unit = (units or {}).get(name, "")
            by_length.setdefault(len(c), []).append(Column(n, c, unit))
    out = []
    for length, columns in by_length.items():
        own = part if len(by_length) == 1 else f"{part}.rows_{length}".lstrip(".")
        out.append(RawTable(path, own, columns))
    if out and left_out:
        out[0].notes.append("no vectors: " + ", ".join(left_out[:8]))
    return out
