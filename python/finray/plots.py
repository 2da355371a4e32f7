"""Pictures of results. Each takes matplotlib axes or makes them, and returns them."""

from __future__ import annotations

from typing import Any

import numpy as np

from finray.calibration import Calibration
from finray.description import Finger, Scene
from finray.estimation import STATUSES, Estimation
from finray.forward import simulate
from finray.outline import Reconstruction
from finray.tables import Floats

COLOURS = {"ok": "C0", "no_contact": "0.6", "unobservable": "C1", "not_converged": "C3", "bad_input": "k"}


def _axes(axes: Any) -> Any:
    if axes is not None:
        return axes
    import matplotlib.pyplot as pyplot

    return pyplot.subplots()[1]


def plot_finger(finger: Finger, contact_mm: float | None = None, normal_N: float = 0.0, *, scene: Scene | None = None,
                axes: Any = None) -> Any:
    """Draws both beams and the ribs' pins, undeformed or under a contact.

    >>> import finray, matplotlib
    >>> matplotlib.use("Agg")  # no window
    >>> axes = finray.plot_finger(finray.paper_finger(), contact_mm=70, normal_N=2)
    >>> [text.get_text() for text in axes.get_legend().get_texts()]
    ['front', 'back', '2 N at 70 mm']
    """
    axes = _axes(axes)
    load = {"contact_1_mm": [contact_mm], "normal_1_N": [normal_N]} if contact_mm is not None else {"time_s": [0.0]}
    found = simulate(finger, load, scene, shapes=True)
    for beam, colour in (("front", "C0"), ("back", "C1")):
        of_beam = found.shapes["beam"] == beam
        axes.plot(found.shapes["x_mm"][of_beam], found.shapes["y_mm"][of_beam], color=colour, label=beam)
    for i in range(1, finger.ribs + 1):
        axes.plot(*([found[f"rib_{i}_{side}_{axis}_mm"][0] for side in ("front", "back")] for axis in "xy"),
                  color="0.4", linewidth=1)
    if contact_mm is not None:
        axes.plot(found["contact_1_x_mm"], found["contact_1_y_mm"], "o", color="C3",
                  label=f"{normal_N:g} N at {contact_mm:g} mm")
    axes.set_aspect("equal")
    axes.set_xlabel("x / mm")
    axes.set_ylabel("y / mm")
    axes.legend()
    return axes


def plot_estimates(found: Estimation, column: str = "normal_1_N", x: Floats | None = None, *, axes: Any = None) -> Any:
    """Draws a column over the frames (or over `x`), by status, with two std where there is one."""
    axes = _axes(axes)
    place = np.arange(len(found.codes), dtype=float) if x is None else np.asarray(x)
    name, _, unit = column.rpartition("_")
    std = found.columns.get(f"{name}_std_{unit}")
    for code, status in enumerate(STATUSES):
        rows = found.codes == code
        if not rows.any():
            continue
        axes.errorbar(place[rows], found[column][rows], None if std is None else 2 * np.nan_to_num(std[rows]), fmt=".", markersize=3,
                      elinewidth=0.5, color=COLOURS[str(status)], label=str(status))
    axes.set_xlabel("frame" if x is None else "x")
    axes.set_ylabel(f"{name} / {unit}")
    axes.legend()
    return axes


def plot_parameters(found: Calibration, *, axes: Any = None) -> Any:
    """Draws how far the free parameters have moved, in std of their priors (or in percent where there is none)."""
    axes = _axes(axes)
    free = [parameter for parameter in found.parameters if parameter.status != "fixed"]
    for i, p in enumerate(free):
        unit = p.prior_std if p.prior_std else max(abs(p.initial), 1e-12) / 100
        axes.errorbar((p.value - p.initial) / unit, i, xerr=2 * p.std / unit, fmt="o",
                      color={"estimated": "C0", "prior_dominated": "C1"}.get(p.status, "C3"))
    axes.set_yticks(range(len(free)), [parameter.name for parameter in free])
    axes.invert_yaxis()
    axes.axvline(0, color="0.7", zorder=0)
    axes.set_xlabel("change, in std of the prior (percent without one)")
    return axes


def plot_outline(found: Reconstruction, *, axes: Any = None) -> Any:
    """Draws an outline with a band of two std, dashed where no touch supports it, and the touches."""
    axes = _axes(axes)
    outline = {name: np.append(values, values[:1]) for name, values in found.outline.items()}
    angle, std = np.radians(outline["angle_deg"]), 2 * outline["std_mm"]
    ring = np.array([np.cos(angle), np.sin(angle)])
    centre = np.array([[found.centroid_x_mm], [found.centroid_y_mm]])
    outer, inner = centre + (outline["radius_mm"] + std) * ring, centre + (outline["radius_mm"] - std) * ring
    axes.fill(*np.concatenate([outer, inner[:, ::-1]], axis=1), color="C0", alpha=0.25, linewidth=0)
    supported = outline["supported"] > 0
    axes.plot(outline["x_mm"], outline["y_mm"], "--", color="C0", linewidth=1)
    axes.plot(np.where(supported, outline["x_mm"], np.nan), outline["y_mm"], color="C0", label="outline")
    axes.plot(found.touches["point_x_mm"], found.touches["point_y_mm"], ".", color="C3", label="touches")
    axes.set_aspect("equal")
    axes.set_xlabel("x / mm")
    axes.set_ylabel("y / mm")
    axes.legend()
    return axes
