"""From logs to a calibrated finger."""

from __future__ import annotations

from dataclasses import dataclass, field
import os
from typing import Any, List, NamedTuple, Sequence, Union
import warnings as python_warnings

import numpy as np

from finray import _finray
from finray.description import Finger, Path, Plan
from finray.errors import Error, FinrayWarning
from finray.estimation import Warning, tell
from finray.tables import Columns, Floats, Log, columns_of, is_path, table_of


class Parameter(NamedTuple):
    """A parameter, as in calibration.yaml. `status` is estimated, prior_dominated, unidentifiable or fixed."""

    name: str
    unit: str
    initial: float
    value: float
    std: float
    prior_std: float | None
    status: str


class Noise(NamedTuple):
    """Residuals of one kind of measurement."""

    family: str
    residuals: int
    dof: float
    chi2: float


class WeakDirection(NamedTuple):
    """A combination of parameters that the data determine badly."""

    words: str
    how_far: str
    remedy: str


@dataclass
class Calibration:
    """The result of a calibration. Only a `verdict` of "good" may be used without a thought."""

    finger: Finger
    plan: Plan
    #: good, doubtful, unidentifiable, unexplained, starts_disagree or not_converged.
    verdict: str
    #: Why the result is doubtful, the likeliest cause first.
    doubts: List[str]
    warnings: List[Warning]
    converged: bool
    iterations: int
    parameters: List[Parameter]
    #: Names of the free parameters, in the order of `covariance`.
    free_names: List[str]
    #: Covariance of the free parameters, in the square of their units.
    covariance: Floats
    noise: List[Noise]
    weak_directions: List[WeakDirection]
    #: Force from the gauges alone against the reference, rms over fitted and held-out frames; None if not known.
    force_rms_before_N: float | None
    force_rms_after_N: float | None
    force_rms_held_out_N: float | None
    #: What to record next, in words.
    next: str
    #: A row for each frame, as in calibration.frames.csv.
    frames: Columns
    #: The text of calibration.yaml.
    yaml: str
    _inside: Any = field(default=None, repr=False, compare=False)

    def __getitem__(self, name: str) -> Parameter:
        """The parameter of a name."""
        for parameter in self.parameters:
            if parameter.name == name:
                return parameter
        raise KeyError(name)

    def write(self, out_dir: Path, report: bool = True) -> None:
        """Writes finger.yaml, calibration.yaml, the tables beside it and report.html, as finray_calibrate does."""
        if self._inside is None:
            raise Error("a calibration that was pickled has no frames left to write; write it first")
        problem = self._inside.write(os.fspath(out_dir), report)
        if problem:
            python_warnings.warn(f"no report.html; {problem}", FinrayWarning, stacklevel=2)

    def __getstate__(self) -> dict[str, Any]:
        return {**self.__dict__, "_inside": None}


def calibrate(finger: Finger, plan: Plan, logs: Union[Log, Sequence[Log]], *, tolerance_std: float = 0.01,
              leave_one_log_out: bool = True, explore: bool = False, threads: int = 0, scheme: str = "taylor",
              resolution: int = 0) -> Calibration:
    """Calibrates a finger from logs, as finray_calibrate does. Logs are all paths, or all tables in memory.

    A verdict other than "good", and each warning of the result, are told as FinrayWarning.

    A simulated finger whose front beam is softer than its drawing says, pressed at 20 places:

    >>> import finray, numpy, warnings
    >>> def finger(front_N_mm2):
    ...     return finray.Finger(
    ...         geometry={"front_length_mm": 140, "back_angle_deg": 112},
    ...         beams={"front": {"bending_stiffness_N_mm2": front_N_mm2}, "back": {"bending_stiffness_N_mm2": 12500}},
    ...         ribs=[{"front_mm": 17 + 22 * i, "angle_deg": 10 + 3 * i} for i in range(5)],
    ...         gauges=[{"beam": "back", "start_mm": mm, "length_mm": 18, "noise_V": 3e-4} for mm in (30, 53, 76, 98)])
    >>> hidden = finger(11000)
    >>> touched = finray.simulate(hidden, {"contact_1_mm": numpy.linspace(30, 110, 20), "normal_1_N": numpy.linspace(2, 6, 20)})
    >>> plan = finray.Plan(scene={"contacts": 1}, parameters={"front_stiffness": {"prior_std_percent": 50}},
    ...                    measurements={"force_std_N": 0.02, "contact_std_mm": 0.3})
    >>> with warnings.catch_warnings():  # that a log of its own should be held out
    ...     warnings.simplefilter("ignore", finray.FinrayWarning)
    ...     found = finray.calibrate(finger(12500), plan, finray.make_log(hidden, touched))
    >>> front = found["front_stiffness_N_mm2"]
    >>> front.status, abs(front.value - 11000) < 4 * front.std < 400
    ('estimated', True)
    """
    all_logs = list(logs) if isinstance(logs, (list, tuple)) else [logs]
    given: list[Any] = ([os.fspath(log) for log in all_logs] if all(is_path(log) for log in all_logs)
                        else [table_of(log) for log in all_logs])
    inside = _finray.calibrate(finger._inside, plan._inside, given, tolerance_std, leave_one_log_out, explore, threads,
                               scheme, resolution)
    names = inside.free_names
    before, after, held_out = inside.force_rms_N
    result = Calibration(
        finger=Finger._of(inside.finger), plan=Plan._of(inside.plan), verdict=inside.verdict, doubts=inside.doubts,
        warnings=[Warning(*warning) for warning in inside.warnings], converged=inside.converged,
        iterations=inside.iterations, parameters=[Parameter(*parameter) for parameter in inside.parameters],
        free_names=names, covariance=np.array(inside.covariance).reshape(len(names), len(names)),
        noise=[Noise(*noise) for noise in inside.noise],
        weak_directions=[WeakDirection(*weak) for weak in inside.weak_directions], force_rms_before_N=before,
        force_rms_after_N=after, force_rms_held_out_N=held_out, next=inside.next, frames=columns_of(inside.frames()),
        yaml=inside.to_yaml(), _inside=inside)
    if result.verdict != "good":
        python_warnings.warn(f"verdict: {result.verdict}", FinrayWarning, stacklevel=2)
    tell(result.warnings)
    return result
