"""What the import prints: a table of what it understood, and what it did not."""

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
    form = used.target.form if used.target.form not in (None, "number") else ""
    return " ".join(w for w in (form, used.unit.name if used.unit else "") if w)


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
    """The table, in text of columns that line up."""
    rows = [("table", "column", "unit", "rate_Hz", "range_in_log", "becomes")]
    for recording in recordings:
        rows += _rows(recording)
    widths = [max(len(row[i]) for row in rows) for i in range(len(rows[0]))]
    return "\n".join("  ".join(cell.ljust(width) for cell, width in zip(row, widths)).rstrip()
                     for row in rows)


def not_understood(recordings):
    """Lines about columns that nobody knows."""
    lines = []
    for r in recordings:
        if r.unknown:
            names = [shown(n, 40) for n in r.unknown]
            more = f" and {len(names) - 12} more" if len(names) > 12 else ""
            lines.append(f"{r.name}: left out: {', '.join(names[:12])}{more}")
    return lines


def example(recordings):
    """A mapping to begin with, for columns that nobody knows."""
    names = [n for r in recordings for n in r.unknown][:1]
    return f"map columns in --mapping M.yaml: columns: {{'{shown(names[0])}': " \
        "{to: gauge_1_V, unit: mV}}" if names else ""


def summary(pairs):
    return "\n".join(f"{name:<14} {text}" for name, text in pairs)
