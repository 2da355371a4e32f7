#!/usr/bin/python3
"""calib/report/dxf_finger.py reads the paper's finger back from the outline of its strips."""
import math
import pathlib
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
try:
    import ezdxf
    import numpy as np
    import yaml
except ImportError:
    sys.exit(77)

FRONT, BACK, RIB = 1.2, 1.5, 1.0
RIBS = ((17, 10), (39, 13), (61, 16), (83, 19), (105, 22))
PLACES = (27.157, 51.357, 74.637, 97.026, 118.543)  # of the hinges behind, statics/geometry.h


def cross(a, b):
    return a[0] * b[1] - a[1] * b[0]


def meet(line, other):
    (p, u), (q, v) = line, other
    return p + u * cross(q - p, v) / cross(u, v)


def contours(phi=112.0, base_angle=0.0, rib=RIB):
    """The outer contour and the cells, in frame S."""
    back = np.array([math.cos(math.radians(phi)), math.sin(math.radians(phi))])
    out = np.array([back[1], -back[0]])
    base = np.array([-140 / math.tan(math.radians(phi)), 0.0])
    up = np.array([0.0, 1.0])
    front = [(np.array([x, 0.0]), up) for x in (-FRONT / 2, FRONT / 2)]
    behind = [(base + out * a, back) for a in (BACK / 2, -BACK / 2)]
    along = np.array([math.cos(base_angle), math.sin(base_angle)])
    bottom = (np.array([0.0, -10.0]), along)
    loops = [[meet(front[0], bottom), meet(behind[0], bottom), meet(front[0], behind[0])]]
    below = (np.zeros(2), np.array([1.0, 0.0]))
    for height, angle in RIBS:
        u = np.array([math.cos(math.radians(angle)), math.sin(math.radians(angle))])
        across = np.array([-u[1], u[0]]) * rib / 2
        under, over = [(np.array([0.0, height]) + s * across, u) for s in (-1, 1)]
        loops.append([meet(front[1], below), meet(behind[1], below), meet(behind[1], under), meet(front[1], under)])
        below = over
    loops.append([meet(front[1], below), meet(behind[1], below), meet(front[1], behind[1])])
    return loops


