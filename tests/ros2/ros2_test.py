#!/usr/bin/env python3
"""The nodes of examples/ros2 against stand-ins for ROS 2: forces, and a status that no subscriber can miss."""
import math
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
BUILD = pathlib.Path(os.environ.get("FINRAY_BINARY_DIR", ROOT / "build/dev")).resolve()
FINGER = ROOT / "configs/fingers/paper_140mm.yaml"
EXAMPLES = ROOT / "examples/ros2"
STAND_INS = ROOT / "tests/ros2/stand_in"
sys.path.insert(0, str(BUILD / "python"))
try:
    import finray
except ImportError as error:
    print(f"skipped: {error}")
    sys.exit(77)

LOADS = [(70.0, 2.0), (55.0, 1.0)]


def install(folder):
    """finray as its users have it, without the executables. Returns the folder of documents."""
    for component in ("runtime", "dev", "python"):
        subprocess.run(["cmake", "--install", BUILD, "--component", component, "--prefix", folder / "installed"],
                       check=True, stdout=subprocess.DEVNULL)
    return folder / "installed/share/doc"


def build(folder, example):
    shutil.copytree(example, folder / "cpp")
    packages = ";".join(map(str, [folder / "installed", STAND_INS / "cpp/cmake"]))
    subprocess.run(["cmake", "-S", folder / "cpp", "-B", folder / "build", f"-DCMAKE_PREFIX_PATH={packages}",
                    "-DCMAKE_CXX_FLAGS=-Wall -Wextra -Werror -O1"], check=True, stdout=subprocess.DEVNULL)
    subprocess.run(["cmake", "--build", folder / "build"], check=True, stdout=subprocess.DEVNULL)
    return [folder / "build/finray_node"]


class Ros2Test(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        documents = install(pathlib.Path(folder.name))
        cls.nodes = {"Python": [sys.executable, documents / "python3-finray/examples/ros2/python/finray_node.py"],
                     "C++": build(pathlib.Path(folder.name), documents / "libfinray-dev/examples/ros2/cpp")}
        finger = finray.Finger.read(FINGER)
        seen = finray.simulate(finger, {"contact_1_mm": [load[0] for load in LOADS],
                                        "normal_1_N": [load[1] for load in LOADS]})
        cls.seen = seen
        cls.volts = [[seen[f"gauge_{j}_V"][row] for j in range(1, 5)] for row in range(len(LOADS))]
        cls.free = [gauge_V for gauge_V in (finray.simulate(finger, {"contact_1_mm": [70.0], "normal_1_N": [0.0]})
                                            [f"gauge_{j}_V"][0] for j in range(1, 5))]

    def run_node(self, command, rows, *parameters):
        words = [f"finger:={FINGER}", *parameters]
        ended = subprocess.run([*command, "--ros-args", *(word for name in words for word in ("-p", name))],
                               input="".join(" ".join(map(repr, map(float, row))) + "\n" for row in rows),
                               text=True, capture_output=True, timeout=120, check=True,
                               env={**os.environ, "PYTHONPATH": f"{BUILD / 'python'}:{STAND_INS / 'python'}"})
        lines = ended.stdout.splitlines()
        self.assertEqual(len(lines), 2 * len(rows), ended.stdout + ended.stderr)
        frames = []
        for wrench, diagnosis in zip(lines[::2], lines[1::2]):
            topic, frame_id, *numbers = wrench.split()
            self.assertEqual((topic, frame_id), ("wrench", "finray"))
            topic, text = diagnosis.split(" ", 1)
            level, name, message, hardware, *values = text.split("|")
            self.assertEqual((topic, name, hardware), ("/diagnostics", "finray: contacts", "finray"))
            frames.append((list(map(float, numbers)), int(level), message,
                           {key: float(value) for key, value in (pair.split("=") for pair in values)}))
        return frames

    def test_nodes_are_short(self):
        for path in ("python/finray_node.py", "cpp/finray_node.cc"):
            self.assertLess(len((EXAMPLES / path).read_text().splitlines()), 100, path)

    def test_forces_and_torques(self):
        for name, command in self.nodes.items():
            for row, (force, level, message, values) in enumerate(self.run_node(command, self.volts)):
                with self.subTest(node=name, row=row):
                    arc_mm, normal_N = LOADS[row]
                    self.assertEqual((level, message), (0, "ok"))
                    self.assertAlmostEqual(values["contact_mm_1"], arc_mm, delta=0.01)
                    self.assertAlmostEqual(values["normal_N_1"], normal_N, delta=0.001)
                    self.assertAlmostEqual(math.hypot(force[0], force[1]), normal_N, delta=0.001)
                    # The load is perpendicular to the beam, into the finger, at the place that was simulated.
                    angle = self.seen["contact_1_angle_rad"][row]
                    self.assertAlmostEqual(force[0] * math.cos(angle) + force[1] * math.sin(angle), 0, delta=1e-3)
                    self.assertGreater(force[0], 0)
                    x_mm, y_mm = self.seen["contact_1_x_mm"][row], self.seen["contact_1_y_mm"][row]
                    self.assertAlmostEqual(force[2], 1e-3 * (x_mm * force[1] - y_mm * force[0]), delta=1e-4)

    def test_a_force_that_is_not_known_is_no_number(self):
        light = [free + 0.02 * (touched - free) for free, touched in zip(self.free, self.volts[0])]
        torn = [0.3, -0.3, 0.3, -0.3]  # explained by no contact
        for name, command in self.nodes.items():
            with self.subTest(node=name):
                rows = [self.free, torn, self.volts[0][:3], [math.nan] * 4, light, self.volts[0]]
                frames = self.run_node(command, rows)
                self.assertEqual(frames[0][:3], ([0, 0, 0], 0, "no_contact"))
                self.assertTrue(frames[2][2].startswith("bad_input: "), frames[2])
                self.assertEqual(frames[5][2], "ok")
                for force, level, message, values in frames:
                    known = message in ("ok", "no_contact")
                    self.assertEqual(known, level == 0, message)
                    self.assertEqual(known, not any(map(math.isnan, force)), message)
                self.assertEqual({message.split(":")[0] for _, level, message, _ in frames if level == 2} - {"not_converged"},
                                 {"bad_input"})
                self.assertNotEqual(frames[1][1], 0)

    def test_scene(self):
        for command in self.nodes.values():
            (frame,) = self.run_node(command, self.volts[:1], "scene:=contacts: 0")
            self.assertEqual(frame[2] == "ok", False)


if __name__ == "__main__":
    unittest.main()
