"""A table in finray's vocabulary: times, and channels in finray's units."""

import numpy as np

import times
import units
import vocabulary
from errors import BadInput, shown
from mapping_file import Target


# A slope of the force lasts some tenths of a second. Fewer rows of one time are a logger's stumbling.
MOST_STEP_S, COARSE_SHARE = 0.1, 0.25  # of a clock, and of rows


class Used:
    """A column that became a channel, and the Unit or Counts that was used, or None."""

    def __init__(self, header, target, unit):
        self.header, self.target, self.unit = header, target, unit


class Recording:
    """name; channels {column: values}; time: seconds of the log, or None.

    used: a Used for each column that became a channel; unknown: columns that nobody knows;
    warnings. offset_s is added to the times, offset_std_s is its std or None.
    """

    def __init__(self, table):
        self.table, self.name = table, table.name
        self.channels, self.used, self.unknown, self.warnings = {}, [], [], []
        self.stamps = self.seconds = self.time = None
        self.offset_s, self.offset_std_s = 0.0, None
        self.same_times = 0  # rows that have the time of the row before
        self.readings = {}  # by channel, of how many each row is the mean; one each where it is not here

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


def _target_of(recording, mapping, column):
    """The Target of a column, or None; notes columns that nobody knows."""
    said, target = mapping.target(recording.name, column.name)
    if said:
        return target
    guessed = vocabulary.guess(column.name, column.unit)
    if guessed is None:
        recording.unknown.append(column)
        return None
    return Target(guessed[0], unit=guessed[1])


def _fail(table, column, text):
    raise BadInput(f"{table.path}: column '{shown(column.name)}': {text}")


def _unit(recording, column, target):
    """The Unit or Counts that converts a column, or None. A scale speaks of the cell as it is
    written, so the file's own word for the unit counts only where no scale is stated."""
    own = units.find_in_file(column.unit)
    if target.unit is not None or not column.unit or column.unit in units.NO_UNIT:
        if target.unit and own and own.name != target.unit.name and target.scale is None:
            _fail(recording.table, column, f"the file gives it in {column.unit}, the mapping in "
                  f"{target.unit.name}")
        return target.unit
    if target.scale is not None:
        would = units.conversion(own, target.to) if own else None
        if would and would.multiply != would.divide and abs(target.scale) == 1:
            recording.warnings.append(
                f"{recording.name}: '{column.name}' is in {column.unit} by the file, yet its "
                f"scale of {target.scale:g} is taken as it is; state `unit: {own.name}` to convert")
        return None
    if own is None or units.conversion(own, target.to) is None:
        _fail(recording.table, column, units.why_not(column.unit, target.to))
    return own


def _convert(recording, column, target, unit):
    table = recording.table
    values = table.numbers(column)
    if isinstance(unit, units.Counts):
        wrong = np.flatnonzero((values < unit.least) | (values > unit.most))
        if len(wrong):
            raise BadInput(f"{table.where(wrong[0])}: column '{shown(column.name)}': expected "
                           f"counts of {unit.bits} bits, {unit.least} to {unit.most}, found "
                           f"{values[wrong[0]]:.17g}")
        values = unit.apply(values)
    elif unit is not None:
        values = units.conversion(unit, target.to).apply(values)
    if target.scale is not None:
        values = target.scale * values
    values = values + target.offset if target.offset else values
    wrong = np.flatnonzero(np.isinf(values))
    if len(wrong):
        raise BadInput(f"{table.where(wrong[0])}: column '{shown(column.name)}': is too large "
                       "when converted")
    return values


