#!/usr/bin/python3
"""Draws docs/pictures/finger.svg: the paper's finger to scale, with the conventions.

draw_finger.py [OUT.svg]
"""

import math
import pathlib
import sys

L0, PHI0 = 140.0, math.radians(112)
RIBS = [(17, 10), (39, 13), (61, 16), (83, 19), (105, 22)]
GAUGES = [30, 53, 76, 98]
GAUGE_LENGTH = 18
CONTACT, RADIUS = 72.0, 15.0
SCALE = 4.0
LEFT, TOP = 250.0, 60.0  # page position of (0, L0)

INK, QUIET, BEAM, RIB = "#22272e", "#6b7480", "#2f6fab", "#8a8f98"
GAUGE, FORCE, OBJECT, BASE = "#d1793b", "#b3382c", "#e9edf2", "#9aa3ad"

out = []


def page(point):
    return LEFT + SCALE * point[0], TOP + SCALE * (L0 - point[1])


def line(a, b, colour=INK, width=1.5, extra=""):
    (x1, y1), (x2, y2) = page(a), page(b)
    out.append(f'<line x1="{x1:.1f}" y1="{y1:.1f}" x2="{x2:.1f}" y2="{y2:.1f}" '
               f'stroke="{colour}" stroke-width="{width}" {extra}/>')


def arrow(a, b, colour=INK, width=1.5):
    head = {INK: "ink", QUIET: "quiet", FORCE: "force"}[colour]
    line(a, b, colour, width, f'marker-end="url(#{head})"')


def dot(at, radius=3.2, fill="#ffffff", stroke=INK):
    x, y = page(at)
    out.append(f'<circle cx="{x:.1f}" cy="{y:.1f}" r="{radius}" fill="{fill}" '
               f'stroke="{stroke}" stroke-width="1.4"/>')


def text(at, words, colour=INK, anchor="start", size=17, dx=0, dy=0, italic=True):
    """`a_b` sets b as a subscript."""
    x, y = page(at)
    style = ' font-style="italic"' if italic else ""
    if italic and "_" in words:
        main, sub = words.split("_", 1)
        words = f'{main}<tspan dy="4" font-size="{size * 0.7:.0f}">{sub}</tspan>'
    out.append(f'<text x="{x + dx:.1f}" y="{y + dy:.1f}" fill="{colour}" font-size="{size}" '
               f'text-anchor="{anchor}"{style}>{words}</text>')


def arc(center, radius, start, end, colour=QUIET):
    a = (center[0] + radius * math.cos(start), center[1] + radius * math.sin(start))
    b = (center[0] + radius * math.cos(end), center[1] + radius * math.sin(end))
    (x1, y1), (x2, y2) = page(a), page(b)
    r = radius * SCALE
    out.append(f'<path d="M{x1:.1f} {y1:.1f} A{r:.1f} {r:.1f} 0 0 0 {x2:.1f} {y2:.1f}" '
               f'fill="none" stroke="{colour}" stroke-width="1.2"/>')


base_back = (-L0 / math.tan(PHI0), 0.0)
along_back = (math.cos(PHI0), math.sin(PHI0))


def back(s, aside=0.0):
    """Point of the back beam; `aside` moves it out to the right."""
    return (base_back[0] + s * along_back[0] + aside * along_back[1],
            base_back[1] + s * along_back[1] - aside * along_back[0])


def clamp(at):
    x, y = page(at)
    out.append(f'<rect x="{x - 26}" y="{y}" width="52" height="11" fill="url(#hatch)"/>')
    out.append(f'<line x1="{x - 26}" y1="{y}" x2="{x + 26}" y2="{y}" stroke="{INK}" stroke-width="2"/>')


def dimension(a, b, label, side=-1, dx=-8):
    line(a, b, QUIET, 1, 'marker-start="url(#quiet)" marker-end="url(#quiet)"')
    text((a[0], (a[1] + b[1]) / 2), label, QUIET, "end" if side < 0 else "start", dx=dx, dy=5)


