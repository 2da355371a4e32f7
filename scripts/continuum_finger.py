"""Equilibria of a Fin-Ray finger's continuum equations by global collocation.

Independent of libfinray: every bay carries the fields (phi, M, u, v), the
turn, moment and displacement against the undeformed finger, at Chebyshev
points, and its constant internal force (N_x, N_y). The bays' integral equations

    phi' = M / EI,  M' = N_x sin(theta) - N_y cos(theta),
    u' = cos(theta) - cos(theta_0),  v' = sin(theta) - sin(theta_0),

the jumps at ribs and contacts, rib lengths, clamps and tip closure make one
sparse Newton system. Working with differences from the undeformed finger keeps
small loads as exact, relatively, as large ones. Residuals are evaluated in
extended precision, the linear solves in double, so that Newton's method is also
iterative refinement. All quantities in here are scaled by l_0 and EI_front.
"""

import numpy as np
from scipy.sparse import csc_matrix
from scipy.sparse.linalg import splu

REAL = np.longdouble
PI = 4 * np.arctan(REAL(1))


def chebyshev(n):
    """Points on [0, 1], values-to-coefficients and integration matrix."""
    k = np.arange(n + 1)
    angle = PI * (n - k).astype(REAL) / n
    points = np.cos(angle)
    halved = np.where((k == 0) | (k == n), REAL(2), REAL(1))
    values = np.cos(angle[:, None] * k[None, :])
    to_coefficients = 2 / (n * halved[:, None] * halved[None, :]) * values.T
    integral = np.zeros((n + 1, n + 1), dtype=REAL)
    integral[:, 0] = points + 1
    integral[:, 1] = (points**2 - 1) / 2
    for j in range(2, n + 1):
        upper = np.cos((j + 1) * angle) / (2 * (j + 1))
        lower = np.cos((j - 1) * angle) / (2 * (j - 1))
        integral[:, j] = (upper - lower) - (upper[0] - lower[0])
    return (points + 1) / 2, to_coefficients, integral.dot(to_coefficients) / 2


def evaluate(to_coefficients, values, at):
    """The interpolant of values at points of [0, 1]."""
    coefficients = to_coefficients.dot(values)
    angle = np.arccos(np.clip(2 * np.asarray(at, dtype=REAL) - 1, -1, 1))
    return np.cos(angle[..., None] * np.arange(len(coefficients))).dot(coefficients)


class Geometry:
    """The undeformed finger over l_0, from a finger YAML."""

    def __init__(self, yaml, front_stiffness, back_stiffness):
        self.unit_mm = REAL(yaml['geometry']['front_length_mm'])
        phi = REAL(yaml['geometry']['back_angle_deg']) * PI / 180
        self.angle = [PI / 2, phi]
        self.direction = [(REAL(0), REAL(1)), (np.cos(phi), np.sin(phi))]
        self.base_x = [REAL(0), -np.cos(phi) / np.sin(phi)]
        self.length = [REAL(1), 1 / np.sin(phi)]
        self.compliance = [REAL(1), REAL(front_stiffness) / REAL(back_stiffness)]
        self.force_N = REAL(front_stiffness) / self.unit_mm**2
        self.ribs = []  # (front arc, back arc, undeformed span x, y)
        for rib in yaml['ribs']:
            front = REAL(rib['front_mm']) / self.unit_mm
            alpha = REAL(rib['angle_deg']) * PI / 180
            # front + span (cos, sin)(alpha) lies on the back beam.
            span = (self.base_x[1] * np.sin(phi) + front * np.cos(phi)) / \
                np.sin(phi - alpha)
            back = (front + span * np.sin(alpha)) / np.sin(phi)
            self.ribs.append((front, back, span * np.cos(alpha),
                              span * np.sin(alpha)))
        self.gauges = [(int(g['beam'] == 'back'), REAL(g['start_mm']) / self.unit_mm,
                        REAL(g['start_mm'] + g['length_mm']) / self.unit_mm)
                       for g in yaml['gauges']]


class Contact:
    """A force on the front beam; a circle's is found with its place."""

    def __init__(self, arc, force, friction):
        self.arc, self.force, self.friction = REAL(arc), REAL(force), REAL(friction)


