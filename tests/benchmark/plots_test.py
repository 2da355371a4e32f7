#!/usr/bin/python3
"""The plots of the benchmark page and of finray_compliance, from made numbers."""

import pathlib
import re
import sys
import tempfile
import unittest
from unittest import mock

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.dont_write_bytecode = True
sys.path += [str(ROOT / folder) for folder in ("scripts/benchmark", "scripts/perception", "calib/report")]

try:
    import calibration_plots
    import pareto_plots
    import plot_style
    import render
    import matplotlib.pyplot as plt
except ImportError as missing:
    print(missing)
    sys.exit(77)


def setting(k, time, error):
    return {"id": f"s{k}", "task": "sensing", "scene": "one_contact", "solver": f"s{k}",
            "how": "alone", "family": "taylor", "solved_percent": 100, "contact_error_mm": error,
            "quartile_1_over_yardstick": time}


SETTINGS = [setting(k, 1 + 0.3 * k, 10**-k) for k in range(5)]
NOISE = {"scene": "one_contact", "gauge_rad": 3e-4, "contact_mm": 0.56, "normal_N": 0.1}


class FamiliesTest(unittest.TestCase):
    def test_every_peer_has_a_look_and_a_script(self):
        code = (ROOT / "libfinray/finray/benchmark/peers.cc").read_text("utf-8")
        peers = re.findall(r'"(\w+)"', re.search(r"kPeers = \{(.*?)\}", code, re.S)[1])
        self.assertGreater(len(peers), 4)
        looks = {plot_style.look({"family": peer, "how": "peer"}) for peer in peers}
        self.assertEqual(len(looks), len(peers))
        for peer in peers:
            self.assertTrue((ROOT / f"scripts/peers/{peer}_peer.py").exists(), peer)


class LogAxisTest(unittest.TestCase):
    def labels(self, low, high):
        figure, axes = plt.subplots()
        axes.set_xlim(low, high)
        plot_style.log_axis(axes.xaxis)
        figure.canvas.draw()
        seen = [t.get_text() for t in axes.get_xticklabels()
                if low <= t.get_position()[0] <= high and t.get_text()]
        plt.close(figure)
        return seen

    def test_at_least_two_labels(self):
        self.assertEqual(self.labels(30, 900), ["50", "100", "200", "500"])
        for low, high in ((2.1, 4.9), (2.1e-5, 6e-5), (0.9, 9), (6e-7, 2e-5), (700, 1300)):
            self.assertGreaterEqual(len(self.labels(low, high)), 2, (low, high))
        self.assertGreaterEqual(len(self.labels(1e-9, 1)), 5)


class NoiseTest(unittest.TestCase):
    def test_every_plot_has_the_line_and_its_words(self):
        plot = pareto_plots.pareto(SETTINGS, ["s0"], 100, NOISE)
        self.assertIn("noise of 0.0003 rad: 0.56 mm", plot)
        loads = [{k: v for k, v in s.items() if k != "contact_error_mm"} |
                 {"gauges_error_rad": s["contact_error_mm"]} for s in SETTINGS]
        plot = pareto_plots.pareto(loads, ["s0"], 100, NOISE)
        self.assertIn("noise of the gauges: 0.0003 rad", plot)

    def test_a_line_beyond_the_points_is_in_the_plot(self):
        def line(noise):
            plot = pareto_plots.pareto(SETTINGS, ["s0"], 100, noise)
            return [float(y) for y in re.findall(r'<path d="M [\d.]+ ([\d.]+) \nL [\d.]+ \1 \n" clip-path', plot)]
        self.assertGreater(len(line(dict(NOISE, contact_mm=50))), len(line({})))


class CalibrationTest(unittest.TestCase):
    ROWS = [{"frames": n, "setting": setting, "kind": kind, "cpu_s": seconds * n / 1000, "clock_s": seconds * n / 1000,
             "error_std": error, "stiffness_std_percent": 10 / n**0.5, "memory_MB": 30}
            for n in (210, 1000)
            for setting, kind, seconds, error in (
                ("default", "default", 2, 1e-3), ("2 threads", "threads", 1, 1e-3),
                ("order 4", "scheme", 1.2, 0.3), ("order 8", "scheme", 1.5, 0.1))]

    def test_the_fastest_that_is_enough(self):
        found = render.calibration_enough(self.ROWS, 0.25)
        self.assertEqual([(e["frames"], e["setting"]) for e in found], [(210, "order 8"), (1000, "order 8")])
        self.assertAlmostEqual(found[0]["times_faster"], 2 / 1.5)
        # Hardly faster is no faster.
        close = [dict(r, cpu_s=1.8 * r["frames"] / 1000) if r["setting"] == "order 8" else r for r in self.ROWS]
        self.assertEqual(render.calibration_enough(close, 0.25)[0]["setting"], "default")

    def test_forms_are_no_settings(self):
        forms = [{"frames": 15, "setting": form, "kind": "form", "cpu_s": seconds, "iterations": 4, "converged": "yes",
                  "error_std": 1e-3} for form, seconds in (("reduced", 0.01), ("weighted", 0.5))]
        settings, compared = render.split_forms(self.ROWS + forms)
        self.assertEqual(settings, self.ROWS)
        self.assertEqual([round(form["times"]) for form in compared], [1, 50])

    def test_the_plots_have_noise_and_frames(self):
        plot = calibration_plots.error(self.ROWS)
        self.assertIn("noise of the log", plot)
        self.assertIn("1000 frames", plot)
        self.assertIn("two threads", calibration_plots.frames(self.ROWS))


class ComplianceTest(unittest.TestCase):
    def test_the_objects_are_in_a_legend(self):
        import plot_compliance
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            (folder / "points.csv").write_text(
                "object,displacement_mm,force_N,displacement_std_mm,force_std_N\n"
                "soft,1,2,0.1,0.1\nhard,1,3,0.1,0.1\n")
            (folder / "laws.csv").write_text(
                "object,trial,displacement_mm,force_N\nsoft,1,0,0\nsoft,1,1,2\nhard,1,0,0\nhard,1,1,3\n")
            (folder / "stiffness.csv").write_text(
                "object,stiffness_N_per_mm,std_N_per_mm,calibration_std_N_per_mm\n"
                "soft,2,0.1,0\nhard,3,0.1,0\n")
            with mock.patch.object(plot_compliance, "save") as save:
                plot_compliance.main(folder)
            legend = save.call_args[0][0].axes[0].get_legend()
        self.assertEqual([t.get_text() for t in legend.get_texts()], ["soft", "hard"])


if __name__ == "__main__":
    unittest.main()
