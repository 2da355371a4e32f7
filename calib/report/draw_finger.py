#!/usr/bin/python3
"""Draws a finger as its YAML has it: draw_finger.py OUT.svg FINGER_YAML_TEXT [x,y x,y ...].

The text is that of FingerToYaml: ribs have back_mm. Places x,y (mm, frame S) are drawn as dots beside the finger.
"""

import math
import pathlib
import sys
import textwrap
import unicodedata

sys.dont_write_bytecode = True

sys.path.append(str(pathlib.Path(__file__).resolve().parents[2] / "scripts/common"))
import guard  # noqa: E402

guard.protect("draw_finger.py", __name__)

import page
import whole_file
from finger_drawing import BEAM, FORCE, GAUGE, QUIET, RIB, Drawing

HEIGHT = 560.0  # of the front beam, in pixels
DIMENSIONS, LABELS = 120.0, 150.0  # room on the left and on the right


def number(value):
    return f"{value:.5g}"


def wrapped(words, pixels):
    """At most six lines of words of 14 pixels that are no wider."""
    wide = any(unicodedata.east_asian_width(letter) in "FW" for letter in words)
    return textwrap.wrap(words, max(int(pixels / (14 if wide else 8.4)), 2), max_lines=6, placeholder=" …")


def beam_words(beam):
    stiffness = [p["bending_stiffness_N_mm2"] for p in beam.get("pieces", [beam])]
    words = "EI " + ", ".join(f"{v:.6g}" for v in stiffness) + " N mm²"
    return words if len(stiffness) < 4 else f"EI {min(stiffness):.6g} to {max(stiffness):.6g} N mm²"


def ribs(drawing, finger):
    for i, rib in enumerate(finger.get("ribs") or [], 1):
        a, b = (0, rib["front_mm"]), drawing.back(rib["back_mm"])
        drawing.line(a, b, RIB, 3)
        middle = ((a[0] + b[0]) / 2, (a[1] + b[1]) / 2)
        angle = math.degrees(math.atan2(b[1] - a[1], b[0] - a[0]))
        drawing.text(middle, f"{i}: {angle:.3g}°", QUIET, "middle", 12, dy=-7, italic=False)


def gauges(drawing, finger, mm):
    for j, gauge in enumerate(finger.get("gauges") or [], 1):
        start, length = gauge["start_mm"], gauge["length_mm"]
        words = f"{j}: {number(start)} to {number(start + length)}"
        if gauge["beam"] == "front":
            drawing.line((5 * mm, start), (5 * mm, start + length), GAUGE, 5)
            drawing.text((26 * mm, start + length / 2), words, GAUGE, "start", 13, dy=4, italic=False)
        else:
            drawing.line(drawing.back(start, 5 * mm), drawing.back(start + length, 5 * mm), GAUGE, 5)
            drawing.text(drawing.back(start + length / 2, 11 * mm), words, GAUGE, "start", 13, dy=4, italic=False)


def draw(finger, places):
    length, angle = finger["geometry"]["front_length_mm"], math.radians(finger["geometry"]["back_angle_deg"])
    scale = HEIGHT / length
    mm = 1 / scale  # a pixel
    aside = max([0.0] + [-x * scale for x, _ in places])
    width = max(DIMENSIONS + aside - length / math.tan(angle) * scale + LABELS, 560 + aside)
    title = wrapped(f"{finger['name']}, lengths in mm from the base of each beam", width - DIMENSIONS - aside + 80)
    top = 42 + 18 * len(title)
    drawing = Drawing(length, angle, scale, DIMENSIONS + aside, top)
    for x, y in places:
        drawing.dot((x, y), 2.4, FORCE, FORCE)
    ribs(drawing, finger)
    drawing.beams()
    gauges(drawing, finger, mm)
    drawing.cap()
    drawing.clamp((0, 0))
    drawing.clamp(drawing.base_back)
    for rib in finger.get("ribs") or []:
        drawing.dot((0, rib["front_mm"]))
        drawing.dot(drawing.back(rib["back_mm"]))
        drawing.text((0, rib["front_mm"]), number(rib["front_mm"]), QUIET, "end", 13, dx=-9, dy=4, italic=False,
                     halo=bool(places))
        drawing.text(drawing.back(rib["back_mm"], 8 * mm), number(rib["back_mm"]), QUIET, "start", 13, dy=4,
                     italic=False)
    x = -max(64, aside + 24) * mm  # left of all places
    for height in (0, length):
        drawing.line((-12 * mm, height), (x - 8 * mm, height), QUIET, 0.8, 'stroke-dasharray="2 3"')
    drawing.dimension((x, 0), (x, length), number(length), dx=-6)
    drawing.arc(drawing.base_back, 34 * mm, 0, angle)
    drawing.line(drawing.base_back, (drawing.base_back[0] + 60 * mm, 0), QUIET, 1, 'stroke-dasharray="4 3"')
    drawing.text((drawing.base_back[0] + 36 * mm, 16 * mm),
                 f"{finger['geometry']['back_angle_deg']:.6g}°", QUIET, size=14, italic=False)
    drawing.frame(60 * mm)
    below = (0, -42 * mm)
    drawing.text(below, f"front {beam_words(finger['beams']['front'])}", BEAM, "start", 14, dx=-80, italic=False)
    drawing.text(below, f"back {number(drawing.back_length)} mm, base at x = {drawing.base_back[0]:.5g} mm, "
                 f"{beam_words(finger['beams']['back'])}", BEAM, "start", 14, dx=-80, dy=20, italic=False)
    for i, words in enumerate(title):
        drawing.text((0, length), words, QUIET, "start", 14, dx=-80, dy=18 * (i + 1) - top + 12, italic=False)
    return drawing.svg(round(width), top + HEIGHT + 90, f"Finger {finger['name']}")


def main():
    places = [tuple(map(float, pair.split(","))) for pair in sys.argv[3:]]
    whole_file.write(pathlib.Path(sys.argv[1]), draw(page.load_yaml(sys.argv[2]), places))


if __name__ == "__main__":
    main()
