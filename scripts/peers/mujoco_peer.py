"""MuJoCo (mujoco_peer.c): chain_model.py's links as bodies on hinges with springs,
stepped until they are at rest. Two chains from the bases; at the tip a `connect` and
equal sums of angles, each rib a tendon of a given length.

Only rest counts, so masses are free: a joint's inertia (armature) is its stiffness,
links have none to speak of. All modes then have the time constant 1. A time step T
with damping 2 + T makes each a factor 1 / (1 + T) smaller. T = 4 is enough: forces
turn with the links, of which a step knows one step late. `solref` damps constraints
as the springs are. They are soft, by up to 0.04 mm as MuJoCo's format has it; the
program hardens them, and 1e-5 mm are left. What links leave is more.
"""

import pathlib
import shutil
import subprocess

import numpy as np
from chain_model import Chain
from run import NotInstalled

STEP = 4
MOST_STEPS = 5000
STILL_RAD = {"forward": 1e-7, "sensing": 1e-9}  # sensing takes differences
MASS = 1e-8
TASKS = (("forward", False), ("forward", True), ("sensing", True))  # warm: from the frame before


def text(*numbers):
    return " ".join(f"{number:.17g}" for number in numbers)


class Bodies:
    """The chain in MuJoCo's format."""

    def __init__(self, chain):
        self.chain = chain
        self.front = chain.front_joints
        self.sites = {}  # beam and number of joints before: name and place
        for k, (before, place) in enumerate(chain.left):
            self.sites.setdefault(("front", before), []).append((f"left{k}", place))
        for k, (before, place) in enumerate(chain.right):
            self.sites.setdefault(("back", chain.n - before), []).append((f"right{k}", place))
        # A little stiffer than critical, which needs more than MuJoCo's own limit.
        decay = 1 / (1 + STEP)
        constant = 2.6 * STEP * decay**2
        self.head = f"""<mujoco>
<compiler angle="radian" boundmass="0" boundinertia="0"/>
<option timestep="{STEP}" gravity="0 0 0" solver="Newton" iterations="1" tolerance="0"
  jacobian="dense"><flag contact="disable" refsafe="disable"/></option>
<default><joint type="hinge" axis="0 0 1"/>
<equality solref="{text(constant, 0.75 * STEP * decay / constant)}" solimp="0.9999 0.9999 1"/>
</default>"""

    def beam(self, name, joints, stiffness):
        origin, lines = np.zeros(2), []
        for before in range(len(joints) + 1):
            if before > 0:
                k = stiffness[before - 1]
                lines.append(
                    f'<body name="{name}{before}" pos="{text(*joints[before - 1] - origin, 0)}">'
                    f'<inertial pos="0 0 0" mass="{MASS}" diaginertia="{text(MASS, MASS, MASS)}"/>'
                    f'<joint name="{name}{before}" stiffness="{text(k)}" armature="{text(k)}" '
                    f'damping="{text((2 + STEP) * k)}"/>')
                origin = joints[before - 1]
            lines += [f'<site name="{site}" pos="{text(*place - origin, 0)}"/>'
                      for site, place in self.sites.get((name, before), [])]
        return lines + ["</body>" * len(joints)]

    def text(self):
        chain, front, back = self.chain, self.front, self.chain.n - self.front
        lines = [self.head, "<worldbody>",
                 *self.beam("front", chain.joints[:front], chain.stiffness[:front]),
                 *self.beam("back", chain.joints[front:][::-1], chain.stiffness[front:][::-1]),
                 "</worldbody><tendon>"]
        ends, bound = list(zip(chain.left, chain.right)), []
        for k, ((_, left), (_, right)) in enumerate(ends):
            longer = chain.rib_length[k] - np.hypot(*(left - right))
            lines.append(f'<spatial name="rib{k}"><site site="left{k}"/><site site="right{k}"/>'
                         "</spatial>")
            bound.append(f'<tendon tendon1="rib{k}" polycoef="{text(longer, 0, 0, 0, 0)}"/>')
        lines += ['<fixed name="turn">',
                  *(f'<joint joint="front{i + 1}" coef="1"/>' for i in range(front)),
                  *(f'<joint joint="back{i + 1}" coef="-1"/>' for i in range(back)), "</fixed>"]
        tip = np.array([0, 1]) - chain.joints[front - 1]
        return "\n".join([*lines, "</tendon><equality>", *bound, '<tendon tendon1="turn"/>',
                          f'<connect body1="front{front}" body2="back{back}" '
                          f'anchor="{text(*tip, 0)}"/>', "</equality></mujoco>"])

    def gauges(self):
        """What gauges sum of the angles of both chains from their bases."""
        return np.hstack([self.chain.gauges[:, :self.front],
                          -self.chain.gauges[:, self.front:][:, ::-1]])

    def loads(self, task, warm, frames):
        rows = self.gauges()
        number = 2 if task == "sensing" else int(warm)
        lines = [f"{number} {self.front} {len(rows)} {len(frames)}",
                 *(text(*row) for row in rows)]
        for frame in frames:
            load = frame["contact_mm"] / self.chain.unit, frame["normal_N"] / self.chain.force
            start = frame["start_mm"] / self.chain.unit, frame["start_N"] / self.chain.force
            lines.append(text(*(start if warm else load), frame["friction"],
                              *(frame["measured_rad"] if task == "sensing" else load)))
        return "\n".join(lines)

    def answer(self, line):
        _, steps, solved, contact, force, *angles = map(float, line.split())
        theta = np.concatenate([angles[:self.front], np.negative(angles[self.front:])[::-1],
                                np.zeros(3 + len(self.chain.rib_length))])
        return self.chain.answer(theta, contact, force, steps, solved)