class System:
    """The equations for given places of contacts, n + 1 points a bay."""

    def __init__(self, geometry, contacts, n, circle=None):
        """circle: (radius, centre of the unloaded touch, centre at full load)."""
        self.geometry, self.contacts, self.n = geometry, contacts, n
        self.circle = circle
        self.points, self.coefficients, self.integral = chebyshev(n)
        self.integral_64 = self.integral[1:].astype(float)
        self.size = 4 * (n + 1) + 2
        # Stations in order along each beam: (arc, ribs, contacts). A contact at a
        # rib shares its station, but for a circle's, which moves.
        self.stations = []
        for side in range(2):
            found = [(rib[side], [i], []) for i, rib in enumerate(geometry.ribs)]
            for c, contact in enumerate(contacts if side == 0 else []):
                same = [s for s in found if s[0] == contact.arc and not circle]
                if same:
                    same[0][2].append(c)
                else:
                    found.append((contact.arc, [], [c]))
            self.stations.append(sorted(found, key=lambda s: s[0]))
        self.bays = [len(s) + 1 for s in self.stations]
        self.rib_row = sum(self.bays) * self.size
        self.total = self.rib_row + len(geometry.ribs) + (2 if circle else 0)
        # The station index of each rib on either beam and of each contact.
        self.rib_station = [{i: k for k, s in enumerate(self.stations[side])
                             for i in s[1]} for side in range(2)]
        self.contact_station = {c: k for k, s in enumerate(self.stations[0])
                                for c in s[2]}

    def offset(self, side, bay):
        return (bay + side * self.bays[0]) * self.size

    def ends(self, state, side):
        """Arc lengths at which bays end, with the circle where it now is."""
        arcs = [s[0] for s in self.stations[side]]
        if self.circle and side == 0:
            arcs[self.contact_station[0]] = state[-2]
        return [REAL(0)] + arcs + [self.geometry.length[side]]

    def fields(self, state, side, bay):
        at, m = self.offset(side, bay), self.n + 1
        return state[at:at + 4 * m].reshape(4, m), state[at + 4 * m:at + 4 * m + 2]

    def zero(self):
        state = np.zeros(self.total, dtype=REAL)
        if self.circle:
            state[-2] = self.contacts[0].arc
        return state

    def load(self, state, contact, share):
        return state[-1] if self.circle else share * self.contacts[contact].force

    def assemble(self, state, share):
        """Residual and sparse Jacobian at a share of the load."""
        self.residual = np.zeros(self.total, dtype=REAL)
        self.triplets = ([], [], [])
        self.row = 0
        for side in range(2):
            ends = self.ends(state, side)
            self._one([(1, self.offset(side, 0) + f * (self.n + 1)) for f in (0, 2, 3)],
                      state)
            for bay in range(self.bays[side]):
                self._bay(state, side, bay, ends[bay + 1] - ends[bay])
            for k in range(self.bays[side] - 1):
                self._station(state, side, k, share)
        self._ribs_and_tip(state)
        if self.circle:
            self._tangency(state, share)
        assert self.row == self.total
        values, rows, columns = (np.concatenate(t) for t in self.triplets)
        return self.residual, csc_matrix((values, (rows, columns)),
                                         shape=(self.total, self.total))

    def _add(self, rows, columns, values):
        values = np.asarray(values, dtype=float)
        shape = values.shape
        self.triplets[0].append(values.ravel())
        self.triplets[1].append(np.broadcast_to(rows, shape).ravel())
        self.triplets[2].append(np.broadcast_to(columns, shape).ravel())

    def _equation(self, value, terms):
        """One row: its residual and (derivative, column) terms."""
        self.residual[self.row] = value
        self._add([self.row] * len(terms), [c for _, c in terms],
                  [d for d, _ in terms])
        self.row += 1

    def _one(self, columns, state):
        for derivative, column in columns:
            self._equation(state[column], [(derivative, column)])

    def _bay(self, state, side, bay, h):
        n, m = self.n, self.n + 1
        (phi, moment, u, v), (nx, ny) = self.fields(state, side, bay)
        rest = self.geometry.angle[side]
        sine, cosine = np.sin(rest + phi), np.cos(rest + phi)
        half = 2 * np.sin(phi / 2)
        soft = self.geometry.compliance[side]
        rates = [soft * moment, nx * sine - ny * cosine,
                 -half * np.sin(rest + phi / 2), half * np.cos(rest + phi / 2)]
        slopes = [(1, np.full(m, soft)), (0, nx * cosine + ny * sine),
                  (0, -sine), (0, cosine)]
        at = self.offset(side, bay)
        weights = -float(h) * self.integral_64
        # The bay before a circle's contact grows with its arc, the next shrinks.
        sign = 0
        if self.circle and side == 0:
            k = self.contact_station[0]
            sign = (bay == k) - (bay == k + 1)
        for f, (field, rate) in enumerate(zip((phi, moment, u, v), rates)):
            integral = self.integral[1:].dot(rate)
            rows = self.row + np.arange(n)
            self.residual[rows] = field[1:] - field[0] - h * integral
            self._add(rows, at + f * m + 1 + np.arange(n), np.ones(n))
            self._add(rows, at + f * m, -np.ones(n))
            of, slope = slopes[f]
            self._add(rows[:, None], at + of * m + np.arange(m)[None, :],
                      weights * slope.astype(float)[None, :])
            if f == 1:
                self._add(rows, at + 4 * m, weights.dot(sine.astype(float)))
                self._add(rows, at + 4 * m + 1, -weights.dot(cosine.astype(float)))
            if sign:
                self._add(rows, self.total - 2, -sign * integral)
            self.row += n

    def _station(self, state, side, k, share):
        n, m = self.n, self.n + 1
        before, after = self.offset(side, k), self.offset(side, k + 1)
        for f in range(4):
            a, b = before + f * m + n, after + f * m
            self._equation(state[b] - state[a], [(1, b), (-1, a)])
        _, ribs, contacts = self.stations[side][k]
        for axis in range(2):
            a, b = before + 4 * m + axis, after + 4 * m + axis
            value, terms = state[b] - state[a], [(1, b), (-1, a)]
            for rib in ribs:
                (span, columns), sign = self.span(state, rib), 1 - 2 * side
                length = np.hypot(*self.geometry.ribs[rib][2:])
                tension = self.rib_row + rib
                value += sign * state[tension] * span[axis] / length
                pull = sign * state[tension] / length
                terms += [(sign * span[axis] / length, tension),
                          (pull, columns[1][axis]), (-pull, columns[0][axis])]
            for contact in contacts:
                push, d_push = self.push(state, contact, share)
                value += push[axis]
                terms.append((d_push[axis], before + n))
                if self.circle:
                    unit, _ = self.push(state, contact, share, unit=True)
                    terms.append((unit[axis], self.total - 1))
            self._equation(value, terms)

    def span(self, state, rib):
        """Front to back hinge, and the columns of (u, v) there, front and back."""
        columns = []
        for side in range(2):
            at = self.offset(side, self.rib_station[side][rib]) + self.n
            columns.append((at + 2 * (self.n + 1), at + 3 * (self.n + 1)))
        nominal = self.geometry.ribs[rib][2:]
        return [nominal[a] + state[columns[1][a]] - state[columns[0][a]]
                for a in range(2)], columns

    def push(self, state, contact, share, unit=False):
        """Force of a contact and its derivative by the angle."""
        at = self.offset(0, self.contact_station[contact])
        theta = self.geometry.angle[0] + state[at + self.n]
        size = REAL(1) if unit else self.load(state, contact, share)
        mu = self.contacts[contact].friction
        normal = np.array([np.sin(theta), -np.cos(theta)])
        tangent = np.array([np.cos(theta), np.sin(theta)])
        return size * (normal + mu * tangent), size * (tangent - mu * normal)

    def _ribs_and_tip(self, state):
        n, m = self.n, self.n + 1
        for rib, (_, _, *nominal) in enumerate(self.geometry.ribs):
            span, columns = self.span(state, rib)
            value, terms = REAL(0), []
            for a in range(2):  # |nominal + move|^2 - |nominal|^2
                move = state[columns[1][a]] - state[columns[0][a]]
                value += move * (2 * nominal[a] + move)
                terms += [(2 * span[a], columns[1][a]), (-2 * span[a], columns[0][a])]
            self._equation(value, terms)
        last = [self.offset(side, self.bays[side] - 1) for side in range(2)]
        for f, sign in ((0, -1), (1, 1), (2, -1), (3, -1)):
            a, b = last[0] + f * m + n, last[1] + f * m + n
            self._equation(state[a] + sign * state[b], [(1, a), (sign, b)])
        for axis in range(2):
            a, b = last[0] + 4 * m + axis, last[1] + 4 * m + axis
            self._equation(state[a] + state[b], [(1, a), (1, b)])

    def _tangency(self, state, share):
        radius, touch, centre = self.circle
        at = self.offset(0, self.contact_station[0]) + self.n
        u, v = at + 2 * (self.n + 1), at + 3 * (self.n + 1)
        phi = state[at]
        # n = (cos(phi), sin(phi)), as the front beam stood at pi / 2.
        wanted = [touch[a] + share * (centre[a] - touch[a]) for a in range(2)]
        self._equation(state[u] - radius * np.cos(phi) - wanted[0],
                       [(1, u), (radius * np.sin(phi), at)])
        self._equation(state[v] + state[-2] - radius * np.sin(phi) - wanted[1],
                       [(1, v), (1, self.total - 2), (-radius * np.cos(phi), at)])

    def solve(self, state, share, final=False, limit=12):
        """Newton from state: (state, sign of the determinant), or None."""
        state, last = state.copy(), np.inf
        scale = self.scale(state)
        for _ in range(limit):
            residual, jacobian = self.assemble(state, share)
            try:
                factors = splu(jacobian)
            except RuntimeError:
                return None
            step = -factors.solve(residual.astype(float))
            if not np.all(np.isfinite(step)):
                return None
            size = np.max(np.abs(step) / scale)
            state += step
            if size < (1e-17 if final else 1e-9) or \
                    (size < 1e-13 and size > 0.1 * last):
                return state, determinant_sign(factors)
            if size > 5 or (size > 0.9 * last and size > 1e-6):
                return None
            last = size
        return None

    def scale(self, state):
        """Magnitudes of the unknowns: forces and moments may be large."""
        forces = 1 + max(float(abs(self.load(state, c, REAL(1))))
                         for c in range(len(self.contacts)))
        scale = np.ones(self.total)
        m = self.n + 1
        for bay in range(sum(self.bays)):
            scale[bay * self.size + m:bay * self.size + 2 * m] = forces**0.5
            scale[bay * self.size + 4 * m:(bay + 1) * self.size] = forces
        scale[self.rib_row:self.rib_row + len(self.geometry.ribs)] = forces
        if self.circle:
            scale[-1] = forces
        return scale

    def turns(self, change):
        """Largest change of an angle (or of a circle's place)."""
        largest = max(np.max(np.abs(self.fields(change, side, bay)[0][0]))
                      for side in range(2) for bay in range(self.bays[side]))
        return max(largest, abs(change[-2])) if self.circle else largest

    def moved_to(self, other, state):
        """The state interpolated to another system of the same finger."""
        out = other.zero()
        for side in range(2):
            ends = self.ends(state, side)
            targets = other.ends(state, side)
            for bay in range(other.bays[side]):
                arcs = targets[bay] + (targets[bay + 1] - targets[bay]) * other.points
                middle = (arcs[0] + arcs[-1]) / 2
                k = min(max(sum(e <= middle for e in ends) - 1, 0), self.bays[side] - 1)
                fields, force = self.fields(state, side, k)
                to, to_force = other.fields(out, side, bay)
                at = (arcs - ends[k]) / (ends[k + 1] - ends[k])
                for f in range(4):
                    to[f] = evaluate(self.coefficients, fields[f], at)
                to_force[:] = force
        out[other.rib_row:] = state[self.rib_row:]
        return out

    def angle_at(self, state, side, arc):
        ends = self.ends(state, side)
        k = min(max(sum(e <= arc for e in ends) - 1, 0), self.bays[side] - 1)
        return evaluate(self.coefficients, self.fields(state, side, k)[0][0],
                        (arc - ends[k]) / (ends[k + 1] - ends[k]))


def determinant_sign(factors):
    sign = int(np.sum(factors.U.diagonal() < 0)) + \
        parity(factors.perm_r) + parity(factors.perm_c)
    return 1 - 2 * (sign % 2)


def parity(permutation):
    seen, cycles = np.zeros(len(permutation), dtype=bool), 0
    for start in range(len(permutation)):
        if seen[start]:
            continue
        cycles += 1
        while not seen[start]:
            seen[start] = True
            start = permutation[start]
    return (len(permutation) - cycles) % 2
