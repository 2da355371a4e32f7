#!/usr/bin/python3
"""Reads a finger from the outline of a strip finger: dxf_finger.py OUTLINE.dxf FINGER.yaml WIDTH_mm MODULUS_GPa.

The drawing has one outer contour with two long straight sides, the front one at a right angle to the base, and
inside it a closed contour for each cell between ribs. Beams and ribs are the material between contours; the finger
of the model is their centre lines. Exit code 2 and one line if the drawing is none of that.
"""

import math
import os
import pathlib
import sys

sys.dont_write_bytecode = True
sys.path.append(str(pathlib.Path(__file__).resolve().parents[2] / "scripts/common"))
import guard  # noqa: E402

guard.protect("finray_design", __name__)

try:
    import ezdxf
    from ezdxf import path as dxf_path
except ImportError:
    sys.exit(print("finray_design: --dxf needs the package python3-ezdxf", file=sys.stderr) or 2)
import numpy as np

import limits
from errors import BadInput

MM = {0: 1.0, 1: 25.4, 2: 304.8, 4: 1.0, 5: 10.0, 6: 1000.0}
UNIT = {0: "no unit, taken as mm", 1: "inches", 2: "feet", 4: "mm", 5: "cm", 6: "m"}
LARGEST = 1e4  # mm across; the points of a larger circle have no end
JOIN = 0.02  # mm between ends of pieces that belong together
STRAIGHT = math.radians(1)  # pieces that turn by less are one edge
PARALLEL = math.radians(4)
SMALLEST = 2e-3  # of the outer area: smaller contours are holes for screws
RIB_BENDS = 0.5  # of the front beam's thickness: ribs from there on are beams, with an eighth of its stiffness or more


def cross(a, b):
    return a[0] * b[1] - a[1] * b[0]


def contours(doc, unit):
    """Closed contours of the model space in mm, counter-clockwise; unit: $INSUNITS."""
    if unit not in MM:
        raise BadInput(f"$INSUNITS {unit} is no unit of length that is read; save it in mm")
    loops, open_ends = [], []
    for entity in doc.modelspace().query("LWPOLYLINE POLYLINE LINE ARC CIRCLE ELLIPSE SPLINE"):
        outline = dxf_path.make_path(entity)
        across = np.ptp(np.array([(p.x, p.y) for p in outline.control_vertices()] or [(0, 0)]) * MM[unit], axis=0).max()
        if not across <= LARGEST:
            raise BadInput(f"a {entity.dxftype()} is {across:.3g} mm across; expected {LARGEST:g} mm at most")
        points = np.array([(p.x, p.y) for p in outline.flattening(0.02 / MM[unit])]) * MM[unit]
        if len(points) < 2:
            continue
        (loops if np.linalg.norm(points[0] - points[-1]) < JOIN and len(points) > 3 else open_ends).append(points)
    while open_ends:
        chain = open_ends.pop()
        while np.linalg.norm(chain[0] - chain[-1]) >= JOIN:
            for i, other in enumerate(open_ends):
                if np.linalg.norm(other[-1] - chain[-1]) < JOIN:
                    other = other[::-1]
                if np.linalg.norm(other[0] - chain[-1]) < JOIN:
                    chain = np.vstack([chain, other[1:]])
                    del open_ends[i]
                    break
            else:
                x, y = chain[-1]
                raise BadInput(f"the contour that ends at ({x:.4g}, {y:.4g}) mm is not closed")
        loops.append(chain)
    closed = []
    for loop in loops:
        loop = loop[:-1]
        area = 0.5 * sum(cross(a, b) for a, b in zip(loop, np.roll(loop, -1, axis=0)))
        closed.append((abs(area), loop if area > 0 else loop[::-1]))
    return sorted(closed, key=lambda item: -item[0]), UNIT[unit]


def edges(loop):
    """Straight edges (start, end); pieces in one direction are joined."""
    steps = np.roll(loop, -1, axis=0) - loop
    angles = np.arctan2(steps[:, 1], steps[:, 0])
    turn = np.abs((np.diff(np.append(angles, angles[0])) + math.pi) % (2 * math.pi) - math.pi) > STRAIGHT
    corners = [(i + 1) % len(loop) for i in range(len(loop)) if turn[i]]
    return [(loop[a], loop[b]) for a, b in zip(corners, corners[1:] + corners[:1])]


def length(edge):
    return float(np.linalg.norm(edge[1] - edge[0]))


