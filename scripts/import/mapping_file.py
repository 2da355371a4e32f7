"""The mapping YAML: which column becomes what, read strictly, with the line of an error.

    delimiter: ";"                  # of CSV; detected if left out
    decimal: ","
    na_words: [ERR]                 # beside the usual ones
    columns:                        # of every table; a table's own come first
      ch0: {to: gauge_1_V, unit: counts, bits: 16, range_V: [-5, 5]}
      Fz: {to: force_N, unit: gf}
      stage_x: {to: object_x_mm, scale: -1000, offset: 150}
      t: {to: time_s, format: epoch}
      operator: null                # left out, and no word about it
    row_type: kind                  # column that tells kinds of rows apart; default row_type
    tables:                         # by file name, or file:part (sheet, topic, group, kind)
      rig.csv: {columns: {}, time_offset_s: -0.04, delimiter: ",", decimal: "."}
    join: {base: rig.csv, method: linear, longest_gap_s: 0.3}
    plateaus: {shortest_s: 0.3}
    force: {bias_N: [0.06], rotation_deg: 0, tool_weight_N: [0, -0.5], free_s: [0, 1],
            turns_with_object: false}
"""

import yaml

import units
import vocabulary
from errors import BadInput, did_you_mean, shown
from times import FORMATS

TOP = ["schema_version", "delimiter", "decimal", "na_words", "columns", "row_type", "tables",
       "join", "plateaus", "force", "time_origin"]
TABLE = ["delimiter", "decimal", "na_words", "columns", "time_offset_s", "time_offset_std_s",
         "row_type"]
COLUMN = ["to", "scale", "offset", "unit", "format", "bits", "range_V"]
JOIN = ["base", "method", "longest_gap_s"]
PLATEAUS = ["shortest_s"]
FORCE = ["bias_N", "bias_std_N", "rotation_deg", "rotation_std_deg", "tool_weight_N",
           "tool_weight_std_N", "turns_with_object", "free_s"]
MOST_BYTES = 16 << 20


class Target:
    """What a column becomes: value = scale * (cell in finray's unit) + offset."""

    def __init__(self, to, scale=1.0, offset=0.0, unit="", form=None, bits=None, range_V=None,
                 stated_scale=False):
        self.to, self.scale, self.offset, self.unit, self.form = to, scale, offset, unit, form
        self.bits, self.range_V, self.stated_scale = bits, range_V, stated_scale


class _Node:
    """A mapping node of the YAML with the line of each key."""

    def __init__(self, path, node, keys=None):
        if not isinstance(node, yaml.MappingNode):
            raise BadInput(f"{path}:{node.start_mark.line + 1}: expected a mapping (key: value)")
        self.path, self.values = path, {}
        for key, value in node.value:
            name, line = str(key.value), key.start_mark.line + 1
            if name in self.values:
                raise BadInput(f"{path}:{line}: '{shown(name)}' is there twice")
            if keys is not None and name not in keys:
                raise BadInput(f"{path}:{line}: unknown key '{shown(name)}'"
                               f"{did_you_mean(name, keys)}")
            self.values[name] = value

    def fail(self, key, text):
        raise BadInput(f"{self.path}:{self.values[key].start_mark.line + 1}: {key}: {text}")

    def plain(self, key):
        if key not in self.values:
            return None
        try:
            return yaml.SafeLoader("").construct_object(self.values[key], deep=True)
        except (yaml.YAMLError, ValueError) as error:
            self.fail(key, f"cannot be read: {shown(error)}")

    def text(self, key, allowed=None):
        value = self.plain(key)
        if value is None:
            return None
        if isinstance(value, bool) or not isinstance(value, str) or not value:
            self.fail(key, f"expected a text, found {shown(value)}")
        if allowed is not None and value not in allowed:
            self.fail(key, f"expected {', '.join(map(repr, allowed))}, found '{shown(value)}'")
        return value

    def is_number(self, value):
        return isinstance(value, (int, float)) and not isinstance(value, bool) and \
            abs(value) < 1e30

    def number(self, key):
        value = self.plain(key)
        if isinstance(value, str):  # PyYAML takes 8e-4 for a text
            try:
                value = float(value)
            except ValueError:
                pass
        if value is not None and not self.is_number(value):
            self.fail(key, f"expected a number, found {shown(value)}")
        return None if value is None else float(value)

    def numbers(self, key, count=None):
        value = self.plain(key)
        if value is None:
            return None
        if not isinstance(value, list) or not all(map(self.is_number, value)) or \
                (count and len(value) != count):
            self.fail(key, f"expected a list of {count or 'some'} numbers, found {shown(value)}")
        return [float(v) for v in value]

    def switch(self, key):
        value = self.plain(key)
        if value is not None and not isinstance(value, bool):
            self.fail(key, f"expected true or false, found {shown(value)}")
        return value

    def words(self, key):
        value = self.plain(key)
        if value is None:
            return []
        if not isinstance(value, list) or not all(isinstance(v, str) for v in value):
            self.fail(key, f"expected a list of words, found {shown(value)}")
        return value

    def child(self, key, keys=None):
        return _Node(self.path, self.values[key], keys) if key in self.values else None


