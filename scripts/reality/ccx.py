"""CalculiX: writes the deck of a solid, runs ccx, reads what it prints."""

import math
import re
import shutil
import subprocess

from solid import RIB_N_PER_MM


class NotInstalled(Exception):
    """ccx is missing; the message says what to install."""


class NotSolved(Exception):
    """ccx ended without an equilibrium; the message is its own."""


def version():
    if shutil.which("ccx") is None:
        raise NotInstalled("calculix-ccx is not installed: scripts/install_dependencies reality")
    words = subprocess.run(["ccx", "-v"], capture_output=True, text=True, check=False).stdout.split()
    return "CalculiX " + words[-1] if words else "CalculiX"


class Deck:
    """The lines of an input file up to its steps, and how its nodes are counted."""

    def __init__(self, solid):
        plant = solid.plant
        self.solid, self.nodes, self.lines, self.count = solid, list(solid.nodes), [], 0
        self.numbers = {}  # set -> element numbers
        for name, elements in solid.elements.items():
            if elements:
                # Ribs are of the front beam's material, as all is one piece.
                side = "back" if name == "BACK" else "front"
                self.add(name, elements, plant.modulus[side], plant.poisson, plant.width_mm)
        for k, (a, b) in enumerate(solid.springs):
            self.count += 1
            self.lines += [f"*ELEMENT, TYPE=SPRINGA, ELSET=S{k}", f"{self.count},{a},{b}",
                           f"*SPRING, ELSET=S{k}", "", f"{RIB_N_PER_MM:.1f},0.,"]
        clamped = sorted({n for side in ("front", "back")
                          if solid.columns[side] for n in solid.column(side, 0)})
        self.clamps = [f"{n},1,2" for n in clamped]

    def add(self, name, elements, modulus, poisson, width):
        # Plane strain, as a strip is far wider than thick. CalculiX's plane stress
        # (CPS8R) is a brick of the full width that cannot curve across it either.
        self.lines.append(f"*ELEMENT, TYPE=CPE8R, ELSET={name}")
        self.numbers[name] = []
        for nodes in elements:
            self.count += 1
            self.numbers[name].append(self.count)
            self.lines.append(",".join(map(str, (self.count, *nodes))))
        self.lines += [f"*MATERIAL, NAME=M{name}", "*ELASTIC", f"{modulus:.12g},{poisson:.6g}",
                       f"*SOLID SECTION, ELSET={name}, MATERIAL=M{name}", f"{width:.12g}"]

    def text(self, steps):
        head = ["*NODE, NSET=ALL"]
        head += [f"{i + 1},{x:.12g},{y:.12g},0" for i, (x, y) in enumerate(self.nodes)]
        return "\n".join(head + self.lines + ["*BOUNDARY"] + self.clamps + steps + [""])


def run(text, folder, seconds=400):
    """Runs the deck; returns [(time, {node: (ux, uy)}, contact)], one for each print.
    contact: (force x, y, torque about the origin) on the slave surface, or None."""
    (folder / "case.inp").write_text(text, "utf-8")
    (folder / "case.dat").unlink(missing_ok=True)
    ended = subprocess.run(["ccx", "case"], cwd=folder, capture_output=True, text=True, check=False,
                           timeout=seconds, env={"OMP_NUM_THREADS": "1", "PATH": "/usr/bin:/bin"})
    if ended.returncode != 0 or "*ERROR" in ended.stdout:
        found = re.findall(r"\*ERROR.*(?:\n.*)?", ended.stdout)
        raise NotSolved(" ".join(found[0].split()) if found else f"ccx ended with {ended.returncode}")
    return read((folder / "case.dat").read_text("utf-8"))


def read(text):
    prints = {}
    block = None
    for line in text.splitlines():
        time = re.search(r"time\s+([0-9.E+-]+)", line)
        if time:
            key = time[1]
            if line.strip().startswith("displacements"):
                block = prints.setdefault(key, [{}, []])[0]
            elif line.strip().startswith("statistics"):
                block = prints.setdefault(key, [{}, []])[1]
            else:
                block = None
            continue
        words = re.findall(r"[-+]?\d+\.?\d*(?:E[-+]?\d+)?", line)
        if isinstance(block, dict) and len(words) == 4:
            block[int(words[0])] = (float(words[1]), float(words[2]))
        elif isinstance(block, list) and words and not re.search(r"[a-zA-Z]{2}", line):
            block.append([float(word) for word in words])
    return [(float(key), *value) for key, value in prints.items()]
