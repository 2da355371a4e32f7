"""Several tables become one by time.

The rows are those of a base table. A value between two readings is interpolated as
stated. Nothing is extrapolated, and in a gap of a table its cells stay empty.
"""

import numpy as np

from errors import BadInput, did_you_mean

GAP_PERIODS = 3


def base_of(recordings, name):
    """The table whose rows the log has: of those with gauges and force the slower one, so
    that no reading counts in two rows."""
    timed = [r for r in recordings if r.channels]
    if name:
        found = next((r for r in timed if r.name == name), None)
        if found is None:
            names = [r.name for r in timed]
            raise BadInput(f"there is no table '{name}' to take rows from"
                           f"{did_you_mean(name, names) or '; there are ' + ', '.join(names)}")
        return found
    kinds = [r for r in timed if r.has("gauge_", "force_")] or timed
    return max(kinds, key=lambda r: r.period_s or 0)


def interpolate(times, values, at, method, longest_gap_s, turns=False):
    """Values at times `at`; NaN before the first reading, behind the last, and in gaps."""
    out = np.full(len(at), np.nan)
    good = np.isfinite(values)
    t, v = times[good], values[good]
    if not len(t):
        return out
    if turns:
        v = np.unwrap(v, period=360)
    after = np.searchsorted(t, at, side="left")
    exact = (after < len(t)) & (t[np.minimum(after, len(t) - 1)] == at)
    inside = (after > 0) & (after < len(t)) & ~exact
    k = after[inside]
    gap = t[k] - t[k - 1]
    share = (at[inside] - t[k - 1]) / gap
    if method == "linear":
        between = v[k - 1] + share * (v[k] - v[k - 1])
    elif method == "nearest":
        between = np.where(share < 0.5, v[k - 1], v[k])
    else:
        between = v[k - 1]
    out[inside] = np.where(gap <= longest_gap_s * (1 + 1e-9), between, np.nan)
    out[exact] = v[after[exact]]
    return out


def join(recordings, base, method, longest_gap_s):
    """({column: values} with time_s, notes on what is missing)."""
    if base.time is None:
        return dict(base.channels), []
    others = [r for r in recordings if r is not base and r.channels]
    keep = np.ones(len(base.time), dtype=bool)
    for r in others:
        keep &= (base.time >= r.time[0]) & (base.time <= r.time[-1])
    if not keep.any():
        raise BadInput(f"{base.name} and {' and '.join(r.name for r in others)} share no time: "
                       + ", ".join(f"{r.name} from {r.time[0]:g} to {r.time[-1]:g} s"
                                   for r in [base] + others)
                       + "; if their clocks differ, state time_offset_s of a table in the mapping")
    at = base.time[keep]
    columns = {"time_s": at}
    columns.update({name: values[keep] for name, values in base.channels.items()})
    notes = []
    outside = int(np.sum(~keep))
    if outside:
        notes.append(f"{outside} rows of {base.name} at its ends lie outside of the other tables "
                     "and are left out")
    for r in others:
        limit = longest_gap_s or GAP_PERIODS * (r.period_s or 0)
        for name, values in r.channels.items():
            columns[name] = interpolate(r.time, values, at, method, limit, name.endswith("_deg"))
        notes += _gaps(r, at, limit)
    return columns, notes


def _gaps(recording, at, limit):
    """What to say of the gaps of a table that rows lie in."""
    notes = []
    for k in np.flatnonzero(np.diff(recording.time) > limit * (1 + 1e-9)):
        low, high = recording.time[k], recording.time[k + 1]
        rows = int(np.sum((at > low) & (at < high)))
        if rows:
            notes.append(f"{recording.name} has a gap from {low:g} to {high:g} s: {rows} rows have "
                         "empty cells there")
    if len(notes) > 5:
        notes = notes[:5] + [f"{recording.name} has {len(notes) - 5} more gaps"]
    return notes
