"""Bias, tool weight and axes of the force sensor, where the recording determines them.

Bias: the mean of free rows, in which the gauges read as at the start of the recording.
Tool weight, of a sensor that turns with the object: free rows at several angles a read
bias + R(a)' w. At one angle the weight is part of the bias.
Axes: without friction the finger keeps the work that the object does on it, so the force
on the finger is the gradient of an energy U(x, y) of the object's place. R(psi) G, with G the
force without bias along the sensor's axes, is a gradient for one psi only (and its opposite,
which pulls). With U a polynomial, the squares of what is no gradient are a quadratic form in
(cos psi, sin psi), and psi is its smaller eigenvector.
"""

import numpy as np

import plateaus
from errors import NoSolution
from noise import reading_std
from vocabulary import SENSOR_AXES

FREE_STD, START_S, LEAST_FREE = 4.0, 0.25, 5
MOST_ANGLE_STD_DEG = 1.0
BLOCKS, MOST_ROWS = 20, 20000
MIRRORED_GAIN = 2.0  # a mirrored axis halves the squares of what is no gradient, or it is none
NO_AXES = "axes of the force sensor: not determined"
JOINT_AXES = ["force_x_N", "force_y_N"]


def force_axes(columns):
    """The columns of the force, along whichever axes."""
    for axes in (SENSOR_AXES, JOINT_AXES, ["force_N"]):
        if all(name in columns for name in axes):
            return axes
    return []


