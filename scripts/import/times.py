"""Times of a column: seconds, or stamps of a clock as whole nanoseconds.

Stamps are kept exact until the origin of the log is known: a double of seconds since
1970 resolves only 0.24 us.
"""

import datetime
import decimal
import re

import numpy as np

import units
from errors import BadInput, shown

ISO = re.compile(r"(\d{4})-(\d\d)-(\d\d)[T ](\d\d):(\d\d)(?::(\d\d)(?:[.,](\d{1,9}))?)?"
                 r"\s*(Z|[+-]\d\d:?\d\d)?")
CLOCK = re.compile(r"(\d\d?):(\d\d):(\d\d)(?:[.,](\d{1,9}))?")
DATE = re.compile(r"\d{4}-\d\d-\d\d|\d\d?[./]\d\d?[./]\d{4}")
# Times since 1970 lie between these years, so that a wrong unit is noticed.
YEAR_1980_S, YEAR_2100_S = 315532800, 4102444800
EPOCH = datetime.datetime(1970, 1, 1)


def iso_ns(text):
    """Nanoseconds since 1970 (UTC unless the text has a zone), or None."""
    found = ISO.fullmatch(text.strip())
    if not found:
        return None
    year, month, day, hour, minute, second, fraction, zone = found.groups()
    try:
        moment = datetime.datetime(int(year), int(month), int(day), int(hour), int(minute),
                                   int(second or 0))
    except ValueError:
        return None
    since = moment - EPOCH
    ns = (since.days * 86400 + since.seconds) * 10**9 + int((fraction or "").ljust(9, "0"))
    if zone and zone != "Z":
        minutes = int(zone[1:3]) * 60 + int(zone[-2:])
        ns -= (1 if zone[0] == "+" else -1) * minutes * 60 * 10**9
    return ns


def looks_iso(text):
    return iso_ns(text) is not None


def clock_s(text):
    """Seconds since midnight of 14:05:07 or 14:05:07,250, or None."""
    found = CLOCK.fullmatch(text.strip())
    if not found:
        return None
    hour, minute, second, fraction = found.groups()
    if int(hour) > 23 or int(minute) > 59 or int(second) > 59:
        return None
    return int(hour) * 3600 + int(minute) * 60 + float(f"{second}.{fraction or 0}")


def clock_seconds(table, column):
    """Seconds since the midnight before the first row; a clock that falls by more than half
    a day has passed another one."""
    out = np.empty(table.rows)
    for i, cell in enumerate(column.cells):
        seconds = clock_s(str(cell))
        if seconds is None:
            raise BadInput(f"{table.where(i)}: column '{shown(column.name)}': expected a time such "
                           f"as 14:05:07.25, found '{shown(str(cell))}'")
        out[i] = seconds
    return out + 86400 * np.cumsum(np.concatenate(([0], np.diff(out) < -43200)))


def looks_like_time(text):
    """Whether a cell is a time, or a date beside one."""
    return looks_iso(text) or clock_s(text) is not None or DATE.fullmatch(text) is not None


def form_of(table, column, unit, target):
    """(form, unit) of times whose mapping states no form: ISO text, the time of a clock, a
    number that can only be a time since 1970, or a number."""
    if column.is_text and looks_iso(column.cells[0]):
        return "iso8601", None
    if column.is_text and clock_s(column.cells[0]) is not None:
        return "clock", None
    values = table.numbers(column)
    first = values[np.isfinite(values)][:1]
    if len(first) and target.scale is None and not target.offset:
        for candidate in (units.UNITS[name] for name in ("s", "ms", "us", "ns")):
            if YEAR_1980_S < first[0] / candidate.divide < YEAR_2100_S and \
                    unit in (None, candidate):
                return "epoch", candidate
    return "number", unit


def stamps_ns(table, column, form, unit):
    """int64 nanoseconds since 1970 of a column with stamps; every cell has one.

    form: `iso8601`, or `epoch` for numbers in a Unit.
    """
    out = np.empty(table.rows, dtype=np.int64)
    where = f"column '{shown(column.name)}'"
    if form == "iso8601":
        cells = column.cells if column.is_text else [str(c) for c in column.cells]
        for i, text in enumerate(cells):
            ns = iso_ns(text)
            if ns is None:
                raise BadInput(f"{table.where(i)}: {where}: expected a time such as "
                               f"2026-11-24T10:30:15.250+01:00, found '{shown(text)}'")
            out[i] = ns
        return out
    per_second = int(unit.divide / unit.multiply)
    integers = not column.is_text and np.asarray(column.cells).dtype.kind in "iu"
    values = np.asarray(column.cells) if integers else table.numbers(column)
    for i, value in enumerate(values):
        if not YEAR_1980_S < value / per_second < YEAR_2100_S:
            raise BadInput(f"{table.where(i)}: {where}: expected a time since 1970 in "
                           f"{unit.name}, found {shown(column.cells[i])}")
        text = column.cells[i].strip().replace(",", ".") if column.is_text else str(value)
        # Digits as they are written: a double of seconds has no nanoseconds.
        out[i] = int((decimal.Decimal(text) * (10**9 // per_second)).to_integral_value())
    return out


def seconds_since(ns, origin_ns):
    """Exact differences as doubles, in s."""
    return (ns - origin_ns) / 1e9


def iso_text(ns):
    """The whole second of a stamp as ISO 8601."""
    return (EPOCH + datetime.timedelta(seconds=ns // 10**9)).isoformat() + "Z"
