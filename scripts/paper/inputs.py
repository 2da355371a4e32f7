"""What the simulations left, read strictly: a missing file or column is one clear
line that names the program which writes it."""

import csv
import math

import yaml


class BadInput(Exception):
    pass


def _open(path, written_by):
    try:
        return open(path, newline="", encoding="utf-8")
    except OSError as error:
        raise BadInput(f"{path}: {error.strerror}; {written_by} writes it") from None


def read_csv(path, columns, written_by):
    """Rows as dicts: numbers where a cell is one, NaN where it is empty."""
    with _open(path, written_by) as file:
        reader = csv.DictReader(line for line in file if not line.startswith("#"))
        for column in columns:
            if column not in (reader.fieldnames or ()):
                raise BadInput(f"{path}: no column {column}; {written_by} writes it")
        rows = [{name: _cell(row[name]) for name in columns} for row in reader]
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
    with _open(path, written_by) as file:
        try:
            content = yaml.safe_load(file)
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
