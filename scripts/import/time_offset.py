"""How far the clock of the force is off from that of the gauges.

At rest and slow motion the force is a function of the gauges alone: both follow from the
same contact. F(t + tau) = c' phi(g(t)) with phi the monomials of the gauges up to a degree.
The tau that leaves the least squares is sought on a grid (the largest multiple correlation
between gauges and force) and refined by Gauss-Newton in tau and c together. Its std is the
largest of three: that of the least squares; that of a jackknife over blocks of time, which
also feels what phi cannot express; and half the stretch in which the squares are as good,
which is wide where the force jumps between two readings.
"""

import itertools

import numpy as np

from errors import NoSolution
from joining import interpolate
from noise import reading_std

LEAST_ROWS, MOST_ROWS, GRID_ROWS, ROWS_A_TERM, BLOCKS = 30, 20000, 2000, 8, 20
CANDIDATES = 5
GRID_STEP_S = 0.1  # at most: a slope of the force lasts some tenths of a second
WIDE_S = 60.0  # beyond what is allowed, so that a refusal can say how far apart the clocks are
SMOOTHING_S = 0.01  # of fast tables: without it noise would pass for slopes
MOST_STD_S = 0.005  # or a quarter of the slower period
LEAST_R2, LEAST_CONTRAST = 0.9, 1.5
SURE_R2 = 0.99  # below it clocks that are further apart are looked for
MOVING_STD = 5.0  # of the force's own noise: below it nothing presses


class ClocksApart(NoSolution):
    """Times as they are would make a useless log."""


class Offset:
    """offset_s is added to the times of the force; r2: share of the force that is explained."""

    def __init__(self, offset_s, std_s, degree, r2, rows):
        self.offset_s, self.std_s, self.degree = offset_s, std_s, degree
        self.r2, self.rows = r2, rows


def _smooth(time, values, width_s):
    """A Gaussian mean over equal steps of time; symmetric, so nothing is shifted."""
    step = np.median(np.diff(time))
    if width_s < step:
        return values
    reach = int(np.ceil(3 * width_s / step))
    kernel = np.exp(-0.5 * (np.arange(-reach, reach + 1) * step / width_s)**2)
    kernel /= kernel.sum()
    return np.convolve(np.pad(values, reach, mode="edge"), kernel, "valid")


def _alive(recording, stem):
    """Names of channels; one that is dead for most of the time would leave no rows."""
    return sorted(name for name, values in recording.channels.items()
                  if name.startswith(stem) and np.isfinite(values).mean() > 0.5)


def _monomials(gauges, degree):
    columns = [np.ones(len(gauges))]
    for d in range(1, degree + 1):
        for which in itertools.combinations_with_replacement(range(gauges.shape[1]), d):
            columns.append(np.prod(gauges[:, which], axis=1))
    return np.stack(columns, axis=1)


