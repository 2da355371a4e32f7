"""Messages of a bag become tables: one a topic, a row a message, a column a field.

A message is a dict of numbers, texts, lists and dicts, as its definition nests them.
`time` is header.stamp where the messages have one, else when they were recorded.
"""

import array
import struct

import numpy as np

import cdr
from errors import BadInput, shown
from limits import MOST_COLUMNS
from raw_table import Column, RawTable

# ROS uses SI units: REP 103.
UNITS = {"force": "N", "point": "m", "translation": "m", "pose.position": "m",
         "temperature": "°C"}


class _TooWide(Exception):
    """A message has more numbers than a table has columns, as an image."""


def stamp_ns(value):
    """Nanoseconds of a time as ROS 1, ROS 2 and JSON have it, or None."""
    if not isinstance(value, dict):
        return None
    for fraction in ("nanosec", "nsec", "nsecs"):
        seconds = value.get("sec", value.get("secs"))
        if seconds is not None and fraction in value and len(value) == 2:
            return int(seconds) * 10**9 + int(value[fraction])
    return None


def _flatten(value, path, out):
    if len(out) > MOST_COLUMNS:
        raise _TooWide
    if stamp_ns(value) is not None:
        out[path] = stamp_ns(value)
    elif isinstance(value, dict):
        names = value.get("name")
        for key, item in value.items():
            below = f"{path}.{key}" if path else key
            if isinstance(names, list) and isinstance(item, list) and \
                    len(names) == len(item) and key != "name":
                for name, one in zip(names, item):  # a JointState
                    _flatten(one, f"{below}.{name}", out)
            else:
                _flatten(item, below, out)
    elif isinstance(value, list):
        for i, item in enumerate(value, 1):
            _flatten(item, f"{path}_{i}", out)
    elif isinstance(value, (int, float)) and not isinstance(value, bool):
        out[path] = value


def _unit(name):
    parts = name.rpartition(".")[0]
    return next((unit for end, unit in UNITS.items()
                 if parts == end or parts.endswith("." + end) or name == end), "")


class _Topic:
    """The columns of a topic, packed: whole numbers as long as all are, else floats."""

    def __init__(self):
        self.recorded, self.stamps, self.columns = array.array("q"), array.array("q"), {}

    def add(self, recorded, message):
        flat = {}
        _flatten(message, "", flat)
        rows = len(self.recorded)
        self.recorded.append(recorded)
        stamped = isinstance(flat.get("header.stamp"), int)
        self.stamps.append(flat.pop("header.stamp") if stamped else 0)
        flat.pop("header.seq", None)
        for name, value in flat.items():
            if name not in self.columns:
                if len(self.columns) > MOST_COLUMNS:
                    raise _TooWide
                self.columns[name] = array.array("d", [np.nan]) * rows if rows else array.array("q")
            self._append(name, value)
        if len(flat) < len(self.columns):
            for name, column in self.columns.items():
                if len(column) <= rows:
                    self._append(name, np.nan)

    def _append(self, name, value):
        column = self.columns[name]
        if column.typecode == "q" and not (isinstance(value, int) and abs(value) < 2**63):
            column = self.columns[name] = array.array("d", column)
        column.append(value)

    def table(self, path, topic):
        stamped = all(self.stamps)
        recorded = np.array(self.recorded, dtype=np.int64)
        times = np.array(self.stamps, dtype=np.int64) if stamped else recorded
        order = np.lexsort((recorded, times))
        columns = [Column("time", times[order], "ns")]
        columns += [Column(name, np.array(values)[order], _unit(name)) for name, values in self.columns.items()
                    if name != "time"]
        table = RawTable(path, topic, columns)
        table.notes.append("time is header.stamp" if stamped else "time is when it was recorded")
        return table


class Topics:
    """The topics of a bag as their messages come, in any order."""

    def __init__(self):
        self.topics, self.left_out = {}, {}  # left_out: {topic: what to say of it}
        self.broken = False  # whether one is left out that should be readable

    def leave_out(self, topic, why):
        self.left_out[topic] = f"{shown(topic)} {why}"
        self.topics.pop(topic, None)

    def add(self, topic, recorded, decoded):
        """A message, recorded in ns, that decoded() returns. A topic of which one cannot be read is left
        out, not the others."""
        if topic in self.left_out:
            return
        rows = self.topics.setdefault(topic, _Topic())
        number = len(rows.recorded) + 1
        try:
            rows.add(recorded, decoded())
        except cdr.UnknownType as unknown:
            self.leave_out(topic, f"needs the definition of {shown(unknown)}, which the bag lacks")
        except _TooWide:
            self.leave_out(topic, f"has more than {MOST_COLUMNS} numbers a message")
        except (ArithmeticError, AttributeError, RecursionError, TypeError, ValueError, struct.error) as error:
            self.broken = True
            self.leave_out(topic, f"has a message that cannot be read, its number {number}: {shown(error)}")

    def tables(self, path):
        if not self.topics and self.left_out:
            raise BadInput(f"{path}: no topic can be read: {'; '.join(self.left_out.values())}")
        out = [topic.table(path, name) for name, topic in self.topics.items()]
        if self.left_out:
            out[0].notes.append("warning: " * self.broken + "left out: " + "; ".join(self.left_out.values()))
        return out
