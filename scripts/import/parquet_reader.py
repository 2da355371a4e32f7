"""Parquet through pandas and pyarrow."""

import os

os.environ.setdefault("ARROW_DEFAULT_MEMORY_POOL", "system")  # another one reserves more than it uses

import pandas
import pyarrow.parquet  # pandas reads Parquet with it; Debian 12 has no package of it

import arrays
from limits import Room

try:
    # Before 14.0.1 it unpickles, and so runs, what a file says of a column of this type.
    pyarrow.unregister_extension_type("arrow.py_extension_type")
except KeyError:  # a version that does not know it
    pass
pyarrow.set_cpu_count(1)


def read(path):
    said = pyarrow.parquet.ParquetFile(path).metadata
    # A column of equal values packs to nothing.
    Room(path).take(said.num_rows * said.num_columns * 8)
    frame = pandas.read_parquet(path, engine="pyarrow")
    return arrays.tables(path, "", {str(name): frame[name].to_numpy() for name in frame.columns})