def free_rows(columns, gauge_noise, free_s):
    """Rows in which nothing touches the finger, as a boolean array."""
    time = columns.get("time_s")
    if free_s is not None and time is not None:
        return (time >= free_s[0]) & (time <= free_s[1])
    gauges = [name for name in columns if name.startswith("gauge_")]
    if not gauges or time is None:
        return np.zeros(len(next(iter(columns.values()))), dtype=bool)
    start = time <= time[0] + START_S
    start[:3] = True
    values = np.stack([columns[name] for name in gauges], axis=1)
    most = np.array([gauge_noise[name] for name in gauges]) + 1e-12
    centre = np.nanmedian(values[start], axis=0)
    known = np.isfinite(values).all(axis=1)
    far = np.where(known, np.max(np.abs(values - centre) / most, axis=1, initial=0), np.inf)
    # The nearest rows, and then all that are as near as the noise of those allows. The noise
    # between neighbouring rows bounds it: it is too large where every row is another place.
    free = far <= np.sort(far)[min(max(LEAST_FREE, len(far) // 50), len(far)) - 1]
    for _ in range(50):
        centre = values[free & known].mean(axis=0)
        spread = np.minimum(values[free & known].std(axis=0), most) + 1e-12
        grown = known & (np.abs(values - centre) < FREE_STD * spread).all(axis=1)
        if not grown.any() or (grown == free).all():
            break
        free = grown
    return free & known


def follows_gauges(columns, axes, free):
    """Whether the force of rows that count as free goes with the gauges, so that something touches
    in them: gauges explain more than half of the variance that chance leaves them. Free rows are
    found by the gauges alone, and where every row is another place all may look alike."""
    gauges = [v for name, v in columns.items() if name.startswith("gauge_")]
    if not gauges:
        return False
    gauges = np.stack(gauges, axis=1)
    force = np.stack([columns[a] for a in axes], axis=1)
    rows = free & np.isfinite(force).all(axis=1) & np.isfinite(gauges).all(axis=1)
    left = rows.sum() - gauges.shape[1] - 1
    if left < gauges.shape[1]:
        return False
    known = np.column_stack([np.ones(rows.sum()), gauges[rows]])
    unexplained = force[rows] - known @ np.linalg.lstsq(known, force[rows], rcond=None)[0]
    total = force[rows] - force[rows].mean(axis=0)
    return bool(((unexplained**2).sum(axis=0) / left <
                 0.5 * (total**2).sum(axis=0) / (rows.sum() - 1)).any())


def gauge_noise(recordings):
    return {name: reading_std(values) for r in recordings
            for name, values in r.channels.items() if name.startswith("gauge_")}


def bias(columns, axes, free):
    """(bias, std) of each axis; raises NoSolution."""
    force = np.stack([columns[a] for a in axes], axis=1)
    rows = free & np.isfinite(force).all(axis=1)
    if rows.sum() < LEAST_FREE:
        raise NoSolution(f"bias of the force sensor: {rows.sum()} free rows, {LEAST_FREE} are "
                         "needed; state when the finger is free with --free_s")
    middle = np.median(force[rows], axis=0)
    scale = np.median(np.abs(force[rows] - middle), axis=0) / 0.6745
    # A light touch that the gauges do not feel is not free.
    rows &= (np.abs(force - middle) <= FREE_STD * scale + 1e-12).all(axis=1)
    value, spread = force[rows].mean(axis=0), force[rows].std(axis=0, ddof=1)
    if axes == ["force_N"]:
        below = np.sum(force[~free] < value - 5 * spread - 1e-9)
        if below > 0.2 * max(np.sum(~free), 1):
            raise NoSolution("bias of the force sensor: many rows have less force than those in "
                             "which the gauges read as at the start; state when the finger is "
                             "free with --free_s")
    return value, spread / np.sqrt(rows.sum())


def turned(vectors, angle_rad):
    """R(angle) v for rows of vectors; one angle, or one a row."""
    c, s = np.cos(angle_rad), np.sin(angle_rad)
    return np.stack((c * vectors[:, 0] - s * vectors[:, 1],
                     s * vectors[:, 0] + c * vectors[:, 1]), axis=1)


def bias_and_weight(columns, free):
    """(bias, weight, std of both) of sensor axes that turn with the object, by least squares."""
    force = np.stack([columns[a] for a in SENSOR_AXES], axis=1)
    rows = free & np.isfinite(force).all(axis=1) & np.isfinite(columns["object_angle_deg"])
    angle = np.deg2rad(columns["object_angle_deg"][rows])
    one, zero, c, s = np.ones(len(angle)), np.zeros(len(angle)), np.cos(angle), np.sin(angle)
    matrix = np.concatenate((np.stack((one, zero, c, s), axis=1),
                             np.stack((zero, one, -s, c), axis=1)))
    right = force[rows].T.ravel()
    if rows.sum() < LEAST_FREE or np.linalg.cond(matrix) > 100:
        raise NoSolution("tool weight: the free rows do not have enough different "
                         "object_angle_deg")
    solution, _, _, _ = np.linalg.lstsq(matrix, right, rcond=None)
    residual = right - matrix @ solution
    variance = residual @ residual / (len(right) - 4)
    std = np.sqrt(variance * np.diag(np.linalg.inv(matrix.T @ matrix)))
    return solution[:2], solution[2:], std[:2], std[2:]


def _gradients(x, y, degree):
    """d/dx and d/dy of all monomials of x, y up to a degree, without the constant."""
    dx, dy = [], []
    for i in range(degree + 1):
        for j in range(degree + 1 - i):
            if i + j == 0:
                continue
            dx.append(i * x**max(i - 1, 0) * y**j)
            dy.append(j * x**i * y**max(j - 1, 0))
    return np.stack(dx, axis=1), np.stack(dy, axis=1)


def _turn(x, y, force, degree):
    """(psi, std, mean square that is no gradient)."""
    dx, dy = _gradients(x, y, degree)
    basis = np.linalg.qr(np.concatenate((dx, dy)))[0]
    sides = np.stack((np.concatenate((force[:, 0], force[:, 1])),
                      np.concatenate((-force[:, 1], force[:, 0]))), axis=1)
    sides = sides - basis @ (basis.T @ sides)
    values, vectors = np.linalg.eigh(sides.T @ sides)
    c, s = vectors[:, 0]
    if np.mean(c * force[:, 0] - s * force[:, 1]) < 0:  # the object pushes, it never pulls
        c, s = -c, -s
    free = max(2 * len(x) - basis.shape[1] - 1, 1)
    return np.arctan2(s, c), np.sqrt(values[0] / free / values[1]), values[0] / free


class _Axes:
    """degrees and std_deg of the turn into frame S, and the mean square that is no gradient."""

    def __init__(self, x, y, force):
        """Raises NoSolution with too few rows."""
        best = None
        for degree in range(2, 9):
            terms = (degree + 1) * (degree + 2) // 2 - 1
            if terms * 6 > 2 * len(x):
                break
            psi, std, rest = _turn(x, y, force, degree)
            score = 2 * len(x) * np.log(rest + 1e-300) + terms * np.log(2 * len(x))
            if best is None or score < best[0]:
                best = (score, psi, std, rest, degree)
        if best is None:
            raise NoSolution(f"{NO_AXES}: too few rows with force")
        _, psi, std, self.rest, degree = best
        blocks = np.arange(len(x)) * BLOCKS // len(x)
        others = [_turn(x[blocks != b], y[blocks != b], force[blocks != b], degree)[0]
                  for b in range(BLOCKS)]
        moves = (np.array(others) - psi + np.pi) % (2 * np.pi) - np.pi
        std = max(std, float(np.sqrt((BLOCKS - 1) * np.mean((moves - moves.mean())**2))))
        self.degrees, self.std_deg = float(np.degrees(psi)), float(np.degrees(std))


def _rows_with_force(columns, force):
    """x and y in one unit, and the force, of rows that tell about axes; raises NoSolution."""
    if not all(n in columns for n in ("object_x_mm", "object_y_mm")):
        raise NoSolution(f"{NO_AXES} without object_x_mm and object_y_mm")
    size = np.hypot(force[:, 0], force[:, 1])
    x, y = columns["object_x_mm"], columns["object_y_mm"]
    good = np.isfinite(size) & np.isfinite(x) & np.isfinite(y)
    if good.sum() < 40:
        raise NoSolution(f"{NO_AXES}: too few rows")
    good &= size > 0.1 * np.percentile(size[good], 95)
    good = np.flatnonzero(good)[::int(np.ceil(good.sum() / MOST_ROWS))]
    x, y, force = x[good], y[good], force[good]
    # One unit for both, or the gradient would be another.
    unit = max(np.ptp(x), np.ptp(y)) / 2
    if not unit > 0 or min(np.ptp(x), np.ptp(y)) < 1e-3 * unit:
        raise NoSolution(f"{NO_AXES}: the object moves along one line only")
    return (x - x.mean()) / unit, (y - y.mean()) / unit, force


def _mirrored(rows, own, axes):
    """What to say if the force is a gradient with one axis mirrored and not as it is, or None."""
    x, y, force = rows
    other = _Axes(x, y, force * [-1, 1])
    if not MIRRORED_GAIN * other.rest < own.rest or other.std_deg > MOST_ANGLE_STD_DEG:
        return None
    # Mirrored in y it is turned by another 180 deg; axes are mapped nearly as they lie.
    wrong, turn = (axes[0], other.degrees) if abs(other.degrees) <= 90 else \
        (axes[1], other.degrees - np.copysign(180, other.degrees))
    return (f"the sign of {wrong} is wrong: mirrored, the forces fit the finger {own.rest / other.rest:.2g} "
            f"times as well (squares of what is left), turned by {turn:.3f} deg, std {other.std_deg:.3f} "
            f"deg; change the sign of its scale in the mapping, or, if that is right, of one axis of "
            "the object's place")


def mirrored(columns, force, axes):
    """What to say of the sign of an axis, or None where nothing shows that it is wrong."""
    try:
        rows = _rows_with_force(columns, force)
        return _mirrored(rows, _Axes(*rows), axes)
    except NoSolution:
        return None


def rotation(columns, force):
    """(degrees, std) by which the sensor's axes are turned into frame S; raises NoSolution.

    force: without bias, in the sensor's axes (turned by the object's angle if it turns with it).
    """
    rows = _rows_with_force(columns, force)
    own = _Axes(*rows)
    wrong = _mirrored(rows, own, SENSOR_AXES)
    if wrong:
        raise NoSolution(f"{NO_AXES}: {wrong}")
    if own.std_deg > MOST_ANGLE_STD_DEG:
        raise NoSolution(f"{NO_AXES}: its std would be {own.std_deg:.2g} deg; record presses at "
                         "more heights and depths")
    return own.degrees, own.std_deg


def take_magnitude(columns, noise):
    """Replaces the force along the sensor's axes by its size force_N, where rows are means.

    noise: (column, std of a reading, std of a row of the median number of readings). The size of
    a mean of n readings is too large by the noise of the mean, |m|^2 = |F|^2 + s_x^2 + s_y^2, which
    scatter tells, so that much is taken off. Returns whether it is known.
    """
    along = np.stack([columns.pop(name) for name in SENSOR_AXES], axis=1)
    square, std = (along**2).sum(axis=1), {name: row for name, _, row in noise}
    scatters = [columns.pop(plateaus.scatter_name(name), None) for name in SENSOR_AXES]
    known = all(name in std for name in SENSOR_AXES)
    with np.errstate(invalid="ignore", divide="ignore"):
        if all(scatter is not None for scatter in scatters):
            columns["force_scatter_N"] = np.sqrt((along**2 * np.stack(scatters, axis=1)**2).sum(axis=1) / square)
        if known:
            count = columns["force_readings"]
            off = sum(std[name]**2 for name in SENSOR_AXES) * np.median(count[count > 0]) / count
            square = np.where(count > 0, np.maximum(square - off, 0), np.nan)
    columns["force_N"] = np.sqrt(square)
    return known
