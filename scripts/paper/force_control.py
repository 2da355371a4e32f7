"""Figs. 23, 25 and 27: force control, as configs/control says."""

import math
import pathlib

import numpy as np

from comparison import Comparison, Finding, Section, count, model_error_text
from inputs import BadInput, read_csv, read_yaml
from look import AFTER, BEFORE, HELD, INK, QUIET, legend, plt, svg

TOOL = "finray_control"
CONFIGS = pathlib.Path(__file__).resolve().parents[2] / "configs" / "control"
COLUMNS = ("time_s", "set_point_N", "force_N", "object_motion_mm", "object_x_mm")
GROUPS = (
    ("Force on a fixed object, Fig. 23",
     "A finger on a stage follows a force that changes; nothing but gauges is measured. The paper gives neither "
     "amplitude nor period: they are chosen so that a lag of 130 ms alone, which the paper blames, costs about what "
     "the paper has.", (("fixed_harmonic", "harmonic force, fixed object"),
                       ("fixed_step", "steps of force, fixed object"))),
    ("Force on a moving object, Fig. 25",
     "6 N are to be held while the object moves in a way that the controller does not know. As the set-point is "
     "constant there is nothing to preview.",
     (("moving_harmonic", "6 N on an object moving harmonically"),
      ("moving_triangular", "6 N on an object moving to and fro"))),
    ("Two fingers on one motor, Fig. 27",
     "4 N to 10 N and back in steps of 2 N, with two four-bar linkages. The paper does not give the linkage, and its "
     "largest error, 0.80 N, rules out that its steps were jumps of 2 N: both are tried.",
     (("two_finger", "steps of 2 N, jumps"), ("two_finger_ramped", "steps of 2 N, each in 0.4 s"))))
# Choices that were made with the paper's figure in view stand beside ours.
CHOSEN = dict.fromkeys(
    ("fixed_harmonic", "fixed_step"),
    "; the course is chosen by us so that a pure delay of 130 ms costs about the rms error that the paper reports")
LOOK = {"model_preview": (HELD, "model-based, with preview"), "model": (AFTER, "model-based"), "pi": (BEFORE, "PI")}


class Experiment:
    """The files that finray_control wrote for one experiment."""

    def __init__(self, folder, name):
        self.name = name
        whole = read_yaml(folder / name / "summary.yaml", ("finger", "experiments"), TOOL)
        experiments, self.finger = whole["experiments"], whole["finger"]
        if not experiments or "paper" not in experiments[0]:
            raise BadInput(f"{folder / name / 'summary.yaml'}: no figure of the paper; {TOOL} writes it")
        summary = experiments[0]
        self.paper, self.settings = summary["paper"], summary["settings"]
        self.controllers = {c["name"]: c for c in summary["controllers"]}
        self.config = read_yaml(CONFIGS / f"{name}.yaml", ("set_point",), "git")
        self.folder = folder / name

    def log(self, controller):
        rows = read_csv(self.folder / self.controllers[controller]["logs"][0], COLUMNS, TOOL)
        return {name: np.array([row[name] for row in rows]) for name in COLUMNS}

    @property
    def measured_from_s(self):
        return self.settings["run"]["measure_from_s"]

    @property
    def jumps(self):
        set_point = self.config["set_point"]
        return set_point["type"] == "steps" and not set_point.get("ramp_s")

    @property
    def delay_s(self):
        return self.settings["actuation"]["delay_ms"] / 1000

    @property
    def period_s(self):
        return 1 / self.settings["actuation"]["rate_Hz"]

    def cost_of_delay(self, delay_s):
        """Rms and largest error of a force that equals the set-point, only this late."""
        log = self.log("model")
        time, wanted = log["time_s"], log["set_point_N"]
        if self.jumps:  # between samples the old value holds
            late = wanted[np.searchsorted(time, time - delay_s + 1e-9, side="right").clip(1) - 1]
        else:
            late = np.interp(time - delay_s, time, wanted)
        error = np.abs(wanted - late)[time >= self.measured_from_s]
        return math.sqrt(np.mean(error ** 2)), np.max(error)

    def largest_jump(self):
        log = self.log("model")
        return np.max(np.abs(np.diff(log["set_point_N"][log["time_s"] >= self.measured_from_s])))

    def contact_stiffness(self):
        """Newtons per mm of the finger where it works, from the log itself."""
        log = self.log("model")
        counts = log["time_s"] >= self.measured_from_s
        return abs(np.polyfit(log["object_x_mm"][counts], log["force_N"][counts], 1)[0])

    def kink_cost(self):
        """Of the object's largest change of speed during delay and period: on it
        nobody can act."""
        log = self.log("model")
        speed = np.diff(log["object_motion_mm"]) / np.diff(log["time_s"])
        spread = np.max(speed) - np.min(speed)
        return spread, spread * (self.delay_s + self.period_s) * self.contact_stiffness()

    def motion_cost(self):
        """The object's largest speed, and what it costs not to know of it for delay
        and period."""
        log = self.log("model")
        speed = np.max(np.abs(np.diff(log["object_motion_mm"]) / np.diff(log["time_s"])))
        return speed, speed * (self.delay_s + self.period_s) * self.contact_stiffness()

    def sensing(self, controller):
        """What the force that the loop follows is off by itself."""
        error = self.controllers[controller]["estimate_error"]["rms_N"]
        return f"The sensed force itself is off by {error:.3f} N rms."

    def conditions(self):
        gauge = read_yaml(self.finger, ("gauges",), TOOL)["gauges"][0]
        runs = self.controllers["model"]["runs"]
        return (f"gauge noise {gauge['noise_V'] / gauge['gain_V_per_rad']:g} rad, "
                f"{model_error_text(self.settings['model_error'])}; loop delay "
                f"{self.settings['actuation']['delay_ms']:g} ms, {self.settings['actuation']['rate_Hz']:g} Hz, "
                f"{count(runs, 'draw')}{CHOSEN.get(self.name, '')}")


