"""One row for each place at which everything stands still.

A channel moves at time t if the means of parts of the shortest plateau about t (before and
after, middle and ends) differ by more than noise and a thousandth of its range allow. A
plateau is a stretch in which no channel moves. Each table's own readings are averaged
there; nothing is interpolated.
"""

import numpy as np

from errors import NoSolution
from noise import mean_std_factor, reading_std

NOISE_STD, RANGE_SHARE = 5.0, 1e-3
FOLLOWED = ("gauge_", "force_", "object_")


def scatter_name(column):
    """gauge_1_scatter_V of gauge_1_V: std of one reading of a plateau about its mean."""
    stem, _, unit = column.rpartition("_")
    return f"{stem}_scatter_{unit}"


class _Means:
    """Means of a channel between times, by sums up to each reading."""

    def __init__(self, time, values):
        self.time = time
        self.total = np.concatenate(([0.0], np.cumsum(values - values[0])))

    def between(self, begin, end):
        """(mean, number of readings); the mean is 0 where there are none."""
        low, high = (np.searchsorted(self.time, at, side="right") for at in (begin, end))
        return (self.total[high] - self.total[low]) / np.maximum(high - low, 1), high - low


def _differ(a, b, noise, allowed):
    """Whether two means differ by more than noise and what is allowed."""
    (a, count_a), (b, count_b) = a, b
    both = (count_a > 0) & (count_b > 0)
    limit = noise * np.sqrt(1 / np.maximum(count_a, 1) + 1 / np.maximum(count_b, 1)) + allowed
    return both & (np.abs(a - b) > limit)


def _moves(time, values, at, half_s):
    good = np.isfinite(values)
    t, v = time[good], values[good]
    if len(t) < 8:
        return np.zeros(len(at), dtype=bool)
    means, noise = _Means(t, v), NOISE_STD * reading_std(v)
    low, high = np.percentile(v, [1, 99])
    allowed = RANGE_SHARE * (high - low)
    moves = _differ(means.between(at - half_s, at), means.between(at, at + half_s), noise, allowed)
    # At a turning point both halves are alike, but the middle is not like the ends.
    middle = means.between(at - half_s / 2, at + half_s / 2)
    for end in (means.between(at - half_s, at - half_s / 2),
                means.between(at + half_s / 2, at + half_s)):
        moves |= _differ(middle, end, noise, allowed)
    return moves


def find(recordings, shortest_s):
    """(begin, end) of every plateau in s."""
    followed = [r for r in recordings if r.has(*FOLLOWED)]
    clock = min(followed, key=lambda r: r.period_s or np.inf)
    begin, end = (max(r.time[0] for r in followed), min(r.time[-1] for r in followed))
    at = clock.time[(clock.time >= begin) & (clock.time <= end)]
    half = shortest_s / 2
    # Both ends of the recording lack half a comparison.
    rests = (at >= begin + half) & (at <= end - half)
    for r in followed:
        for name, values in r.channels.items():
            if name.startswith(FOLLOWED):
                rests &= ~_moves(r.time, values, at, half)
    edges = np.flatnonzero(np.diff(np.concatenate(([0], rests.astype(int), [0]))))
    # Half of the margin that the comparison takes at each end is left for settling.
    runs = [(at[a] - half / 2, at[b - 1] + half / 2) for a, b in zip(edges[::2], edges[1::2])]
    merged = []
    for run in runs:
        if merged and run[0] <= merged[-1][1]:
            merged[-1] = (merged[-1][0], run[1])
        else:
            merged.append(run)
    return merged


def average(recordings, shortest_s):
    """({column: values}, [(column, std of a reading, std of a row)], notes)."""
    found = find(recordings, shortest_s)
    if not found:
        raise NoSolution(f"no place is held for {shortest_s:g} s: nothing to average; leave out "
                         "--plateaus, or choose a smaller --shortest_plateau_s")
    columns = {"time_s": np.array([(a + b) / 2 for a, b in found])}
    scatters, noise = {}, []
    for r in recordings:
        ranges = [np.searchsorted(r.time, (a, b)) for a, b in found]
        # By kind of channel: so many readings tell as much as one independent one, and how many there are.
        worth = {name.split("_")[0]: 1.0 for name in r.channels}
        counts = {}
        for name, values in r.channels.items():
            runs = [values[a:b][np.isfinite(values[a:b])] for a, b in ranges]
            of_rows = r.readings.get(name)  # rows of one time are their mean
            columns[name] = np.array([run.mean() if len(run) else np.nan for run in runs])
            kind = name.split("_")[0]
            own = np.array([len(run) if of_rows is None else of_rows[a:b].sum() for run, (a, b) in zip(runs, ranges)])
            there = counts.setdefault(kind, own)
            # The channel with the fewest readings counts for its kind, unless it is dead.
            counts[kind] = np.where((own > 0) & (there > 0), np.minimum(own, there), np.maximum(own, there))
            spread = np.array([run.std(ddof=1) if len(run) > 1 else np.nan for run in runs])
            spread *= np.sqrt(own / np.maximum(1, [len(run) for run in runs]))
            scatters[scatter_name(name)] = spread
            if np.isfinite(spread).any():
                one = float(np.sqrt(np.nanmean(spread**2)))
                count, factor = np.median(own[own > 0]), mean_std_factor(runs)
                noise.append((name, one, one / np.sqrt(count) * factor))
                worth[kind] = max(worth[kind], factor**2)
        for kind, readings in sorted(worth.items()):
            scatters[f"{kind}_readings"] = np.where(counts[kind] > 0, np.maximum(1.0, counts[kind] / readings), 0.0)
    measured = [n for n in columns if n.startswith(FOLLOWED)]
    empty = sum(bool(np.isnan([columns[n][i] for n in measured]).any())
                for i in range(len(found)))
    notes = [f"{empty} plateaus have empty cells"] if empty else []
    columns.update(scatters)
    return columns, noise, notes
