"""The finger as plane solids: nodes and eight-node elements for CalculiX.

A beam is a strip of elements around its neutral line, from the clamped base to the
section through the inner corner P, where the inner surfaces of both beams meet. A
solid cap from both sections to behind P joins the beams. A rib with a thickness is
a strip of elements between the inner surfaces, joined to both; a rib without is a
stiff spring between the neutral lines, hence rigid on hinges.
"""

import math

RIB_N_PER_MM = 1e6  # stretches by 5e-6 mm under 5 N


class Solid:
    def __init__(self, plant, contact=None, step_mm=2.0, fine_mm=0.4, reach_mm=10.0, layers=2):
        """plant: see plant.py. contact: the arc length on the front beam around which
        elements are fine, within reach_mm. layers: elements through a thickness."""
        self.prepare(plant, step_mm, layers)
        self._fine = None if contact is None else (contact - reach_mm, contact + reach_mm, fine_mm)
        self.ends = self._ends()
        ribs = [self._rib_edges(rib) for rib in plant.ribs]
        pieces = [None if edges is None else self._pieces(*edges["front"]) for edges in ribs]
        for side in ("front", "back"):
            self.beam(side, ribs, pieces)
        self._cap()
        for rib, edges, count in zip(plant.ribs, ribs, pieces):
            if edges is None:
                self.springs.append((self.neutral("front", rib.front_mm),
                                     self.neutral("back", rib.back_mm)))
            else:
                self._rib(edges, count)

    def prepare(self, plant, step_mm, layers):
        self.plant, self.layers = plant, layers
        self.nodes, self.elements = [], {"FRONT": [], "BACK": [], "RIBS": []}
        self.springs = []  # (node, node)
        self.outer = []  # (index of the element, its arc lengths) along the front beam
        self._known = {}
        self._fine, self._step = None, step_mm
        self.columns = {"front": {}, "back": {}}  # arc length -> nodes, right to left
        self._middles = {"front": [], "back": []}  # (s0, s1, nodes between, right to left)

    # Geometry

    def point(self, side, s, across):
        """The undeformed point at arc length s, `across` to the left of the neutral line."""
        (x, y), angle = self.plant.base[side], self.plant.angle[side]
        c, sine = math.cos(angle), math.sin(angle)
        return x + s * c - across * sine, y + s * sine + across * c

    def _inner(self, side):
        """The line of the inner surface: a point and a direction."""
        half = self.plant.thickness[side] / 2
        angle = self.plant.angle[side]
        return self.point(side, 0, -half if side == "front" else half), (math.cos(angle), math.sin(angle))

    def _ends(self):
        """Arc lengths of the sections through P."""
        corner = cross(*self._inner("front"), *self._inner("back"))
        self.corner = corner
        return {side: along(self.plant.base[side], self.plant.angle[side], corner)
                for side in ("front", "back")}

    def _rib_edges(self, rib):
        """Arc lengths of the rib's edges on either beam, lower first."""
        if not rib.thickness_mm:
            return None
        a, b = self.point("front", rib.front_mm, 0), self.point("back", rib.back_mm, 0)
        length = math.dist(a, b)
        t = ((b[0] - a[0]) / length, (b[1] - a[1]) / length)
        edges = {"front": [], "back": []}
        for offset in (-rib.thickness_mm / 2, rib.thickness_mm / 2):
            start = (a[0] - offset * t[1], a[1] + offset * t[0])
            for side in edges:
                edges[side].append(along(self.plant.base[side], self.plant.angle[side],
                                         cross(start, t, *self._inner(side))))
        return edges

    # Mesh

    def node(self, x, y):
        """Its number; nodes at one place are one node."""
        key = (round(x, 7), round(y, 7))
        if key not in self._known:
            self.nodes.append((x, y))
            self._known[key] = len(self.nodes)
        return self._known[key]

    def _pieces(self, a, b):
        step = self._step
        if self._fine and a < self._fine[1] and b > self._fine[0]:
            step = self._fine[2]
        return max(1, math.ceil((b - a) / step - 1e-6))

    def beam(self, side, ribs, pieces):
        plant, end = self.plant, self.ends[side]
        stations, counts = {0.0, end}, {}
        for rib, edges, count in zip(plant.ribs, ribs, pieces):
            if edges is None:
                stations.add(rib.front_mm if side == "front" else rib.back_mm)
            else:
                stations.update(edges[side])
                counts[edges[side][0]] = count
        for gauge in plant.gauges:
            if gauge.beam == side:
                stations.update((gauge.start_mm, gauge.start_mm + gauge.length_mm))
        if side == "front" and self._fine:
            stations.update(s for s in self._fine[:2]
                            if 0 < s < end and not any(e and e["front"][0] < s < e["front"][1] for e in ribs))
        stations = sorted(stations)
        arcs = [0.0]
        for a, b in zip(stations, stations[1:]):
            count = counts.get(a) or (self._pieces(a, b) if side == "front" else
                                      max(1, math.ceil((b - a) / self._step - 1e-6)))
            arcs += [a + (b - a) * k / count for k in range(1, count)] + [b]
        for s in arcs:
            self.columns[side][s] = self._column(side, s, 2 * self.layers)
        for a, b in zip(arcs, arcs[1:]):
            self._middles[side].append((a, b, self._column(side, (a + b) / 2, self.layers)))
            first, last = self.columns[side][a], self.columns[side][b]
            middle = self._middles[side][-1][2]
            for k in range(self.layers):
                self.elements[side.upper()].append(
                    (first[2 * k], last[2 * k], last[2 * k + 2], first[2 * k + 2],
                     middle[k], last[2 * k + 1], middle[k + 1], first[2 * k + 1]))
            if side == "front":
                self.outer.append((len(self.elements["FRONT"]) - 1, (a, b)))

    def _column(self, side, s, intervals):
        half = self.plant.thickness[side] / 2
        return [self.node(*self.point(side, s, half * (2 * k / intervals - 1))) for k in range(intervals + 1)]

    def _cap(self):
        """Quadrilaterals A-P-B-T: both end sections and a point T behind P."""
        ends = {side: self.columns[side][self.ends[side]] for side in ("front", "back")}
        a, b = ends["front"][-1], ends["back"][0]  # outer surfaces
        (ax, ay), (bx, by) = self.nodes[a - 1], self.nodes[b - 1]
        mid = ((ax + bx) / 2, (ay + by) / 2)
        away = 0.5 * math.dist((ax, ay), (bx, by)) / math.dist(mid, self.corner) if \
            math.dist(mid, self.corner) > 1e-9 else 0
        top = (mid[0] + away * (mid[0] - self.corner[0]), mid[1] + away * (mid[1] - self.corner[1]))
        self._patch("FRONT", (self.corner, (bx, by), top, (ax, ay)), self.layers, self.layers)

    def _rib(self, edges, count):
        """Elements between the inner surfaces, `count` across, from front to back."""
        corners = []  # lower front, lower back, upper back, upper front
        for k, side in ((0, "front"), (0, "back"), (1, "back"), (1, "front")):
            half = self.plant.thickness[side] / 2
            corners.append(self.point(side, edges[side][k], -half if side == "front" else half))
        length = math.dist(corners[0], corners[1])
        self._patch("RIBS", corners, max(4, math.ceil(length / min(self._step, 1.0))), count)

    def _patch(self, elements, corners, along_first, along_last):
        """A grid of elements in a quadrilateral: so many along its first edge, so many
        along its last one."""
        grid = {}
        for i in range(2 * along_first + 1):
            for j in range(2 * along_last + 1):
                if i % 2 and j % 2:
                    continue
                u, v = i / (2 * along_first), j / (2 * along_last)
                grid[i, j] = self.node(*(
                    (1 - u) * (1 - v) * p + u * (1 - v) * q + u * v * r + (1 - u) * v * w
                    for p, q, r, w in zip(*corners)))
        self.elements[elements] += [quadrilateral(grid, i, j) for i in range(0, 2 * along_first, 2)
                                    for j in range(0, 2 * along_last, 2)]

    # Nodes for the readers of a solution

    def nearest(self, side, s):
        """The arc length of the column of nodes that is nearest to s."""
        return min(self.columns[side], key=lambda other: abs(other - s))

    def column(self, side, s):
        return self.columns[side][self.nearest(side, s)]

    def neutral(self, side, s):
        return self.column(side, s)[self.layers]

    def fibre(self, side, start, end, outermost):
        """Triples of nodes along a surface; outermost: 0 right, -1 left of the beam."""
        return [(self.columns[side][a][outermost], middle[outermost], self.columns[side][b][outermost], a, b)
                for a, b, middle in self._middles[side] if a > start - 1e-6 and b < end + 1e-6]


def quadrilateral(grid, i, j):
    return (grid[i, j], grid[i + 2, j], grid[i + 2, j + 2], grid[i, j + 2],
            grid[i + 1, j], grid[i + 2, j + 1], grid[i + 1, j + 2], grid[i, j + 1])


def cross(p, d, q, e):
    """The point where p + u d meets q + v e."""
    u = ((q[0] - p[0]) * e[1] - (q[1] - p[1]) * e[0]) / (d[0] * e[1] - d[1] * e[0])
    return p[0] + u * d[0], p[1] + u * d[1]


def along(base, angle, point):
    return (point[0] - base[0]) * math.cos(angle) + (point[1] - base[1]) * math.sin(angle)
