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

STIFF = 1e4  # of what does not bend, relative
RIGID_SHARE = 0.7  # of the way into a joint of solids, where it agrees best with CalculiX


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

    def section(self, side, thickness):
        """EA in N and EI in N mm^2 of a strip too wide to curve across its width (plane strain)."""
        modulus = self.modulus[side] / (1 - self.poisson**2)
        return modulus * self.width_mm * thickness, modulus * self.width_mm * thickness**3 / 12

    def stiffness(self, side):
        return self.section(side, self.thickness[side])[1]

    def rib_section(self, rib):
        """Ribs are of the front beam's material, as all is one piece."""
        return self.section("front", rib.thickness_mm)

    def rigid_ends(self, rib, share):
        """The rib's lengths in front and behind from the neutral line to `share` of the way
        to the inner surface. A joint of solids is stiff within the beam."""
        (x0, y0), (x1, y1) = (self.point(side, s) for side, s in (("front", rib.front_mm), ("back", rib.back_mm)))
        length = math.dist((x0, y0), (x1, y1))
        c, s = (x1 - x0) / length, (y1 - y0) / length
        return [share * self.thickness[side] / 2 / abs(c * math.sin(self.angle[side]) - s * math.cos(self.angle[side]))
                for side in ("front", "back")]

    def point(self, side, s):
        (x, y), angle = self.base[side], self.angle[side]
        return x + s * math.cos(angle), y + s * math.sin(angle)

    def rigid_tip(self, share):
        """So much of either beam at the tip is within `share` of the solid that joins them, which
        begins where the inner surfaces meet."""
        front, back = (self.thickness[side] / 2 for side in ("front", "back"))
        wedge = self.angle["back"] - self.angle["front"]
        return {"front": share * (front * math.cos(wedge) + back) / math.sin(wedge),
                "back": share * (front + back * math.cos(wedge)) / math.sin(wedge)}

    def one_piece(self, share):
        """Beams and ribs of finger.yaml: ribs bend, all stretches, contacts act on the surface, and of
        a joint's solid the first `share` does not bend."""
        beams, tip = {}, self.rigid_tip(share)
        for side, thickness in self.thickness.items():
            axial, bending = self.section(side, thickness)
            length = self.front_length_mm / math.sin(self.angle[side])
            beams[side] = {"axial_stiffness_N": axial, "pieces": [{"bending_stiffness_N_mm2": bending}]}
            if share:
                beams[side]["pieces"] = [{"end_mm": length - tip[side], "bending_stiffness_N_mm2": bending},
                                         {"bending_stiffness_N_mm2": STIFF * bending}]
        beams["front"]["surface_offset_mm"] = self.thickness["front"] / 2
        ribs = []
        for rib in self.ribs:
            axial, bending = self.rib_section(rib)
            ribs.append({"front_mm": rib.front_mm, "back_mm": rib.back_mm, "axial_stiffness_N": axial,
                         "bending_stiffness_N_mm2": bending, "rigid_ends_mm": self.rigid_ends(rib, share)})
        return {"beams": beams, "ribs": ribs}


def read(path):
    return Plant(yaml.safe_load(pathlib.Path(path).read_text("utf-8")))
