"""GetFEM: both beams as one geometrically exact beam that does not stretch or shear,
by the weak form of its energy, which GetFEM differentiates.

The beam goes from the front base over the tip to the back base; t is its tangent in
the straight finger. Unknowns: displacement u, turn psi, force N inside, force p of
each rib. Stationary is

  int EI/2 psi'^2 + N . (u' - (R(psi) - 1) t) ds + sum_k p_k (|r(b_k) - r(a_k)| - d_k)

less the work of the contact's force f, which turns with the beam. u and psi are
continuous, of one order, so the tip is rigid as it is; N is discontinuous, of one
order less. Nodes are at ribs, the tip, the contact and the ends of gauges, so only
the order approximates. Newton from the straight finger.

Sensing has two more unknowns, f and how far the contact moves: elements between its
neighbours stretch by j. Gauss-Newton from the frame before, constraints linearised.
Lengths are over l_0, forces over EI / l_0^2.
"""

import subprocess
import time

import getfem
import numpy as np
from scipy.sparse import csc_matrix
from scipy.sparse.linalg import splu

TASKS = (("forward", False), ("forward", True), ("sensing", True))  # warm: from the frame before
SMALL, STEPS = 1e-6, 30
CLAMPED, TOUCHED, HINGED = 1, 2, 3  # regions of the mesh


