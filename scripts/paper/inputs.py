"""Reads the results of the simulations strictly: a missing file or column is one
clear line that names the program which writes it."""

import csv
import math
import pathlib

import yaml


class BadInput(Exception):
    exit_code = 2


def _text(path, written_by):
    try:
        return pathlib.Path(path).read_text("utf-8")
    except OSError as error:
        raise BadInput(f"{path}: {error.strerror}; {written_by} writes it") from None
    except UnicodeDecodeError as error:
        raise BadInput(f"{path}: byte {error.start + 1} is not UTF-8; {written_by} writes it") from None


def read_csv(path, columns, written_by, optional=()):
    """Rows as dicts: numbers where a cell is one, NaN where it is empty; optional
    columns if they are there."""
    lines = _text(path, written_by).splitlines()
    reader = csv.DictReader(line for line in lines if not line.startswith("#"))
    there = reader.fieldnames or ()
    for column in columns:
        if column not in there:
            raise BadInput(f"{path}: no column {column}; {written_by} writes it")
    names = [*columns, *(name for name in optional if name in there)]
    rows = [{name: _cell(row[name]) for name in names} for row in reader]
    if not rows:
        raise BadInput(f"{path}: no rows; {written_by} writes them")
    return rows


def _cell(text):
    if not text:
        return math.nan
    try:
        return float(text)
    except ValueError:
        return text


def read_yaml(path, keys, written_by):
    try:
        content = yaml.safe_load(_text(path, written_by))
    except yaml.YAMLError as error:
        raise BadInput(f"{path}: {' '.join(str(error).split())}") from None
    for key in keys:
        if not isinstance(content, dict) or key not in content:
            raise BadInput(f"{path}: no key {key}; {written_by} writes it")
    return content


def folders(parent, pattern, written_by):
    """One of each seed."""
    found = sorted(parent.glob(pattern))
    if not found:
        raise BadInput(f"{parent / pattern}: nothing there; {written_by} writes it")
    return found
