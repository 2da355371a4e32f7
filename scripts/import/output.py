"""Writes the log, and the mapping by which the same log comes out again."""

import os
import tempfile

import numpy as np
import yaml

import vocabulary
from errors import BadInput


def _write(path, text):
    """The whole file or nothing."""
    folder = os.path.dirname(path) or "."
    try:
        descriptor, part = tempfile.mkstemp(prefix=".", suffix=".part", dir=folder)
        try:
            with os.fdopen(descriptor, "w", encoding="utf-8", newline="\n") as file:
                file.write(text)
            os.chmod(part, 0o666 & ~_umask())
            os.replace(part, path)
        except BaseException:
            os.unlink(part)
            raise
    except OSError as error:
        raise BadInput(f"{path}: cannot be written: {error.strerror}") from error


def _umask():
    mask = os.umask(0)
    os.umask(mask)
    return mask


def log_text(columns):
    """CSV with numbers that read back as the same double; an empty cell is not measured."""
    names = sorted(columns, key=vocabulary.order)
    cells = [["" if np.isnan(v) else repr(float(v)) for v in columns[name]] for name in names]
    return "\n".join([",".join(names)] + [",".join(row) for row in zip(*cells)]) + "\n"


def mapping_path(out):
    for end in (".csv.gz", ".csv"):
        if out.endswith(end):
            return out[:-len(end)] + ".mapping.yaml"
    return out + ".mapping.yaml"


def _column(target):
    out = {"to": target.to}
    if target.bits is not None:
        out.update(unit="counts", bits=int(target.bits), range_V=target.range_V)
    elif target.unit_used:
        out["unit"] = target.unit_used
    if target.form and target.form != "seconds":
        out["format"] = target.form
    if target.stated_scale:
        out["scale"] = target.scale
    if target.offset:
        out["offset"] = target.offset
    return out if len(out) > 1 else target.to


def _table(recording, mapping):
    columns = {header: _column(target) for header, target in recording.used}
    columns.update({c.name: None for c in recording.table.columns if c.name not in columns})
    out = {}
    if recording.table.delimiter is not None:
        out.update(delimiter=recording.table.delimiter, decimal=recording.table.decimal)
    if mapping.of(recording.name, "na_words"):
        out["na_words"] = mapping.of(recording.name, "na_words")
    if recording.offset_s or recording.offset_std_s is not None:
        out["time_offset_s"] = float(recording.offset_s)
    if recording.offset_std_s is not None:
        out["time_offset_std_s"] = float(recording.offset_std_s)
    out["columns"] = columns
    return out


class _Dumper(yaml.SafeDumper):
    """Doubles with all their digits, in a form that YAML 1.1 takes for numbers too."""


def _number(dumper, value):
    text = repr(float(value))
    if "e" in text and "." not in text:
        text = text.replace("e", ".0e")
    return dumper.represent_scalar("tag:yaml.org,2002:float", text)


_Dumper.add_representer(float, _number)


def mapping_text(recordings, mapping, in_force):
    """in_force: join, plateaus, force and time_origin as used, None where not."""
    out = {"schema_version": 1}
    if mapping.settings["row_type"]:
        out["row_type"] = mapping.settings["row_type"]
    out.update({key: value for key, value in in_force.items() if value})
    out["tables"] = {r.name: _table(r, mapping) for r in recordings}
    return "# Written by finray_import. With it and the same recordings the same log comes out " \
        "again.\n" + yaml.dump(out, Dumper=_Dumper, sort_keys=False, allow_unicode=True,
                               default_flow_style=None, width=110)


def write(path, columns, text):
    _write(path, log_text(columns))
    _write(mapping_path(path), text)
