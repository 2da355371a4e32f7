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

LEAST_ROWS, MOST_ROWS, ROWS_A_TERM, BLOCKS = 30, 20000, 8, 20
SMOOTHING_S = 0.01  # of fast tables: without it noise would pass for slopes
MOST_STD_S = 0.005  # or a quarter of the slower period
LEAST_R2, LEAST_CONTRAST = 0.9, 1.5


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


def _monomials(gauges, degree):
    columns = [np.ones(len(gauges))]
    for d in range(1, degree + 1):
        for which in itertools.combinations_with_replacement(range(gauges.shape[1]), d):
            columns.append(np.prod(gauges[:, which], axis=1))
    return np.stack(columns, axis=1)


class _Misfit:
    """Rows of force against gauges for a trial offset."""

    def __init__(self, force, gauges, longest_s):
        self.force_is_slow = force.period_s >= gauges.period_s
        self.slow, self.fast = (force, gauges) if self.force_is_slow else (gauges, force)
        self.period = self.slow.period_s
        # A gauge that is dead for most of the time would leave no rows.
        self.names = {r: sorted(n for n, v in r.channels.items() if n.startswith(stem) and
                                np.isfinite(v).mean() > 0.5)
                      for r, stem in ((force, "force_"), (gauges, "gauge_"))}
        self.width_s = max(0.1 * self.period, SMOOTHING_S)
        self.inputs = {n: _smooth(r.time, r.channels[n], self.width_s)
                       for r in (force, gauges) for n in self.names[r]}
        margin = longest_s + self.period + self.width_s
        rows = (self.slow.time > self.fast.time[0] + margin) & \
            (self.slow.time < self.fast.time[-1] - margin)
        if not all(self.names.values()):
            rows[:] = False
        for name in self.names[self.slow]:
            rows &= np.isfinite(self.inputs[name])
        # Rows that smoothing has made alike would count several times.
        alike = 2 * self.width_s / self.period if self.width_s > self.period else 1
        self.rows = np.flatnonzero(rows)[::int(np.ceil(max(alike, rows.sum() / MOST_ROWS)))]
        self.centre = self.width = None

    def sides(self, offset_s):
        """(gauges scaled, force) at the slow table's times, force moved by the offset."""
        at = self.slow.time[self.rows] + (offset_s if self.force_is_slow else -offset_s)
        gap = 3 * self.fast.period_s
        fast = np.stack([interpolate(self.fast.time, self.inputs[n], at, "linear", gap)
                         for n in self.names[self.fast]], axis=1)
        slow = np.stack([self.inputs[n][self.rows] for n in self.names[self.slow]], axis=1)
        gauges, force = (fast, slow) if self.force_is_slow else (slow, fast)
        if self.centre is None:
            self.centre = np.nanmean(gauges, axis=0)
            self.width = np.nanstd(gauges, axis=0)
            self.width[self.width <= 1e-12 * np.abs(self.centre)] = np.inf  # it does not move
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
        if good.sum() < LEAST_ROWS:
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


def estimate(force, gauges, longest_s):
    """Offset of a Recording with force_* against one with gauge_*; raises NoSolution."""
    why = f"the time offset between {force.name} and {gauges.name} is not determined"
    if not force.period_s or not gauges.period_s:
        raise NoSolution(f"{why}: a table has fewer than two times")
    misfit = _Misfit(force, gauges, longest_s)
    rows = len(misfit.rows)
    if rows < LEAST_ROWS:
        raise NoSolution(f"{why}: {rows} rows in common, {LEAST_ROWS} are needed")
    step = min(max(misfit.period / 3, longest_s / 400), longest_s / 10)
    grid = np.arange(-np.ceil(longest_s / step), np.ceil(longest_s / step) + 1) * step
    coarse = 2 if rows > 15 * ROWS_A_TERM else 1
    values = np.array([misfit.misfit(tau, coarse) for tau in grid])
    k = int(np.argmin(values))
    if values[k] > 1 - 1e-9:
        raise NoSolution(f"{why}: too few rows in common, or a force that stays as it is")
    if k in (0, len(grid) - 1):
        raise NoSolution(f"{why} within {longest_s:g} s: choose a larger --longest_offset_s")
    tau = float(grid[k])
    degree = _degree(misfit, tau, rows)
    for _ in range(20):
        move, std = misfit.step(tau, degree)
        move = float(np.clip(move, -misfit.period, misfit.period))
        tau += move
        if abs(move) < 1e-3 * std or abs(move) < 1e-7:
            break
    r2 = 1 - misfit.misfit(tau, degree)
    if r2 < LEAST_R2:
        raise NoSolution(f"{why}: gauges explain only {100 * r2:.0f} % of the force")
    alike = values < LEAST_CONTRAST * values[k]
    others = np.flatnonzero(~alike)
    lobe = slice(max(others[others < k], default=-1) + 1,
                 min(others[others > k], default=len(grid)))
    alike[lobe] = False
    if alike.any():
        other = grid[alike][np.argmin(values[alike])]
        raise NoSolution(f"{why}: {tau:.3g} s and {other:.3g} s explain it alike, as in a motion "
                         "that repeats")
    blocks = np.arange(rows) * BLOCKS // rows
    moves = np.array([misfit.step(tau, degree, blocks != b)[0] for b in range(BLOCKS)])
    jackknife = np.sqrt((BLOCKS - 1) * np.mean((moves - moves.mean())**2))
    std = max(std, float(jackknife), _half_stretch(misfit, tau, degree, std))
    if not std < max(misfit.period / 4, MOST_STD_S):
        raise NoSolution(f"{why}: its std would be {std:.2g} s; record more slopes of force "
                         "that last some readings")
    return Offset(tau, std, degree, r2, rows)
