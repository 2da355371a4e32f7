"""What the import prints: a table of what it understood, and what it did not."""

import numpy as np

from errors import shown


def _range(values):
    good = values[np.isfinite(values)]
    if not len(good):
        return "no value"
    return f"{good.min():.6g} to {good.max():.6g}"


def _becomes(target):
    text = target.to
    if target.scale != 1.0:
        text += f", scale {target.scale:g}"
    if target.offset:
        text += f", offset {target.offset:g}"
    return text


def _rate(recording):
    period = recording.period_s
    return f"{1 / period:.4g}" if period else ""


def _rows(recording):
    for header, target in recording.used:
        if target.to == "time_s":
            values, unit = recording.time, target.form if target.form != "seconds" else \
                target.unit_used or "s"
        else:
            values, unit = recording.channels[target.to], target.unit_used
        yield (recording.name, shown(header, 30), unit, _rate(recording), _range(values),
               _becomes(target))


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
