#!/usr/bin/python3
"""The plant of scripts/reality against the elastica and against finray_simulate, which
is in FINRAY_BINARY_DIR. Skipped where CalculiX or SciPy is missing."""

import os
import pathlib
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.dont_write_bytecode = True
sys.path.insert(0, str(ROOT / "scripts" / "reality"))

import ccx

try:
    ccx.version()
    import verify
except (ccx.NotInstalled, ImportError) as error:
    print(f"skipped: {error}")
    sys.exit(77)

import plant as plants

BUILD = pathlib.Path(os.environ["FINRAY_BINARY_DIR"])


class CalculixTest(unittest.TestCase):
    def setUp(self):
        self.plant = plants.read(verify.DATA / "strip/plant.yaml")
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.path = pathlib.Path(self.folder.name)

    def test_a_cantilever_is_an_elastica(self):
        for _, solid, exact in verify.cantilever(self.plant, self.path, forces=(1.0,)):
            self.assertLess(verify.difference(solid, exact), 0.2)

    def test_a_point_load_bends_the_strip_finger_as_in_finray(self):
        for _, _, of_gauges, of_sections, place in verify.point_loads(BUILD, self.plant, self.path, [(70.0, 3.0)]):
            self.assertLess(of_gauges, 0.5)
            self.assertLess(of_sections, 0.5)
            self.assertLess(place, 0.02)

    def test_a_circle_presses_the_strip_finger_as_in_finray(self):
        for _, _, force, force_off, gauges_off, place_off in verify.circles(
                BUILD, self.plant, "strip", self.path, 0.0, [(60.0, 3.0)]):
            self.assertGreater(force, 2.0)
            self.assertLess(force_off, 0.5)
            self.assertLess(gauges_off, 0.5)
            self.assertLess(place_off, 0.02)

    def test_friction_bends_the_strip_finger_as_in_finray(self):
        (_, _, _, _, gauges_off, _), = verify.circles(BUILD, self.plant, "strip", self.path, 0.3, [(60.0, 3.0)])
        self.assertLess(gauges_off, 0.5)

    def test_a_one_piece_finger_bends_lightly_as_a_frame_of_beams(self):
        printed = plants.read(verify.DATA / "printed/plant.yaml")
        pressed = verify.pressed(printed, self.path, [(54.0, 0.3)])
        for _, _, _, way_off, gauges_off in verify.frames(printed, plants.RIGID_SHARE, pressed):
            self.assertLess(way_off, 2)
            self.assertLess(gauges_off, 2)

    def test_a_one_piece_finger_bends_far_as_in_finray(self):
        printed = plants.read(verify.DATA / "printed/plant.yaml")
        places = [(50.0, 1.2)]
        touches = verify.touches(printed, self.path, 0.0, places)
        (_, _, force, force_off, gauges_off, place_off), = verify.beside(
            BUILD, printed, "printed", self.path, 0.0, places, touches, plants.RIGID_SHARE)
        self.assertGreater(force, 5)
        self.assertLess(force_off, 3)
        self.assertLess(gauges_off, 2)
        self.assertLess(place_off, 0.2)

    def test_a_deck_that_ccx_refuses_is_one_clear_line(self):
        with self.assertRaisesRegex(ccx.NotSolved, r"^\*ERROR"):
            ccx.run("*NODE\n1,0,0,0\n*NONSENSE\n*STEP\n*STATIC\n*CLOAD\n1,1,x\n*END STEP\n", self.path)


if __name__ == "__main__":
    unittest.main()
