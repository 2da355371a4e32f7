"""The paper's finger as a script of a lab models it: one chain of rigid links from
the front base over the tip to the back base, vectorised with numpy.

Unknowns (theta, F_t, f[, l_c, f_c]): n joint angles, the wrench at the clamped
end, r rib compressions. Residuals: the end's pose (4), joint torques (9), (14),
rib lengths (7). Lengths are over l_0, forces over EI / l_0^2.
"""

import numpy as np


def divide(ends, count, total):
    """Nodes of bays between `ends`, about `count` segments over `total`."""
    nodes = [0.0]
    for a, b in zip(ends[:-1], ends[1:]):
        pieces = max(1, round(count * (b - a) / total))
        nodes += list(a + (b - a) * np.arange(1, pieces + 1) / pieces)
    return np.array(nodes)


class Chain:
    def __init__(self, finger, links):
        unit = finger["front_length_mm"]
        self.unit = unit
        self.force = finger["front_stiffness_N_mm2"] / unit**2
        phi = finger["back_angle_rad"]
        back_length = 1 / np.sin(phi)
        soft = finger["front_stiffness_N_mm2"] / finger["back_stiffness_N_mm2"]
        front_ribs = [rib["front_mm"] / unit for rib in finger["ribs"]]
        back_ribs = [rib["back_mm"] / unit for rib in finger["ribs"]]
        total = 1 + back_length
        front = divide([0, *front_ribs, 1], links, total)
        back = divide([0, *back_ribs, back_length], links, total)
        # The chain walks the back beam from the tip down.
        self.front_nodes = front
        h = np.concatenate([np.diff(front), np.diff(back)[::-1]])
        self.front_joints = len(front) - 1
        self.n = len(h)
        stiffness = np.where(np.arange(self.n) < self.front_joints, 1, 1 / soft)
        self.stiffness = stiffness / h
        up, down = np.array([0, 1]), -np.array([np.cos(phi), np.sin(phi)])
        tip = np.array([0.0, 1.0])
        front_mid = (front[:-1] + front[1:]) / 2
        back_mid = ((back[:-1] + back[1:]) / 2)[::-1]
        self.joints = np.vstack([front_mid[:, None] * up,
                                 tip + (back_length - back_mid)[:, None] * down])
        self.front_mid = front_mid
        self.end = tip + back_length * down
        # A link ahead of each joint; the one ahead of the last ends at the base.
        self.steps = np.diff(np.vstack([[0, 0], self.joints, self.end]), axis=0)
        # Hinges: the number of joints before, and the place at rest.
        self.left = [(int(np.sum(front_mid < s)), s * up) for s in front_ribs]
        self.right = [(self.front_joints + int(np.sum(back_mid > s)),
                       tip + (back_length - s) * down) for s in back_ribs]
        self.rib_length = np.array([rib["length_mm"] / unit for rib in finger["ribs"]])
        self.gauges = np.zeros((len(finger["gauges"]), self.n))
        for j, gauge in enumerate(finger["gauges"]):
            a = gauge["start_mm"] / unit
            b = a + gauge["length_mm"] / unit
            nodes = front if gauge["beam"] == "front" else back
            share = np.clip((np.minimum(nodes[1:], b) - np.maximum(nodes[:-1], a)) /
                            np.diff(nodes), 0, None)
            if gauge["beam"] == "front":
                self.gauges[j, :self.front_joints] = share
            else:
                self.gauges[j, self.front_joints:] = -share[::-1]

    def places(self, theta):
        """Turns of all links and places of their ends."""
        turn = np.concatenate([[0], np.cumsum(theta)])
        c, s = np.cos(turn), np.sin(turn)
        moved = np.column_stack([c * self.steps[:, 0] - s * self.steps[:, 1],
                                 s * self.steps[:, 0] + c * self.steps[:, 1]])
        return turn, np.cumsum(moved, axis=0)

    def at(self, turn, ends, link, rest):
        """The place of a point of a link that lies at `rest` in the straight finger."""
        start = ends[link - 1] if link > 0 else np.zeros(2)
        origin = self.joints[link - 1] if link > 0 else np.zeros(2)
        c, s = np.cos(turn[link]), np.sin(turn[link])
        x, y = rest - origin
        return start + np.array([c * x - s * y, s * x + c * y])

    def model(self, unknowns, contact, force, friction):
        """Residuals of the finger under a contact at an arc length."""
        n, r = self.n, len(self.rib_length)
        theta, wrench, ribs = unknowns[:n], unknowns[n:n + 3], unknowns[n + 3:n + 3 + r]
        turn, ends = self.places(theta)
        joints = ends[:-1]
        loads = []  # joints before, place, force
        distance = np.empty(r)
        for k in range(r):
            left = self.at(turn, ends, *self.left[k])
            right = self.at(turn, ends, *self.right[k])
            across = left - right
            distance[k] = np.hypot(*across)
            push = ribs[k] * across / distance[k]
            loads += [(self.left[k][0], left, push), (self.right[k][0], right, -push)]
        link = int(np.sum(self.front_mid < contact))
        angle = np.pi / 2 + turn[link]
        place = self.at(turn, ends, link, np.array([0, contact]))
        along = np.array([np.cos(angle), np.sin(angle)])
        loads.append((link, place, force * (np.array([along[1], -along[0]]) + friction * along)))
        torque = self.stiffness * theta
        for before, place, push in loads:
            arm = place - joints[:before]
            torque[:before] -= arm[:, 0] * push[1] - arm[:, 1] * push[0]
        arm = ends[-1] - joints
        torque -= wrench[0] + arm[:, 0] * wrench[2] - arm[:, 1] * wrench[1]
        return np.concatenate([[turn[-1]], ends[-1] - self.end, torque,
                               distance - self.rib_length])

    def unknowns(self):
        return self.n + 3 + len(self.rib_length)

    def answer(self, unknowns, contact, force, iterations, solved):
        turn, ends = self.places(unknowns[:self.n])
        tip = self.at(turn, ends, self.front_joints, np.array([0, 1.0])) * self.unit
        return {"solved": bool(solved), "contact_mm": float(contact * self.unit),
                "normal_N": float(force * self.force),
                "gauges_rad": (self.gauges @ unknowns[:self.n]).tolist(),
                "tip_x_mm": float(tip[0]), "tip_y_mm": float(tip[1]),
                "iterations": int(iterations)}
