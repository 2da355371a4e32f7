"""The effects of real fingers and benches, each alone in simulated logs, that the plan
configs/plans/force_and_circle.yaml leaves out. An effect changes the finger that is
simulated, its scene, or the rows of the log behind the simulation."""

import copy
import math

RADIUS_MM = 15


def _finger(change):
    def effect(finger, draw):
        change(finger, draw)
        return {}
    return effect


def _gauges_beside(finger, draw):
    for gauge in finger["gauges"]:
        gauge["start_mm"] += draw.choice((-1, 1))


def _hinges_moved(finger, draw):
    # The ribs keep their lengths, so that they push and pull before anything touches.
    for rib in finger["ribs"]:
        rib["front_mm"] += draw.choice((-0.5, 0.5))
        rib["back_mm"] += draw.choice((-0.5, 0.5))


def _hinge_torsion(finger, _):
    for rib in finger["ribs"]:
        rib["hinge_stiffness_N_mm_per_rad"] = 40


def _taper(finger, _):
    pieces = 20
    for beam, length in zip(("front", "back"), lengths(finger)):
        stiffness = finger["beams"][beam].pop("bending_stiffness_N_mm2")
        finger["beams"][beam]["pieces"] = [
            {"end_mm": length * k / pieces, "bending_stiffness_N_mm2": stiffness * (1.05 - 0.1 * (k - 0.5) / pieces)}
            for k in range(1, pieces + 1)]
        del finger["beams"][beam]["pieces"][-1]["end_mm"]


def _rows(change):
    def effect(finger, _):
        return {"rows": lambda rows: change(rows, finger)}
    return effect


def _turned(rows, _):
    c, s = math.cos(math.radians(1)), math.sin(math.radians(1))
    for row in rows:
        x, y = row["object_x_mm"], row["object_y_mm"]
        row["object_x_mm"], row["object_y_mm"] = c * x + s * y, c * y - s * x


def _shifted(rows, _):
    for row in rows:
        row["object_x_mm"] -= 0.5
        row["object_y_mm"] += 0.5


def _angles(change):
    """change: takes the angles of one gauge row by row, rad, and gives what it reads."""
    def rows_of(rows, finger):
        for j, gauge in enumerate(finger["gauges"], 1):
            name, gain, offset = f"gauge_{j}_V", gauge["gain_V_per_rad"], gauge["offset_V"]
            read = change([(row[name] - offset) / gain for row in rows])
            for row, angle in zip(rows, read):
                row[name] = offset + gain * angle
    return _rows(rows_of)


def _curved(finger, _):
    # As real gauges were measured: 20 % less when flat than when bent by 0.1 rad.
    for gauge in finger["gauges"]:
        gauge["curvature_per_rad"] = 1.25


def _flat(angles):
    # The slope is 0.8 at 0 and 1 when bent by some 0.05 rad and more.
    return [a - 0.2 * 0.025 * math.tanh(a / 0.025) for a in angles]


def _play(angles):
    # What follows drags behind by up to 1 mrad.
    at, read = 0.0, []
    for a in angles:
        at = min(max(at, a - 1e-3), a + 1e-3)
        read.append(at)
    return read


# The families of a plan that are the effect, or the same by other words.
EFFECTS = {
    "none": (lambda finger, draw: {}, ()),
    "friction 0.3": (lambda finger, draw: {"friction": 0.3}, ("friction",)),
    "stage turned by 1 deg": (_rows(_turned), ("object_rotation",)),
    "stage shifted by 0.5 mm": (_rows(_shifted), ("object_origin",)),
    "gauges 1 mm beside their drawing": (_finger(_gauges_beside), ("gauge_start",)),
    "gain 20 % lower near flat": (_finger(_curved), ("gauge_curvature",)),
    "the same bent either way": (_angles(_flat), ("gauge_flat_share",)),
    "hysteresis of 1 mrad": (_angles(_play), ("gauge_hysteresis",)),
    "hinges moved by 0.5 mm": (_finger(_hinges_moved), ("hinge_place", "rib_length")),
    "hinge torsion of 40 N mm/rad": (_finger(_hinge_torsion), ("hinge_stiffness",)),
    "stiffness tapering by 10 %": (_finger(_taper), ("stiffness_pieces",)),
}


def lengths(finger):
    """Of the front and the back beam, mm."""
    front, angle = (finger["geometry"][key] for key in ("front_length_mm", "back_angle_deg"))
    return front, front / math.sin(math.radians(angle))


def _normal(draw, std):
    return max(-2 * std, min(2 * std, draw.gauss(0, std)))


def true_finger(drawn, draw):
    """A finger as it comes out of assembly, as a dictionary that a finger YAML holds. Ribs
    get their back hinge and their length in place of their angle."""
    finger = copy.deepcopy(drawn)
    for beam in ("front", "back"):
        finger["beams"][beam]["bending_stiffness_N_mm2"] *= math.exp(_normal(draw, 0.15))
    front, back = lengths(finger)
    angle = math.radians(finger["geometry"]["back_angle_deg"])
    base = -back * math.cos(angle)
    for rib in finger["ribs"]:
        # The hinge is at (base + s cos, s sin) = (L cos, front + L sin) of the rib.
        direction = math.radians(rib.pop("angle_deg"))
        c, s = math.cos(direction), math.sin(direction)
        cross = c * math.sin(angle) - s * math.cos(angle)
        rib["back_mm"] = (c * rib["front_mm"] + s * base) / cross
        rib["length_mm"] = (base + rib["back_mm"] * math.cos(angle)) / c + _normal(draw, 0.2)
    for gauge in finger["gauges"]:
        gauge["gain_V_per_rad"] = 1.5 + 1.1 * draw.random()
        gauge["offset_V"] = _normal(draw, 0.02)
    return finger


# About the force in N that 1 mm of indentation costs, by height in mm.
STIFFNESS = [(20, 9.7), (40, 2.0), (60, 1.0), (80, 0.83), (100, 1.04), (115, 1.9)]


def places(contacts, free, draw):
    """(x, y) of the circle's centre in mm, in random order, with rows without contact."""
    rows = []
    for _ in range(contacts):
        height, force = 22 + 90 * draw.random(), 0.5 + 6.5 * draw.random()
        for (low, k_low), (high, k_high) in zip(STIFFNESS, STIFFNESS[1:]):
            if low <= height <= high:
                k = k_low + (k_high - k_low) * (height - low) / (high - low)
        rows.append((force / k - RADIUS_MM, height))
    step = len(rows) // free
    for i in range(free):
        rows.insert(i * (step + 1), (-RADIUS_MM - 5.0, 70.0))
    return rows