def draw():
    # The object and its contact.
    center = (-RADIUS, CONTACT)
    x, y = page(center)
    out.append(f'<circle cx="{x}" cy="{y}" r="{RADIUS * SCALE}" fill="{OBJECT}" stroke="{BASE}" stroke-width="1.5"/>')
    dot(center, 2, INK)
    arrow(center, (center[0] - RADIUS * math.cos(0.7), center[1] + RADIUS * math.sin(0.7)), QUIET, 1.2)
    text((center[0] - 5, center[1] + 6), "R", QUIET, "start", dx=10, dy=-4)
    text(center, "object", QUIET, "middle", 14, dy=28, italic=False)

    # Ribs under the beams.
    hinges = []
    for index, (front, angle) in enumerate(RIBS):
        a = math.radians(angle)
        cross = math.cos(a) * math.sin(PHI0) - math.sin(a) * math.cos(PHI0)
        s = (math.cos(a) * front + math.sin(a) * base_back[0]) / cross
        line((0, front), back(s), RIB, 3)
        if index == 1:
            line((0, front), (24, front), QUIET, 1, 'stroke-dasharray="4 3"')
            arc((0, front), 21, 0, a)
            text((24.5, front), "φ_i", QUIET, dx=3, dy=-2)
            text((4, front + 4.5), "rib i", QUIET, "start", 14, italic=False)
        hinges.append(back(s))

    # Beams, tip cap, clamps.
    line((0, 0), (0, L0), BEAM, 5, 'stroke-linecap="round"')
    line(base_back, (0, L0), BEAM, 5, 'stroke-linecap="round"')
    for p in GAUGES:
        line(back(p, 1.6), back(p + GAUGE_LENGTH, 1.6), GAUGE, 6)
    (x1, y1), (x2, y2), (x3, y3) = page((0, L0 - 9)), page((0, L0)), page(back(L0 / math.sin(PHI0) - 9))
    out.append(f'<path d="M{x1:.1f} {y1:.1f} L{x2:.1f} {y2 - 5:.1f} L{x3:.1f} {y3:.1f} Z" fill="{INK}" stroke="{INK}" stroke-width="4" stroke-linejoin="round"/>')
    text((0, 120), "front beam", BEAM, "end", 14, dx=-10, dy=5, italic=False)
    text(back(130), "back beam", BEAM, "start", 14, dx=10, dy=5, italic=False)
    text((0, L0), "tip cap, keeps its angle", QUIET, "start", 14, dx=16, dy=2, italic=False)
    clamp((0, 0))
    clamp(base_back)
    for hinge in hinges + [(0, front) for front, _ in RIBS]:
        dot(hinge)

    # Contact force.
    dot((0, CONTACT), 4, FORCE, FORCE)
    arrow((0, CONTACT), (15, CONTACT), FORCE, 3)
    text((15, CONTACT), "f_c", FORCE, dx=8, dy=5, size=19)

    # Lengths along the front beam.
    for height, start, end in ((RIBS[1][0], -3, -39), (CONTACT, -2 * RADIUS - 1, -48), (L0, -3, -57)):
        line((start, height), (end, height), QUIET, 0.8, 'stroke-dasharray="2 3"')
    line((-8, 0), (-57, 0), QUIET, 0.8, 'stroke-dasharray="2 3"')
    dimension((-37, 0), (-37, RIBS[1][0]), "l_i")
    dimension((-46, 0), (-46, CONTACT), "l_c")
    dimension((-55, 0), (-55, L0), "l_0")

    # A gauge's place.
    p = GAUGES[1]
    for s in (0, p, p + GAUGE_LENGTH):
        line(back(s, 4 if s else 11.5), back(s, 17), QUIET, 0.8, 'stroke-dasharray="2 3"')
    line(back(0, 14), back(p, 14), QUIET, 1, 'marker-start="url(#quiet)" marker-end="url(#quiet)"')
    line(back(p, 14), back(p + GAUGE_LENGTH, 14), QUIET, 1,
         'marker-start="url(#quiet)" marker-end="url(#quiet)"')
    text(back(p / 2, 17), "p_j", QUIET, dx=2)
    text(back(p + GAUGE_LENGTH / 2, 17), "w_j", QUIET, dx=2)
    text(back(p + GAUGE_LENGTH / 2, -3), "gauge j", GAUGE, "end", 14, dy=2, italic=False)

    # Angle of the back beam, frame S, arc length.
    line(base_back, (base_back[0] + 17, 0), QUIET, 1, 'stroke-dasharray="4 3"')
    arc(base_back, 10, 0, PHI0)
    text((base_back[0] + 1, 3), "φ_0", QUIET, dx=4)
    arrow((0, 0), (17, 0), INK, 2.2)
    arrow((0, 0), (0, 14), INK, 2.2)
    text((17, 0), "x", dx=6, dy=5)
    text((0, 14), "y", dx=8, dy=2)
    text((0, 0), "S", dx=-20, dy=-8, anchor="end", italic=False)
    arrow((3.5, 110), (3.5, 122), QUIET, 1.2)
    text((3.5, 116), "s", QUIET, dx=6, dy=4)
    arrow(back(9, -4), back(21, -4), QUIET, 1.2)
    text(back(15, -4), "s", QUIET, "end", dx=-9, dy=5)


def main():
    draw()
    width, height = 620, 660
    markers = "".join(
        f'<marker id="{name}" viewBox="0 0 10 10" refX="9" refY="5" markerWidth="6.5" markerHeight="6.5" '
        f'orient="auto-start-reverse" markerUnits="strokeWidth"><path d="M0 1 L9 5 L0 9 z" fill="{colour}"/></marker>'
        for name, colour in (("ink", INK), ("force", FORCE)))
    markers += (f'<marker id="quiet" viewBox="0 0 10 10" refX="9" refY="5" markerWidth="9" markerHeight="9" '
                f'orient="auto-start-reverse" markerUnits="strokeWidth"><path d="M0 2 L9 5 L0 8 z" fill="{QUIET}"/></marker>')
    svg = (f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" width="{width}" height="{height}" '
           f'font-family="Georgia, \'Times New Roman\', serif">\n'
           f'<title>A Fin-Ray finger and its conventions</title>\n<defs>{markers}'
           f'<pattern id="hatch" width="7" height="7" patternUnits="userSpaceOnUse" patternTransform="rotate(45)">'
           f'<line x1="0" y1="0" x2="0" y2="7" stroke="{BASE}" stroke-width="2.4"/></pattern></defs>\n'
           f'<rect x="1" y="1" width="{width - 2}" height="{height - 2}" rx="14" fill="#ffffff" stroke="#d9dee4"/>\n'
           + "\n".join(out) + "\n</svg>\n")
    target = pathlib.Path(sys.argv[1]) if len(sys.argv) > 1 else (
        pathlib.Path(__file__).resolve().parent.parent / "docs" / "pictures" / "finger.svg")
    target.write_text(svg, "utf-8")


if __name__ == "__main__":
    main()
