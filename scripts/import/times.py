"""Times of a column: seconds, or stamps of a clock as whole nanoseconds.

Stamps are kept exact until the origin of the log is known: a double of seconds since
1970 resolves only 0.24 us.
"""

import datetime
import decimal
import re

import numpy as np

from errors import BadInput, shown

FORMATS = {"seconds": 0, "iso8601": 0, "epoch": 1, "epoch_ms": 1000, "epoch_us": 10**6,
           "epoch_ns": 10**9}
ISO = re.compile(r"(\d{4})-(\d\d)-(\d\d)[T ](\d\d):(\d\d)(?::(\d\d)(?:[.,](\d{1,9}))?)?"
                 r"\s*(Z|[+-]\d\d:?\d\d)?")
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


def stamps_ns(table, column, form):
    """int64 nanoseconds since 1970 of a column with stamps; every cell has one."""
    out = np.empty(table.rows, dtype=np.int64)
    if form == "iso8601":
        cells = column.cells if column.is_text else [str(c) for c in column.cells]
        for i, text in enumerate(cells):
            ns = iso_ns(text)
            if ns is None:
                raise BadInput(f"{table.where(i)}: column '{shown(column.name)}': expected an "
                               f"ISO 8601 time such as 2026-03-11T14:05:07.25, found "
                               f"'{shown(text)}'")
            out[i] = ns
        return out
    per_second = FORMATS[form]
    integers = not column.is_text and np.asarray(column.cells).dtype.kind in "iu"
    values = None if integers else table.numbers(column)
    for i in range(table.rows):
        if integers:
            seconds = decimal.Decimal(int(column.cells[i]))
        else:
            if np.isnan(values[i]):
                raise BadInput(f"{table.where(i)}: column '{shown(column.name)}': a row needs a "
                               "time")
            text = column.cells[i].strip().replace(",", ".") if column.is_text else \
                repr(float(values[i]))
            seconds = decimal.Decimal(text)
        ns = seconds * 10**9 / per_second
        if not 0 <= ns < 2**63 - 1:
            raise BadInput(f"{table.where(i)}: column '{shown(column.name)}': {shown(seconds)} is "
                           f"no time of format {form}")
        out[i] = int(ns.to_integral_value())
    return out


def seconds_since(ns, origin_ns):
    """Exact differences as doubles, in s."""
    return (ns - origin_ns) / 1e9


def iso_text(ns):
    """The whole second of a stamp as ISO 8601."""
    return (EPOCH + datetime.timedelta(seconds=ns // 10**9)).isoformat() + "Z"
