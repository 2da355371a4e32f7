"""What strain gauges on both faces of a beam read: the stretch of one surface less
that of the other, over the thickness, is the angle between the gauge's ends."""

import math

POINTS = [(0.5 - math.sqrt(0.15), 5 / 18), (0.5, 4 / 9), (0.5 + math.sqrt(0.15), 5 / 18)]


def place(solid, moved, node):
    x, y = solid.nodes[node - 1]
    ux, uy = moved[node]
    return x + ux, y + uy


def length(a, b, c):
    """Of the parabola through three points, b at half."""
    total = 0.0
    for u, weight in POINTS:
        d = [p * (4 * u - 3) + q * (4 - 8 * u) + r * (4 * u - 1) for p, q, r in zip(a, b, c)]
        total += weight * math.hypot(*d)
    return total


def stretch(solid, moved, side, start, end, face):
    """The growth in mm of a surface between two arc lengths; face: 0 right, -1 left."""
    return sum(length(*(place(solid, moved, n) for n in nodes)) - length(*(solid.nodes[n - 1] for n in nodes))
               for *nodes, _, _ in solid.fibre(side, start, end, face))


def angles(solid, moved):
    """Of every gauge in rad: counter-clockwise bending stretches the right surface."""
    found = []
    for gauge in solid.plant.gauges:
        ends = gauge.start_mm, gauge.start_mm + gauge.length_mm
        right, left = (stretch(solid, moved, gauge.beam, *ends, face) for face in (0, -1))
        found.append((right - left) / solid.plant.thickness[gauge.beam])
    return found


def turn(solid, moved, side, s):
    """Of the section at s, in rad."""
    column = solid.column(side, s)
    (x0, y0), (x1, y1) = (solid.nodes[column[k] - 1] for k in (0, -1))
    (x2, y2), (x3, y3) = (place(solid, moved, column[k]) for k in (0, -1))
    ax, ay, bx, by = x1 - x0, y1 - y0, x3 - x2, y3 - y2
    return math.atan2(ax * by - ay * bx, ax * bx + ay * by)


def arc_of(solid, moved, point):
    """The arc length whose point of the front beam's outer surface is nearest."""
    best = (math.inf, 0)
    for *nodes, a, b in solid.fibre("front", 0, solid.plant.front_length_mm, -1):
        p, q, r = (place(solid, moved, n) for n in nodes)
        if math.dist(q, point) > 3 * math.dist(p, r) + 0.1:
            continue
        for k in range(41):
            u = k / 40
            at = [i * (1 - u) * (1 - 2 * u) + j * 4 * u * (1 - u) + l * u * (2 * u - 1) for i, j, l in zip(p, q, r)]
            best = min(best, (math.dist(at, point), a + u * (b - a)))
    return best[1]