def pure_delay(experiment, which):
    """What being late costs, rms (0) or at most (1)."""
    delay, with_period = experiment.delay_s, experiment.delay_s + experiment.period_s
    costs = [experiment.cost_of_delay(d)[which] for d in (delay, with_period)]
    return (f"A pure delay of {1000 * delay:.0f} ms, without any other error, costs {costs[0]:.3f} N "
            f"{'at most' if which else 'rms'} on this course; with the loop's own period ({1000 * with_period:.0f} ms) "
            f"{costs[1]:.3f} N.")


def late_object(experiment):
    """Why a constant force is not held, from how the object moves."""
    motion = experiment.config.get("object_motion", {}).get("type")
    blind = f"{1000 * (experiment.delay_s + experiment.period_s):.0f} ms"
    at = f"{experiment.contact_stiffness():.2f} N/mm"
    if motion == "triangular":
        spread, cost = experiment.kink_cost()
        return (f"Where it turns the object's speed changes by {spread:.1f} mm/s, on which the loop cannot act for "
                f"{blind}: that alone is about {cost:.2f} N at {at}. The paper gives no speed.")
    speed, cost = experiment.motion_cost()
    return (f"The object moves by up to {speed:.1f} mm/s, of which the loop learns {blind} later; a loop that does not "
            f"foresee it is off by {cost:.2f} N at {at}. The paper gives no speed.")


def why_rms(experiment, name):
    """Why the rms is not below the paper's, with what a pure delay would cost."""
    if experiment.config["set_point"]["type"] == "constant":
        return f"{late_object(experiment)} {experiment.sensing(name)}"
    if experiment.controllers[name]["preview"]:
        return experiment.sensing(name)
    return (f"Without preview a set-point is followed late. {pure_delay(experiment, 0)} A controller that guesses smooth "
            "courses from their past could be less late; this one does not.")


def why_largest(experiment, name):
    most = "The largest of all draws is counted."
    if experiment.config["set_point"]["type"] == "constant":
        return f"{late_object(experiment)} {most}"
    if experiment.jumps:
        return (f"A jump of {experiment.largest_jump():g} N is an error of that size at its first instant, whoever "
                f"drives. {most}")
    late = experiment.sensing(name) if experiment.controllers[name]["preview"] else pure_delay(experiment, 1)
    return f"{late} {most}"


def comparisons(experiment, what):
    section = f"Fig. {experiment.paper['figure']}, VI"
    rows = []
    for name in ("model", "model_preview"):
        if name not in experiment.controllers:
            continue
        preview = name == "model_preview"
        errors = experiment.controllers[name]["control_error"]
        how = " (with preview)" if preview else ""
        for kind, paper, ours, why in (("rms", "rms_N", "rms_N", why_rms), ("largest", "max_N", "max_N", why_largest)):
            worse = not errors[ours] < experiment.paper[paper]
            rows.append(Comparison(f"{what}, {kind}{how}", section, "N", experiment.paper[paper], errors[ours],
                                   experiment.conditions(), why(experiment, name) if worse else "", preview))
    return rows