def unit(edge):
    return (edge[1] - edge[0]) / length(edge)


def meet(p, u, q, v):
    return p + u * cross(q - p, v) / cross(u, v)


def angle_between(u, v):
    """Of two lines, 0 to pi/2."""
    return math.acos(min(1.0, abs(float(np.dot(u, v)))))


def frame(outer):
    """The front side's line, the base's direction, and the back side's line, as (point, direction towards the tip)."""
    sides = sorted(edges(outer), key=length, reverse=True)
    if len(sides) < 3:
        raise BadInput("the outer contour has no two straight sides and a base")
    a, b = sides[0], sides[1]
    if angle_between(unit(a), unit(b)) < PARALLEL:
        raise BadInput("the two longest sides of the outer contour are parallel; a finger's meet at the tip")
    tip = meet(a[0], unit(a), b[0], unit(b))
    base = max(sides[2:], key=lambda e: float(np.linalg.norm((e[0] + e[1]) / 2 - tip)))
    right = [abs(math.degrees(angle_between(unit(e), unit(base))) - 90) for e in (a, b)]
    if min(right) > 3:
        raise BadInput(f"neither long side is at a right angle to the base (off by {right[0]:.1f} and {right[1]:.1f} "
                      "deg); the front beam has to be")
    front, back = (a, b) if right[0] < right[1] else (b, a)

    def upwards(edge):
        u = unit(edge)
        return u if np.dot(tip - (edge[0] + edge[1]) / 2, u) > 0 else -u

    return (tip, upwards(front)), (tip, upwards(back))


class Cell:
    """A cell in frame S with its edges, y from the base's direction."""

    def __init__(self, loop, back_angle):
        self.edges = edges(loop)
        along_back = np.array([math.cos(back_angle), math.sin(back_angle)])
        self.front = self.parallel_to(np.array([0.0, 1.0]), lambda e: e[0][0])
        self.back = self.parallel_to(along_back, lambda e: -e[0][0])
        across = [e for e in self.edges if angle_between(unit(e), (0.0, 1.0)) > PARALLEL
                  and angle_between(unit(e), along_back) > PARALLEL]
        widest = max([length(e) for e in across], default=0)
        across = [e for e in across if length(e) > 0.5 * widest]
        self.height = float(np.mean(loop[:, 1]))
        self.lowest, self.highest = float(loop[:, 1].min()), float(loop[:, 1].max())
        self.bottom = min(across, key=lambda e: e[0][1] + e[1][1], default=None)
        self.top = max(across, key=lambda e: e[0][1] + e[1][1], default=None)

    def parallel_to(self, direction, order):
        found = [e for e in self.edges if angle_between(unit(e), direction) < PARALLEL]
        found = [e for e in found if length(e) > 0.3 * max(map(length, found))]
        return min(found, key=order) if found else None


def thickness(values, name, notes):
    if max(values) > 1.05 * min(values):
        notes.append(f"the {name} beam is {min(values):.3g} to {max(values):.3g} mm thick; the mean counts")
    return float(np.mean(values))


