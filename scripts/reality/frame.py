"""A one-piece finger as a frame of straight elastic beams, for small loads: linear,
joints rigid, ribs clamped to both beams.

The first `rigid_share` of a rib's way from the beam's neutral line to its inner
surface does not bend.
"""

import math

import numpy as np

from plant import STIFF


class Frame:
    def __init__(self, plant, load_mm, rigid_share):
        """load_mm: where a force may act, arc length on the front beam."""
        self.plant, self.load_mm = plant, load_mm
        self.nodes, self.beams = [], []  # (node, node, EA, EI)
        self.column = {"front": {}, "back": {}}  # arc length -> node
        tip = self._node(0.0, plant.front_length_mm)
        for side in self.column:
            self._beam(side, tip)
        for rib in plant.ribs:
            self._rib(rib, rigid_share)

    def _node(self, x, y):
        self.nodes.append((x, y))
        return len(self.nodes) - 1

    def _beam(self, side, tip):
        plant, angle = self.plant, self.plant.angle[side]
        (x, y), end = plant.base[side], plant.front_length_mm / math.sin(angle)
        stations = {0.0, end} | ({self.load_mm} if side == "front" else set())
        stations |= {rib.front_mm if side == "front" else rib.back_mm for rib in plant.ribs}
        for gauge in plant.gauges:
            if gauge.beam == side:
                stations |= {gauge.start_mm, gauge.start_mm + gauge.length_mm}
        last = None
        for s in sorted(stations):
            node = tip if s == end else self._node(x + s * math.cos(angle), y + s * math.sin(angle))
            self.column[side][s] = node
            if last is not None:
                self.beams.append((last, node, *plant.section(side, plant.thickness[side])))
            last = node

    def _rib(self, rib, rigid_share):
        ends = [self.column["front"][rib.front_mm], self.column["back"][rib.back_mm]]
        (x0, y0), (x1, y1) = (self.nodes[n] for n in ends)
        length = math.dist((x0, y0), (x1, y1))
        c, s = (x1 - x0) / length, (y1 - y0) / length
        section = self.plant.rib_section(rib)
        rigid = self.plant.rigid_ends(rib, rigid_share)
        if rigid_share:
            inner = [self._node(x0 + c * rigid[0], y0 + s * rigid[0]), self._node(x1 - c * rigid[1], y1 - s * rigid[1])]
            self.beams += [(end, near, *(STIFF * value for value in section)) for end, near in zip(ends, inner)]
            ends = inner
        self.beams.append((*ends, *section))

    def press(self, force):
        """Under a force along +x: the way of its place along +x and the gauges' angles."""
        size = 3 * len(self.nodes)
        stiffness = np.zeros((size, size))
        for a, b, ea, ei in self.beams:
            length = math.dist(self.nodes[a], self.nodes[b])
            c, s = ((q - p) / length for p, q in zip(self.nodes[a], self.nodes[b]))
            turn = np.kron(np.eye(2), [[c, s, 0], [-s, c, 0], [0, 0, 1]])
            i = [3 * a, 3 * a + 1, 3 * a + 2, 3 * b, 3 * b + 1, 3 * b + 2]
            stiffness[np.ix_(i, i)] += turn.T @ element(ea, ei, length) @ turn
        fixed = {3 * self.column[side][0.0] + k for side in self.column for k in range(3)}
        free = [i for i in range(size) if i not in fixed]
        load, moved = np.zeros(size), np.zeros(size)
        at = 3 * self.column["front"][self.load_mm]
        load[at] = force
        moved[free] = np.linalg.solve(stiffness[np.ix_(free, free)], load[free])

        def turned(gauge, s):
            return moved[3 * self.column[gauge.beam][s] + 2]
        return moved[at], [turned(g, g.start_mm + g.length_mm) - turned(g, g.start_mm) for g in self.plant.gauges]


def element(ea, ei, length):
    """The stiffness of a beam along x: (x, y, turn) of both ends."""
    a, b, c, d = ea / length, 12 * ei / length**3, 6 * ei / length**2, 2 * ei / length
    return np.array([[a, 0, 0, -a, 0, 0], [0, b, c, 0, -b, c], [0, c, 2 * d, 0, -c, d],
                     [-a, 0, 0, a, 0, 0], [0, -b, -c, 0, b, -c], [0, c, d, 0, -c, 2 * d]])
