"""The finger that CalculiX bends: plant.yaml, lengths in mm.

    geometry: {front_length_mm: 140, back_angle_deg: 112}
    beams: {front: {width_mm: 20, thickness_mm: 0.5, youngs_modulus_GPa: 60}, back: {...}}
    poisson_ratio: 0.3
    ribs:   [{front_mm: 17, back_mm: 24}]         # rigid on hinges
         or [{front_mm: 17, back_mm: 24, thickness_mm: 0.8}]   # one piece with the beams
    gauges: [{beam: back, start_mm: 30, length_mm: 18, gain_V_per_rad: 1, offset_V: 0, noise_V: 0.0003}]
"""

import dataclasses
import math
import pathlib

import yaml


@dataclasses.dataclass
class Rib:
    front_mm: float
    back_mm: float
    thickness_mm: float


@dataclasses.dataclass
class Gauge:
    beam: str
    start_mm: float
    length_mm: float
    gain_V_per_rad: float = 1.0
    offset_V: float = 0.0
    noise_V: float = 0.0003


class Plant:
    def __init__(self, text):
        length = text["geometry"]["front_length_mm"]
        phi = math.radians(text["geometry"]["back_angle_deg"])
        self.front_length_mm = length
        self.base = {"front": (0.0, 0.0), "back": (-length / math.tan(phi), 0.0)}
        self.angle = {"front": math.pi / 2, "back": phi}
        beams = text["beams"]
        self.width_mm = beams["front"]["width_mm"]
        self.thickness = {side: beams[side]["thickness_mm"] for side in beams}
        self.modulus = {side: 1000.0 * beams[side]["youngs_modulus_GPa"] for side in beams}  # N/mm^2
        self.poisson = text["poisson_ratio"]
        self.ribs = [Rib(rib["front_mm"], self._back_mm(rib), rib.get("thickness_mm", 0)) for rib in text["ribs"]]
        self.gauges = [Gauge(**gauge) for gauge in text["gauges"]]

    def _back_mm(self, rib):
        if "back_mm" in rib:
            return rib["back_mm"]
        # Where a line from (0, front_mm) at angle_deg meets the back beam.
        alpha, phi = math.radians(rib["angle_deg"]), self.angle["back"]
        x = self.base["back"][0]
        span = (x * math.sin(phi) + rib["front_mm"] * math.cos(phi)) / math.sin(phi - alpha)
        return (rib["front_mm"] + span * math.sin(alpha)) / math.sin(phi)

    def stiffness(self, side):
        """EI in N mm^2 of a strip too wide to curve across its width (plane strain)."""
        return self.modulus[side] * self.width_mm * self.thickness[side] ** 3 / (12 * (1 - self.poisson**2))


def read(path):
    return Plant(yaml.safe_load(pathlib.Path(path).read_text("utf-8")))