def read(path):
    try:
        doc = ezdxf.readfile(path)
    except OSError as error:
        raise BadInput(error.strerror or "cannot be read as DXF")
    except Exception as error:  # a DXFError, or whatever else comes on odd files
        raise BadInput("is no DXF file: " + " ".join(str(error).split()))
    # ezdxf takes a drawing that names no unit for one in metres.
    named = b"$INSUNITS" in pathlib.Path(path).read_bytes()
    found, unit_words = contours(doc, doc.header.get("$INSUNITS", 0) if named else 0)
    if not found:
        raise BadInput("has no closed contour in its model space")
    outer_area, outer = found[0]
    notes = [f"unit of the drawing: {unit_words}"]
    inner = [loop for area, loop in found[1:] if area > SMALLEST * outer_area]
    if len(inner) < len(found) - 1:
        notes.append(f"{len(found) - 1 - len(inner)} small contours are left out as holes")
    if not inner:
        raise BadInput("has no cells: draw a closed contour for each cell between ribs")

    (tip, up), (_, along) = frame(outer)
    right = np.array([up[1], -up[0]])
    mirror = 1.0 if np.dot(-along, right) > 0 else -1.0  # the back beam lies towards +x

    def in_s(points):
        return np.column_stack([(points - tip) @ right * mirror, (points - tip) @ up])

    back = np.array([np.dot(along, right) * mirror, np.dot(along, up)])
    back_angle = math.atan2(back[1], back[0])
    cells = []
    for loop in inner:
        loop = in_s(loop)
        cells.append(Cell(loop if mirror > 0 else loop[::-1], back_angle))
    cells.sort(key=lambda cell: cell.height)
    for i, cell in enumerate(cells, 1):
        if cell.front is None or cell.back is None or cell.bottom is None:
            raise BadInput(f"cell {i} from the base has no sides along both beams")
    normal = np.array([back[1], -back[0]])  # out of the back beam
    front_mm = thickness([float(np.mean([c.front[0][0], c.front[1][0]])) for c in cells], "front", notes)
    back_mm = thickness([-float(np.mean([c.back[0] @ normal, c.back[1] @ normal])) for c in cells], "back", notes)
    if min(front_mm, back_mm) <= 0:
        raise BadInput("a cell reaches out of the outer contour")
    base = float(np.mean([cells[0].bottom[0][1], cells[0].bottom[1][1]]))

    # The centre lines; the origin is where the front one meets the base.
    front_line = (np.array([front_mm / 2, 0.0]), np.array([0.0, 1.0]))
    back_line = (-normal * back_mm / 2, back)
    top = meet(*front_line, *back_line)
    back_base = meet(*back_line, np.array([0.0, base]), np.array([1.0, 0.0]))
    ribs = []
    for below, above in zip(cells, cells[1:]):
        lines = [(e[0], unit(e)) for e in (below.top, above.bottom)]
        at_front = np.mean([meet(*front_line, *line) for line in lines], axis=0)
        at_back = np.mean([meet(*back_line, *line) for line in lines], axis=0)
        slope = math.atan2(*(at_back - at_front)[::-1])
        gap = abs(meet(*front_line, *lines[1])[1] - meet(*front_line, *lines[0])[1])
        ribs.append((at_front[1] - base, float((at_back - back_base) @ back), gap * math.cos(slope)))
    cap = top[1] - max(cell.highest for cell in cells)
    if cap > 0.05 * (top[1] - base):
        notes.append(f"the tip is solid over {cap:.3g} mm, where the model bends")
    return top[1] - base, back_angle, front_mm, back_mm, ribs, notes


def text(source, finger, width, modulus):
    front_length, back_angle, front_mm, back_mm, ribs, notes = finger
    plate = "width_mm: {}, thickness_mm: {:.5g}, youngs_modulus_GPa: {}"
    lines = [f"schema_version: 1", f"name: {pathlib.Path(source).stem.replace(':', '_') or 'drawn'}",
             f"geometry: {{front_length_mm: {front_length:.6g}, back_angle_deg: {math.degrees(back_angle):.6g}}}",
             "beams:",
             f"  front: {{{plate.format(width, front_mm, modulus)}, surface_offset_mm: {front_mm / 2:.5g}}}",
             f"  back: {{{plate.format(width, back_mm, modulus)}}}"]
    if ribs:
        lines.append("ribs:")
    for a, b, t in ribs:
        bends = ""
        if t > RIB_BENDS * front_mm:
            bends = f", bending_stiffness_N_mm2: {1000 * float(modulus) * float(width) * t**3 / 12:.6g}"
        lines.append(f"  - {{front_mm: {a:.6g}, back_mm: {b:.6g}{bends}}}  # {t:.3g} mm thick")
    thick = [t for _, _, t in ribs if t > RIB_BENDS * front_mm]
    if thick:
        notes.append(f"{len(thick)} of {len(ribs)} ribs are {min(thick):.3g} to {max(thick):.3g} mm thick: they bend, with a "
                     "bending_stiffness_N_mm2 by width and modulus")
    return "\n".join(lines) + "\n", notes


def main():
    source, target, width, modulus = sys.argv[1:5]
    try:
        with limits.bounded(os.path.getsize(source) if os.path.isfile(source) else 0):
            yaml, notes = text(source, read(source), width, modulus)
    except (BadInput, limits.TooLong) as error:
        raise BadInput(f"{source}: {error}") from error
    except MemoryError as error:
        raise BadInput(f"{source}: {limits.why('memory')}") from error
    except Exception as error:  # ezdxf raises whatever comes on odd drawings
        raise BadInput(f"{source}: the contours are none of a strip finger") from error
    pathlib.Path(target).write_text(yaml, "utf-8")
    for note in notes:
        print("drawing        " + note)
    return 0


if __name__ == "__main__":
    sys.exit(main())
