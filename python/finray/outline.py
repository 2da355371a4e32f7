"""From touches to the outline of an object."""

from __future__ import annotations

from dataclasses import dataclass

from finray import _finray
from finray.description import Finger, Scene
from finray.tables import Columns, Log, columns_of, table_of


@dataclass
class Reconstruction:
    """The outline of an object."""

    #: angle_deg, x_mm, y_mm, radius_mm, std_mm, supported (1 or 0), around the centroid.
    outline: Columns
    #: The usable touches: row, point_x_mm, point_y_mm, normal_deg, normal_N, ...
    touches: Columns
    centroid_x_mm: float
    centroid_y_mm: float
    perimeter_mm: float
    #: Scatter of the touches over their std.
    noise_scale: float
    #: The share of the outline's length that touches support.
    supported_share: float
    usable_touches: int
    rows: int


def reconstruct(finger: Finger, touches: Log, scene: Scene | None = None, *, stage_std_mm: float = 0.02,
                scheme: str = "taylor", resolution: int = 0) -> Reconstruction:
    """Reconstructs an outline from gauge_<j>_V, object_x_mm, object_y_mm, object_angle_deg, as finray_reconstruct does.

    Raises GateError if the touches leave too much of the object open.

    A circle of 15 mm that turns in front of the finger, touched every 15 degrees:

    >>> import finray, numpy
    >>> finger = finray.paper_finger()
    >>> turns = numpy.arange(0, 360, 15.0)
    >>> places = {"object_x_mm": -12 + 0 * turns, "object_y_mm": 80 + 0 * turns, "object_angle_deg": turns}
    >>> seen = finray.simulate(finger, places, finray.Scene(object={"shape": "circle", "radius_mm": 15}))
    >>> touches = {name: seen[name] for name in seen if name.startswith("object") or name[:6] == "gauge_" and name[-1] == "V"}
    >>> found = finray.reconstruct(finger, touches)
    >>> found.usable_touches, bool(abs(found.outline["radius_mm"] - 15).max() < 0.1), found.supported_share > 0.9
    (24, True, True)
    """
    scene = scene or Scene()
    outline, used, *rest = _finray.reconstruct(finger._inside, table_of(touches, scene, "touches"), scene._inside,
                                               stage_std_mm, scheme, resolution)
    return Reconstruction(columns_of(outline), columns_of(used), *rest)