class DxfFingerTest(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.path = pathlib.Path(self.folder.name)

    def tearDown(self):
        self.folder.cleanup()

    def save(self, loops, turn=0.0, mirror=False, unit=4, scale=1.0, lines=False):
        doc = ezdxf.new()
        doc.header["$INSUNITS"] = unit
        space = doc.modelspace()
        c, s = math.cos(turn), math.sin(turn)
        for loop in loops:
            points = [((c * (-x if mirror else x) - s * y + 30) * scale, (s * (-x if mirror else x) + c * y - 7) * scale)
                      for x, y in loop]
            if lines:
                for a, b in zip(points, points[1:] + points[:1]):
                    space.add_line(a, b)
            else:
                space.add_lwpolyline(points, close=True)
        doc.saveas(self.path / "strip.dxf")

    def read(self):
        return subprocess.run(["/usr/bin/python3", str(ROOT / "calib/report/dxf_finger.py"),
                               str(self.path / "strip.dxf"), str(self.path / "out.yaml"), "20", "2.1"],
                              capture_output=True, text=True)

    def expect_paper(self):
        result = self.read()
        self.assertEqual(result.returncode, 0, result.stderr)
        finger = yaml.safe_load((self.path / "out.yaml").read_text("utf-8"))
        self.assertAlmostEqual(finger["geometry"]["front_length_mm"], 140, places=2)
        self.assertAlmostEqual(finger["geometry"]["back_angle_deg"], 112, places=2)
        self.assertAlmostEqual(finger["beams"]["front"]["thickness_mm"], FRONT, places=3)
        self.assertAlmostEqual(finger["beams"]["back"]["thickness_mm"], BACK, places=3)
        self.assertEqual(len(finger["ribs"]), 5)
        for rib, (height, _), place in zip(finger["ribs"], RIBS, PLACES):
            self.assertAlmostEqual(rib["front_mm"], height, places=2)
            self.assertAlmostEqual(rib["back_mm"], place, places=2)
            # E w t^3 / 12 of 2.1 GPa and 20 mm
            self.assertAlmostEqual(rib["bending_stiffness_N_mm2"], 2100 * 20 * RIB**3 / 12, delta=15)
        return result.stdout

    def test_as_drawn(self):
        self.save(contours())
        self.assertIn("unit of the drawing: mm", self.expect_paper())

    def test_a_drawing_that_names_no_unit_is_in_mm(self):
        self.save(contours(), lines=True)
        text = (self.path / "strip.dxf").read_text("utf-8")
        start = text.index("ENTITIES")
        entities = text[start:text.index("ENDSEC", start)]
        (self.path / "strip.dxf").write_text("  0\nSECTION\n  2\n" + entities + "ENDSEC\n  0\nEOF\n")
        self.assertIn("no unit, taken as mm", self.expect_paper())

    def test_thin_ribs_are_hinged_bars(self):
        self.save(contours(rib=0.5))
        result = self.read()
        finger = yaml.safe_load((self.path / "out.yaml").read_text("utf-8"))
        self.assertEqual([sorted(rib) for rib in finger["ribs"]], 5 * [["back_mm", "front_mm"]])
        self.assertNotIn("they bend", result.stdout)

    def test_turned_mirrored_and_in_inches(self):
        self.save(contours(), turn=2.1, mirror=True, unit=1, scale=1 / 25.4)
        self.assertIn("inches", self.expect_paper())

    def test_single_lines_are_joined(self):
        self.save(contours(), turn=-0.4, lines=True)
        self.expect_paper()

    def test_screw_holes_are_left_out(self):
        self.save(contours() + [[(10, -6), (12, -6), (12, -4), (10, -4)]])
        self.assertIn("1 small contours are left out", self.expect_paper())

    def refused(self, words):
        result = self.read()
        self.assertEqual(result.returncode, 2, result.stdout)
        self.assertIn(words, result.stderr)
        self.assertEqual(result.stderr.count("\n"), 1)
        self.assertFalse((self.path / "out.yaml").exists())

    def test_refusals(self):
        self.save(contours(base_angle=0.2))
        self.refused("right angle to the base")
        self.save(contours()[:1])
        self.refused("no cells")
        self.save([])
        self.refused("no closed contour")
        self.save([[(0, 0), (10, 0), (10, 100), (0, 100)], [(2, 2), (8, 2), (8, 98), (2, 98)]])
        self.refused("parallel")
        (self.path / "strip.dxf").write_text("no drawing")
        self.refused("strip.dxf")
        (self.path / "strip.dxf").unlink()
        self.refused("strip.dxf")

    def test_an_open_contour_is_named(self):
        self.save(contours(), lines=True)
        doc = ezdxf.readfile(self.path / "strip.dxf")
        space = doc.modelspace()
        space.delete_entity(space[4])
        doc.saveas(self.path / "strip.dxf")
        self.refused("is not closed")

    def test_odd_drawings_are_one_line(self):
        """Circles without end, places that are no numbers, and things that are no outline."""
        odd = {"1e+12": lambda space: space.add_circle((0, 0), 0.5e12),
               "nan": lambda space: space.add_circle((0, 0), 1e200),
               "1e+15": lambda space: space.add_lwpolyline([(0, 0), (1e15, 0), (0, 1)], close=True),
               "5e+08": lambda space: space.add_lwpolyline([(0, 0, 0, 0, 1e9), (1, 0), (1, 1)], close=True),
               "none of a strip finger": lambda space: space.add_polyface()}
        for words, draw in odd.items():
            with self.subTest(words):
                doc = ezdxf.new()
                doc.header["$INSUNITS"] = 4
                draw(doc.modelspace())
                doc.saveas(self.path / "strip.dxf")
                done = self.read()
                self.assertEqual((done.returncode, done.stdout, done.stderr.count("\n")), (2, "", 1), done.stderr)
                self.assertIn(words, done.stderr)
                self.assertIn("strip.dxf: ", done.stderr)
                self.assertFalse((self.path / "out.yaml").exists())


if __name__ == "__main__":
    unittest.main()
