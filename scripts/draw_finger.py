#!/usr/bin/python3
"""Draws docs/pictures/finger.svg: the paper's finger to scale, with the conventions.

draw_finger.py [OUT.svg]
"""

import math
import pathlib
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
sys.dont_write_bytecode = True

sys.path.append(str(pathlib.Path(__file__).resolve().parents[1] / "scripts/common"))
import guard  # noqa: E402

guard.protect("draw_finger.py", __name__)

sys.path.insert(0, str(ROOT / "calib" / "report"))

import whole_file
from finger_drawing import BEAM, FORCE, GAUGE, INK, QUIET, RIB, Drawing

L0, PHI0 = 140.0, math.radians(112)
RIBS = [(17, 10), (39, 13), (61, 16), (83, 19), (105, 22)]
GAUGES = [30, 53, 76, 98]
GAUGE_LENGTH = 18
CONTACT, RADIUS = 72.0, 15.0


def draw(drawing):
    # The object and its contact.
    center = (-RADIUS, CONTACT)
    drawing.circle(center, RADIUS)
    drawing.dot(center, 2, INK)
    drawing.arrow(center, (center[0] - RADIUS * math.cos(0.7), center[1] + RADIUS * math.sin(0.7)), QUIET, 1.2)
    drawing.text((center[0] - 5, center[1] + 6), "R", QUIET, "start", dx=10, dy=-4)
    drawing.text(center, "object", QUIET, "middle", 14, dy=28, italic=False)

    # Ribs under the beams.
    hinges = []
    for index, (front, angle) in enumerate(RIBS):
        a = math.radians(angle)
        cross = math.cos(a) * math.sin(PHI0) - math.sin(a) * math.cos(PHI0)
        s = (math.cos(a) * front + math.sin(a) * drawing.base_back[0]) / cross
        drawing.line((0, front), drawing.back(s), RIB, 3)
        if index == 1:
            drawing.line((0, front), (24, front), QUIET, 1, 'stroke-dasharray="4 3"')
            drawing.arc((0, front), 21, 0, a)
            drawing.text((24.5, front), "φ_i", QUIET, dx=3, dy=-2)
            drawing.text((4, front + 4.5), "rib i", QUIET, "start", 14, italic=False)
        hinges.append(drawing.back(s))

    # Beams, tip cap, clamps.
    drawing.beams()
    for p in GAUGES:
        drawing.line(drawing.back(p, 1.6), drawing.back(p + GAUGE_LENGTH, 1.6), GAUGE, 6)
    drawing.cap()
    drawing.text((0, 120), "front beam", BEAM, "end", 14, dx=-10, dy=5, italic=False)
    drawing.text(drawing.back(130), "back beam", BEAM, "start", 14, dx=10, dy=5, italic=False)
    drawing.text((0, L0), "tip cap, keeps its angle", QUIET, "start", 14, dx=16, dy=2, italic=False)
    drawing.clamp((0, 0))
    drawing.clamp(drawing.base_back)
    for hinge in hinges + [(0, front) for front, _ in RIBS]:
        drawing.dot(hinge)

    # Contact force.
    drawing.dot((0, CONTACT), 4, FORCE, FORCE)
    drawing.arrow((0, CONTACT), (15, CONTACT), FORCE, 3)
    drawing.text((15, CONTACT), "f_c", FORCE, dx=8, dy=5, size=19)

    # Lengths along the front beam.
    for height, start, end in ((RIBS[1][0], -3, -39), (CONTACT, -2 * RADIUS - 1, -48), (L0, -3, -57)):
        drawing.line((start, height), (end, height), QUIET, 0.8, 'stroke-dasharray="2 3"')
    drawing.line((-8, 0), (-57, 0), QUIET, 0.8, 'stroke-dasharray="2 3"')
    drawing.dimension((-37, 0), (-37, RIBS[1][0]), "l_i")
    drawing.dimension((-46, 0), (-46, CONTACT), "l_c")
    drawing.dimension((-55, 0), (-55, L0), "l_0")

    # A gauge's place.
    p = GAUGES[1]
    for s in (0, p, p + GAUGE_LENGTH):
        drawing.line(drawing.back(s, 4 if s else 11.5), drawing.back(s, 17), QUIET, 0.8, 'stroke-dasharray="2 3"')
    drawing.line(drawing.back(0, 14), drawing.back(p, 14), QUIET, 1, 'marker-start="url(#quiet)" marker-end="url(#quiet)"')
    drawing.line(drawing.back(p, 14), drawing.back(p + GAUGE_LENGTH, 14), QUIET, 1,
                 'marker-start="url(#quiet)" marker-end="url(#quiet)"')
    drawing.text(drawing.back(p / 2, 17), "p_j", QUIET, dx=2)
    drawing.text(drawing.back(p + GAUGE_LENGTH / 2, 17), "w_j", QUIET, dx=2)
    drawing.text(drawing.back(p + GAUGE_LENGTH / 2, -3), "gauge j", GAUGE, "end", 14, dy=2, italic=False)

    # Angle of the back beam, frame S, arc length.
    drawing.line(drawing.base_back, (drawing.base_back[0] + 17, 0), QUIET, 1, 'stroke-dasharray="4 3"')
    drawing.arc(drawing.base_back, 10, 0, PHI0)
    drawing.text((drawing.base_back[0] + 1, 3), "φ_0", QUIET, dx=4)
    drawing.frame(17)
    drawing.arrow((3.5, 110), (3.5, 122), QUIET, 1.2)
    drawing.text((3.5, 116), "s", QUIET, dx=6, dy=4)
    drawing.arrow(drawing.back(9, -4), drawing.back(21, -4), QUIET, 1.2)
    drawing.text(drawing.back(15, -4), "s", QUIET, "end", dx=-9, dy=5)


def main():
    target = pathlib.Path(*guard.words(__doc__, 0, 1) or [ROOT / "docs" / "pictures" / "finger.svg"])
    drawing = Drawing(L0, PHI0, scale=4.0, left=250.0, top=60.0)
    draw(drawing)
    whole_file.write(target, drawing.svg(620, 660, "A Fin-Ray finger and its conventions"))


if __name__ == "__main__":
    main()
