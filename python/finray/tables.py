"""Logs and results as columns."""

from __future__ import annotations

import importlib
import os
from typing import Any, Dict, Mapping, Union

import numpy as np
import numpy.typing as npt

from finray import _finray
from finray.description import Path, Scene
from finray.errors import InputError

Floats = npt.NDArray[np.float64]
#: The columns of a table: numbers as float64 arrays, text as arrays of str.
Columns = Dict[str, npt.NDArray[Any]]
#: A log: the path of a CSV, a pandas.DataFrame, a mapping from names to arrays, or a structured array.
Log = Union[Path, Mapping[str, npt.ArrayLike], "npt.NDArray[Any]", Any]


def is_path(log: Log) -> bool:
    return isinstance(log, (str, os.PathLike))


def table_of(log: Log, scene: Scene | None = None, name: str = "the log") -> _finray.Table:
    """The table of a log. Columns of float64 are not copied.

    >>> table_of({"time_s": [0.0, 0.1], "note": ["free"]})
    Traceback (most recent call last):
    finray.errors.InputError: the log: column 'note': expected 2 values, found 1
    >>> table_of(3.5)
    Traceback (most recent call last):
    finray.errors.InputError: the log: expected a path, a DataFrame, a mapping from names to arrays, or a structured array, found float
    """
    if isinstance(log, (str, os.PathLike)):
        return _finray.Table.read(os.fspath(log), (scene or Scene())._inside)
    if isinstance(log, np.ndarray) and log.dtype.names:
        return _finray.Table({column: log[column] for column in log.dtype.names}, name)
    if hasattr(log, "columns") and hasattr(log, "to_numpy"):
        frame: Any = log  # a DataFrame
        return _finray.Table({str(column): frame[column].to_numpy() for column in frame.columns}, name)
    if isinstance(log, Mapping):
        return _finray.Table({column: np.asarray(values) for column, values in log.items()}, name)
    raise InputError(f"{name}: expected a path, a DataFrame, a mapping from names to arrays, or a structured array, "
                     f"found {type(log).__name__}")


def columns_of(table: Mapping[str, Any]) -> Columns:
    """Columns as arrays, text too."""
    return {name: np.asarray(values) for name, values in table.items()}


def data_frame(columns: Mapping[str, Any]) -> Any:
    """A pandas.DataFrame of columns."""
    return importlib.import_module("pandas").DataFrame(dict(columns), copy=False)
