"""Logs and results as columns."""

from __future__ import annotations

import decimal
import importlib
import numbers
import os
from typing import Any, Dict, Iterable, List, Mapping, Tuple, Union

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


def _is_missing(value: Any) -> bool:
    return value is None or value is np.ma.masked or type(value).__name__ in ("NAType", "NaTType") or (
        isinstance(value, (float, np.datetime64, np.timedelta64)) and value != value)


def _of_objects(name: str, array: Any) -> Union[Floats, None]:
    """The doubles of objects that are real numbers or missing; None if one is neither."""
    real = (numbers.Real, np.bool_, decimal.Decimal)
    if not all(_is_missing(value) or isinstance(value, real) for value in array):
        return None
    try:
        return np.array([np.nan if _is_missing(value) else float(value) for value in array])
    except (OverflowError, ValueError):  # a signaling NaN, too
        raise InputError(f"column '{name}': expected numbers that a double holds") from None


def _numbers(name: str, values: Any) -> Union[Floats, None]:
    """The doubles of values, NaN where they are masked or missing; None if they are no numbers."""
    dtype: Any = getattr(values, "dtype", None)
    if hasattr(dtype, "kind") and not isinstance(dtype, np.dtype):  # an extension type of pandas
        if dtype.kind in "fiub":
            values = values.to_numpy(dtype=np.float64, na_value=np.nan)
    try:
        array: Any = values if isinstance(values, np.ma.MaskedArray) else np.asarray(values)
    except Exception as error:  # whatever __array__ of another library raises
        raise InputError(f"column '{name}': expected an array of numbers or text: {error}") from None
    if array.ndim != 1:
        raise InputError(f"column '{name}': expected a one-dimensional array, found one with {array.ndim} dimensions")
    if array.dtype.kind in "cV":
        raise InputError(f"column '{name}': expected real numbers or text, found {array.dtype}")
    if array.dtype.kind == "O":
        return _of_objects(name, array)
    if array.dtype.kind not in "fiub":
        return None
    if isinstance(array, np.ma.MaskedArray):
        masked: Any = array.astype(np.float64)
        return np.asarray(masked.filled(np.nan))
    # A table reads whole doubles: steps of other sizes, odd addresses and other types are copied.
    if array.dtype == np.float64 and array.flags.aligned and array.strides[0] % array.itemsize == 0:
        return np.asarray(array)
    return np.array(array, dtype=np.float64)


def floats_of(name: str, values: Any) -> Floats:
    """The doubles of an array-like of real numbers: what numpy.asarray(values, float64) holds, and NaN for what is masked
    or missing. Arrays of float64 are not copied where a table can read them in place.

    >>> floats_of("gauges_V", np.ma.masked_invalid([1, float("inf")]))
    array([ 1., nan])
    >>> floats_of("gauges_V", [1j])
    Traceback (most recent call last):
    finray.errors.InputError: column 'gauges_V': expected real numbers or text, found complex128
    """
    found = _numbers(name, values)
    if found is None:
        raise InputError(f"column '{name}': expected numbers, found text")
    return found


def _utf8(text: str) -> str:
    """The text without halves of surrogate pairs, which are no UTF-8."""
    return text.encode("utf-8", "replace").decode("utf-8")


def _column(name: str, values: Any) -> Union[Floats, List[str]]:
    found = _numbers(name, values)
    if found is not None:
        return found
    texts = np.char.decode(values, "utf-8", "replace") if np.asarray(values).dtype.kind == "S" else values
    return ["" if _is_missing(value) else _utf8(str(value)) for value in texts]


def _holds_numbers(name: str) -> bool:
    """Whether the library knows a column of this name as one of numbers."""
    try:
        _finray.Table({name: ["text"]}, "")
    except InputError:
        return True
    return False


def _table(columns: Iterable[Tuple[Any, Any]], name: str) -> _finray.Table:
    table: dict[str, Any] = {}
    told = {}  # what a column of text was
    for key, values in columns:
        column = _utf8(str(key))
        if column in told:
            raise InputError(f"{name}: two columns '{column}'")
        told[column] = getattr(values, "dtype", None)
        try:
            table[column] = _column(column, values)
        except InputError as error:
            if _holds_numbers(column):  # else nobody uses it, and it is left out
                raise InputError(f"{name}: {error}") from None
    try:
        return _finray.Table(table, name)
    except InputError as error:
        for column, dtype in told.items():
            if dtype is not None and f"'{column}' of the frame table" in str(error):
                raise InputError(f"{error} (dtype {dtype})") from None
        raise


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
        array: Any = log
        return _table(((column, array[column]) for column in log.dtype.names), name)
    if hasattr(log, "columns") and hasattr(log, "to_numpy"):
        frame: Any = log  # a DataFrame; of two columns of one name, frame[name] is both
        return _table(((column, frame[column]) for column in dict.fromkeys(frame.columns)), name)
    if isinstance(log, Mapping):
        return _table(log.items(), name)
    raise InputError(f"{name}: expected a path, a DataFrame, a mapping from names to arrays, or a structured array, "
                     f"found {type(log).__name__}")


def columns_of(table: Mapping[str, Any]) -> Columns:
    """Columns as arrays, text too."""
    return {name: np.asarray(values) for name, values in table.items()}


def data_frame(columns: Mapping[str, Any]) -> Any:
    """A pandas.DataFrame of columns."""
    return importlib.import_module("pandas").DataFrame(dict(columns), copy=False)
