"""A table in finray's vocabulary: times, and channels in finray's units."""

import numpy as np

import times
import units
import vocabulary
from errors import BadInput, shown
from mapping_file import Target


class Recording:
    """name; channels {column: values}; time: seconds of the log, or None.

    used: (header, unit, Target) of every column that became a channel; unknown: headers that
    nobody knows; warnings. offset_s is added to the times, std_s is its std or None.
    """

    def __init__(self, table):
        self.table, self.name = table, table.name
        self.channels, self.used, self.unknown, self.warnings = {}, [], [], []
        self.stamps = self.seconds = self.time = None
        self.offset_s, self.offset_std_s = 0.0, None

    def has(self, *stems):
        return any(name.startswith(stem) for name in self.channels for stem in stems)

    @property
    def period_s(self):
        """The median time between readings, or None."""
        if self.time is None or len(self.time) < 2:
            return None
        steps = np.diff(self.time)
        steps = steps[steps > 0]
        return float(np.median(steps)) if len(steps) else None

    def shift(self, offset_s, std_s=None):
        self.time = self.time + (offset_s - self.offset_s)
        self.offset_s, self.offset_std_s = offset_s, std_s


def _time_format(table, column, unit):
    """The format of times whose mapping states none."""
    if column.is_text and times.looks_iso(column.cells[0]):
        return "iso8601"
    values = table.numbers(column)
    first = values[np.isfinite(values)][:1]
    for form, per_second in (("epoch", 1), ("epoch_ms", 1e3), ("epoch_us", 1e6),
                             ("epoch_ns", 1e9)):
        if len(first) and 3e8 * per_second < first[0] < 4e9 * per_second:
            wanted = {"epoch": ("", "s"), "epoch_ms": ("", "ms"), "epoch_us": ("", "us", "µs"),
                      "epoch_ns": ("", "ns")}[form]
            if unit in wanted:
                return form
    return "seconds"


def _target_of(recording, mapping, column):
    """The Target of a column, or None; notes headers that nobody knows."""
    said, target = mapping.target(recording.name, column.name)
    if said:
        return target
    guessed = vocabulary.guess(column.name, column.unit)
    if guessed is None:
        recording.unknown.append(column.name)
        return None
    return Target(guessed[0], unit=guessed[1], form=guessed[2])


def _convert(recording, column, target):
    """Values of a channel; fills in the unit that was used."""
    table, unit = recording.table, target.unit
    if not unit and not target.stated_scale and target.bits is None and column.unit and \
            target.to != column.name:
        unit = column.unit  # the file's own word
    elif not unit and target.stated_scale and column.unit:
        factor, _ = units.factor(column.unit, target.to)
        if factor not in (None, 1.0) and target.scale in (1.0, -1.0):
            recording.warnings.append(
                f"{recording.name}: '{column.name}' is in {column.unit} by the file, yet its "
                f"scale of {target.scale:g} is taken as it is; state `unit: {column.unit}` to "
                "convert")
    values = table.numbers(column)
    if target.bits is not None:
        low, high = target.range_V
        values = low + values * ((high - low) / 2.0**target.bits)
        unit = f"{int(target.bits)} bits over {low:g} to {high:g} V"
    elif unit and not (target.stated_scale and (units.find(unit) or ("",))[0] == "count"):
        factor, why = units.factor(unit, target.to)
        if factor is None:
            raise BadInput(f"{table.path}: column '{shown(column.name)}': {why}")
        values = values * factor if factor != 1.0 else values
    target.unit_used = unit
    if target.scale != 1.0:
        values = target.scale * values
    return values + target.offset if target.offset else values


def _take_time(recording, column, target):
    table = recording.table
    form = target.form or _time_format(table, column, target.unit or column.unit)
    target.form = form
    if form == "seconds":
        recording.seconds = _convert(recording, column, target)
        missing = np.flatnonzero(np.isnan(recording.seconds))
        if len(missing):
            raise BadInput(f"{table.where(missing[0])}: column '{shown(column.name)}': a row "
                           "needs a time")
    else:
        recording.stamps = times.stamps_ns(table, column, form)
        target.unit_used = ""
    steps = np.diff(recording.stamps if form != "seconds" else recording.seconds)
    back = np.flatnonzero(steps < 0)
    if len(back):
        raise BadInput(f"{table.where(back[0] + 1)}: column '{shown(column.name)}': the time goes "
                       "back; rows must be in order of time")
    same = int(np.sum(steps == 0))
    if same:
        recording.warnings.append(f"{recording.name}: {same} rows have the time of the row before")


def convert(table, mapping):
    recording = Recording(table)
    taken = {}
    for column in table.columns:
        target = _target_of(recording, mapping, column)
        if target is None:
            continue
        if target.to in taken:
            raise BadInput(f"{table.path}: columns '{shown(taken[target.to])}' and "
                           f"'{shown(column.name)}' would both become {target.to}; map one of "
                           "them to null")
        taken[target.to] = column.name
        if target.to == "time_s":
            _take_time(recording, column, target)
        else:
            recording.channels[target.to] = _convert(recording, column, target)
        recording.used.append((column.name, target))
    return recording


def align_clocks(recordings, mapping):
    """Sets the times of the log, and returns what its second 0 is, as ISO text or None."""
    stamped = [r for r in recordings if r.stamps is not None]
    plain = [r for r in recordings if r.seconds is not None]
    if stamped and plain:
        raise BadInput(
            f"{stamped[0].table.path} tells the time of day, {plain[0].table.path} seconds of its "
            "own: nothing says how they go together; give both one kind of time")
    origin = None
    if stamped:
        origin_ns = min(int(r.stamps[0]) for r in stamped) // 10**9 * 10**9
        origin = times.iso_text(origin_ns)
        for r in stamped:
            r.time = times.seconds_since(r.stamps, origin_ns)
    for r in plain:
        r.time = r.seconds.copy()
    for r in recordings:
        _, _, offset, std = mapping.tables.get(r.name, (0, 0, None, None))
        if offset is not None and r.time is not None:
            r.shift(offset, std)
    return origin
