"""Draws a finger to scale as SVG: beams, ribs, gauges, clamps, and what stands beside them.

Points are in mm in frame S; the origin is the base of the front beam, +y along it.
"""

import html
import math

INK, QUIET, BEAM, RIB = "#22272e", "#6b7480", "#2f6fab", "#8a8f98"
GAUGE, FORCE, OBJECT, BASE = "#d1793b", "#b3382c", "#e9edf2", "#9aa3ad"


class Drawing:
    """Elements of an SVG. `left`, `top` is the page position of (0, front_length)."""

    def __init__(self, front_length, back_angle, scale, left, top):
        self.front_length, self.back_angle = front_length, back_angle
        self.scale, self.left, self.top = scale, left, top
        self.back_length = front_length / math.sin(back_angle)
        self.base_back = (-front_length / math.tan(back_angle), 0.0)
        self.along_back = (math.cos(back_angle), math.sin(back_angle))
        self.out = []

    def page(self, point):
        return (self.left + self.scale * point[0],
                self.top + self.scale * (self.front_length - point[1]))

    def back(self, s, aside=0.0):
        """Point of the back beam; `aside` moves it out to the right."""
        return (self.base_back[0] + s * self.along_back[0] + aside * self.along_back[1],
                self.base_back[1] + s * self.along_back[1] - aside * self.along_back[0])

    def line(self, a, b, colour=INK, width=1.5, extra=""):
        (x1, y1), (x2, y2) = self.page(a), self.page(b)
        self.out.append(f'<line x1="{x1:.1f}" y1="{y1:.1f}" x2="{x2:.1f}" y2="{y2:.1f}" '
                        f'stroke="{colour}" stroke-width="{width}" {extra}/>')

    def arrow(self, a, b, colour=INK, width=1.5):
        head = {INK: "ink", QUIET: "quiet", FORCE: "force"}[colour]
        self.line(a, b, colour, width, f'marker-end="url(#{head})"')

    def dot(self, at, radius=3.2, fill="#ffffff", stroke=INK):
        x, y = self.page(at)
        self.out.append(f'<circle cx="{x:.1f}" cy="{y:.1f}" r="{radius}" fill="{fill}" '
                        f'stroke="{stroke}" stroke-width="1.4"/>')

    def circle(self, center, radius, fill=OBJECT, stroke=BASE, extra=""):
        x, y = self.page(center)
        self.out.append(f'<circle cx="{x}" cy="{y}" r="{radius * self.scale}" fill="{fill}" '
                        f'stroke="{stroke}" stroke-width="1.5"{extra}/>')

    def text(self, at, words, colour=INK, anchor="start", size=17, dx=0, dy=0, italic=True,
             halo=False):
        """`a_b` in italics sets b as a subscript; a halo keeps the words apart from what is below them."""
        x, y = self.page(at)
        style = ' font-style="italic"' if italic else ""
        style += ' stroke="#ffffff" stroke-width="4" paint-order="stroke"' if halo else ""
        words = html.escape(words)
        if italic and "_" in words:
            main, sub = words.split("_", 1)
            words = f'{main}<tspan dy="4" font-size="{size * 0.7:.0f}">{sub}</tspan>'
        self.out.append(f'<text x="{x + dx:.1f}" y="{y + dy:.1f}" fill="{colour}" font-size="{size}" '
                        f'text-anchor="{anchor}"{style}>{words}</text>')

    def arc(self, center, radius, start, end, colour=QUIET):
        a = (center[0] + radius * math.cos(start), center[1] + radius * math.sin(start))
        b = (center[0] + radius * math.cos(end), center[1] + radius * math.sin(end))
        (x1, y1), (x2, y2) = self.page(a), self.page(b)
        r = radius * self.scale
        self.out.append(f'<path d="M{x1:.1f} {y1:.1f} A{r:.1f} {r:.1f} 0 0 0 {x2:.1f} {y2:.1f}" '
                        f'fill="none" stroke="{colour}" stroke-width="1.2"/>')

    def clamp(self, at):
        x, y = self.page(at)
        self.out.append(f'<rect x="{x - 26}" y="{y}" width="52" height="11" fill="url(#hatch)"/>')
        self.out.append(f'<line x1="{x - 26}" y1="{y}" x2="{x + 26}" y2="{y}" stroke="{INK}" stroke-width="2"/>')

    def dimension(self, a, b, label, side=-1, dx=-8):
        self.line(a, b, QUIET, 1, 'marker-start="url(#quiet)" marker-end="url(#quiet)"')
        self.text((a[0], (a[1] + b[1]) / 2), label, QUIET, "end" if side < 0 else "start", dx=dx, dy=5)

    def cap(self):
        """The tip cap, which keeps its angle."""
        page, cap = self.page, 9 / 140 * self.front_length
        (x1, y1), (x2, y2) = page((0, self.front_length - cap)), page((0, self.front_length))
        x3, y3 = page(self.back(self.back_length - cap))
        self.out.append(f'<path d="M{x1:.1f} {y1:.1f} L{x2:.1f} {y2 - 5:.1f} L{x3:.1f} {y3:.1f} Z" fill="{INK}" '
                        f'stroke="{INK}" stroke-width="4" stroke-linejoin="round"/>')

    def beams(self):
        self.line((0, 0), (0, self.front_length), BEAM, 5, 'stroke-linecap="round"')
        self.line(self.base_back, (0, self.front_length), BEAM, 5, 'stroke-linecap="round"')

    def frame(self, length):
        """The axes of frame S."""
        self.arrow((0, 0), (length, 0), INK, 2.2)
        self.arrow((0, 0), (0, 14 / 17 * length), INK, 2.2)
        self.text((length, 0), "x", dx=6, dy=5)
        self.text((0, 14 / 17 * length), "y", dx=8, dy=2)
        self.text((0, 0), "S", dx=-20, dy=-8, anchor="end", italic=False)

    def svg(self, width, height, title):
        markers = "".join(
            f'<marker id="{name}" viewBox="0 0 10 10" refX="9" refY="5" markerWidth="6.5" markerHeight="6.5" '
            f'orient="auto-start-reverse" markerUnits="strokeWidth"><path d="M0 1 L9 5 L0 9 z" fill="{colour}"/></marker>'
            for name, colour in (("ink", INK), ("force", FORCE)))
        markers += (f'<marker id="quiet" viewBox="0 0 10 10" refX="9" refY="5" markerWidth="9" markerHeight="9" '
                    f'orient="auto-start-reverse" markerUnits="strokeWidth"><path d="M0 2 L9 5 L0 8 z" fill="{QUIET}"/></marker>')
        return (f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" width="{width}" height="{height}" '
                f'font-family="Georgia, \'Times New Roman\', serif">\n'
                f'<title>{html.escape(title)}</title>\n<defs>{markers}'
                f'<pattern id="hatch" width="7" height="7" patternUnits="userSpaceOnUse" patternTransform="rotate(45)">'
                f'<line x1="0" y1="0" x2="0" y2="7" stroke="{BASE}" stroke-width="2.4"/></pattern></defs>\n'
                f'<rect x="1" y="1" width="{width - 2}" height="{height - 2}" rx="14" fill="#ffffff" stroke="#d9dee4"/>\n'
                + "\n".join(self.out) + "\n</svg>\n")
