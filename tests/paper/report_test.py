#!/usr/bin/python3
"""The page of the paper's experiments from tiny canned inputs."""

import math
import pathlib
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.dont_write_bytecode = True
sys.path.insert(0, str(ROOT / "scripts" / "paper"))

import contact_frames
import force_control
import outlines
import report
import simulate
import stiffness
import structural
import structural_plant
from comparison import Comparison, Finding, Section, worst
from inputs import BadInput, read_csv


def figure(ours, paper=0.5, **more):
    return Comparison("place", "Fig. 11, V-B", "mm", paper, ours, "noise 3e-4 rad", "too noisy", **more)


def write(path, header, rows):
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text("\n".join([header, *(",".join(map(str, row)) for row in rows)]) + "\n")


class VerdictTest(unittest.TestCase):
    def test_only_a_smaller_error_beats(self):
        self.assertEqual(figure(0.4).verdict, "beats")
        self.assertEqual(figure(0.6).verdict, "does not beat")
        self.assertEqual(figure(0.5).verdict, "does not beat")
        self.assertEqual(figure(math.nan).verdict, "does not beat")

    def test_nan_is_the_worst(self):
        for numbers in ([0.1, math.nan], [math.nan, 0.1], [math.nan]):
            self.assertTrue(math.isnan(worst(numbers)))
            self.assertEqual(figure(worst(numbers)).verdict, "does not beat")
            self.assertEqual(figure(worst(numbers)).ours_text, "none")
        self.assertEqual(worst([0.1, 0.3, 0.2]), 0.3)
        self.assertEqual(worst([("a", 1), ("b", math.nan), ("c", 2)], key=lambda item: item[1])[0], "b")
        self.assertIn("nan", outlines.three([{"fit": {"mean": 1, "quantile_95": 1, "largest": value}}
                                             for value in (0.1, math.nan)], "fit"))

    def test_a_preview_is_counted_apart(self):
        section = Section("a", "b", [figure(0.4), figure(0.6), figure(0.4, preview=True),
                                     Finding("order", "Fig. 20", "x", "y", "z", True, "")])
        tally = report.tally([section])
        self.assertEqual((tally["beaten"], tally["figures"]), (1, 2))
        self.assertEqual((tally["preview_beaten"], tally["preview_figures"]), (1, 1))

    def test_what_differs_is_counted(self):
        found = [Finding("order", "Fig. 20", "x", "y", "z", agrees, "") for agrees in (True, False, False)]
        section = Section("a", "b", [figure(0.4), *found])
        tally = report.tally([section])
        self.assertEqual((tally["rows"], tally["findings"], tally["differs"]), (4, 3, 2))
        self.assertIn("4 rows. Without a preview 1 of 1 beat", report.tally_text([section]))


class PageTest(unittest.TestCase):
    def test_a_worse_figure_says_so_and_why(self):
        page = report.rendered([Section("Contact", "One sentence.", [figure(0.6)])])
        self.assertIn("0 of 1 with a number are beaten", page)
        self.assertIn("does not beat", page)
        self.assertIn("too noisy", page)
        self.assertIn("These are simulations, not measurements of a real finger", page)

    def test_a_better_one_gives_no_reason(self):
        page = report.rendered([Section("Contact", "One sentence.", [figure(0.4)])])
        self.assertIn("1 of 1 with a number are beaten", page)
        self.assertNotIn("does not beat", page)
        self.assertNotIn("too noisy", page)

    def test_table(self):
        table = report.markdown([Section("Contact", "One sentence.", [figure(0.6)])])
        self.assertIn("| place | Fig. 11, V-B | 0.50 mm | 0.600 mm | does not beat |", table)