def _take_time(recording, column, target):
    """Sets stamps or seconds, and returns the unit that was used."""
    table = recording.table
    # Of times in words the unit says nothing: ISO, UTC.
    words = column.is_text and times.looks_like_time(column.cells[0].strip())
    unit = target.unit if words else _unit(recording, column, target)
    if target.form is None:
        target.form, unit = times.form_of(table, column, unit, target)
    if target.form == "number":
        recording.seconds = _convert(recording, column, target, unit)
        missing = np.flatnonzero(np.isnan(recording.seconds))
        if len(missing):
            raise BadInput(f"{table.where(missing[0])}: column '{shown(column.name)}': a row "
                           "needs a time")
    elif target.scale is not None or target.offset:
        _fail(table, column, f"a time of format {target.form} takes no scale and no offset; "
              "state time_offset_s of its table")
    elif target.form == "clock":
        recording.seconds, unit = times.clock_seconds(table, column), None
    else:
        unit = None if target.form == "iso8601" else unit or units.UNITS["s"]
        recording.stamps = times.stamps_ns(table, column, target.form, unit)
    steps = np.diff(recording.stamps if recording.seconds is None else recording.seconds)
    back = np.flatnonzero(steps < 0)
    if len(back):
        raise BadInput(f"{table.where(back[0] + 1)}: column '{shown(column.name)}': the time goes "
                       "back; rows must be in order of time")
    recording.same_times = int(np.sum(steps == 0))
    return unit


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
        # The same Target may serve other tables, whose times have another form.
        target = Target(target.to, target.scale, target.offset, target.unit, target.form)
        if target.to == "time_s":
            unit = _take_time(recording, column, target)
        else:
            unit = _unit(recording, column, target)
            recording.channels[target.to] = _convert(recording, column, target, unit)
        recording.used.append(Used(column.name, target, unit))
    return recording


def _means(values, first, turns):
    """The mean of each group of rows, of what is measured in it."""
    good = np.isfinite(values)
    if turns:
        values = values.copy()
        values[good] = np.unwrap(values[good], period=360)
    with np.errstate(invalid="ignore"):
        return np.add.reduceat(np.where(good, values, 0.0), first) / np.add.reduceat(good.astype(int), first)


def _differ(values, first):
    """Whether what is measured in a group of rows differs."""
    good = np.isfinite(values)
    return np.maximum.reduceat(np.where(good, values, -np.inf), first) > \
        np.minimum.reduceat(np.where(good, values, np.inf), first)


def tell_equal_times(recording, joins):
    """Says that rows have one time. Where the table is joined with others by time they become their mean;
    BadInput if many differ and the steps of the clock are so long that what is measured in one has no time."""
    if not recording.same_times:
        return
    name, same = recording.name, f"{recording.same_times} of the {recording.table.rows} rows of {recording.name} have " \
        "the time of the row before"
    if not joins:
        recording.warnings.append(f"{name}: {same}")
        return
    at = recording.stamps if recording.seconds is None else recording.seconds
    steps = np.diff(at)
    first = np.concatenate(([0], np.flatnonzero(steps > 0) + 1))
    if len(first) == 1:
        raise BadInput(f"{recording.table.path}: all rows of {name} have one time, so they cannot be joined with the others")
    step_s = np.median(steps[steps > 0]) / (1e9 if recording.seconds is None else 1)
    differ = np.any([_differ(values, first) for values in recording.channels.values()], axis=0)
    tied = np.sum((np.diff(first, append=len(at)) - 1)[differ])
    if step_s > MOST_STEP_S * (1 + 1e-6) and tied >= COARSE_SHARE * len(steps):
        raise BadInput(f"{recording.table.path}: {same}: its clock steps by {step_s:.3g} s, which is too coarse to join it "
                       f"with the others by time; a clock that steps by {MOST_STEP_S:g} s or less will do")
    for channel, values in recording.channels.items():
        count = np.add.reduceat(np.isfinite(values).astype(int), first)
        recording.readings[channel] = np.where(_differ(values, first), count, np.minimum(count, 1))  # copies tell nothing
        recording.channels[channel] = _means(values, first, channel.endswith("_deg"))
    if recording.seconds is None:
        recording.stamps = recording.stamps[first]
    else:
        recording.seconds = recording.seconds[first]
    recording.warnings.append(f"{name}: {same}; rows of one time become their mean, one every {step_s:.3g} s")


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
        offset, std = mapping.time_offset(r.name)
        if offset is not None and r.time is not None:
            r.shift(offset, std)
    return origin
