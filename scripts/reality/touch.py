"""A rigid circle pressed along a path: what CalculiX says at each place of it.

The circle does not turn. A touch begins with it 0.01 mm off the undeformed front
beam; friction has the whole path as its past.
"""

import dataclasses
import math

import ccx
import gauges
from circle import Circle, PENALTY_N_MM3
from solid import Solid

RADIUS_MM = 15.0
GAP_MM = 0.01
FINE_MM, REACH_MM, SPAN_MM = 0.4, 10.0, 14.0
SETTLE_MM = 0.01


@dataclasses.dataclass
class Frame:
    object_mm: tuple  # centre of the circle, in frame S
    force_N: tuple  # on the finger, in frame S
    contact_mm: float  # arc length of the centre of pressure
    normal_N: float
    friction: float  # tangential over normal force, + towards the tip
    point_mm: tuple  # of the contact, on the deformed surface
    tangent_rad: float
    gauges_rad: list


def touch(plant, path, friction, folder, fine_mm=FINE_MM, step_mm=2.0, layers=2, increment=0.2,
          penalty_N_mm3=PENALTY_N_MM3):
    """path: [(depth, height)]: how far the circle is pressed into the undeformed
    outer surface, and its y. increment: the share of a way between two places that
    CalculiX tries first. Returns a Frame each; raises ccx.NotSolved."""
    middle = sum(height for _, height in path) / len(path)
    solid = Solid(plant, middle, step_mm, fine_mm, REACH_MM, layers)
    deck = ccx.Deck(solid)
    surface = -RADIUS_MM - plant.thickness["front"] / 2
    circle = Circle(deck, RADIUS_MM, (surface - GAP_MM, path[0][1]))
    circle.contact(middle - SPAN_MM, middle + SPAN_MM, friction, penalty_N_mm3)
    places = [(surface + depth, height) for depth, height in path]
    stops = []  # (place, whether a row is read there)
    for last, place in zip(places[:1] + places, places):
        along = place[1] - last[1]
        if along:
            # The last increment of a slide is short, as tangents lag behind by one.
            stops.append(((place[0], place[1] - math.copysign(SETTLE_MM, along)), False))
        stops.append((place, True))
    steps = []
    for place, _ in stops:
        steps += circle.step(place, increment)
    prints = ccx.run(deck.text(steps), folder)
    if len(prints) != len(stops):
        raise ccx.NotSolved(f"{len(prints)} of {len(stops)} places")
    return [frame(solid, place, moved, contact)
            for (place, is_read), (_, moved, contact) in zip(stops, prints) if is_read]


def frame(solid, place, moved, contact):
    """contact: of ccx.run. The normal is the circle's at the centre of pressure."""
    (fx, fy, *_), (x, y, *_), moment = contact[0], contact[1], contact[2][2]
    # The centre of pressure, from that of the area: both are on the same tangent.
    nx, ny = normal_at(place, (x, y))
    shift = -moment / (fx * nx + fy * ny)
    x, y = x - shift * ny, y + shift * nx
    nx, ny = normal_at(place, (x, y))
    normal, tangential = -(fx * nx + fy * ny), fx * ny - fy * nx
    return Frame(place, (fx, fy), gauges.arc_of(solid, moved, (x, y)), normal, tangential / normal,
                 (x, y), math.atan2(-nx, ny), gauges.angles(solid, moved))


def normal_at(centre, point):
    """Out of the beam, towards the centre of the circle."""
    size = math.dist(centre, point)
    return (centre[0] - point[0]) / size, (centre[1] - point[1]) / size
