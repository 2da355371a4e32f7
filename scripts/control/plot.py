#!/usr/bin/python3
"""Plots of force-control experiments: plot.py OUT_DIR

OUT_DIR is that of finray_control. For each experiment of its summary.yaml a PNG
and an SVG beside the logs: set-point, true force of each controller's first draw
and the error, with the rms of all draws; the paper's rms where it has one.
"""

import csv
import math
import pathlib
import sys

sys.path.append(str(pathlib.Path(__file__).resolve().parents[1] / "common"))
import guard  # noqa: E402

guard.protect("plot.py", __name__)

import figure_file
import yaml
from errors import BadInput

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "studies"))
from plot_style import BLUE, GREEN, INK, ORANGE, QUIET, RED, plt, save

plt.rcParams["svg.hashsalt"] = "finray"
plt.rcParams["svg.fonttype"] = "none"
COLOURS = (BLUE, GREEN, ORANGE, RED)


def read(path):
    with open(path, newline="") as file:
        rows = list(csv.DictReader(file))
    number = lambda cell: float(cell) if cell else math.nan
    names = ("time_s", "set_point_N", "force_N", "force_estimate_N", "force_estimate_std_N")
    log = {name: [number(row[name]) for row in rows] for name in names}
    log["mode"] = [row["mode"] for row in rows]
    log["status"] = [row["status"] for row in rows]
    return log


def sure(status, std, limit):
    """Whether the loop believes an estimate; one of no contact has no std."""
    return status == "no_contact" or (status == "ok" and std <= limit)


def spans(log, modes):
    """Where the loop is in one of these modes: pairs of times."""
    start = None
    for time, mode in zip(log["time_s"], log["mode"]):
        if mode in modes and start is None:
            start = time
        if mode not in modes and start is not None:
            yield start, time
            start = None
    if start is not None:
        yield start, log["time_s"][-1]


def label(controller):
    errors = controller.get("control_error", controller.get("estimate_error"))
    return f"{controller['name']}: {errors['rms_N']:.3f} N rms"


def draw(folder, experiment):
    figure, (above, below) = plt.subplots(
        2, 1, figsize=(8.4, 5.2), sharex=True, height_ratios=(3, 2), constrained_layout=True)
    controlled = any("control_error" in c for c in experiment["controllers"])
    most = 0
    for colour, controller in zip(COLOURS, experiment["controllers"]):
        log = read(folder / controller["logs"][0])
        time = log["time_s"]
        if controlled:
            shown, against = log["force_N"], log["set_point_N"]
        else:
            limit = experiment["settings"]["safety"]["force_std_limit_N"]
            shown = [force if sure(status, std, limit) else math.nan
                     for force, status, std in zip(log["force_estimate_N"], log["status"],
                                                   log["force_estimate_std_N"])]
            against = log["force_N"]
        error = [s - a for s, a in zip(shown, against)]
        above.plot(time, shown, color=colour, lw=1.3, label=label(controller))
        below.plot(time, error, color=colour, lw=1.1)
        start = experiment["settings"]["run"]["measure_from_s"]
        most = max([most] + [abs(e) for e, t in zip(error, time) if t >= start and e == e])
        for begin, end in spans(log, ("hold", "stopped")):
            above.axvspan(begin, end, color=colour, alpha=0.06, lw=0)
    above.plot(time, against, color=INK, lw=1.1, ls=(0, (4, 2)),
               label="set-point" if controlled else "true force")
    for axes in (above, below):
        axes.axvspan(0, experiment["settings"]["run"]["measure_from_s"], color=QUIET, alpha=0.1,
                     lw=0)
    below.axhline(0, color=QUIET, lw=0.8)
    title = f"{experiment['name']}, simulated"
    paper = experiment.get("paper")
    if paper:
        title += f" (paper, Fig. {paper['figure']}: {paper['rms_N']:.2f} N rms)"
        for side in (-1, 1):
            below.axhline(side * paper["rms_N"], color=QUIET, lw=1, ls=(0, (1, 2)))
    above.set(title=title, ylabel="force (N)")
    reach = 1.1 * max(most, paper["rms_N"] if paper else 0)
    below.set(xlabel="time (s)", ylabel="error (N)", xlim=(0, time[-1]), ylim=(-reach, reach))
    above.legend(loc="upper left", bbox_to_anchor=(1.0, 1.0), fontsize=8.5)
    svg = folder / f"{experiment['name']}.svg"
    figure_file.write(figure, svg)
    print(svg)
    save(figure, folder / f"{experiment['name']}.png")


def main():
    folder = pathlib.Path(*guard.words(__doc__, 1, 1))
    try:
        summary = yaml.safe_load((folder / "summary.yaml").read_text())
        experiments = summary["experiments"]
    except (OSError, KeyError, TypeError, ValueError, yaml.YAMLError) as error:
        raise BadInput(f"{folder}/summary.yaml is not that of finray_control: {error}") from error
    for experiment in experiments:
        draw(folder, experiment)


if __name__ == "__main__":
    main()