def compiled(folder):
    """The path of the program."""
    if shutil.which("cc") is None:
        raise NotInstalled("gcc is not installed")
    found = subprocess.run(["cc", "-E", "-"], input="#include <mujoco/mujoco.h>", text=True,
                           capture_output=True, check=False)
    if found.returncode != 0:
        raise NotInstalled("libmujoco-dev is not installed")
    program = folder / "mujoco_peer"
    subprocess.run(["cc", "-O2", pathlib.Path(__file__).with_suffix(".c"), "-o", program,
                    "-lmujoco", "-lm"], check=True)
    version = subprocess.run([program, "version"], capture_output=True, text=True, check=True)
    return program, "MuJoCo " + version.stdout.strip()


def run(job, folder):
    program, version = compiled(folder)
    settings = []
    for links in (40,) if job["quick"] else (40, 100, 160):
        chain = Chain(job["finger"], links)
        bodies = Bodies(chain)
        (folder / "chain.xml").write_text(bodies.text(), "utf-8")
        for scene in job["scenes"]:
            for task, warm in TASKS if job["finger"]["gauges"] else TASKS[:2]:
                (folder / "loads.txt").write_text(bodies.loads(task, warm, scene["frames"]))
                times = []
                for _ in range(1 if job["quick"] else 5):
                    subprocess.run([program, folder, str(MOST_STEPS), str(STILL_RAD[task])],
                                   cwd=folder, stdout=subprocess.DEVNULL, check=True)
                    lines = (folder / "angles.txt").read_text("utf-8").splitlines()
                    seconds = sum(float(line.split()[0]) for line in lines)
                    times.append(1e6 * seconds / len(lines))
                settings.append({
                    "task": task, "scene": scene["scene"],
                    "solver": f"mujoco{links}" + ("_warm" if (task, warm) == TASKS[1] else ""),
                    "words": f"MuJoCo on the paper's chain, n = {chain.n}, from the "
                             + ("frame before" if warm else "straight finger"),
                    "links": chain.n, "unknowns": chain.n + (2 if task == "sensing" else 0),
                    "answers": [bodies.answer(line) for line in lines], "time_us": times})
    return {"version": version, "settings": settings}
