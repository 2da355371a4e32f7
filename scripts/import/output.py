"""Writes the log, and the mapping by which the same log comes out again."""

import os
import pathlib
import sys
import zlib

import numpy as np
import yaml

import units
import vocabulary
from errors import BadInput

sys.path.append(str(pathlib.Path(__file__).resolve().parents[2] / "calib" / "report"))
import whole_file  # noqa: E402

ROWS_A_BLOCK = 10000


def _log(columns):
    """CSV in blocks, with numbers that read back as the same double; an empty cell is not measured."""
    names = sorted(columns, key=vocabulary.order)
    yield (",".join(names) + "\n").encode()
    for first in range(0, len(columns[names[0]]), ROWS_A_BLOCK):
        cells = [["" if np.isnan(v) else repr(float(v)) for v in columns[name][first:first + ROWS_A_BLOCK]]
                 for name in names]
        yield "".join(",".join(row) + "\n" for row in zip(*cells)).encode()


def _packed(blocks):
    squeeze = zlib.compressobj(9, wbits=31)  # gzip without a time in it
    for block in blocks:
        yield squeeze.compress(block)
    yield squeeze.flush()


def mapping_path(out):
    for end in (".csv.gz", ".csv"):
        if out.endswith(end):
            return out[:-len(end)] + ".mapping.yaml"
    return out + ".mapping.yaml"


class _OneLine(dict):
    """A mapping that YAML has in one line."""


def _column(used):
    target, out = used.target, {"to": used.target.to}
    if isinstance(used.unit, units.Counts):
        out["unit"] = {"adc_bits": used.unit.bits, "range_V": [used.unit.low_V, used.unit.high_V]}
        if used.unit.signed:
            out["unit"]["signed"] = True
    elif used.unit is not None and not (target.form == "epoch" and used.unit.name == "s"):
        out["unit"] = used.unit.name
    if target.form in ("iso8601", "epoch", "clock"):
        out["format"] = target.form
    if target.scale is not None:
        out["scale"] = target.scale
    if target.offset:
        out["offset"] = target.offset
    return _OneLine(out) if len(out) > 1 else target.to


def _tables(recordings, mapping):
    """What is said of each file and of each table of it."""
    out = {}
    for r in recordings:
        of_file = out.setdefault(r.name.partition(":")[0], {})
        if r.table.delimiter is not None:
            of_file.update(delimiter=r.table.delimiter, decimal=r.table.decimal)
        of_file.update((key, value) for key, value in
                       ((key, mapping.setting(r.name, key)) for key in
                        ("header_line", "units_row", "not_measured", "row_type"))
                       if value is not None)
        own = out.setdefault(r.name, {})
        if r.offset_s or r.offset_std_s is not None:
            own["time_offset_s"] = float(r.offset_s)
        if r.offset_std_s is not None:
            own["time_offset_std_s"] = float(r.offset_std_s)
        columns = {used.header: _column(used) for used in r.used}
        columns.update({c.name: None for c in r.table.columns if c.name not in columns})
        own["columns"] = columns
    return {name: table for name, table in out.items() if table}


class _Dumper(yaml.SafeDumper):
    """Doubles with all their digits, in a form that YAML 1.1 takes for numbers too."""


def _number(dumper, value):
    text = repr(float(value))
    if "e" in text and "." not in text:
        text = text.replace("e", ".0e")
    return dumper.represent_scalar("tag:yaml.org,2002:float", text)


_Dumper.add_representer(float, _number)
_Dumper.add_representer(_OneLine, lambda dumper, value: dumper.represent_mapping(
    "tag:yaml.org,2002:map", value, flow_style=True))


def mapping_text(recordings, mapping, in_force):
    """in_force: join, plateaus, force and time_origin as used, None where not."""
    out = {"schema_version": 1}
    out.update({key: value for key, value in in_force.items() if value})
    out["tables"] = _tables(recordings, mapping)
    return "# Written by finray_import. With it and the same recordings the same log comes out " \
        "again.\n" + yaml.dump(out, Dumper=_Dumper, sort_keys=False, allow_unicode=True,
                               default_flow_style=None, width=200)


def refuse_to_overwrite(inputs, out):
    """BadInput if the log or its mapping would take the place of a file that is read, or of a
    folder."""
    for path in (out, mapping_path(out)):
        if os.path.isdir(path):
            raise BadInput(f"{path}: is a folder, expected a file to write")
        for read in inputs:
            if os.path.exists(path) and os.path.exists(read) and os.path.samefile(path, read):
                raise BadInput(f"{read}: is an input and would be written over; choose another --out")


def write(path, columns, text):
    log = _log(columns)
    whole_file.write_all({mapping_path(path): [text.encode()], path: _packed(log) if path.endswith(".gz") else log})
