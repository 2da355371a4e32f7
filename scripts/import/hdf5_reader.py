"""HDF5: the datasets of a group are columns, groups are parts. An attribute `unit` or
`units` of a dataset is its unit. A file may name others, whose bytes are its readings; those
are never opened, and a note says what is left out."""

import h5py
import numpy as np

import arrays
from errors import BadInput, shown
from limits import Room

MOST_LINKS = 8  # of links that lead to links
MOST_SAID = 8


def _unit(dataset):
    for key in ("unit", "units"):
        if key in dataset.attrs:
            value = dataset.attrs[key]
            return value.decode() if isinstance(value, bytes) else str(value)
    return ""


def _item(group, path, left=MOST_LINKS):
    """What a path within the file leads to, or None. h5py follows links to other files even where
    it is asked for the link alone."""
    for name in path.split(b"/"):
        if name in (b"", b"."):
            continue
        if not isinstance(group, h5py.Group) or not group.id.links.exists(name):
            return None
        kind = group.id.links.get_info(name).type
        if kind == h5py.h5l.TYPE_HARD:
            group = group[name]
        elif kind == h5py.h5l.TYPE_SOFT and left > 0:
            target = group.id.links.get_val(name)
            group = _item(group.file["/"] if target.startswith(b"/") else group, target, left - 1)
        else:
            return None
    return group


class _Found:
    """{part: ({name: array}, {name: unit})} of a file, and what is left out."""

    def __init__(self, path):
        self.parts, self.seen, self.room, self.left_out = {}, set(), Room(path), []

    def collect(self, group, part):
        self.seen.add(h5py.h5o.get_info(group.id).addr)
        for name in group:
            if name.startswith("#"):  # MATLAB's own
                continue
            item = _item(group, name.encode("utf-8", "surrogateescape"))
            if item is None:
                self.left_out.append(f"{shown(name)} is a link to another file or to nothing")
            elif isinstance(item, h5py.Group):
                if h5py.h5o.get_info(item.id).addr not in self.seen:  # else a link
                    self.collect(item, f"{part}/{name}".strip("/"))
            elif isinstance(item, h5py.Dataset) and item.ndim in (1, 2):
                if item.external or item.is_virtual:
                    self.left_out.append(f"the readings of {shown(name)} are in another file")
                    continue
                self.room.take(item.size * item.dtype.itemsize)
                # MATLAB stores a matrix by columns, HDF5 shows it transposed.
                matlab = "MATLAB_class" in item.attrs
                values = np.asarray(item[()].T if matlab else item[()])
                arrays_of, units = self.parts.setdefault(part, ({}, {}))
                arrays_of["" if values.dtype.names else name] = values
                units[name] = _unit(item)


def read(path):
    found = _Found(path)
    with h5py.File(path, "r") as file:
        found.collect(file["/"], "")
    tables = [table for part, (named, units) in found.parts.items()
              for table in arrays.tables(path, part, named, units)]
    left_out = "; ".join(found.left_out[:MOST_SAID])
    if left_out and not tables:
        raise BadInput(f"{path}: no readings: {left_out}")
    if left_out:
        tables[0].notes.append(f"warning: left out: {left_out}")
    return tables