def settled_percent(experiment):
    """Largest error in percent of the set-point, settled, first draw."""
    log = experiment.log("model")
    time, wanted = log["time_s"], log["set_point_N"]
    changes = time[1:][np.abs(np.diff(wanted)) > 1e-9]
    wait = experiment.settings["run"]["settled_after_s"]
    settled = (time >= experiment.measured_from_s) & np.array(
        [not np.any((changes <= t) & (t < changes + wait)) for t in time])
    return 100 * np.max(np.abs(log["force_N"] - wanted)[settled] / wanted[settled])


def plot(experiment):
    figure, (above, below) = plt.subplots(2, 1, figsize=(9.4, 4.2), sharex=True, height_ratios=(2, 1.2))
    most = experiment.paper["rms_N"]
    for name, (colour, label) in reversed(LOOK.items()):
        if name not in experiment.controllers:
            continue
        log = experiment.log(name)
        rms = experiment.controllers[name]["control_error"]["rms_N"]
        error = log["force_N"] - log["set_point_N"]
        above.plot(log["time_s"], log["force_N"], color=colour, lw=1.2, label=f"{label}: {rms:.3f} N rms")
        below.plot(log["time_s"], error, color=colour, lw=1)
        most = max(most, np.max(np.abs(error[log["time_s"] >= experiment.measured_from_s])))
    above.plot(log["time_s"], log["set_point_N"], color=INK, lw=1, ls=(0, (4, 2)), label="set-point")
    for side in (-1, 1):
        below.axhline(side * experiment.paper["rms_N"], color=QUIET, lw=1, ls=(0, (4, 3)))
    above.set(ylabel="force (N)")
    below.set(xlabel="time (s)", ylabel="error (N)", xlim=(experiment.measured_from_s, log["time_s"][-1]),
              ylim=(-1.08 * most, 1.08 * most))
    wanted = log["set_point_N"]
    above.set_ylim(min(wanted) - 1.3 * most, max(wanted) + 1.3 * most)
    legend(above, 4)
    return svg(figure, f"Force control, {experiment.name}")


def table(experiments):
    rows = []
    for experiment, what in experiments:
        for name, controller in experiment.controllers.items():
            errors, settled = controller["control_error"], controller.get("settled_error")
            rows.append([what, "PI" if name.startswith("pi") else "model-based", "yes" if controller["preview"] else "no",
                         f"{errors['rms_N']:.3f}", f"{errors['max_N']:.3f}",
                         f"{settled['rms_N']:.3f}" if settled else "–",
                         f"{controller['lag_ms']:.0f}".replace("-", "\u2212") if "lag_ms" in controller else "–",
                         f"{controller['estimate_error']['rms_N']:.3f}"])
    header = ("", "controller", "preview", "rms, N", "largest, N", "settled, rms, N", "lag, ms", "estimate, rms, N")
    return ("All controllers", header, rows,
            "True force less set-point over all draws; the last column is the error of the sensed force. A preview is "
            "of no use where the set-point is constant.")


def sections(folder):
    made = []
    for title, sentence, members in GROUPS:
        experiments = [(Experiment(folder / "force_control", name), what) for name, what in members]
        rows = [row for experiment, what in experiments for row in comparisons(experiment, what)]
        for experiment, what in experiments:
            lag = experiment.controllers["model"].get("lag_ms")
            if lag is not None and experiment.name == "fixed_harmonic":
                rows.append(Finding(
                    "lag of the force behind a harmonic set-point", "Fig. 23, VI", "about 130 ms", f"{lag:.0f} ms",
                    f"{experiment.conditions()}; without preview, first draw; the lag put in is the paper's, "
                    f"{1000 * experiment.delay_s:.0f} ms, so that this only shows that it comes out again",
                    abs(lag - 130) <= 20, "What is beyond the delay put in is the loop's."))
            if experiment.name.startswith("two_finger"):
                rows.append(Comparison(
                    f"{what}, first draw, largest error in stable steps, of the set-point", "Fig. 27, VI", "%", 5,
                    settled_percent(experiment), f"{experiment.conditions()}, of which the first only, without preview",
                    experiment.sensing("model"), limit=True))
        plots = [(plot(experiment), f"{what[0].upper()}{what[1:]}, first draw; rms of all draws. Dashed in the "
                                    f"lower plot: the paper's {experiment.paper['rms_N']:.2f} N rms.")
                 for experiment, what in experiments]
        made.append(Section(title, sentence, rows, plots, [table(experiments)]))
    return made
