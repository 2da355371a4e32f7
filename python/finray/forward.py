"""From contacts to shape and gauges."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Mapping
import warnings

from finray import _finray
from finray.description import Finger, Scene
from finray.errors import FinrayWarning
from finray.tables import Columns, Floats, Log, columns_of, data_frame, table_of


@dataclass
class Simulation(Mapping[str, Any]):
    """The simulated rows: a mapping from column names to arrays."""

    columns: Columns
    #: Both beams of every row, if asked for: row, beam, arc_mm, x_mm, y_mm, angle_rad, moment_N_mm.
    shapes: Columns
    contact: int
    free: int
    not_converged: int

    def __getitem__(self, name: str) -> Any:
        return self.columns[name]

    def __iter__(self) -> Any:
        return iter(self.columns)

    def __len__(self) -> int:
        return len(self.columns)

    def to_dataframe(self) -> Any:
        """The columns as a pandas.DataFrame."""
        return data_frame(self.columns)


def simulate(finger: Finger, frames: Log, scene: Scene | None = None, *, shapes: bool = False,
             scheme: str = "taylor", resolution: int = 0) -> Simulation:
    """Solves the finger for given contacts or places of an object, as finray_simulate does.

    Rows have contact_<c>_mm and normal_<c>_N (and friction_<c>), or object_x_mm and object_y_mm of the scene's object.
    Rows without a solution get NaN and the status not_converged, and a FinrayWarning says so.

    >>> import finray
    >>> finger = finray.paper_finger()
    >>> found = finray.simulate(finger, {"contact_1_mm": [70.0], "normal_1_N": [2.0]})
    >>> found["status"][0], round(found["gauge_1_V"][0], 4)
    ('ok', -0.0098)
    """
    scene = scene or Scene()
    columns, beams, contact, free, failed, first = _finray.simulate(
        finger._inside, scene._inside, table_of(frames, scene, "frames"), shapes, scheme, resolution)
    if failed:
        warnings.warn(f"{failed} of {contact + free + failed} rows have no solution, first {first}; "
                      "their cells are empty; lower their loads", FinrayWarning, stacklevel=2)
    return Simulation(columns_of(columns), columns_of(beams), contact, free, failed)


def make_log(finger: Finger, simulated: Log, *, force_std_N: float = 0.02, object_std_mm: float = 0.05,
             pin_std_mm: float = 0.0, seed: int = 1) -> Mapping[str, Floats]:
    """The log that a lab would record of simulated frames: gauges, force_N, the object's place; with noise."""
    return columns_of(_finray.make_log(finger._inside, table_of(simulated), force_std_N, object_std_mm, pin_std_mm,
                                       seed))
