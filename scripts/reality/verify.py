#!/usr/bin/python3
"""Checks the plant against what is not CalculiX: verify.py [BUILD_DIR]

Prints tables; exit code 1 if a difference is beyond what it may be, 2 if a package
is not installed. BUILD_DIR (default build) holds finray_simulate.
"""

import copy
import math
import pathlib
import statistics
import sys
import tempfile

sys.dont_write_bytecode = True

sys.path.append(str(pathlib.Path(__file__).resolve().parents[1] / "common"))
import guard  # noqa: E402

guard.protect("verify.py", __name__)

try:
    from scipy.optimize import brentq
    from scipy.special import ellipe, ellipeinc, ellipk, ellipkinc
except ImportError:
    if __name__ != "__main__":
        raise  # a test that imports this skips
    sys.exit(print("verify.py: python3-scipy is not installed: scripts/install_dependencies reality", file=sys.stderr) or 2)

import ccx
import gauges
from beams import beam_model, bundled, difference, readings
from frame import Frame
import plant as plants
from plant import RIGID_SHARE
from solid import Solid
from touch import RADIUS_MM, touch

ROOT = pathlib.Path(__file__).resolve().parents[2]
DATA = ROOT / "datasets" / "reality"
POINTS = [(45.0, 4.0), (70.0, 3.0), (100.0, 3.0)]  # arc length, N
CIRCLES = [(45.0, 2.0), (70.0, 4.0), (100.0, 2.5)]  # height, depth in mm
# The one-piece finger: three depths, to about 7 N, at three heights.
PRINTED = [(30.0, 0.3), (30.0, 0.6), (30.0, 0.9), (50.0, 0.4), (50.0, 0.8), (50.0, 1.2),
           (70.0, 0.4), (70.0, 0.7), (70.0, 1.0)]


class Cantilever(Solid):
    """The front beam alone, up to its full length."""

    def __init__(self, plant, step_mm):
        plant = copy.copy(plant)
        plant.ribs = []
        self.prepare(plant, step_mm, layers=2)
        self.ends = {"front": plant.front_length_mm}
        self.beam("front", [], [])


def elastica(stiffness, length, force):
    """Way of a cantilever's end along and across, and its turn, under a dead load
    across it (Bisshopp and Drucker, 1945)."""
    alpha = force * length**2 / stiffness

    def parts(turn):
        m = (1 + math.sin(turn)) / 2
        return m, math.asin(1 / math.sqrt(2 * m))

    def excess(turn):
        m, start = parts(turn)
        return ellipk(m) - ellipkinc(start, m) - math.sqrt(alpha)
    turn = brentq(excess, 1e-9, math.pi / 2 - 1e-9, xtol=1e-14)
    m, start = parts(turn)
    across = length * (1 - 2 / math.sqrt(alpha) * (ellipe(m) - ellipeinc(start, m)))
    return length * (1 - math.sqrt(2 * math.sin(turn) / alpha)), across, turn


def load(solid, node, force, folder):
    """Displacements under a dead load on a node."""
    steps = ["*STEP, NLGEOM, INC=200", "*STATIC", "0.25,1.", "*CLOAD", f"{node},1,{force[0]:.12g}",
             f"{node},2,{force[1]:.12g}", "*NODE PRINT, NSET=ALL, FREQUENCY=1000", "U", "*END STEP"]
    return ccx.run(ccx.Deck(solid).text(steps), folder)[-1][1]


def cantilever(plant, folder, forces=(0.5, 2.0), step_mm=2.0):
    """Force, solid and elastica: (shortening, deflection, turn) each."""
    found = []
    for force in forces:
        solid = Cantilever(plant, step_mm)
        end = solid.neutral("front", plant.front_length_mm)
        moved = load(solid, end, (force, 0), folder)
        ux, uy = moved[end]
        turn = -gauges.turn(solid, moved, "front", plant.front_length_mm)
        found.append((force, (-uy, ux, turn), elastica(plant.stiffness("front"), plant.front_length_mm, force)))
    return found


