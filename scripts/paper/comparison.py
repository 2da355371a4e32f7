"""A figure of the paper beside ours, and a section of the report."""

import dataclasses
import math

BEATS, EQUALS, WORSE, DIFFERS = "beats", "same", "does not beat", "differs"


def worst(items, key=lambda number: number):
    """The item of the largest key, or one whose key is NaN if there is any. Python's
    max() would pass it over: max([0.1, nan]) is 0.1."""
    return max(items, key=lambda item: (math.isnan(key(item)), key(item)))


@dataclasses.dataclass(frozen=True)
class Comparison:
    """Errors: the smaller one is better.

    `why` is printed where ours is not smaller; a comparison without it could not
    be honest, so that it has no default.
    """
    what: str
    source: str  # figure and section of the paper
    unit: str
    paper: float
    ours: float
    conditions: str
    why: str
    preview: bool = False  # the controller knows the set-point beforehand
    limit: bool = False  # the paper gives an upper limit only
    structural: float | None = None  # ours with a plant of structural errors; None: not repeated

    @property
    def verdict(self):
        return BEATS if self.ours < self.paper else WORSE  # NaN does not beat

    @property
    def beats(self):
        return self.verdict == BEATS

    @property
    def structural_verdict(self):
        return None if self.structural is None else BEATS if self.structural < self.paper else WORSE

    @property
    def paper_text(self):
        number = f"{self.paper:g}" if self.paper == round(self.paper) else f"{self.paper:.2f}"
        return f"{'below ' if self.limit else ''}{number} {self.unit}"

    @property
    def ours_text(self):
        return self._text(self.ours)

    @property
    def structural_text(self):
        return "" if self.structural is None else self._text(self.structural)

    def _text(self, error):
        if math.isnan(error):
            return "none"
        places = 3 if abs(error) < 1 else 2 if abs(error) < 10 else 1
        return f"{error:.{places}f} {self.unit}"


@dataclasses.dataclass(frozen=True)
class Finding:
    """A finding of the paper that has no number to beat."""
    what: str
    source: str
    paper: str
    ours: str
    conditions: str
    agrees: bool
    why: str

    @property
    def verdict(self):
        return EQUALS if self.agrees else DIFFERS


@dataclasses.dataclass
class Section:
    title: str
    sentence: str
    rows: list  # of Comparison and Finding
    plots: list = dataclasses.field(default_factory=list)  # (SVG, caption)
    tables: list = dataclasses.field(default_factory=list)  # (title, header, rows, note)


def count(number, word):
    return f"{number:g} {word}" + ("" if number == 1 else "s")


def model_error_text(error):
    """The std of a finger's parameters, as studies and experiments write them."""
    parts = []
    if error.get("stiffness_std_percent"):
        parts.append(f"EI {error['stiffness_std_percent']:g} %")
    if error.get("gauge_gain_std_percent"):
        parts.append(f"gains {error['gauge_gain_std_percent']:g} %")
    if error.get("gauge_offset_std_V"):
        parts.append(f"offsets {1000 * error['gauge_offset_std_V']:g} mV")
    if error.get("rib_length_std_mm"):
        parts.append(f"ribs {error['rib_length_std_mm']:g} mm")
    if error.get("delay_std_ms"):
        parts.append(f"delay {error['delay_std_ms']:g} ms")
    return "model error (std) " + ", ".join(parts) if parts else "no model error"
