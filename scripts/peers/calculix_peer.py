"""CalculiX: both beams as thin plane solids (CPS8R) with large displacements, ribs
and the tip cap as stiff springs. It knows no follower loads, so the contact force
is given the direction that it has in equilibrium. Forward only.

Solids also have shear and stretch; they are thin, so both are small.
"""

import math
import re
import shutil
import subprocess
import time

from run import NotInstalled

THICKNESS_MM, WIDTH_MM = 0.2, 10.0
RIB_N_PER_MM, CAP_N_PER_MM = 1e6, 1e8


class Deck:
    """The input of one load case."""

    def __init__(self, finger, step_mm):
        self.nodes, self.elements, self.springs = [], {"front": [], "back": []}, []
        self.line = {"front": {}, "back": {}}  # arc length: (below, middle, above)
        length = finger["front_length_mm"]
        phi = finger["back_angle_rad"]
        self.shape = {
            "front": ((0.0, 0.0), math.pi / 2, length),
            "back": ((-length / math.tan(phi), 0.0), phi, length / math.sin(phi))}
        self.step_mm = step_mm

    def node(self, x, y):
        self.nodes.append((x, y))
        return len(self.nodes)

    def point(self, side, s, across):
        (x, y), angle, _ = self.shape[side]
        c, sine = math.cos(angle), math.sin(angle)
        return x + s * c - across * sine, y + s * sine + across * c

    def beam(self, side, stations, tip=None):
        """Elements between stations; `tip`: the node of the other beam's end."""
        length = self.shape[side][2]
        fixed = sorted({0.0, length, *(round(s, 9) for s in stations)})
        arcs = [0.0]
        for a, b in zip(fixed[:-1], fixed[1:]):
            pieces = max(1, math.ceil((b - a) / self.step_mm))
            arcs += [a + (b - a) * k / pieces for k in range(1, pieces + 1)]
        half = THICKNESS_MM / 2
        before = None
        for s in arcs:
            middle = tip if tip and s == arcs[-1] else self.node(*self.point(side, s, 0))
            here = (self.node(*self.point(side, s, -half)), middle,
                    self.node(*self.point(side, s, half)))
            self.line[side][s] = here
            if before is not None:
                m = (s + last) / 2
                low = self.node(*self.point(side, m, -half))
                high = self.node(*self.point(side, m, half))
                self.elements[side].append((before[0], here[0], here[2], before[2],
                                            low, here[1], high, before[1]))
            before, last = here, s

    def at(self, side, s):
        return self.line[side][min(self.line[side], key=lambda other: abs(other - s))]

    def text(self, finger, force):
        lines = ["*NODE, NSET=ALL"]
        lines += [f"{i + 1},{x:.12g},{y:.12g},0" for i, (x, y) in enumerate(self.nodes)]
        number = 0
        for side, elements in self.elements.items():
            lines.append(f"*ELEMENT, TYPE=CPS8R, ELSET={side.upper()}")
            for nodes in elements:
                number += 1
                lines.append(",".join(map(str, (number, *nodes))))
            modulus = 12 * finger[f"{side}_stiffness_N_mm2"] / (WIDTH_MM * THICKNESS_MM**3)
            lines += [f"*MATERIAL, NAME=M{side}", "*ELASTIC", f"{modulus:.12g},0.",
                      f"*SOLID SECTION, ELSET={side.upper()}, MATERIAL=M{side}", f"{WIDTH_MM}"]
        for k, (a, b, stiffness) in enumerate(self.springs):
            number += 1
            lines += [f"*ELEMENT, TYPE=SPRINGA, ELSET=S{k}", f"{number},{a},{b}",
                      f"*SPRING, ELSET=S{k}", "", f"{stiffness:.1f},0.,"]
        clamped = [n for side in ("front", "back") for n in self.at(side, 0)]
        lines.append("*BOUNDARY")
        lines += [f"{n},1,2" for n in clamped]
        lines += ["*STEP, NLGEOM, INC=200", "*STATIC", "0.25,1.", "*CLOAD"]
        node, fx, fy = force
        lines += [f"{node},1,{fx:.12g}", f"{node},2,{fy:.12g}",
                  "*NODE PRINT, NSET=ALL, FREQUENCY=1000", "U", "*END STEP", ""]
        return "\n".join(lines)