def point_loads(build, plant, folder, points=POINTS):
    """(place, force, difference of gauges in percent, of the same by sections, of the
    contact's place in mm)."""
    solids = [Solid(plant, arc) for arc, _ in points]
    points = [(solid.nearest("front", arc), force) for solid, (arc, force) in zip(solids, points)]
    expected = beam_model(build, plant, "strip", {"contacts": 1}, "contact_1_mm,normal_1_N", points, folder)
    found = []
    for solid, (arc, force), row in zip(solids, points, expected):
        node = solid.neutral("front", arc)
        theta = float(row["contact_1_angle_rad"])
        # CalculiX knows no follower load: its dead load has the direction of equilibrium.
        moved = load(solid, node, (force * math.sin(theta), -force * math.cos(theta)), folder)
        sections = [gauges.turn(solid, moved, g.beam, g.start_mm + g.length_mm)
                    - gauges.turn(solid, moved, g.beam, g.start_mm) for g in plant.gauges]
        place = gauges.place(solid, moved, node)
        found.append((arc, force, difference(gauges.angles(solid, moved), readings(row, plant)),
                      difference(sections, readings(row, plant)),
                      math.dist(place, (float(row["contact_1_x_mm"]), float(row["contact_1_y_mm"])))))
    return found


def touches(plant, folder, friction, places, **mesh):
    return [touch(plant, [(0.5 * depth, height), (depth, height)], friction, folder, **mesh)[-1]
            for height, depth in places]


def circles(build, plant, name, folder, friction, places=CIRCLES, **mesh):
    """(height, depth, force, its difference in percent, of the gauges, of the place in
    mm), at the same place of the circle. With friction it is under the same contact,
    and only the gauges can differ."""
    return beside(build, plant, name, folder, friction, places, touches(plant, folder, friction, places, **mesh))


def beside(build, plant, name, folder, friction, places, frames, one_piece=None):
    """The rows of circles() for touches of CalculiX."""
    if friction:
        expected = beam_model(build, plant, name, {"contacts": 1}, "contact_1_mm,normal_1_N,friction_1",
                              [(f.contact_mm, f.normal_N, f.friction) for f in frames], folder, one_piece)
    else:
        outside = RADIUS_MM + (plant.thickness["front"] / 2 if one_piece is None else 0)
        expected = beam_model(build, plant, name, {"object": {"shape": "circle", "radius_mm": outside}},
                              "object_x_mm,object_y_mm", [f.object_mm for f in frames], folder, one_piece)
    return [(height, depth, frame.normal_N,
             math.nan if friction else difference([frame.normal_N], [float(row["normal_1_N"])]),
             difference(frame.gauges_rad, readings(row, plant)),
             math.nan if friction else abs(frame.contact_mm - float(row["contact_1_mm"])))
            for (height, depth), frame, row in zip(places, frames, expected)]


def frames(plant, rigid_share, presses):
    """(height, depth, force, difference of the way and of the gauges in percent) of the
    one-piece finger, lightly pressed; presses: of pressed()."""
    found = []
    for frame, depth in presses:
        way, angles = Frame(plant, frame.contact_mm, rigid_share).press(math.hypot(*frame.force_N))
        found.append((frame.object_mm[1], depth, frame.normal_N, difference([way], [depth]),
                      difference(angles, frame.gauges_rad)))
    return found


def pressed(plant, folder, places=((30.0, 0.3), (42.0, 0.3), (54.0, 0.3), (65.0, 0.3), (78.0, 0.3))):
    """[(Frame, depth)] of light touches between the ribs."""
    return [(touch(plant, [(depth, height)], 0.0, folder)[-1], depth) for height, depth in places]


def refined(plant, folder, friction, height=70.0, depth=4.0):
    """(elements, penalty, force, contact, friction): what the contact's mesh does."""
    found = []
    for fine, penalty in ((0.4, 50.0), (0.2, 50.0), (0.2, 500.0), (0.2, 5000.0)):
        frame = touch(plant, [(depth / 2, height), (depth, height)], friction, folder, fine_mm=fine,
                      penalty_N_mm3=penalty)[-1]
        found.append((fine, penalty, frame.normal_N, frame.contact_mm, frame.friction))
    return found


def table(title, header, body):
    print(f"\n{title}\n\n| {' | '.join(header)} |\n|{'---|' * len(header)}")
    for row in body:
        print("| " + " | ".join("given" if math.isnan(cell) else f"{cell:.5g}" for cell in row) + " |", flush=True)


