"""The mapping YAML: which column becomes what.

`columns` and the keys of CSV are those of scenes and plans, so that all can name one file:

    delimiter: ";"                  # of CSV; what is left out is detected
    decimal: ","
    header_line: 4                  # in the file, from 1
    units_row: true                 # whether units stand below the header
    not_measured: [ERR]             # beside the usual words
    columns:                        # or the path of a YAML with these keys
      ch0: {to: gauge_1_V, unit: {adc_bits: 16, range_V: [-5, 5], signed: false}}
      Fz: {to: force_N, unit: gf}
      stage_x: {to: object_x_mm, scale: -1000, offset: 150}
      t: {to: time_s, format: epoch}
      operator: null                # left out, and no word about it

The rest is for finray_import:

    row_type: kind                  # column that tells kinds of rows apart; default row_type
    tables:                         # by file name, or file:part (sheet, topic, group, kind); * is any text
      rig.csv: {columns: {}, time_offset_s: -0.04, delimiter: ",", decimal: "."}
    join: {base: rig.csv, method: linear, longest_gap_s: 0.3}
    plateaus: {shortest_s: 0.3}
    force: {bias_N: [0.06], rotation_deg: 0, tool_weight_N: [0, -0.5], free_s: [0, 1],
            turns_with_object: false}
"""

import os
import re

import flags
import units
import vocabulary
from errors import BadInput, did_you_mean, shown
from yaml_node import Node, load, place

FORMAT_KEYS = ["delimiter", "decimal", "header_line", "units_row", "not_measured"]
SETTINGS = FORMAT_KEYS + ["row_type"]
TOP = ["schema_version", "columns", "tables", "join", "plateaus", "force", "time_origin"] + SETTINGS
TABLE = ["columns", "time_offset_s", "time_offset_std_s"] + SETTINGS
FORCE = ["bias_N", "bias_std_N", "rotation_deg", "rotation_std_deg", "tool_weight_N",
         "tool_weight_std_N", "turns_with_object", "free_s"]
EPOCH_UNITS = {"epoch": "s", "epoch_s": "s", "epoch_ms": "ms"}


class Target:
    """What a column becomes: value = scale * (cell in finray's unit) + offset.

    unit: a Unit or Counts or None; scale: None where none is stated; form: of times, `iso8601`,
    `epoch` (since 1970, in the unit), `clock` (14:05:07), `number`, or None where it is to be
    found out.
    """

    def __init__(self, to, scale=None, offset=0.0, unit=None, form=None):
        self.to, self.scale, self.offset, self.unit, self.form = to, scale, offset, unit, form


def _counts(node):
    bits, volts = node.integer("adc_bits", 1, 32), node.numbers("range_V", 2)
    for key, value in (("adc_bits", bits), ("range_V", volts)):
        if value is None:
            raise BadInput(f"{place(node.path, node.node)}: unit: counts need adc_bits and range_V")
    if not volts[0] < volts[1]:
        node.fail("range_V", "expected [from, to] in V, the first one smaller")
    return units.Counts(bits, *volts, node.switch("signed", False))


def _read_unit(node, target):
    own = units.of_column(target.to)
    if node.is_map("unit"):
        if own is None or own.dimension != "voltage":
            node.fail("unit", f"counts of a converter are volts, not {target.to}")
        target.unit = _counts(node.child("unit", ["adc_bits", "range_V", "signed"]))
        return
    name = node.text("unit")
    if target.to == "time_s" and name in EPOCH_UNITS and target.form != "iso8601":
        target.form, name = "epoch", EPOCH_UNITS[name]
    unit = units.find(name)
    if unit is None or units.conversion(unit, target.to) is None:
        node.fail("unit", units.why_not(name, target.to))
    if target.form in ("iso8601", "clock"):
        node.fail("unit", f"a time of {target.form} has none")
    target.unit = unit


def _target(node, header):
    """(header, Target or None) of an entry; {ours: theirs} is taken the other way round."""
    if not node.is_map(header):
        to = node.plain(header)
        if to is None:
            return header, None  # left out on purpose
        if vocabulary.is_column(header) and not vocabulary.is_column(str(to)):
            return str(to), Target(header)
        _check_target(node, header, str(to))
        return header, Target(str(to))
    own = node.child(header, ["to", "scale", "offset", "unit", "format"])
    if "to" not in own.values:
        node.fail(header, "needs `to`, the column that it becomes")
    target = Target(own.text("to"), own.number("scale"), own.number("offset", 0),
                    form=own.text("format", ["iso8601", "epoch", "clock"]))
    _check_target(own, "to", target.to)
    if target.scale == 0:
        own.fail("scale", "expected another than 0")
    if target.form and target.to != "time_s":
        own.fail("format", f"is for time_s, not for {target.to}")
    if "unit" in own.values:
        _read_unit(own, target)
    return header, target


def _check_target(node, key, to):
    if not vocabulary.is_column(to):
        node.fail(key, f"'{shown(to)}' is no column of a log{vocabulary.nearest(to)}")


