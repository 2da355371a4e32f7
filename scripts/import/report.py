"""What the import prints: a table of what it understood, and what it did not."""

import itertools

import numpy as np

import units
from errors import shown


def _range(values):
    good = values[np.isfinite(values)]
    if not len(good):
        return "no value"
    return f"{good.min():.6g} to {good.max():.6g}"


def _becomes(target):
    text = target.to
    if target.scale is not None:
        text += f", scale {target.scale:g}"
    if target.offset:
        text += f", offset {target.offset:g}"
    return text


def _unit(used):
    if isinstance(used.unit, units.Counts):
        return f"{used.unit.bits} bits, {used.unit.low_V:g} to {used.unit.high_V:g} V"
    if used.target.form in ("iso8601", "clock"):
        return used.target.form
    unit = used.unit or (units.of_column(used.target.to) if used.target.scale is None else None)
    name = unit.name if unit else ""
    return f"epoch {name}" if used.target.form == "epoch" else name


def _rate(recording):
    period = recording.period_s
    return f"{1 / period:.4g}" if period else ""


def _rows(recording):
    for used in recording.used:
        to = used.target.to
        values = recording.time if to == "time_s" else recording.channels[to]
        yield (recording.name, shown(used.header, 30), _unit(used), _rate(recording),
               _range(values), _becomes(used.target))


def understood(recordings):
    """The lines of the table, whose columns line up."""
    rows = [("table", "column", "unit", "rate_Hz", "range_in_log", "becomes")]
    for recording in recordings:
        rows += _rows(recording)
    widths = [max(len(row[i]) for row in rows) for i in range(len(rows[0]))]
    return ["  ".join(cell.ljust(width) for cell, width in zip(row, widths)).rstrip()
            for row in rows]


def _named(column):
    unit = f" [{column.unit}]" if column.unit and column.unit not in column.name else ""
    return shown(column.name, 40) + unit


def not_understood(recordings):
    """Lines about columns that nobody knows, and how to map them."""
    lines = []
    for r in recordings:
        if r.unknown:
            names = [_named(c) for c in r.unknown]
            more = f" and {len(names) - 12} more" if len(names) > 12 else ""
            lines.append(f"{r.name}: left out: {', '.join(names[:12])}{more}")
    if lines:
        name = next(c.name for r in recordings for c in r.unknown)
        taken = {used.target.to for r in recordings for used in r.used}
        free = next(to for to in map("gauge_{}_V".format, itertools.count(1)) if to not in taken)
        lines.append(f"to use them, say what they are in --mapping M.yaml, such as columns: "
                     f"{{'{shown(name)}': {{to: {free}, unit: mV}}}}")
    return lines


def summary(pairs):
    return [f"{name:<14} {text}" for name, text in pairs]
