"""What is described by a YAML: the finger, the scene, the plan of a calibration."""

from __future__ import annotations

import json
import os
from typing import Any, Mapping, Sequence, Type, TypeVar, Union

from finray import _finray

Path = Union[str, "os.PathLike[str]"]
Keys = Mapping[str, Any]
Described = TypeVar("Described", bound="Description")


def yaml_of(keys: Mapping[str, Any]) -> str:
    """JSON is YAML. A top-level key a line, so that messages name a line."""
    lines = [f"{json.dumps(key)}: {json.dumps(value)}" for key, value in keys.items() if value is not None]
    return "{" + ",\n ".join(lines) + "}\n"


class Description:
    """A text that reads back as the same object: pickled, compared and written by it."""

    _inside: Any
    _kind: Any

    @classmethod
    def _of(cls: Type[Described], inside: Any) -> Described:
        self = cls.__new__(cls)
        self._inside = inside
        return self

    @classmethod
    def read(cls: Type[Described], path: Path) -> Described:
        """Reads a YAML file. Raises InputError with file, line and column."""
        return cls._of(cls._kind.read(os.fspath(path)))

    @classmethod
    def from_yaml(cls: Type[Described], text: str, name: str = "text") -> Described:
        """The same of a text; `name` stands for the path in messages."""
        return cls._of(cls._kind.from_yaml(text, name))

    def to_yaml(self) -> str:
        """The YAML text, which reads back as the same."""
        text: str = self._inside.to_yaml()
        return text

    @property
    def path(self) -> str:
        """The path that it was read from, or the name of its text."""
        path: str = self._inside.path
        return path

    def __eq__(self, other: object) -> bool:
        return type(other) is type(self) and isinstance(other, Description) and other.to_yaml() == self.to_yaml()

    def __hash__(self) -> int:
        return hash(self.to_yaml())

    def __reduce__(self) -> tuple[Any, ...]:
        return (_restored, (type(self), self.to_yaml(), self.path))


def _restored(cls: Type[Described], text: str, name: str) -> Described:
    return cls.from_yaml(text, name)


class Finger(Description):
    """A Fin-Ray finger, from the keys of a finger YAML (docs/reference/formats.md).

    >>> import finray
    >>> finger = finray.Finger(
    ...     name="mine",
    ...     geometry={"front_length_mm": 140, "back_angle_deg": 112},
    ...     beams={"front": {"bending_stiffness_N_mm2": 12500}, "back": {"bending_stiffness_N_mm2": 12500}},
    ...     ribs=[{"front_mm": 17, "angle_deg": 10}, {"front_mm": 42, "angle_deg": 10}],
    ...     gauges=[{"beam": "back", "start_mm": 30, "length_mm": 18}])
    >>> finger
    Finger('mine', 2 ribs, 1 gauges)
    >>> finray.Finger(geometry={"front_lenght_mm": 140, "back_angle_deg": 112}, beams={})
    Traceback (most recent call last):
    finray.errors.InputError: finger:3:15: unknown key 'front_lenght_mm' in geometry (did you mean 'front_length_mm'?)
    """

    _kind = _finray.Finger

    def __init__(self, *, geometry: Keys, beams: Keys, ribs: Sequence[Keys] = (), gauges: Sequence[Keys] = (),
                 name: str = "finger", calibration: Keys | None = None) -> None:
        keys = {"schema_version": 1, "name": name, "geometry": dict(geometry), "beams": dict(beams),
                "ribs": [dict(rib) for rib in ribs], "gauges": [dict(gauge) for gauge in gauges],
                "calibration": calibration}
        self._inside = _finray.Finger.from_yaml(yaml_of(keys), "finger")

    @property
    def name(self) -> str:
        return str(self._inside.name)

    @property
    def front_length_mm(self) -> float:
        return float(self._inside.front_length_mm)

    @property
    def back_angle_rad(self) -> float:
        """Direction of the back beam, from +x."""
        return float(self._inside.back_angle_rad)

    @property
    def front_stiffness_N_mm2(self) -> float:
        return float(self._inside.front_stiffness_N_mm2)

    @property
    def back_stiffness_N_mm2(self) -> float:
        return float(self._inside.back_stiffness_N_mm2)

    @property
    def ribs(self) -> int:
        """The number of ribs."""
        return int(self._inside.ribs)

    @property
    def gauges(self) -> int:
        """The number of gauges."""
        return int(self._inside.gauges)

    @property
    def calibrated(self) -> bool:
        """The finger carries the covariance of a calibration."""
        return bool(self._inside.calibrated)

    def gauge_angle_rad(self, gauge: int, volts: float) -> float:
        """The bending angle of a gauge, counted from 0, at a reading."""
        return float(self._inside.gauge_angle_rad(gauge, volts))

    def gauge_volts(self, gauge: int, angle_rad: float) -> float:
        """The reading of a gauge, counted from 0, at a bending angle."""
        return float(self._inside.gauge_volts(gauge, angle_rad))

    def write(self, path: Path) -> None:
        """Writes a finger YAML."""
        self._inside.write(os.fspath(path))

    def __repr__(self) -> str:
        return f"Finger({self.name!r}, {self.ribs} ribs, {self.gauges} gauges)"


class Scene(Description):
    """What an experiment contains, from the keys of a scene YAML.

    >>> import finray
    >>> finray.Scene(contacts=1, friction_coefficient=0.3).to_yaml()
    '{"contacts": 1,\\n "friction_coefficient": 0.3}\\n'
    """

    _kind = _finray.Scene

    def __init__(self, **keys: Any) -> None:
        self._inside = _finray.Scene.from_yaml(yaml_of(keys or {"contacts": "auto"}), "scene")

    def __repr__(self) -> str:
        return f"Scene.from_yaml({self.to_yaml()!r})"


class Plan(Description):
    """What to calibrate and from which measurements, from the keys of a plan YAML."""

    _kind = _finray.Plan

    def __init__(self, **keys: Any) -> None:
        self._inside = _finray.Plan.from_yaml(yaml_of({"schema_version": 1, **keys}), "plan")

    def __repr__(self) -> str:
        return f"Plan.from_yaml({self.to_yaml()!r})"