class InputTest(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = pathlib.Path(temporary.name)

    def test_a_missing_input_is_one_line(self):
        done = subprocess.run([ROOT / "scripts" / "paper" / "report.py", self.folder], capture_output=True, text=True)
        self.assertEqual(done.returncode, 2)
        self.assertEqual(done.stderr.strip(),
                         f"paper_experiments: {self.folder}/contact_frames/grid.csv: No such file or directory; "
                         "paper_protocol_study writes it")
        self.assertFalse((self.folder / "report.html").exists())

    def test_a_missing_column_is_named(self):
        path = self.folder / "grid.csv"
        write(path, "height_mm,force_N", [(30, 1)])
        with self.assertRaisesRegex(BadInput, "grid.csv: no column place_mm; a study writes it"):
            read_csv(path, ("height_mm", "place_mm"), "a study")

    def test_what_cannot_be_used_is_one_line(self):
        class Experiment:
            __name__ = "springs"

            def __init__(self, action):
                self.sections = action

        with self.assertRaisesRegex(BadInput, "springs: no value 'left_out'"):
            report.sections_of(Experiment(lambda folder: {}["left_out"]), self.folder)
        with self.assertRaisesRegex(BadInput, "springs: no mean: "):
            report.sections_of(Experiment(lambda folder: stiffness.statistics.fmean([])), self.folder)
        with self.assertRaisesRegex(BadInput, "springs: .*division by zero"):
            report.sections_of(Experiment(lambda folder: 1 / 0.0), self.folder)
        path = self.folder / "grid.csv"
        path.write_bytes(b"height_mm\n\xff\n")
        with self.assertRaisesRegex(BadInput, "grid.csv: byte 11 is not UTF-8; a study writes it"):
            read_csv(path, ("height_mm",), "a study")

    def test_points_left_out_are_not_of_the_trial(self):
        """Two of four points are wrong; one of them is left out."""
        folder = self.folder / "seed_1" / "springs"
        write(folder / "points.csv", "object,trial,displacement_mm,force_N,left_out",
              [("spring", 1, 1, 0.2, 0), ("spring", 1, 2, 0.4, 0), ("spring", 1, 3, 50, 0), ("spring", 1, 4, 60, 1)])
        (folder / "compliance.yaml").write_text(
            "trials: [{object: spring, trial: 1, left_out: 1, stiffness_N_per_mm: 0.25, std_N_per_mm: 0.1, "
            "chi2: 9, dof: 1}]")
        why = stiffness.why_trial([self.folder / "seed_1"], [{"name": "spring", "N_per_mm": 0.2}])
        self.assertIn("1 points left out", why)
        self.assertIn("has 1 of 3 points of up to 50 N where the spring has 0.6 N at most", why)

    def structural_draws(self, *places):
        for seed, place in enumerate(places, 1):
            errors = f"{{place_mm: {place}, angle_deg: 0.1, force_N: 0.1, force_percent: 4}}"
            press = f"{{rms_N: {place}, max_N: 0.5, rms_of_all_N: 0.3}}"
            write(self.folder / "structural" / f"seed_{seed}" / "results.yaml", "words: friction", [
                ("bench: {friction: 0.1, hinge_N_mm_per_rad: 12, turn_deg: -0.2}",),
                ("calibration: {verdict: doubtful, freed: [hinge_stiffness]}",),
                (f"contact_frames: {{sensed: {errors}, kinetostatics: {errors}}}",),
                (f"presses: {{plain: {press}, known: {press}}}",), ("outlines: {empty_touches: 1}",)])

    def test_the_structural_column_has_a_verdict_of_its_own(self):
        self.structural_draws(0.5, 0.7)
        self.assertAlmostEqual(structural.mean(self.folder, "sensed", "place_mm"), 0.6)
        self.assertAlmostEqual(structural.worst_press(self.folder, "plain", "rms_N"), 0.7)
        table = report.markdown([Section("Contact", "One sentence.", [figure(0.4, structural=0.6)])])
        self.assertIn("| 0.400 mm | beats | 0.600 mm | does not beat |", table)
        self.assertEqual(figure(0.4, structural=math.nan).structural_verdict, "does not beat")
        self.assertIsNone(figure(0.4).structural_verdict)
        section, = structural.sections(self.folder)
        self.assertIn("hinge stiffness", report.rendered([section]))
        self.assertIn("2 touches of the outlines found no equilibrium", report.rendered([section]))
        self.assertIn("0 of 1 beat the paper.", report.tally_text([Section("a", "b", [figure(0.4, structural=0.6)])]))

    def test_contact_frames(self):
        """Kinetostatics of 0.1 mm beat 0.70 mm; sensing of 0.6 mm is worse than 0.58 mm."""
        folder = self.folder / "contact_frames"
        settings = contact_frames.SETTINGS
        places = {name: 0.1 if "kinetostatics" in name else 0.6 for name in settings}
        write(folder / "grid.csv",
              "setting,height_mm,force_N,place_mean_mm,angle_mean_deg,force_error_mean_N,not_ok_percent",
              [(f'"{name}"', height, force, places[name] * scale, 0.1, 0.02, 0)
               for name in settings for height, force, scale in ((30, 2, 1.5), (80, 4, 0.5))])
        write(folder / "contact_frames.csv", "setting,x_mm,y_mm,true_x_mm,true_y_mm",
              [(f'"{name}"', 1, 30, 1, 30.5) for name in settings])
        write(folder / "by_height.csv", "setting,height_mm,force_rms_N",
              [(f'"{name}"', height, force) for name in settings
               for height, force in ((30, 0.035), (75, 0.01), (80, 0.031))])
        (folder / "conditions.yaml").write_text(
            "{gauge_noise_rad: 0.0003, stage_std_mm: 0.05, force_sensor_std_N: 0.02, circle_radius_mm: 15, draws: 1, "
            "repeats: 1, nominal_error: {front_stiffness_percent: 12, back_stiffness_percent: -10, "
            "largest_rib_length_mm: 0.2}}")
        self.structural_draws(0.5, 0.7)
        section, = contact_frames.sections(self.folder)
        rows = {row.what: row for row in section.rows}
        model = rows["contact frame from kinetostatics, mean error of place"]
        sensed = rows["contact frame sensed, mean error of place"]
        self.assertAlmostEqual(model.ours, 0.1)
        self.assertAlmostEqual(sensed.ours, 0.6)
        self.assertEqual((model.verdict, sensed.verdict), ("beats", "does not beat"))
        self.assertAlmostEqual(sensed.structural, 0.6)
        self.assertAlmostEqual(rows["sensed force, mean error, of the force"].ours, 0.75)
        self.assertEqual(rows["force error near base and tip over that in the middle"].verdict, "same")
        page = report.rendered([section])
        for outside in ('src="', 'href="http', "url(http", "<link", "<script", "@import"):
            self.assertNotIn(outside, page)

    def experiment(self, name, set_point):
        """What finray_control leaves, but for the force: a course at 30 Hz."""
        folder = self.folder / name
        times = [k / 30 for k in range(30 * 30)]
        write(folder / "model.csv", ",".join(force_control.COLUMNS), [(t, set_point(t), 4, 0, 0) for t in times])
        (folder / "summary.yaml").write_text(
            "{finger: f.yaml, experiments: [{paper: {figure: 23, rms_N: 0.32, max_N: 0.65}, "
            "settings: {actuation: {delay_ms: 130, rate_Hz: 30}, run: {measure_from_s: 1.2}}, "
            "controllers: [{name: model, logs: [model.csv]}]}]}")
        return force_control.Experiment(self.folder, name)

    def test_what_a_delay_alone_costs(self):
        """A sqrt(2) sin(pi d / T) on a harmonic; a step of A every second is off by
        A in four of thirty periods."""
        harmonic = self.experiment("fixed_harmonic", lambda t: 4 + 2 * math.sin(2 * math.pi * t / 3.6))
        rms, largest = harmonic.cost_of_delay(0.130)
        self.assertAlmostEqual(rms, 2 * math.sqrt(2) * math.sin(math.pi * 0.130 / 3.6),
                               delta=0.002)
        self.assertAlmostEqual(largest, math.sqrt(2) * rms, delta=0.005)
        steps = self.experiment("fixed_step", lambda t: 3 + 0.25 * math.floor(t + 1e-9))
        self.assertAlmostEqual(steps.cost_of_delay(0.130)[0], 0.25 * math.sqrt(4 / 30), delta=0.002)


class StructuralPlantTest(unittest.TestCase):
    def test_the_plant_has_what_the_page_says(self):
        finger, bench = structural_plant.draw(3)
        self.assertEqual((finger, bench), structural_plant.draw(3))
        self.assertTrue(0 <= bench["friction"] <= 0.2 and 0 <= bench["hinge_N_mm_per_rad"] <= 20)
        for beam in ("front", "back"):
            stiffness = [piece["bending_stiffness_N_mm2"] for piece in finger["beams"][beam]["pieces"]]
            self.assertAlmostEqual(max(stiffness[0], stiffness[-1]) / min(stiffness[0], stiffness[-1]), 1.05, delta=0.004)
        self.assertTrue(all(rib["hinge_stiffness_N_mm_per_rad"] == bench["hinge_N_mm_per_rad"] for rib in finger["ribs"]))
        self.assertNotEqual(finger["gauges"][0]["start_mm"], 30)

    def test_the_stage_reads_turned_axes(self):
        x, y = structural_plant.turned(3.0, 4.0, 90)
        self.assertAlmostEqual(x, -4)
        self.assertAlmostEqual(y, 3)
        with tempfile.TemporaryDirectory() as name:
            log = pathlib.Path(name) / "log.csv"
            log.write_text("object_x_mm,object_y_mm,object_angle_deg\n3,4,10\n")
            structural_plant.moved(log, (0, 0, -90))
            structural_plant.moved(log, (0, 0, 90))  # as a lab that has found the turn
            row, = read_csv(log, ("object_x_mm", "object_y_mm", "object_angle_deg"), "a test")
            for found, true in zip(row.values(), (3, 4, 10)):
                self.assertAlmostEqual(found, true)

    def test_touches_without_an_equilibrium_are_taken_out(self):
        with tempfile.TemporaryDirectory() as name:
            log = pathlib.Path(name) / "log.csv"
            log.write_text("gauge_1_V,object_x_mm,object_angle_deg\n0.1,-15,0\n,,10\n0.2,-14,20\n")
            self.assertEqual(structural_plant.without_empty_rows(log), 1)
            self.assertEqual(log.read_text(), "gauge_1_V,object_x_mm,object_angle_deg\n0.1,-15,0\n0.2,-14,20\n")

    def test_a_frame_without_an_estimate_is_no_good_mean(self):
        truth = {"contact_1_x_mm": ["0", "0"], "contact_1_y_mm": ["50", "60"], "contact_1_angle_rad": ["1.5", "1.5"],
                 "force_N": ["2", "4"]}
        found = {**{name: cells[:1] + [""] for name, cells in truth.items()}, "normal_1_N": ["2.1", ""]}
        both, first = (structural_plant.errors(truth, found, 0, structural_plant.np.array([True, second]))
                       for second in (True, False))
        self.assertTrue(math.isnan(both["place_mm"]))
        self.assertAlmostEqual(first["force_N"], 0.1)
        self.assertAlmostEqual(first["force_percent"], 5)


class SimulateTest(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.out = pathlib.Path(temporary.name) / "out"

    def test_only_known_refusals_are_accepted(self):
        def say(text, code):
            return simulate.run("sh", "-c", f"echo 'finray_reconstruct: {text}' >&2; exit {code}",
                                refusals=simulate.REFUSALS)

        self.assertIsNone(say("a.csv: too few touches: 3 usable", 2))
        self.assertIsNone(say("a.csv: badly spread touches: none", 4))
        for text, code in (("a.csv: no column x", 2), ("too few touches: 3", 4), ("too few touches: 3", 1)):
            with self.assertRaisesRegex(simulate.Failed, f"{text} .exit code {code}"):
                say(text, code)

    def test_only_marked_folders_are_deleted(self):
        simulate.prepare(self.out)
        old = self.out / "stiffness" / "seed_5"
        old.mkdir()
        (self.out / "report.html").touch()
        simulate.prepare(self.out)
        self.assertFalse(old.exists() or (self.out / "report.html").exists())
        old.mkdir()
        (self.out / "outlines" / simulate.MARKER).unlink()
        with self.assertRaisesRegex(simulate.Failed, "outlines: there already and not marked"):
            simulate.prepare(self.out)
        self.assertTrue(old.exists())

    def test_a_name_that_is_a_pattern_is_refused(self):
        for name in ("a[1]", "a*", "a,b"):
            with self.assertRaisesRegex(simulate.Failed, "pattern"):
                simulate.prepare(self.out / name)
        self.assertFalse(self.out.exists())


if __name__ == "__main__":
    unittest.main()