def _target(columns, header):
    node = columns.values[header]
    if isinstance(node, yaml.ScalarNode):
        to = columns.plain(header)
        if to is None:
            return None  # left out on purpose
        target = Target(str(to))
        fail = lambda text: columns.fail(header, text)
    else:
        own = columns.child(header, COLUMN)
        if "to" not in own.values:
            columns.fail(header, "needs `to`, the column that it becomes")
        scale, offset = own.number("scale"), own.number("offset")
        target = Target(own.text("to"), 1.0 if scale is None else scale, offset or 0.0,
                        own.text("unit") or "", own.text("format", list(FORMATS)),
                        own.number("bits"), own.numbers("range_V", 2), scale is not None)
        fail = lambda text: own.fail("unit" if "unit" in own.values else "to", text)
        if target.scale == 0:
            own.fail("scale", "a scale of 0 leaves nothing of the column")
        if (target.bits is None) != (target.range_V is None):
            fail("`bits` and `range_V` go together")
        if target.bits is not None and not (target.bits == int(target.bits) and
                                            1 <= target.bits <= 32):
            own.fail("bits", f"expected 1 to 32, found {target.bits:g}")
        if target.bits is not None and (units.find(target.unit or "counts") or ("",))[0] != "count":
            fail("`bits` and `range_V` are for `unit: counts`")
    if not vocabulary.is_column(target.to):
        fail(f"'{shown(target.to)}' is no column of a log{vocabulary.nearest(target.to)}")
    if target.form and target.to != "time_s":
        fail(f"`format` is for time_s, not for {target.to}")
    if target.unit and target.bits is None:
        _, why = units.factor(target.unit, target.to)
        scaled_counts = target.stated_scale and (units.find(target.unit) or ("",))[0] == "count"
        if why and not scaled_counts:
            fail(why)
    return target


def _columns(node):
    """{header: Target, or None for one that is left out}."""
    columns = node.child("columns")
    return {} if columns is None else {name: _target(columns, name) for name in columns.values}


def _settings(node):
    return {"delimiter": node.text("delimiter"), "decimal": node.text("decimal", [".", ","]),
            "na_words": node.words("na_words"), "row_type": node.text("row_type")}


class Mapping:
    """columns, settings: of all tables; tables: {name: (columns, settings, offset, std)};
    join, plateaus, force: plain values, None where nothing is said."""

    def __init__(self):
        self.path, self.columns, self.tables = None, {}, {}
        self.settings = {"delimiter": None, "decimal": None, "na_words": [], "row_type": None}
        self.join, self.plateaus, self.force = {}, None, {}

    def of(self, table, key):
        own = self.tables.get(table, ({}, {}, None, None))[1].get(key)
        return own or self.settings[key]

    def target(self, table, header):
        """(whether the mapping says something, Target or None)."""
        for columns in (self.tables.get(table, ({},))[0], self.columns):
            if header in columns:
                return True, columns[header]
        return False, None


def read(path):
    mapping = Mapping()
    mapping.path = path
    try:
        with open(path, "rb") as file:
            data = file.read(MOST_BYTES + 1)
        if len(data) > MOST_BYTES:
            raise BadInput(f"{path}: larger than 16 MiB")
        node = yaml.compose(data.decode("utf-8-sig"), Loader=yaml.SafeLoader)
    except OSError as error:
        raise BadInput(f"{path}: cannot be read: {error.strerror}") from error
    except UnicodeDecodeError as error:
        raise BadInput(f"{path}: is not UTF-8 text") from error
    except (yaml.YAMLError, RecursionError) as error:
        mark = getattr(error, "problem_mark", None)
        line = f":{mark.line + 1}" if mark else ""
        raise BadInput(f"{path}{line}: {shown(getattr(error, 'problem', None) or error)}") \
            from error
    if node is None:
        raise BadInput(f"{path}: is empty")
    top = _Node(path, node, TOP)
    if top.plain("schema_version") not in (None, 1):
        top.fail("schema_version", "expected 1")
    mapping.columns, mapping.settings = _columns(top), _settings(top)
    tables = top.child("tables")
    for name in tables.values if tables else ():
        own = tables.child(name, TABLE)
        mapping.tables[name] = (_columns(own), _settings(own), own.number("time_offset_s"),
                                own.number("time_offset_std_s"))
    join = top.child("join", JOIN)
    if join:
        mapping.join = {"base": join.text("base"),
                        "method": join.text("method", ["linear", "nearest", "previous"]),
                        "longest_gap_s": join.number("longest_gap_s")}
    plateaus = top.child("plateaus", PLATEAUS)
    if plateaus:
        mapping.plateaus = {"shortest_s": plateaus.number("shortest_s")}
    force = top.child("force", FORCE)
    if force:
        mapping.force = {"bias_N": force.numbers("bias_N"),
                         "bias_std_N": force.numbers("bias_std_N"),
                         "rotation_deg": force.number("rotation_deg"),
                         "rotation_std_deg": force.number("rotation_std_deg"),
                         "tool_weight_N": force.numbers("tool_weight_N", 2),
                         "tool_weight_std_N": force.numbers("tool_weight_std_N", 2),
                         "turns_with_object": force.switch("turns_with_object"),
                         "free_s": force.numbers("free_s", 2)}
    return mapping