def make_deck(finger, frame, step_mm):
    deck = Deck(finger, step_mm)
    stations = {"front": [frame["contact_mm"]], "back": []}
    for rib in finger["ribs"]:
        stations["front"].append(rib["front_mm"])
        stations["back"].append(rib["back_mm"])
    for gauge in finger["gauges"]:
        stations[gauge["beam"]] += [gauge["start_mm"], gauge["start_mm"] + gauge["length_mm"]]
    deck.beam("front", stations["front"])
    front_end = deck.at("front", deck.shape["front"][2])
    deck.beam("back", stations["back"], tip=front_end[1])
    back_end = deck.at("back", deck.shape["back"][2])
    for k in (0, 2):
        deck.springs.append((front_end[k], back_end[k], CAP_N_PER_MM))
    for rib in finger["ribs"]:
        deck.springs.append((deck.at("front", rib["front_mm"])[1],
                             deck.at("back", rib["back_mm"])[1], RIB_N_PER_MM))
    return deck


def displacements(path, count):
    found = {}
    for line in path.read_text("utf-8").splitlines():
        words = re.findall(r"[-+0-9.Ee]+", line)
        if len(words) == 4 and words[0].isdigit() and int(words[0]) <= count:
            found[int(words[0])] = (float(words[1]), float(words[2]))
    return found


def solve(finger, frame, step_mm, folder):
    deck = make_deck(finger, frame, step_mm)
    theta = frame["contact_angle_rad"]
    force = frame["normal_N"]
    mu = frame["friction"]
    push = (force * (math.sin(theta) + mu * math.cos(theta)),
            force * (-math.cos(theta) + mu * math.sin(theta)))
    loaded = deck.at("front", frame["contact_mm"])[1]
    (folder / "case.inp").write_text(deck.text(finger, (loaded, *push)), "utf-8")
    (folder / "case.dat").unlink(missing_ok=True)
    begin = time.perf_counter()
    ended = subprocess.run(["ccx", "case"], cwd=folder, capture_output=True, text=True, check=False)
    spent = time.perf_counter() - begin
    moved = displacements(folder / "case.dat", len(deck.nodes)) if ended.returncode == 0 else {}
    if len(moved) < len(deck.nodes):
        return {"solved": False}, spent, deck

    def place(node):
        return [deck.nodes[node - 1][i] + moved[node][i] for i in (0, 1)]

    def turn(side, s):
        below, _, above = deck.at(side, s)
        x, y = (a - b for a, b in zip(place(above), place(below)))
        x0, y0 = (a - b for a, b in zip(deck.nodes[above - 1], deck.nodes[below - 1]))
        return math.atan2(x0 * y - y0 * x, x0 * x + y0 * y)

    tip = place(deck.at("front", deck.shape["front"][2])[1])
    gauges = [turn(g["beam"], g["start_mm"] + g["length_mm"]) - turn(g["beam"], g["start_mm"])
              for g in finger["gauges"]]
    iterations = len(re.findall(r"^ iteration ", ended.stdout, flags=re.M))
    return {"solved": True, "contact_mm": frame["contact_mm"], "normal_N": force,
            "gauges_rad": gauges, "tip_x_mm": tip[0], "tip_y_mm": tip[1],
            "iterations": iterations}, spent, deck


def run(job, folder):
    if shutil.which("ccx") is None:
        raise NotInstalled("calculix-ccx is not installed")
    version = subprocess.run(["ccx", "-v"], capture_output=True, text=True, check=False).stdout
    version = "CalculiX " + version.split()[-1] if version.split() else "CalculiX"
    finger = job["finger"]
    nominal = make_deck(finger, job["scenes"][0]["frames"][0], 5)
    for rib, (a, b, _) in zip(finger["ribs"], nominal.springs[2:]):
        if abs(math.dist(nominal.nodes[a - 1], nominal.nodes[b - 1]) - rib["length_mm"]) > 1e-6:
            return {"version": version, "settings": [],
                    "skipped": "ribs under prestress are not set up for it"}
    settings = []
    for step_mm in (2.0,) if job["quick"] else (2.0, 1.0):
        for scene in job["scenes"]:
            answers, spent = [], 0
            for frame in scene["frames"]:
                answer, seconds, deck = solve(finger, frame, step_mm, folder)
                answers.append(answer)
                spent += seconds
            elements = sum(map(len, deck.elements.values()))
            settings.append({
                "task": "forward", "scene": scene["scene"], "solver": f"calculix{elements}",
                "words": f"CalculiX, plane solids of {step_mm:g} mm, a run a frame",
                "links": 0, "unknowns": 2 * len(deck.nodes), "answers": answers,
                "time_us": [1e6 * spent / len(scene["frames"])]})
    return {"version": version, "settings": settings}
