"""Which reader a file is for: by its first bytes, else by its name."""

import importlib
import os

import csv_reader
import event_log
import isolated
import limits
import mapping_file
from errors import BadInput, shown

INSTALL = "scripts/install_dependencies import"
# name of the format, its reader, where what the reader needs comes from.
FORMATS = {
    "hdf5": ("an HDF5 file", "hdf5_reader", INSTALL),
    "mat": ("a MAT file", "mat_reader", INSTALL),
    "npz": ("an NPZ file", "npz_reader", INSTALL),
    "xlsx": ("an XLSX file", "xlsx_reader", INSTALL),
    "parquet": ("a Parquet file", "parquet_reader",
                "pandas and pyarrow, of which Debian 12 has no package"),
    "ros1": ("a ROS 1 bag", "ros1_reader", INSTALL),
    "ros2": ("a ROS 2 bag", "ros2_reader", INSTALL),
    "mcap": ("an MCAP file", "mcap_reader", INSTALL),
}
BY_NAME = {".mat": "mat", ".h5": "hdf5", ".hdf5": "hdf5", ".hdf": "hdf5", ".npz": "npz",
           ".xlsx": "xlsx", ".xlsm": "xlsx", ".parquet": "parquet", ".bag": "ros1",
           ".db3": "ros2", ".mcap": "mcap"}
YAML = (".yaml", ".yml")
BY_BYTES = [(b"#ROSBAG V", "ros1"), (b"SQLite format 3\0", "ros2"), (b"\x89MCAP0\r\n", "mcap"),
            (b"PAR1", "parquet"), (b"MATLAB", "mat"), (b"\x89HDF\r\n\x1a\n", "hdf5")]


def format_of(path):
    """A key of FORMATS, or None for text."""
    with open(path, "rb") as file:
        start = file.read(16)
    for magic, form in BY_BYTES:
        if start.startswith(magic):
            return form
    return BY_NAME.get(os.path.splitext(path)[1].lower())


def read(path, mapping):
    """The tables of a file. Whatever a library says of a broken file becomes one line."""
    name = os.path.basename(path)
    settings = {key: mapping.setting(name, key) for key in mapping_file.FORMAT_KEYS}
    settings["mapped"] = mapping.headers(name)
    try:
        if not os.path.exists(path):
            raise BadInput(f"{path}: there is no such file")
        if not os.path.isfile(path):
            raise BadInput(f"{path}: is not a file; a ROS 2 bag is the .db3 or .mcap in its "
                           "folder")
        if name.lower().endswith(YAML):
            raise BadInput(f"{path}: is a YAML file, expected a recording; --mapping takes a "
                           "mapping")
        form = format_of(path)
        if form is None:
            tables = csv_reader.read(path, settings)
        else:
            tables = _read_binary(path, form)
    except OSError as error:
        raise BadInput(f"{path}: cannot be read: {error.strerror or shown(error)}") from error
    except (MemoryError, limits.TooLong) as error:
        limit = "memory" if isinstance(error, MemoryError) else "time"
        raise BadInput(f"{path}: {limits.why(limit)}") from error
    tables = [table for table in tables if table.rows]
    if not tables:
        raise BadInput(f"{path}: has no rows of numbers")
    kind = mapping.setting(name, "row_type") or "row_type"
    return [part for table in tables for part in event_log.split(table, kind)]


def _read_binary(path, form):
    words, module, source = FORMATS[form]
    try:
        return isolated.call(importlib.import_module(module).read, path, os.path.getsize(path))
    except (BadInput, MemoryError):
        raise
    except ImportError as error:  # some packages are for compressed chunks alone
        raise BadInput(f"{path}: {words} needs a package that is not installed "
                       f"({shown(error)}): {source}") from error
    except Exception as error:  # libraries raise whatever comes on broken files
        said = shown(" ".join(str(error).split()) or type(error).__name__, 100)
        raise BadInput(f"{path}: broken or cut: not readable as {words}: {said}") from error