class Beam:
    """The finger with a contact at an arc length."""

    def __init__(self, finger, order, contact, friction):
        self.unit = finger["front_length_mm"]
        self.force = finger["front_stiffness_N_mm2"] / self.unit**2
        phi = finger["back_angle_rad"]
        self.end = 1 + 1 / np.sin(phi)
        self.down = -np.array([np.cos(phi), np.sin(phi)])
        self.contact = contact
        ribs = [(rib["front_mm"] / self.unit, self.end - rib["back_mm"] / self.unit,
                 rib["length_mm"] / self.unit) for rib in finger["ribs"]]
        gauges = np.array([[g["start_mm"], g["start_mm"] + g["length_mm"]]
                           for g in finger["gauges"]]).reshape(-1, 2) / self.unit
        back = [g["beam"] == "back" for g in finger["gauges"]]
        gauges[back] = self.end - gauges[back]
        stations = {0, 1, self.end, contact, *gauges.flat, *(s for rib in ribs for s in rib[:2])}
        self.nodes = np.array(sorted({round(float(s), 9) for s in stations}))
        self.mesh = getfem.Mesh("cartesian", self.nodes)
        self.model = getfem.Model("real")
        self.integral = getfem.MeshIm(self.mesh, getfem.Integ(f"IM_GAUSS1D({2 * order})"))
        self.add_beam(order, finger["front_stiffness_N_mm2"] / finger["back_stiffness_N_mm2"])
        if ribs:
            self.add_ribs(ribs)
        self.add_contact(friction)
        psi = self.model.mesh_fem_of_variable("psi").basic_dof_nodes()[0]
        self.ends = np.array([[np.argmin(np.abs(psi - s)) for s in pair] for pair in gauges],
                             int).reshape(-1, 2)

    def at(self, s):
        return int(np.argmin(np.abs(self.nodes - s)))

    def rest(self, s):
        return np.array([0.0, s]) if s <= 1 else np.array([0, 1.0]) + (s - 1) * self.down

    def field(self, element, size=1):
        found = getfem.MeshFem(self.mesh, size)
        found.set_fem(getfem.Fem(element))
        return found

    def add_beam(self, order, soft):
        model = self.model
        model.add_fem_variable("u", self.field(f"FEM_PK(1,{order})", 2))
        model.add_fem_variable("psi", self.field(f"FEM_PK(1,{order})"))
        model.add_fem_variable("N", self.field(f"FEM_PK_DISCONTINUOUS(1,{order - 1})", 2))
        model.add_variable("moved", 1)
        constant = self.field("FEM_PK(1,0)")
        middles = constant.basic_dof_nodes()[0]
        front = middles < 1
        model.add_initialized_fem_data("EI", constant, np.where(front, 1, 1 / soft))
        model.add_initialized_fem_data(
            "t", constant, np.where(front[:, None], [0, 1], self.down).ravel())
        touched = self.at(self.contact)
        self.below, self.above = self.nodes[touched - 1], self.nodes[touched + 1]
        before = (middles > self.below) & (middles < self.contact)
        after = (middles > self.contact) & (middles < self.above)
        stretch = before / (self.contact - self.below) - after / (self.above - self.contact)
        model.add_initialized_fem_data("stretch", constant, stretch)
        model.add_macro("j", "(1 + moved*stretch)")
        model.add_nonlinear_term(
            self.integral, "EI/2*Grad_psi.Grad_psi/j + "
            "N.(Grad_u - j*[cos(psi)-1, -sin(psi); sin(psi), cos(psi)-1]*t)")
        self.mesh.set_region(CLAMPED, self.mesh.outer_faces())
        for name in ("u", "psi"):
            model.add_Dirichlet_condition_with_simplification(name, CLAMPED)

    def add_ribs(self, ribs):
        """One term for all: data at the front hinges say where the back hinges are."""
        linear = self.field("FEM_PK(1,1)")
        places = linear.basic_dof_nodes()[0]
        hinges = [int(np.argmin(np.abs(places - a))) for a, _, _ in ribs]
        ahead, across = np.zeros(len(places)), np.zeros((len(places), 2))
        length = np.zeros(len(places))
        for hinge, (a, b, distance) in zip(hinges, ribs):
            ahead[hinge], length[hinge] = self.nodes[self.at(b)] - places[hinge], distance
            across[hinge] = self.rest(b) - self.rest(a)
        for name, values in (("ahead", ahead), ("across", across), ("length", length)):
            self.model.add_initialized_fem_data(name, linear, values.ravel())
        self.model.add_fem_variable("p", getfem.MeshFem("partial", linear, hinges))
        self.model.add_interpolate_transformation_from_expression(
            "far", self.mesh, self.mesh, "X + [ahead]")
        # A node is the first face of the element before it.
        self.mesh.set_region(HINGED, [[self.at(a) - 1 for a, _, _ in ribs], [0] * len(ribs)])
        self.model.add_nonlinear_term(
            self.integral, "p*(Norm(across + Interpolate(u, far) - u) - length)", HINGED)

    def add_contact(self, friction):
        self.model.add_variable("f", 1)
        self.model.add_initialized_data("mu", friction)
        self.mesh.set_region(TOUCHED, [[self.at(self.contact) - 1], [0]])
        self.model.add_nonlinear_term(
            self.integral, "-f*[cos(psi) - mu*sin(psi); sin(psi) + mu*cos(psi)].Test_u", TOUCHED)

    def system(self):
        self.model.assembly("build_all")
        tangent = self.model.tangent_matrix()
        tangent.to_csc()
        columns, rows = tangent.csc_ind()
        return csc_matrix((tangent.csc_val(), rows, columns)), self.model.rhs()

    def step(self, change):
        """Returns whether it was so small that the next one, its square, is not needed."""
        self.model.to_variables(self.model.from_variables() + change)
        return np.abs(change).max() < SMALL

    def newton(self, force):
        """Solves from where the model is; returns steps, and whether they ended."""
        self.model.set_variable("f", force)
        for count in range(1, STEPS + 1):
            tangent, residual = self.system()
            if self.step(splu(tangent).solve(residual)):
                return count, True
        return STEPS, False

    def solve(self, force):
        """From the straight finger, and by shares of the load where that fails."""
        self.model.disable_variable("moved")
        self.model.disable_variable("f")
        total = 0
        for steps in (1, 4, 16):
            self.model.to_variables(np.zeros(self.model.nbdof()))
            solved = True
            for share in np.arange(1, steps + 1) / steps:
                count, reached = self.newton(share * force)
                total, solved = total + count, solved and reached
            if solved:
                break
        return total, solved

    def sense(self, measured):
        """Gauss-Newton from an equilibrium; returns steps, and whether they ended
        with the contact between the nodes beside it."""
        self.model.enable_variable("moved")
        self.model.enable_variable("f")
        loads = [self.model.interval_of_variable(name)[0] for name in ("moved", "f")]
        psi = self.model.interval_of_variable("psi")[0] + self.ends
        size = self.model.nbdof()
        shape = np.setdiff1d(np.arange(size), loads)
        for count in range(1, STEPS + 1):
            tangent, residual = self.system()
            right = np.column_stack([residual[shape], -tangent[shape][:, loads].toarray()])
            changes = np.zeros((size, 3))
            changes[shape] = splu(tangent[shape][:, shape]).solve(right)
            changes[loads, [1, 2]] = 1
            turns = changes[psi[:, 1]] - changes[psi[:, 0]]
            best = np.linalg.lstsq(turns[:, 1:], measured - self.readings() - turns[:, 0],
                                   rcond=None)[0]
            small = self.step(changes @ [1, *best])
            if not self.below < self.place() < self.above:
                return count, False
            if small:
                return count, True
        return STEPS, False

    def place(self):
        return self.contact + np.ravel(self.model.variable("moved"))[0]

    def load(self):
        return np.ravel(self.model.variable("f"))[0]

    def readings(self):
        psi = self.model.variable("psi")
        return psi[self.ends[:, 1]] - psi[self.ends[:, 0]]

    def answer(self, iterations, solved):
        tip = self.rest(1) + np.ravel(self.model.interpolation("u", [[1.0]], self.mesh))
        return {"solved": bool(solved), "contact_mm": float(self.place() * self.unit),
                "normal_N": float(self.load() * self.force),
                "gauges_rad": self.readings().tolist(),
                "tip_x_mm": float(tip[0] * self.unit), "tip_y_mm": float(tip[1] * self.unit),
                "iterations": int(iterations)}