class _Misfit:
    """Rows of force against gauges for a trial offset."""

    def __init__(self, force, gauges, longest_s, most_rows=MOST_ROWS):
        self.force_is_slow = force.period_s >= gauges.period_s
        self.slow, self.fast = (force, gauges) if self.force_is_slow else (gauges, force)
        self.period = self.slow.period_s
        self.names = {r: _alive(r, stem) for r, stem in ((force, "force_"), (gauges, "gauge_"))}
        self.width_s = max(0.1 * self.period, SMOOTHING_S)
        self.inputs = {n: _smooth(r.time, r.channels[n], self.width_s)
                       for r in (force, gauges) for n in self.names[r]}
        # The same rows for all offsets, unless few would be left.
        margin = longest_s + self.period + self.width_s
        rows = (self.slow.time > self.fast.time[0] + margin) & \
            (self.slow.time < self.fast.time[-1] - margin)
        if 2 * rows.sum() < len(rows):
            rows[:] = True
        if not all(self.names.values()):
            rows[:] = False
        for name in self.names[self.slow]:
            rows &= np.isfinite(self.inputs[name])
        # Rows that smoothing has made alike would count several times.
        alike = 2 * self.width_s / self.period if self.width_s > self.period else 1
        self.rows = np.flatnonzero(rows)[::int(np.ceil(max(alike, rows.sum() / most_rows)))]
        read = [self.inputs[n] for n in self.names[gauges]]
        self.centre = np.array([np.nanmean(v) for v in read])
        self.width = np.array([np.nanstd(v) for v in read])
        self.width[self.width <= 1e-12 * np.abs(self.centre)] = np.inf  # it does not move

    def sides(self, offset_s):
        """(gauges scaled, force) at the slow table's times, force moved by the offset."""
        at = self.slow.time[self.rows] + (offset_s if self.force_is_slow else -offset_s)
        gap = 3 * self.fast.period_s
        fast = np.stack([interpolate(self.fast.time, self.inputs[n], at, "linear", gap)
                         for n in self.names[self.fast]], axis=1)
        slow = np.stack([self.inputs[n][self.rows] for n in self.names[self.slow]], axis=1)
        gauges, force = (fast, slow) if self.force_is_slow else (slow, fast)
        return (gauges - self.centre) / self.width, force

    def fit(self, offset_s, degree):
        """(residuals, terms, coefficients, good rows)."""
        gauges, force = self.sides(offset_s)
        good = np.isfinite(gauges).all(axis=1) & np.isfinite(force).all(axis=1)
        terms, force = _monomials(gauges[good], degree), force[good]
        coefficients = np.linalg.lstsq(terms, force, rcond=1e-10)[0]
        return force - terms @ coefficients, terms, coefficients, good

    def misfit(self, offset_s, degree):
        """Mean square of what the gauges do not explain of the force, over its variance."""
        residual, terms, coefficients, good = self.fit(offset_s, degree)
        if good.sum() < max(LEAST_ROWS, len(self.rows) / 4):
            return 1.0
        force = residual + terms @ coefficients
        return float(np.sum(residual**2) / (np.sum((force - force.mean(axis=0))**2) + 1e-300))

    def step(self, offset_s, degree, keep=None):
        """(Gauss-Newton step, its std): d residual / d tau by central differences, with the
        coefficients eliminated."""
        residual, terms, coefficients, good = self.fit(offset_s, degree)
        h = self.width_s
        later, earlier = self.sides(offset_s + h), self.sides(offset_s - h)
        slope = (later[1] - earlier[1])[good] - (
            _monomials(later[0][good], degree) - _monomials(earlier[0][good], degree)) \
            @ coefficients
        slope /= 2 * h
        use = np.isfinite(slope).all(axis=1)
        if keep is not None:
            use &= keep[good]
        basis = np.linalg.qr(terms[use])[0]
        residual, slope = residual[use], slope[use]
        residual = residual - basis @ (basis.T @ residual)
        slope = slope - basis @ (basis.T @ slope)
        information = float(np.sum(slope**2))
        free = residual.size - basis.shape[1] * residual.shape[1] - 1
        variance = float(np.sum(residual**2)) / max(free, 1)
        if information <= 0:
            return 0.0, np.inf
        return -float(np.sum(slope * residual)) / information, np.sqrt(variance / information)


def _half_stretch(misfit, tau, degree, std):
    """Half the stretch about tau in which the sum of squares grows by less than one variance."""
    residual, terms, _, _ = misfit.fit(tau, degree)
    free = max(residual.size - terms.shape[1] * residual.shape[1] - 1, 1)
    least = np.mean(residual**2)
    allowed = least * (1 + 1 / free) + 1e-300
    ends = []
    for sign in (1, -1):
        reach = max(std, 1e-6)
        while reach < 2 * misfit.period and \
                np.mean(misfit.fit(tau + sign * reach, degree)[0]**2) < allowed:
            reach *= 1.3
        ends.append(reach)
    return sum(ends) / 2


def _degree(misfit, offset_s, rows):
    """The degree by the Bayesian criterion."""
    best, chosen = np.inf, 1
    for degree in (1, 2, 3, 4):
        residual, terms, _, _ = misfit.fit(offset_s, degree)
        if degree > 1 and terms.shape[1] * ROWS_A_TERM > rows:
            break
        score = residual.size * np.log(np.mean(residual**2) + 1e-300) + \
            terms.shape[1] * residual.shape[1] * np.log(residual.size)
        if score < best:
            best, chosen = score, degree
    return chosen


def _on_grid(misfit, longest_s):
    """(offsets, the misfit of each)."""
    step = min(max(misfit.period / 3, min(longest_s / 400, GRID_STEP_S)), longest_s / 10)
    grid = np.arange(-np.ceil(longest_s / step), np.ceil(longest_s / step) + 1) * step
    coarse = 2 if len(misfit.rows) > 15 * ROWS_A_TERM else 1
    return grid, np.array([misfit.misfit(tau, coarse) for tau in grid])


def _refined(misfit, tau, rows):
    """(offset, std of the least squares, degree, r2) from a place on the grid."""
    for _ in range(2):
        start, degree = tau, _degree(misfit, tau, rows)
        for _ in range(20):
            move, std = misfit.step(tau, degree)
            move = float(np.clip(move, -misfit.period, misfit.period))
            tau += move
            if abs(move) < 1e-3 * std or abs(move) < 1e-7:
                break
        if abs(tau - start) <= misfit.period:
            break  # else the degree was chosen too far off
    return tau, std, degree, 1 - misfit.misfit(tau, degree)


