#!/usr/bin/python3
"""Renders report.html of a benchmark: render.py FOLDER, from its benchmark.json."""

import json
import math
import pathlib
import statistics
import sys

sys.dont_write_bytecode = True

sys.path.append(str(pathlib.Path(__file__).resolve().parents[1] / "common"))
import guard  # noqa: E402

guard.protect("render.py", __name__)

LOOK = pathlib.Path(__file__).parents[2] / "calib" / "report"
sys.path.append(str(LOOK))

import jinja2

import calibration_plots
import page
import pareto_plots
import scaling_plots
import whole_file

CLEARLY_FASTER = 1.15  # as for the front
MINUS = "\u2212"
USES = {"30_Hz": "30 Hz control", "1_kHz": "1 kHz control", "batch": "batch of logs",
        "reference": "reference"}
TASKS = {"forward": "Forward: load to shape", "sensing": "Sensing: gauges to contact",
         "estimation": "Estimation: all of finray_estimate"}


def known(value):
    return isinstance(value, (int, float)) and math.isfinite(value)


def figures(value, count=3):
    """A number to so many significant figures."""
    if not known(value):
        return "–"
    if value == 0:
        return "0"
    places = count - 1 - math.floor(math.log10(abs(value)))
    text = f"{value:.{max(0, places)}f}" if places <= 4 else f"{value:.{count - 1}e}"
    return text.replace("-", MINUS)


def small(value):
    """An error: one figure and its power of ten."""
    if not known(value):
        return "–"
    return f"{value:.1e}".replace("-", MINUS) if value else "0"


def duration(us):
    if not known(us):
        return "–"
    for unit, size in (("s", 1e6), ("ms", 1e3)):
        if us >= size:
            return f"{figures(us / size)} {unit}"
    return f"{figures(us)} µs"


def quartiles(setting):
    return " .. ".join(duration(setting[q]) for q in ("quartile_1_us", "quartile_3_us"))


def size(count):
    if not known(count):
        return "–"
    for unit, bytes_ in (("MB", 1e6), ("kB", 1e3)):
        if count >= bytes_:
            return f"{figures(count / bytes_)} {unit}"
    return f"{count:.0f} B"


def tiles(run, by_id):
    out = []
    log = by_id.get("estimation/one_contact/default/block")
    paper = by_id.get("sensing/one_contact/paper100/alone")
    if log:
        out.append(("a frame of a log", duration(log["median_us"]),
                    f"default, one core, l_c off by {small(log['contact_error_mm'])} mm"))
    if log and paper:
        ratio = paper["quartile_1_over_yardstick"] / log["quartile_1_over_yardstick"]
        out.append(("against the paper’s Newton", f"{figures(ratio, 2)} times",
                    f"faster than n = 100, whose l_c is off by {small(paper['contact_error_mm'])} mm"))
    for r in run["recommended"]:
        if r["use"] == "1_kHz" and r["id"]:
            out.append(("live at 1 kHz", f"{figures(r['margin'], 2)} times",
                        "the period over the slowest hundredth of frames"))
    threads = run["scaling"]["threads"]
    if threads:
        best = max(threads, key=lambda t: t["frames_per_s"])
        out.append(("throughput", f"{best['frames_per_s'] / 1e3:.0f} 000 /s",
                    f"frames, {best['threads']} thread" + "s" * (best["threads"] > 1)))
    return out


def verdict(run):
    checks = run["defaults"]
    failing = [c for c in checks if not c["holds"]]
    if not checks:
        return "No setting of the default was measured.", "", False
    if not failing:
        return ("The default lies on the Pareto front.",
                "In every way of sensing one contact no other setting is 20 % faster and more "
                "accurate.", True)
    return ("The default is not the best choice here.",
            "See the table of defaults: " + ", ".join(c["id"] for c in failing) + ".", False)


