"""Contact sensing and calibration of sensorised Fin-Ray fingers.

Units are mm, N, rad and V, and stand in every name.

>>> import finray
>>> finger = finray.paper_finger()
>>> finger
Finger('paper_140mm', 5 ribs, 4 gauges)
"""

from finray import _finray
from finray.calibration import Calibration, Noise, Parameter, WeakDirection, calibrate
from finray.description import Finger, Plan, Scene
from finray.errors import Error, FinrayWarning, GateError, InputError, SolveError
from finray.estimation import STATUSES, Contact, Estimation, Estimator, Frame, Live, Warning, estimate
from finray.forward import Simulation, make_log, simulate
from finray.outline import Reconstruction, reconstruct
from finray.plots import plot_estimates, plot_finger, plot_outline, plot_parameters

__version__: str = _finray.version()

__all__ = [
    "STATUSES", "Calibration", "Contact", "Error", "Estimation", "Estimator", "Finger", "FinrayWarning", "Frame",
    "GateError", "InputError", "Live", "Noise", "Parameter", "Plan", "Reconstruction", "Scene", "Simulation",
    "SolveError", "Warning", "WeakDirection", "calibrate", "estimate", "make_log", "paper_finger", "plot_estimates",
    "plot_finger", "plot_outline", "plot_parameters", "reconstruct", "simulate", "versions",
]


def paper_finger() -> Finger:
    """The finger of the paper: 140 mm, five ribs, four gauges."""
    return Finger.read(_finray.resource("configs/fingers/paper_140mm.yaml"))


def versions() -> str:
    """finray and the libraries that it was built with, one a line."""
    return str(_finray.versions())
