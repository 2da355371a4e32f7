"""Parquet through pandas and pyarrow."""

import pandas
import pyarrow  # noqa: F401  pandas reads Parquet with it; Debian 12 has no package of it

import arrays


def read(path):
    frame = pandas.read_parquet(path, engine="pyarrow")
    return arrays.tables(path, "", {str(name): frame[name].to_numpy() for name in frame.columns})