def enough(run):
    """What is exact enough for the noise of the finger's gauges, with that noise added."""
    floor = next((n for n in run["noise"] if n["scene"] == "one_contact"), {})
    return [dict(e, together_mm=math.hypot(e["contact_rms_mm"], floor["contact_mm"]))
            for e in run["enough"]]


def split_forms(rows):
    """The settings of a calibration; and both forms of equilibrium, one above the other, with
    the weighted one's time over the reduced one's."""
    forms = [r for r in rows if r["kind"] == "form"]
    reduced = {r["frames"]: r["cpu_s"] for r in forms if r["setting"] == "reduced"}
    return ([r for r in rows if r["kind"] != "form"],
            [dict(r, times=r["cpu_s"] / reduced[r["frames"]]) for r in forms])


def calibration_enough(rows, share):
    """By number of frames, the fastest setting on one thread whose error is small against the
    noise of the log, with the default's time over its own."""
    out = []
    for count in sorted({r["frames"] for r in rows}):
        mine = [r for r in rows if r["frames"] == count and r["kind"] != "threads"]
        good = [r for r in mine if r["error_std"] <= share]
        if good:
            best = min(good, key=lambda r: r["cpu_s"])
            default = next(r for r in mine if r["kind"] == "default")
            if default["cpu_s"] < CLEARLY_FASTER * best["cpu_s"]:
                best = default
            out.append(dict(best, times_faster=default["cpu_s"] / best["cpu_s"]))
    return out


def groups(run):
    """Settings by task and scene, in the order they were measured."""
    out = {}
    for s in run["settings"]:
        out.setdefault((s["task"], s["scene"]), []).append(s)
    front = {i for p in run["pareto"] for i in p["front"]}
    return [(f"{task}/{scene}", sorted(rows, key=lambda s: s["quartile_1_over_yardstick"]), front)
            for (task, scene), rows in sorted(out.items(), key=lambda g: list(TASKS).index(g[0][0]))]


def main():
    folder = pathlib.Path(*guard.words(__doc__, 1, 1))
    run = json.loads((folder / "benchmark.json").read_text("utf-8"))
    by_id = {s["id"]: s for s in run["settings"]}
    environment = page.environment(pathlib.Path(__file__).parent, undefined=jinja2.Undefined)
    environment.filters.update(figures=figures, small=small, duration=duration, size=size,
                               quartiles=quartiles)
    headline, meaning, good = verdict(run)
    yardstick_us = statistics.median(
        y for s in run["settings"] for y in s["yardstick_us"])
    noise = {n["scene"]: n for n in run["noise"]}
    scenes = []
    for task in TASKS:
        plots = []
        for front in run["pareto"]:
            if front["task"] != task:
                continue
            plot = pareto_plots.pareto([s for s in run["settings"] if s["task"] == task and
                                        s["scene"] == front["scene"]], front["front"],
                                       yardstick_us, noise.get(front["scene"], {}))
            if plot:
                plots.append((front["scene"].replace("_", " "), plot))
        scenes.append((TASKS[task], plots))
    calibration, forms = None, []
    if (folder / "calibration.json").exists():
        calibration, forms = split_forms(json.loads((folder / "calibration.json").read_text("utf-8")))
    text = environment.get_template("benchmark.html.jinja").render(
        run=run, headline=headline, meaning=meaning, good=good, tiles=tiles(run, by_id),
        uses=USES, noise=noise.get("one_contact"), enough=enough(run), yardstick_us=yardstick_us, by_id=by_id, scenes=scenes, groups=groups(run),
        key=pareto_plots.key(run["settings"]), links=scaling_plots.links(run["settings"]),
        frames=scaling_plots.frames(run["scaling"]["frames"]),
        calibration=calibration, calibration_forms=forms, calibration_enough=calibration and calibration_enough(
            calibration, run["share_of_noise"]),
        calibration_plots=calibration and [calibration_plots.error(calibration),
                                           calibration_plots.frames(calibration)],
        threads=scaling_plots.threads(run["scaling"]["threads"]))
    whole_file.write(folder / "report.html", text)


if __name__ == "__main__":
    main()
