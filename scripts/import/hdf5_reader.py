"""HDF5: the datasets of a group are columns, groups are parts. An attribute `unit` or
`units` of a dataset is its unit."""

import h5py
import numpy as np

import arrays


def _unit(dataset):
    for key in ("unit", "units"):
        if key in dataset.attrs:
            value = dataset.attrs[key]
            return value.decode() if isinstance(value, bytes) else str(value)
    return ""


def _collect(group, part, found):
    for name, item in group.items():
        if name.startswith("#"):  # MATLAB's own
            continue
        if isinstance(item, h5py.Group):
            _collect(item, f"{part}/{name}".strip("/"), found)
        elif isinstance(item, h5py.Dataset) and item.ndim in (1, 2):
            # MATLAB stores a matrix by columns, HDF5 shows it transposed.
            matlab = "MATLAB_class" in item.attrs
            values = np.asarray(item[()].T if matlab else item[()])
            arrays_of, units = found.setdefault(part, ({}, {}))
            arrays_of["" if values.dtype.names else name] = values
            units[name] = _unit(item)


def read(path):
    found = {}
    with h5py.File(path, "r") as file:
        _collect(file, "", found)
    return [table for part, (named, units) in found.items()
            for table in arrays.tables(path, part, named, units)]
