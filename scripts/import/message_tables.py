"""Messages of a bag become tables: one a topic, a row a message, a column a field.

A message is a dict of numbers, texts, lists and dicts, as its definition nests them.
`time` is header.stamp where the messages have one, else when they were recorded.
"""

import numpy as np

from raw_table import Column, RawTable

# ROS uses SI units: REP 103.
UNITS = {"force": "N", "point": "m", "translation": "m", "pose.position": "m",
         "temperature": "°C"}


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


def _column(name, rows):
    values = [row.get(name) for row in rows]
    if all(isinstance(v, int) for v in values):
        return Column(name, np.array(values, dtype=np.int64), _unit(name))
    return Column(name, np.array([np.nan if v is None else float(v) for v in values]),
                  _unit(name))


def tables(path, topics, left_out):
    """topics: {topic: [(recorded in ns, message)]}; left_out: what to say of other topics."""
    out = []
    for topic, messages in topics.items():
        rows = []
        for recorded, message in messages:
            row = {}
            _flatten(message, "", row)
            stamp = row.pop("header.stamp", None)
            row.pop("header.seq", None)
            rows.append((stamp or recorded, recorded, row, bool(stamp)))
        stamped = all(row[3] for row in rows)
        if not stamped:
            rows = [(recorded, recorded, row, False) for _, recorded, row, _ in rows]
        rows.sort(key=lambda row: row[0])
        columns = [Column("time", np.array([r[0] for r in rows], dtype=np.int64), "ns")]
        names = dict.fromkeys(name for r in rows for name in r[2])
        columns += [_column(name, [r[2] for r in rows]) for name in names if name != "time"]
        table = RawTable(path, topic, columns)
        table.notes.append("time is header.stamp" if stamped else "time is when it was recorded")
        out.append(table)
    if out and left_out:
        out[0].notes.append("left out: " + "; ".join(left_out))
    return out