def main():
    build = pathlib.Path(*guard.words(__doc__, 0, 1) or ["build"]).resolve()
    try:
        print(ccx.version())
    except ccx.NotInstalled as error:
        sys.exit(print(f"verify.py: {error}", file=sys.stderr) or 2)
    strip, printed = (plants.read(DATA / name / "plant.yaml") for name in ("strip", "printed"))
    worst = []
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        bent = cantilever(strip, folder)
        table("Cantilever of solids (the front strip, 140 mm) against the elastica, under a dead load across its end",
              ["load, N", "end moves across, mm", "elastica", "along, mm", "elastica", "turns, rad", "elastica"],
              [(force, s[1], e[1], s[0], e[0], s[2], e[2]) for force, s, e in bent])
        worst += [(difference(s, e), 0.2) for _, s, e in bent]
        points = point_loads(build, strip, folder)
        table("Strip finger under a point load on the neutral line against `finray_simulate`",
              ["place, mm", "load, N", "gauges differ by, % of the largest", "by section turns, %", "place differs by, mm"],
              points)
        worst += [(row[2], 1.0) for row in points]
        header = ["height, mm", "depth, mm", "force, N", "force differs by, %", "gauges differ by, % of the largest",
                  "contact differs by, mm"]
        for friction in (0.0, 0.3):
            found = circles(build, strip, "strip", folder, friction)
            table(f"Strip finger against a circle, friction {friction:g}", header, found)
            worst += [(value, 1.0) for row in found for value in row[3:5] if not math.isnan(value)]
        for friction in (0.0, 0.3):
            table(f"The same at 70 mm, 4 mm deep, friction {friction:g}, with other meshes at the contact and penalties",
                  ["elements, mm", "penalty, N/mm^3", "force, N", "contact, mm", "friction"], refined(strip, folder, friction))
        heights = [(30.0, 0.6), (50.0, 1.2), (70.0, 0.6)]
        for words, mesh in (("as for the logs: 2 layers, 0.4 mm at the contact, 2 mm elsewhere", {}),
                            ("3 layers, 0.25 mm, 1 mm", {"layers": 3, "fine_mm": 0.25, "step_mm": 1.0})):
            table(f"One-piece finger against `finray_simulate` with ribs on hinges; {words}", header,
                  circles(build, printed, "printed", folder, 0.0, heights, **mesh))
        deep = touches(printed, folder, 0.0, PRINTED)
        for share in (0.0, RIGID_SHARE, 1.0):
            found = beside(build, printed, "printed", folder, 0.0, PRINTED, deep, share)
            table("One-piece finger against `finray_simulate` with ribs that bend; the first "
                  f"{share:g} of the way into a joint is rigid", header, found)
            if share == RIGID_SHARE:
                worst += [(row[4], 2.0) for row in found] + [(row[3], 3.0) for row in found]
        logs = sorted((DATA / "printed").glob("*/*_truth.csv"))
        every = {share: bundled(build, printed, logs, folder, share) for share in (0.0, 0.5, RIGID_SHARE, 0.85, 1.0)}
        table("One-piece finger, all touches of datasets/reality, against `finray_simulate` with ribs that bend, under the same "
              "contact", ["rigid share of a joint", "touches", "from, N", "to, N", "gauges differ by, % of the largest, mean",
                          "at most"],
              [(share, len(found), min(found)[0], max(found)[0], statistics.fmean(off for _, off in found),
                max(off for _, off in found)) for share, found in every.items()])
        worst += [(off, 2.0) for _, off in every[RIGID_SHARE]]
        presses = pressed(printed, folder)
        for share in (0.0, RIGID_SHARE, 1.0):
            found = frames(printed, share, presses)
            table(f"One-piece finger, lightly pressed, against a linear frame of beams; the first {share:g} of a rib's way "
                  "through half a beam is rigid",
                  ["height, mm", "depth, mm", "force, N", "depth differs by, %", "gauges differ by, % of the largest"], found)
            if share == RIGID_SHARE:
                worst += [(value, 3.0) for row in found for value in row[3:]]
    if any(not value <= limit for value, limit in worst):
        sys.exit("verify.py: a difference is beyond what it may be: "
                 + ", ".join(f"{value:.3g} of {limit:g} %" for value, limit in worst if not value <= limit))


if __name__ == "__main__":
    main()
