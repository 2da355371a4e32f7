"""From gauges to contacts: whole logs, and live."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Iterator, List, Mapping, NamedTuple, Sequence, Union
import warnings

import numpy as np
import numpy.typing as npt

from finray import _finray
from finray.description import Finger, Scene
from finray.errors import FinrayWarning
from finray.tables import Columns, Floats, Log, columns_of, data_frame, floats_of, table_of

#: By number, as the library counts them.
STATUSES = np.array(["ok", "no_contact", "unobservable", "not_converged", "bad_input"])


class Warning(NamedTuple):
    """A fact that the user should know, and what to do about it."""

    code: str
    text: str
    remedy: str


def tell(found: Sequence[Warning], stacklevel: int = 3) -> None:
    """Tells the warnings of a result, as the command line prints them."""
    for code, text, remedy in found:
        warnings.warn(f"{code}: {text}; {remedy}", FinrayWarning, stacklevel=stacklevel)


@dataclass
class Estimation(Mapping[str, Any]):
    """The estimates of a log: a mapping from the names of the computed columns to arrays, `status` among them."""

    #: The computed columns, as finray_estimate writes them.
    columns: Columns
    #: The status of each frame by number: STATUSES[codes] are the words.
    codes: npt.NDArray[np.uint8]
    #: Counts over the frames, and force errors where the log has a force_N.
    summary: Mapping[str, Any]
    warnings: List[Warning]

    @property
    def status(self) -> npt.NDArray[np.str_]:
        """ok, no_contact, unobservable, not_converged or bad_input, by frame."""
        return STATUSES[self.codes]

    def __getitem__(self, name: str) -> Any:
        return self.status if name == "status" else self.columns[name]

    def __iter__(self) -> Iterator[str]:
        yield from self.columns
        yield "status"

    def __len__(self) -> int:
        return len(self.columns) + 1

    def to_dataframe(self, log: Log | None = None) -> Any:
        """A pandas.DataFrame; with the log, its columns come first, as finray_estimate writes them."""
        columns: dict[str, Any] = columns_of(table_of(log).to_dict()) if log is not None else {}
        return data_frame({**columns, **self})


class Estimator:
    """Estimates the contacts in all frames of logs. Making one takes some milliseconds; use it for many logs.

    The numbers are those of finray_estimate, bit by bit, and do not depend on `threads` (0: all cores). Other Python
    threads run meanwhile.
    """

    def __init__(self, finger: Finger, scene: Scene | None = None, *, solver: str = "fast",
                 equilibrium: str = "reduced", joint: bool = False, threads: int = 0, scheme: str = "taylor",
                 resolution: int = 0) -> None:
        self._scene = scene or Scene()
        self._inside = _finray.Estimator(finger._inside, self._scene._inside, solver, equilibrium, joint, threads,
                                         scheme, resolution)

    def estimate(self, log: Log) -> Estimation:
        """Estimates all rows of a log, which has a column gauge_<j>_V (or gauge_<j>_rad) for each gauge."""
        columns, codes, summary, found = self._inside.estimate(table_of(log, self._scene))
        result = Estimation(columns_of(columns), np.frombuffer(codes, dtype=np.uint8), summary,
                            [Warning(*warning) for warning in found])
        tell(result.warnings)
        return result


def estimate(finger: Finger, log: Log, scene: Scene | None = None, *, solver: str = "fast",
             equilibrium: str = "reduced", joint: bool = False, threads: int = 0, scheme: str = "taylor",
             resolution: int = 0) -> Estimation:
    """Estimates the contact in every frame of a log, as finray_estimate does.

    >>> import finray, warnings
    >>> finger = finray.paper_finger()
    >>> log = finray.simulate(finger, {"contact_1_mm": [40.0, 70.0], "normal_1_N": [1.0, 2.0]})
    >>> with warnings.catch_warnings():  # the finger is not calibrated
    ...     warnings.simplefilter("ignore", finray.FinrayWarning)
    ...     found = finray.estimate(finger, {name: log[name] for name in log if name.startswith("gauge")})
    >>> found.status.tolist(), found["contact_1_mm"].round(3).tolist(), found["normal_1_N"].round(3).tolist()
    (['ok', 'ok'], [40.0, 70.0], [1.0, 2.0])
    """
    return Estimator(finger, scene, solver=solver, equilibrium=equilibrium, joint=joint, threads=threads,
                     scheme=scheme, resolution=resolution).estimate(log)


class Contact(NamedTuple):
    """One contact of a live frame."""

    arc_mm: float  #: l_c, from the base of the front beam
    arc_std_mm: float
    normal_N: float  #: f_c
    normal_std_N: float
    x_mm: float
    y_mm: float
    angle_rad: float
    arc_low_mm: float
    arc_high_mm: float
    normal_low_N: float
    normal_high_N: float


class Frame(NamedTuple):
    """The estimate of one live frame."""

    status: str
    contacts: List[Contact]
    chi2: float
    chi2_p_value: float
    tip_x_mm: float
    tip_y_mm: float
    tip_angle_rad: float
    iterations: int
    search_ended: bool
    ribs_N: List[float]


class Live:
    """Estimates frames as they arrive, as finray_estimate --follow does.

    >>> import finray
    >>> finger = finray.paper_finger()
    >>> seen = finray.simulate(finger, {"contact_1_mm": [70.0], "normal_1_N": [2.0]})
    >>> live = finray.Live(finger, finray.Scene(contacts=1))
    >>> frame = live.next([seen[f"gauge_{j}_V"][0] for j in (1, 2, 3, 4)])
    >>> frame.status, round(frame.contacts[0].arc_mm, 3), round(frame.contacts[0].normal_N, 3)
    ('ok', 70.0, 2.0)
    """

    def __init__(self, finger: Finger, scene: Scene | None = None, *, solver: str = "fast",
                 equilibrium: str = "reduced", scheme: str = "taylor", resolution: int = 0) -> None:
        self._inside = _finray.LiveEstimator(finger._inside, (scene or Scene())._inside, solver, equilibrium, scheme,
                                             resolution)

    def next(self, gauges_V: Union[Sequence[float], Floats], time_s: float = float("nan"), *,
             object_x_mm: float = float("nan"), object_y_mm: float = float("nan"),
             object_angle_deg: float = 0.0) -> Frame:
        """Estimates the next frame. A NaN means not measured; a gauge that creeps needs time_s."""
        status, contacts, *rest = self._inside.next(floats_of("gauges_V", gauges_V).tolist(), time_s, object_x_mm,
                                                    object_y_mm, object_angle_deg)
        return Frame(status, [Contact(*contact) for contact in contacts], *rest)

    def restart(self) -> None:
        """The next frame begins a new log."""
        self._inside.restart()