def _within(force, gauges, longest_s):
    """Offset of at most longest_s; raises NoSolution."""
    misfit = _Misfit(force, gauges, longest_s)
    rows = len(misfit.rows)
    if rows < LEAST_ROWS:
        raise NoSolution(f"{rows} rows in common, {LEAST_ROWS} are needed")
    grid, values = _on_grid(_Misfit(force, gauges, longest_s, GRID_ROWS), longest_s)
    k = int(np.argmin(values))
    if values[k] > 1 - 1e-9:
        raise NoSolution("too few rows in common, or a force that stays as it is")
    if grid[1] - grid[0] > misfit.period:  # too coarse to tell the best from the next ones
        inner = np.flatnonzero((values[1:-1] <= values[:-2]) & (values[1:-1] <= values[2:])) + 1
        near = [k, *(i for i in inner[np.argsort(values[inner])] if i != k)][:CANDIDATES]
        fine = [_refined(misfit, float(grid[i]), rows) for i in near]
        values = np.full(len(grid), 1.0)
        values[near] = [1 - r2 for *_, r2 in fine]
        k = near[int(np.argmin(values[near]))]
        tau, std, degree, r2 = fine[near.index(k)]
    else:
        tau, std, degree, r2 = _refined(misfit, float(grid[k]), rows)
    if r2 < LEAST_R2:
        raise NoSolution(f"gauges explain only {100 * r2:.0f} % of the force")
    if k in (0, len(grid) - 1) or abs(tau) > longest_s:
        raise NoSolution("the best is at the end of what is sought")
    alike = values < LEAST_CONTRAST * values[k]
    others = np.flatnonzero(~alike)
    lobe = slice(max(others[others < k], default=-1) + 1,
                 min(others[others > k], default=len(grid)))
    alike[lobe] = False
    if alike.any():
        other = grid[alike][np.argmin(values[alike])]
        raise NoSolution(f"{tau:.3g} s and {other:.3g} s explain it alike, as in a motion "
                         "that repeats")
    blocks = np.arange(rows) * BLOCKS // rows
    moves = np.array([misfit.step(tau, degree, blocks != b)[0] for b in range(BLOCKS)])
    jackknife = np.sqrt((BLOCKS - 1) * np.mean((moves - moves.mean())**2))
    std = max(std, float(jackknife), _half_stretch(misfit, tau, degree, std))
    if not std < max(misfit.period / 4, MOST_STD_S):
        raise NoSolution(f"its std would be {std:.2g} s; record more slopes of force "
                         "that last some readings")
    return Offset(tau, std, degree, r2, rows)


def _wider(force, gauges, longest_s, most_misfit):
    """What to say if clocks that are further apart explain the force, and leave less than a
    share of its variance, or None."""
    if longest_s >= WIDE_S:
        return None
    try:
        found = _within(force, gauges, WIDE_S)
    except NoSolution:
        return None
    if abs(found.offset_s) <= longest_s or 1 - found.r2 > most_misfit:
        return None
    return f"the clocks are {abs(found.offset_s):.4g} s apart by them: gauges explain " \
        f"{100 * found.r2:.2f} % of the force there; give --longest_offset_s " \
        f"{max(np.ceil(1.2 * abs(found.offset_s)), 2 * longest_s):g} to take that"


def _agrees(force, gauges, longest_s):
    """Whether times may be taken as they are: gauges explain the force by them, or the force stays
    within its noise."""
    misfit = _Misfit(force, gauges, longest_s)
    moves = any(np.nanstd(force.channels[n]) > MOVING_STD * reading_std(force.channels[n])
                for n in misfit.names[force])
    rows = misfit.fit(0.0, 1)[3].sum()
    return not moves or len(misfit.rows) < LEAST_ROWS or rows >= LEAST_ROWS and \
        1 - misfit.misfit(0.0, _degree(misfit, 0.0, rows)) >= LEAST_R2


def estimate(force, gauges, longest_s):
    """Offset of a Recording with force_* against one with gauge_*.

    Raises NoSolution where it is not determined, and ClocksApart where times as they are would
    join what does not belong together.
    """
    why = f"the time offset between {force.name} and {gauges.name} is not determined"
    if not force.period_s or not gauges.period_s:
        raise NoSolution(f"{why}: a table has fewer than two times")
    for recording, stem in ((force, "force_"), (gauges, "gauge_")):
        if not _alive(recording, stem):
            raise NoSolution(f"{why}: {recording.name} has no readings in most of its rows")
    why += f" within {longest_s:g} s"
    try:
        found = _within(force, gauges, longest_s)
    except NoSolution as error:
        why += f": {error}"
        apart = _wider(force, gauges, longest_s, 1 - LEAST_R2)
        if apart:
            raise ClocksApart(f"{why}; {apart}") from error
        if not _agrees(force, gauges, longest_s):
            raise ClocksApart(
                f"{why}; if the clocks are further apart, give a larger --longest_offset_s; if they "
                "agree, --force_time_offset_s 0; if a column is not what the mapping says, mend that"
            ) from error
        raise NoSolution(why) from error
    if found.r2 < SURE_R2:  # a motion that nearly repeats
        apart = _wider(force, gauges, longest_s, (1 - found.r2) / LEAST_CONTRAST)
        if apart:
            raise ClocksApart(f"{why}: {100 * found.r2:.2f} % explained at {found.offset_s:.4g} s; "
                              f"{apart}")
    return found