def measure(finger, order, task, warm, frames):
    """Answers, and seconds by the clock."""
    answers, spent = [], 0
    unit = finger["front_length_mm"]
    unit_force = finger["front_stiffness_N_mm2"] / unit**2
    for frame in frames:
        begin = time.perf_counter()
        place, force = ("start_mm", "start_N") if warm else ("contact_mm", "normal_N")
        beam = Beam(finger, order, frame[place] / unit, frame["friction"])
        count, solved = beam.solve(frame[force] / unit_force)
        if warm:
            begin = time.perf_counter()
        if task == "sensing":
            measured = np.array(frame["measured_rad"])
            count, solved = beam.sense(measured)
            if not solved and 0 < beam.place() < 1:  # again with nodes around where it went
                force = beam.load()
                beam = Beam(finger, order, beam.place(), frame["friction"])
                count += beam.solve(force)[0]
                more, solved = beam.sense(measured)
                count += more
        elif warm:
            contact, force = frame["contact_mm"] / unit, frame["normal_N"] / unit_force
            if beam.below < contact < beam.above:
                beam.model.set_variable("moved", contact - beam.contact)
                count, solved = beam.newton(force)
            else:
                beam = Beam(finger, order, contact, frame["friction"])
                count, solved = beam.solve(force)
        spent += time.perf_counter() - begin
        answers.append(beam.answer(count, solved))
    return answers, spent, beam


def version():
    """Takes it from Debian's package, since the module does not tell its own."""
    asked = subprocess.run(["dpkg-query", "-W", "-f", "${Version}", "python3-getfem++"],
                           capture_output=True, text=True, check=False)
    return f"GetFEM {asked.stdout}" if asked.returncode == 0 else "GetFEM"


def run(job, folder):
    del folder
    getfem.util_trace_level(0)
    getfem.util_warning_level(0)
    finger = job["finger"]
    settings = []
    for order in (3,) if job["quick"] else (2, 3, 4):
        for scene in job["scenes"]:
            frames = scene["frames"]
            for task, warm in TASKS if finger["gauges"] else TASKS[:2]:
                times = []
                for _ in range(1 if job["quick"] else 5):
                    answers, spent, beam = measure(finger, order, task, warm, frames)
                    times.append(1e6 * spent / len(frames))
                settings.append({
                    "task": task, "scene": scene["scene"],
                    "solver": f"getfem{order}" + ("_warm" if (task, warm) == TASKS[1] else ""),
                    "words": f"GetFEM, exact beam, {len(beam.nodes) - 1} elements of order "
                             f"{order}, from the " + ("frame before" if warm else "straight finger"),
                    "links": 0, "unknowns": beam.model.nbdof(),
                    "answers": answers, "time_us": times})
    return {"version": version(), "settings": settings}
