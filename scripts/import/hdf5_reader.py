"""HDF5: the datasets of a group are columns, groups are parts. An attribute `unit` or
`units` of a dataset is its unit."""

import h5py
import numpy as np

import arrays
from limits import Room


def _unit(dataset):
    for key in ("unit", "units"):
        if key in dataset.attrs:
            value = dataset.attrs[key]
            return value.decode() if isinstance(value, bytes) else str(value)
    return ""


class _Found:
    """{part: ({name: array}, {name: unit})} of a file."""

    def __init__(self, path):
        self.parts, self.seen, self.room = {}, set(), Room(path)

    def collect(self, group, part):
        for name, item in group.items():
            place = h5py.h5o.get_info(item.id)
            if name.startswith("#") or (place.fileno, place.addr) in self.seen:  # MATLAB's own; a link
                continue
            if isinstance(item, h5py.Group):
                self.seen.add((place.fileno, place.addr))
                self.collect(item, f"{part}/{name}".strip("/"))
            elif isinstance(item, h5py.Dataset) and item.ndim in (1, 2):
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
        found.collect(file, "")
    return [table for part, (named, units) in found.parts.items()
            for table in arrays.tables(path, part, named, units)]