class Table:
    """columns: {header: Target, or None for one that is left out}, and where in the mapping each
    of them is said; settings of CSV."""

    def __init__(self, node=None):
        self.columns, self.places, self.settings = {}, {}, {key: None for key in SETTINGS}
        self.time_offset_s = self.time_offset_std_s = None
        if node is None:
            return
        if node.is_map("columns"):
            columns = node.child("columns")
            for key in columns.values:
                header, target = _target(columns, key)
                self.columns[header], self.places[header] = target, columns.places[key]
        elif "columns" in node.values:
            shared = os.path.join(os.path.dirname(node.path), node.text(
                "columns", expected="a mapping (header: column), or the name of a YAML file"))
            other = Node(shared, load(shared), ["schema_version", "columns"] + FORMAT_KEYS)
            if not other.is_map("columns"):
                raise BadInput(f"{shared}: needs `columns`, a mapping")
            said = Table(other)
            self.columns, self.places, self.settings = said.columns, said.places, said.settings
        delimiter = node.text("delimiter", [",", ";", "\t", "tab", "|", " "])
        read = {"delimiter": "\t" if delimiter == "tab" else delimiter,
                "decimal": node.text("decimal", [".", ","]),
                "header_line": node.integer("header_line", 1, 10**9),
                "units_row": node.switch("units_row"),
                "not_measured": node.words("not_measured") or None,
                "row_type": node.text("row_type") if "row_type" in node.values else None}
        self.settings.update({key: v for key, v in read.items() if v is not None})
        self.time_offset_s = node.number("time_offset_s", allowed=flags.is_offset, expected="a number below 1e9 s")
        self.time_offset_std_s = node.number("time_offset_std_s", allowed=lambda std: std >= 0, expected="a number of at least 0")


def means(said, name):
    """Whether a name under `tables` means the table `name`: it is that of the table or of its
    file, where * stands for any text, and .gz may be left out."""
    pattern = re.compile(re.escape(said).replace(r"\*", ".*"), re.DOTALL)
    file, colon, part = name.partition(":")
    plain = file.removesuffix(".gz")
    return any(pattern.fullmatch(n) for n in (name, file, plain, plain + colon + part))


class Mapping:
    """top, tables {name: Table}; join, plateaus, force: values, None where nothing is said."""

    def __init__(self):
        self.path, self.top, self.tables = None, Table(), {}
        self.join, self.plateaus, self.force = {}, None, {}

    def _tables(self, name):
        """What speaks of a table, the nearest first: itself, its file, patterns, all."""
        names = dict.fromkeys((name, name.partition(":")[0]))
        exact = [n for n in names if n in self.tables]
        near = [n for n in self.tables if n not in exact and means(n, name)]
        return [self.tables[n] for n in exact + near] + [self.top]

    def setting(self, name, key):
        said = [t.settings[key] for t in self._tables(name) if t.settings[key] is not None]
        return said[0] if said else None

    def headers(self, name):
        """Those of a file's columns that become something."""
        return {header for table in self._tables(name) for header, target in table.columns.items()
                if target is not None}

    def target(self, name, header):
        """(whether the mapping says something, Target or None)."""
        for table in self._tables(name):
            if header in table.columns:
                return True, table.columns[header]
        return False, None

    def time_offset(self, name):
        """(seconds, std), each None where nothing is stated."""
        for table in self._tables(name):
            if table.time_offset_s is not None:
                return table.time_offset_s, table.time_offset_std_s
        return None, None


def refuse_absent(mapping, tables):
    """BadInput for a column that the mapping names and that no table has, unless another one
    becomes the same."""
    for name, said in (("", mapping.top), *mapping.tables.items()):
        headers = [header for t in tables if not name or means(name, t.name)
                   for header in t.headers]
        if not headers and name:
            continue  # of a file that is not there, which is a warning of its own
        there = {said.columns[h].to for h in said.columns if h in headers and said.columns[h]}
        for header, target in said.columns.items():
            if target is None or header in headers or target.to in there:
                continue
            who = f"{shown(name)} has no" if name else "no recording has a"
            raise BadInput(
                f"{said.places[header]}: {who} column '{shown(header)}' to become {target.to}"
                f"{did_you_mean(header, headers)}" + ("" if name else
                "; what another file has goes under `tables`"))


def read(path):
    mapping = Mapping()
    top = Node(path, load(path), TOP)
    if top.plain("schema_version") not in (None, 1):
        top.fail("schema_version", "expected 1")
    mapping.path, mapping.top = path, Table(top)
    tables = top.child("tables")
    for name in tables.values if tables else ():
        mapping.tables[name] = Table(tables.child(name, TABLE))
    join = top.child("join", ["base", "method", "longest_gap_s"])
    if join:
        mapping.join = {"base": join.text("base"),
                        "method": join.text("method", flags.JOINS, flags.default("join")),
                        "longest_gap_s": join.number("longest_gap_s", allowed=flags.is_duration, expected=flags.DURATION)}
    plateaus = top.child("plateaus", ["shortest_s"])
    if plateaus:
        mapping.plateaus = {"shortest_s": plateaus.number(
            "shortest_s", flags.default("shortest_plateau_s"), flags.is_duration, flags.DURATION)}
    force = top.child("force", FORCE)
    if force:
        mapping.force = {key: force.numbers(key) for key in ("bias_N", "bias_std_N")}
        mapping.force.update((key, force.numbers(key, 2)) for key in
                             ("tool_weight_N", "tool_weight_std_N", "free_s"))
        mapping.force.update((key, force.number(key)) for key in
                             ("rotation_deg", "rotation_std_deg"))
        free_s = mapping.force["free_s"]
        if free_s is not None and not flags.is_span(free_s):
            force.fail("free_s", "expected [first, last], the first one not larger")
        mapping.force["turns_with_object"] = force.switch("turns_with_object", False)
    return mapping
